"""The functions of the package: they convert arguments, and the Rust crate judges."""

from __future__ import annotations

import json
import os
import pathlib
from collections.abc import Callable, Iterable, Mapping
from types import ModuleType
from typing import Any, Union

from . import _native
from ._native import Judgement, Limit, Study
from ._tables import with_index
from ._variants import Variants, described

Order = Union[float, str, Mapping[str, Union[float, str]], None]
Numbers = Union[Iterable[Any], None]
Names = Union[Iterable[Union[str, int]], str, None]


class Judged(dict):
    """What is judged of a table. It has no truth value: one of any verdict would be true."""

    def __bool__(self) -> bool:
        raise TypeError("what is judged of a table is no truth value: ask the verdict of each")


def judge(
    h: Any = None,
    errors: Numbers = None,
    order: Order = None,
    tolerance: float | None = None,
    *,
    n: Numbers = None,
    dim: float | None = None,
    floor: float = 0.0,
    step: str | int | None = None,
    columns: Names = None,
    names: Names = None,
    ratio: float | None = None,
) -> Any:
    """Judges errors against the order that theory claims.

    h: the steps, in any order, positive; errors: the same number of errors, in any unit. Lists, arrays and series are accepted. n: counts in
    place of the steps, then h = n^(-1/dim): dim=1 for cells along an edge, dim=2 for cells in the plane. Or h is a table: a data frame or an
    xarray.Dataset, whose index is the step, a dict of lists, or a series over its steps; errors is then None. Its columns are recognised as
    `convergence-study rates` does; step (a name, or a number from 1), columns (of errors), names (for all columns), dim and ratio (of the
    steps of numbered levels) say what the table does not.

    order: a number > 0, or ">= 2" for a minimum order, ">= 2.." if any higher rate will do; for a table also a dict of names and orders; None for no claim, which is never a pass.
    tolerance: allowed deviation of the rate from the order, 0 < tolerance < 0.5 and less than the order; None is 0.25, but at most half of the
    order, and a quarter of a minimum order. floor: round-off, in the unit of the errors: the finest
    levels are dropped as long as their errors are not above it.

    Returns a Judgement; for a table of several columns a dict of them by name. Raises ValueError or TypeError, which names the argument, if
    the input is not a table of numbers. NaN among the errors is a finding, not bad input.
    """
    found, is_table = judged("judge", h, errors, order, tolerance, n, dim, floor, step, columns, names, ratio)
    return Judged((judgement.name, judgement) for judgement in found) if is_table else found[0]


def assert_order(
    h: Any = None,
    errors: Numbers = None,
    order: Order = None,
    tolerance: float | None = None,
    *,
    n: Numbers = None,
    dim: float | None = None,
    floor: float = 0.0,
    step: str | int | None = None,
    columns: Names = None,
    names: Names = None,
    ratio: float | None = None,
    allow_inconclusive: bool = False,
) -> None:
    """Does nothing if the order is confirmed; arguments as for judge.

    Raises AssertionError unless every verdict is a pass: the verdict in a line, then the table, the rate, its interval, the reason and what to
    do. With allow_inconclusive only the verdict fail is a failure. Raises ValueError and TypeError as judge does.
    """
    __tracebackhide__ = True
    found, _ = judged("assert_order", h, errors, order, tolerance, n, dim, floor, step, columns, names, ratio)
    message = _native.failure(found, allow_inconclusive)
    if message is not None:
        raise AssertionError(message)


def limit(
    h: Any = None,
    values: Numbers = None,
    order: float | None = None,
    tolerance: float | None = None,
    *,
    n: Numbers = None,
    dim: float | None = None,
) -> Limit:
    """The limit at h = 0 of values without a known exact value, with its interval, the observed order and the grid convergence index.

    h, n, dim: the steps or the counts, as for judge; values: the same number of values, at least three, in any unit; or h is a series of
    values over its steps. order: the theoretical order, or None: then the observed order replaces it. tolerance as for judge.

    Returns a Limit. Raises ValueError or TypeError, which names the argument.
    """
    if values is None and hasattr(getattr(h, "index", None), "nlevels"):
        h, values = h.index, h
    if values is None:
        raise ValueError("values: expected the values at the steps h, found None")
    return _native.limit(_steps(h, n, dim)[0], values, order, optional("tolerance", tolerance))


