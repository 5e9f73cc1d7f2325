"""Norms of errors: lists of numbers are made of what the caller has, and the Rust crate computes."""

from __future__ import annotations

from typing import Any

from . import _native
from ._judging import number
from ._taylor import _flat, _like, _refuse_shape


def norms(errors: Any, weights: Any = None, boundary: Any = None) -> dict[str, float]:
    """The norms L1, L2, "max" and "max inside" of errors at points or in cells, as a dict that `solve` of `study` may return.

    errors: a list or an array of any shape, of any sign; NaN is kept. weights: the size of the cell of each, a number for all, or None for
    1/N. boundary: whether each is at the boundary, in the shape of errors, or the places of those that are, from 0; without it there is no
    "max inside", the maximum of the others.

    An error at few points is invisible in L1 and plain in the maximum, and a maximum without the ends hides what happens there: where "max"
    has a lower rate than "max inside", the study says that the boundary loses the order, and is inconclusive unless both are claimed.

    Raises ValueError or TypeError, which names the argument.
    """
    given, errors = errors, _flat("errors", errors, finite=False)
    count = len(errors)
    if weights is None:
        weights = [1 / count] * count if count else []
    elif isinstance(weights, (int, float)) or getattr(weights, "shape", None) == ():
        weights = [number("weights", weights)] * count
    else:
        weights = _like("weights", weights, given, finite=False)
    return dict(_native.norms(errors, weights, None if boundary is None else _mask(boundary, given, count)))


def _mask(boundary, errors, count):
    """Whether each error is at the boundary."""
    given = boundary
    if hasattr(boundary, "reshape") and hasattr(boundary, "tolist"):
        boundary = boundary.reshape(-1).tolist()
    if isinstance(boundary, (str, bytes, dict)) or not hasattr(boundary, "__iter__"):
        raise TypeError(f"boundary: expected true or false for each error, or places, found {boundary!r}")
    flags = []
    for item in boundary:
        flags.extend(item if isinstance(item, (list, tuple)) else [item])
    if all(isinstance(flag, bool) for flag in flags):
        _refuse_shape("boundary", given, errors)
        return flags
    mask = [False] * count
    for k, place in enumerate(flags):
        if isinstance(place, bool) or not hasattr(place, "__index__") or not 0 <= place < count:
            raise ValueError(f"boundary[{k}]: expected a place from 0 to {count - 1}, found {place!r}")
        if mask[place]:
            raise ValueError(f"boundary[{k}]: expected each place once, or True and False for each error; found {place!r} again")
        mask[place] = True
    return mask
