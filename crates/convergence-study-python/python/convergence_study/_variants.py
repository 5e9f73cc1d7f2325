"""Variants of a manufactured solution: its module is run again with each of them."""

import contextlib
import inspect
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


class Variants:
    """A module whose functions are those of one variant after another."""

    def __init__(self, module):
        self.module = module
        # Compiled once, whether or not Python keeps compiled files.
        self.code = compile(inspect.getsource(module), module.__file__, "exec")

    @contextlib.contextmanager
    def chosen(self, variant):
        """The module has the functions of a variant, here and in processes that are started."""
        os.environ[VARIABLE] = variant
        try:
            self._run_again()
            yield
        except Exception as error:
            raise RuntimeError(f"variants: solve does not run with the variant {variant}: {error!r}") from error
        finally:
            del os.environ[VARIABLE]
            self._run_again()

    def _run_again(self):
        """Defines the functions anew. They stay the same objects, for others may have imported them by name."""
        names = vars(self.module)
        before = {name: value for name, value in names.items() if isinstance(value, types.FunctionType) and value.__globals__ is names}
        exec(self.code, names)
        for name, function in before.items():
            function.__code__, function.__defaults__ = names[name].__code__, names[name].__defaults__
            names[name] = function