def study(
    solve: Callable[..., float | Mapping[str, float]],
    n: str | Iterable[int] | None = None,
    order: Order = None,
    budget: float = 60.0,
    tolerance: float | None = None,
    name: str = "study",
    *,
    h: Numbers = None,
    floor: float = 0.0,
    allow_inconclusive: bool = False,
    variants: ModuleType | None = None,
    samples: int | None = None,
    of: str | Mapping[str, str] = "mean",
) -> Study:
    """Computes levels and judges the rates of their errors.

    solve: called level by level, in the thread of the caller; returns a dict of errors by name, or one error. n: whole numbers, each an
    argument of solve, or None or "auto": 8, 16, 32, 64, or coarser ones for an order above 6, then finer ones until every rate has a verdict, at most 8
    levels, while the next one fits the budget (seconds) and its errors are above the floor. The step is 1/n, or the value that solve returns with the errors as "h" or "dt". h: in place of n, the steps
    themselves, each an argument of solve. order: as for judge; a dict has orders by name, and other errors are not judged; one number applies
    to every error. floor: as for judge. name: its name in reports. allow_inconclusive: whether assert_passes() accepts that verdict.

    samples: at least 10: each level is made of so many calls solve(n, seed) with the seeds 1, 2, 3, ..., the same on all levels. of: what makes
    the error of them: their "mean", the root of their mean square, "rms", or "weak", the size of the mean of signed numbers; a dict has it by
    name. How the samples scatter says how well a level is known, and where more samples are needed.

    variants: the module that `convergence-study manufacture FILE --variants --language python` has written, from which solve takes source, data
    and exact values. If the order is lost, solve is run with each variant of the solution, for at most the budget each, and the Study says in
    which part of the program it is lost, as far as that follows.

    Returns a Study. Raises ValueError or TypeError, which names the argument, and exceptions of solve.
    """
    found = options(name, budget=budget, floor=floor, allow_inconclusive=allow_inconclusive, samples=samples, of=of)
    return studied(solve, n, h, order, tolerance, found, variants)


def rates(
    path_or_text: str | os.PathLike[str],
    order: Order = None,
    tolerance: float | None = None,
    *,
    floor: float = 0.0,
    step: str | int | None = None,
    columns: Names = None,
    values: Names = None,
    names: Names = None,
    dim: float | None = None,
    ratio: float | None = None,
    lines: Iterable[str] | str | None = None,
    scale: float | None = None,
    eps: float | None = None,
    samples: str | None = None,
    factor: Order = None,
) -> dict[str, Any]:
    """What the program prints: the object of `convergence-study rates --format json`, as a dict.

    path_or_text: a file, or a text of several lines with a table, a log, a list or JSON. values: the columns of values that tend to an unknown
    limit. lines: where the table is, such as "3-9", or several of them. scale: the size of the solution, and eps: the relative round-off of its
    numbers, which say what may be round-off. samples: "mean", "rms" or "weak": rows with equal steps are samples, at least ten of each. factor: in place of
    order, where convergence is exponential: by which the errors fall for each unit of a count or a degree, a number > 1, ">=3", or a dict. The
    other arguments as for judge. Raises ValueError or TypeError, which names the place in the text or the argument.
    """
    source, is_text = _source(path_or_text)
    for name, value in {"order": order, "dim": dim, "ratio": ratio, "samples": samples}.items():
        if factor is not None and value is not None:
            raise ValueError(f"{name}: expected none beside factor, found {value!r}")
    claim = order if factor is None else factor
    claim = dict(claim) if isinstance(claim, Mapping) else claim
    chosen = _chosen(step, columns, names, dim, ratio, values, lines, samples)
    round_off = [optional("scale", scale), optional("eps", eps)]
    return Judged(json.loads(_native.rates(source, is_text, claim, factor is not None, optional("tolerance", tolerance), number("floor", floor), round_off, chosen)))


def studied(solve, n, h, order, tolerance, options, variants):
    """A study, and where its order is lost, if it is lost and there are variants of its solution."""
    tolerance = optional("tolerance", tolerance)
    description = None if variants is None else described(variants)
    study = _native.study(solve, n, h, order, tolerance, options)
    if description is None or not study._has_lost_order():
        return study
    options, again = {**options, "is_variant": True}, Variants(variants)

    def with_variant(variant):
        with again.chosen(variant):
            return _native.study(solve, n, h, order, tolerance, options)

    return study._where_lost(json.dumps(description), with_variant)


FEWEST_SAMPLES = 10
MAKERS = ("mean", "rms", "weak")


def options(name, test="", *, budget=60.0, floor=0.0, allow_inconclusive=False, samples=None, of="mean"):
    """What a study is called, and what it may do."""
    if not isinstance(name, str):
        raise TypeError(f"name: expected a text, found {name!r}")
    if samples is not None and (isinstance(samples, bool) or not hasattr(samples, "__index__") or samples < FEWEST_SAMPLES):
        raise ValueError(f"samples: expected a whole number >= {FEWEST_SAMPLES}, found {samples!r}")
    floor = number("floor", floor)
    if not 0 <= floor < float("inf"):
        raise ValueError(f"floor: expected a finite number >= 0, found {floor!r}")
    if samples is not None and floor > 0:
        raise ValueError("floor: expected none beside samples, which leaves it no meaning")
    makers = dict(of) if isinstance(of, Mapping) else {"": of}
    for error, maker in makers.items():
        if maker not in MAKERS:
            raise ValueError(f"of: expected one of {', '.join(MAKERS)}, found {maker!r}")
    if samples is None and makers != {"": "mean"}:
        raise ValueError(f"of: expected only with samples, found {of!r}")
    return {
        "name": name,
        "test": test,
        "budget": number("budget", budget),
        "floor": floor,
        "allow_inconclusive": bool(allow_inconclusive),
        "samples": None if samples is None else int(samples),
        "of": [] if samples is None else [(str(error), maker) for error, maker in makers.items()],
        "is_variant": False,
    }


