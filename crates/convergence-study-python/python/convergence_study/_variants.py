"""Variants of a manufactured solution: its module is run again with each of them."""

import contextlib
import inspect
import os
import types

VARIABLE = "MANUFACTURE_VARIANT"
COMMAND = "convergence-study manufacture FILE --variants --language python"
PARAMETER = "parameter_"


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
        """The module has the functions of a variant, here and in processes that are started; parameters that were set keep their values."""
        changed = self._changed()
        switches_off = next(one["switches_off"] for one in self.module.VARIANTS["usable"] if one["name"] == variant)
        zero = switches_off["name"] if switches_off["part"] == "parameter" else None
        os.environ[VARIABLE] = variant
        try:
            self._run_again({name: value for name, value in changed.items() if name != zero})
            yield
        except Exception as error:
            raise RuntimeError(f"variants: solve does not run with the variant {variant}: {error!r}") from error
        finally:
            del os.environ[VARIABLE]
            self._run_again(changed)

    def _changed(self):
        """The parameters that have another value than in the file, by name; those that follow others are none."""
        fresh = {"__name__": self.module.__name__}
        exec(self.code, fresh)
        changed = {}
        for name in [name for name in fresh if name.startswith(PARAMETER)]:
            value = getattr(self.module, name)
            if value != fresh[name]:
                plain = name.removeprefix(PARAMETER)
                fresh["set_parameter"](plain, value)
                changed[plain] = value
        return changed

    def _run_again(self, parameters):
        """Defines the functions anew. They stay the same objects, for others may have imported them by name."""
        names = vars(self.module)
        before = {name: value for name, value in names.items() if isinstance(value, types.FunctionType) and value.__globals__ is names}
        exec(self.code, names)
        for name, function in before.items():
            function.__code__, function.__defaults__ = names[name].__code__, names[name].__defaults__
            names[name] = function
        for name, value in parameters.items():
            self.module.set_parameter(name, value)
