import os

_VARIANTS = [
    "",
    @LIST@,
]
_NAME = os.environ.get("MANUFACTURE_VARIANT", "")
if _NAME not in _VARIANTS:
    raise ValueError(
        f"MANUFACTURE_VARIANT: unknown variant `{_NAME}`; expected one of{' '.join(_VARIANTS)}"
    )
_VARIANT = _VARIANTS.index(_NAME)
@CHANGES@