def judged(function, h, errors, order, tolerance, n=None, dim=None, floor=0.0, step=None, columns=None, names=None, ratio=None):
    """The judgements of one or several errors, and whether there may be several; function: the one that was called."""
    tolerance, floor = optional("tolerance", tolerance), number("floor", floor)
    if h is None and n is None and errors is not None:
        h, errors = errors, None
    if errors is not None:
        for name, value in {"step": step, "columns": columns, "names": names, "ratio": ratio}.items():
            if value is not None:
                raise ValueError(f"{name}: expected only with a table in place of h and errors, found {value!r}")
        steps, label = _steps(h, n, dim)
        found = Judgement("error", label, steps, errors, order, tolerance, floor)
        if n is None:
            _refuse_counts(found)
        return [found], False
    if n is not None:
        raise ValueError("errors: expected the errors at the counts n, found None")
    if h is None:
        raise ValueError("h: expected steps, or a table with a column of steps, found None")
    table, is_series = with_index(h)
    found = _native.judge_table(table, order, tolerance, floor, _chosen(step, columns, names, dim, ratio), function)
    if found is None:
        raise ValueError("errors: expected the errors at the steps h, or a table in place of h; found None")
    return found, not is_series


def _steps(h, n, dim):
    """The steps, and their name."""
    if n is None:
        if dim is not None:
            raise ValueError(f"dim: expected only with counts n=[...] or a table, found {dim!r} with steps h")
        if h is None:
            raise ValueError("h: expected steps, or counts as n=[...], found None")
        return h, "h"
    if h is not None:
        raise ValueError("n: expected either steps h or counts n, found both")
    dim = 1.0 if dim is None else number("dim", dim, above=0)
    n = n.tolist() if hasattr(n, "tolist") else n.to_list() if hasattr(n, "to_list") else n
    if isinstance(n, (str, bytes, dict)) or not hasattr(n, "__iter__"):
        raise ValueError(f"n: expected a sequence of numbers, found {n!r}")
    counts = [number(f"n[{k}]", count, above=0) for k, count in enumerate(n)]
    return [count ** (-1 / dim) for count in counts], "1/n" if dim == 1 else f"n^(-1/{dim:g})"


def _refuse_counts(judgement):
    """Raises ValueError if the steps must be counts."""
    if not judgement._are_counts():
        return
    steps = judgement.to_dict()["steps"]
    counts = ", ".join(f"{step:g}" for step in reversed(steps[-4:]))
    more = ", ..." if len(steps) > 4 else ""
    raise ValueError(
        f"h: expected steps, which fall with the errors; found {counts}{more}, which grow where the errors fall\n"
        f"  n=[{counts}{more}]  # if they count cells along an edge\n"
        f"  n=[{counts}{more}], dim=2  # all, in the plane\n"
        f"  n=[{counts}{more}], dim=3  # all, in space\n"
        "If they are steps, the errors grow as the steps fall: nothing converges."
    )


def number(name, value, above=None):
    """A finite number, greater than `above`."""
    expected = "a number" if above is None else f"a finite number > {above}"
    if isinstance(value, (bool, str, bytes, complex)) or _kind(value) in "bcmM" or not hasattr(value, "__float__"):
        raise TypeError(f"{name}: expected {expected}, found {value!r}")
    found = float(value)
    if above is not None and not above < found < float("inf"):
        raise ValueError(f"{name}: expected {expected}, found {value!r}")
    return found


def _kind(value):
    """That of NumPy: "c" is complex, whose imaginary part would be dropped."""
    return getattr(getattr(value, "dtype", None), "kind", "f")


def optional(name, value):
    """A number, or None."""
    return None if value is None else number(name, value)


def _chosen(step, columns, names, dim, ratio, values=None, lines=None, samples=None):
    """How a table is read."""
    return {
        "step": None if step is None else str(step),
        "columns": _names("columns", columns),
        "values": _names("values", values),
        "names": _names("names", names),
        "dim": None if dim is None else number("dim", dim, above=0),
        "ratio": None if ratio is None else number("ratio", ratio, above=1),
        "samples": None if samples is None else str(samples),
        "lines": None if lines is None else [lines] if isinstance(lines, str) else [str(one) for one in lines],
    }


def _names(name, given):
    """A list of names of columns, or of their numbers from 1, if it is given."""
    if given is None:
        return None
    if isinstance(given, (str, int)):
        given = [given]
    if not all(isinstance(one, (str, int)) for one in given):
        raise TypeError(f"{name}: expected names of columns, found {given!r}")
    return [str(one) for one in given]


def _source(path_or_text):
    """A path or a text, and whether it is a text."""
    if isinstance(path_or_text, os.PathLike) or isinstance(path_or_text, str) and "\n" not in path_or_text:
        path = pathlib.Path(path_or_text)
        if not path.is_file():
            raise ValueError(f"path_or_text: expected an existing file, or a text of several lines; found {str(path)!r}")
        return str(path), False
    if isinstance(path_or_text, str):
        return path_or_text, True
    raise TypeError(f"path_or_text: expected a path or a text, found {path_or_text!r}")
