import os

_VARIANTS = [
    "",
    @LIST@,
]
_VARIANT = os.environ.get("MANUFACTURE_VARIANT", "")
if _VARIANT not in _VARIANTS:
    raise ValueError(
        f"MANUFACTURE_VARIANT: unknown variant `{_VARIANT}`; expected one of{' '.join(_VARIANTS)}"
    )
_NUMBER = _VARIANTS.index(_VARIANT)
@CHANGES@

