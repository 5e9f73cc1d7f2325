"""Variants of a manufactured solution: its module is run again with each of them."""

import contextlib
import os
import types

VARIABLE = "MANUFACTURE_VARIANT"
COMMAND = "convergence-study manufacture FILE --variants --language python"


def described(module):
    """Which variants the module has."""
    if not isinstance(module, types.ModuleType):
        raise TypeError(f"variants: expected the module that `{COMMAND}` has written, found {module!r}")
    description = getattr(module, "VARIANTS", None)
    if not isinstance(description, dict) or module.__spec__ is None:
        found = f"found {module.__name__}, which has none; write it again with --variants"
        raise ValueError(f"variants: expected a module with the variants of a solution, as `{COMMAND}` writes it; {found}")
    before = os.environ.get(VARIABLE)
    if before or module._VARIANT:
        raise ValueError(f"variants: expected the solution of the file, found {VARIABLE}={before or ''} in the environment; unset it")
    return description


@contextlib.contextmanager
def chosen(module, variant):
    """The module has the functions of a variant, here and in processes that are started."""
    os.environ[VARIABLE] = variant
    try:
        _run_again(module)
        yield
    except Exception as error:
        raise RuntimeError(f"variants: solve does not run with the variant {variant}: {error!r}") from error
    finally:
        del os.environ[VARIABLE]
        _run_again(module)


def _run_again(module):
    """Defines the functions of a module anew. They stay the same objects, for others may have imported them by name."""
    names = vars(module)
    before = {name: value for name, value in names.items() if isinstance(value, types.FunctionType) and value.__globals__ is names}
    module.__spec__.loader.exec_module(module)
    for name, function in before.items():
        function.__code__, function.__defaults__ = names[name].__code__, names[name].__defaults__
        names[name] = function
