"""Tests of derivatives: they make lists of numbers of what the user's functions take and return, and the Rust crate judges."""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Iterable, Mapping
from numbers import Integral
from typing import Any, Union

from . import _native
from ._judging import number


class Taylor:
    """What a Taylor test has found.

    verdict: "pass", "fail" or "inconclusive"; directions: for each direction the derivatives with what was found, as JSON has them;
    notes: what the test could not do; assert_passes(): AssertionError unless it passes. It has no truth value.
    """

    def __init__(self, verdict: str, text: str, found: str, notes: list[str]) -> None:
        self.verdict = verdict
        self.notes = notes
        self.directions: list[dict[str, Any]] = json.loads(found)["directions"]
        self._text = "\n".join([text, *(f"  note: {note}" for note in notes)])

    def __repr__(self) -> str:
        return self._text

    def __bool__(self) -> bool:
        raise TypeError("a Taylor test has no truth value: use assert_passes(), or verdict == 'pass'")

    def assert_passes(self) -> None:
        """Does nothing if the derivatives are right; raises AssertionError with what was found otherwise."""
        __tracebackhide__ = True
        if self.verdict != "pass":
            raise AssertionError(self._text)


def taylor(
    J: Callable[[Any], Any],
    gradient: Any = None,
    at: Any = None,
    *,
    derivative: Union[Callable[[Any], Any], float, None] = None,
    hessian: Union[Callable[[Any], Any], None] = None,
    directions: Union[int, Iterable[Any]] = 3,
    seed: int = 1,
    scales: Any = None,
    inner: Union[Callable[[Any, Any], Any], None] = None,
    to: float = 1e-6,
) -> Taylor:
    """Tests derivatives of J at a point by Taylor remainders: their order, down to the noise of J, and the size of the derivative.

    J: a function of m; a number, or an array whose components are weighted at random. at: m, a number, a list, an array, or a dict of these.
    gradient: a function of m, or its value at m, of the shape of m. derivative: in its place a function of a direction d that returns dJ·d,
    for J of several components too; or that number, for one given direction. hessian: a function of d that returns the second derivative
    along d: H d in the shape of m, or the number d'Hd.

    directions: how many are drawn by seed, or a list of directions in the shape of m. scales: the sizes of the components of m, if they
    differ. inner: the inner product to which a gradient belongs, inner(gradient, d), if it is not the dot product. to: the part by which a
    derivative may be off, 0 < to < 1.

    Returns a Taylor. Raises ValueError or TypeError, which names the argument, and exceptions of the functions.
    """
    point = _flat("at", at)
    if (gradient is None) == (derivative is None):
        raise ValueError("gradient: expected either gradient or derivative, found " + ("both" if derivative is not None else "neither"))
    to = _part(to)
    drawn = isinstance(directions, Integral)
    if isinstance(directions, bool) or drawn and directions < 1:
        raise ValueError(f"directions: expected a whole number > 0, or a list of directions, found {directions!r}")
    if isinstance(seed, bool) or not isinstance(seed, Integral) or seed < 0:
        raise ValueError(f"seed: expected a whole number >= 0, found {seed!r}")
    along = None if drawn else [_like("directions", direction, at) for direction in directions]
    if along is not None and (not along or not all(any(direction) for direction in along)):
        raise ValueError("directions: expected at least one direction, and none that is zero")
    if along is not None and len(set(map(tuple, along))) < len(along):
        raise ValueError("directions: expected each direction once, found one twice")
    if not (callable(derivative) or derivative is None) and (along is None or len(along) != 1):
        raise ValueError("derivative: expected a function of the direction; a number belongs to one direction, directions=[d]")
    weights = _Weights(seed)
    slope = _Slope(point, gradient, derivative, inner, weights, at, to)
    options = {
        "at": point,
        "scales": None if scales is None else [abs(scale) for scale in _like("scales", scales, at)],
        "along": along,
        "drawn": int(directions) if drawn else 0,
        "seed": int(seed),
        "to": to,
    }
    curvature = None if hessian is None else lambda d: _curvature(hessian, d, inner, weights, at, point)
    found = _native.taylor(lambda m: weights.of("J", J(_shaped(m, at))), slope, curvature, options)
    return Taylor(*found, slope.notes(along))


def adjoint(
    A: Any, At: Any, v: Any, w: Any, *, inner: Union[Callable[[Any, Any], Any], None] = None, trials: int = 3, seed: int = 1, to: float = 1e-10
) -> None:
    """Does nothing if <w, A v> = <At w, v> for random v and w; raises AssertionError with the two numbers otherwise.

    A, At: functions, or matrices with `@`. v, w: an argument of each, whose shapes are taken. inner: the inner product of both spaces, if it
    is not the dot product. to: the part of the sum of the absolute values of the products by which they may differ.
    """
    __tracebackhide__ = True
    to, draw = _part(to), random.Random(seed)
    shape_v, shape_w = _flat("v", v), _flat("w", w)
    if isinstance(trials, bool) or not isinstance(trials, int) or trials < 1:
        raise ValueError(f"trials: expected a whole number > 0, found {trials!r}")
    for trial in range(trials):
        one, other = [draw.gauss(0, 1) for _ in shape_v], [draw.gauss(0, 1) for _ in shape_w]
        # An operator may change its argument, or return the same buffer again: each has one of its own, and its result is used at once.
        forward = _product("A", _applied("A", A, _shaped(one, v)), _shaped(other, w), inner)
        backward = _product("At", _applied("At", At, _shaped(other, w)), _shaped(one, v), inner)
        problem = _native.adjoint(forward, backward, to)
        if problem is not None:
            raise AssertionError(f"adjoint, trial {trial + 1}: {problem}")


def _part(to):
    """The part by which a number may be off. One would allow anything."""
    part = number("to", to, above=0)
    if part >= 1:
        raise ValueError(f"to: expected a number between 0 and 1, found {to!r}")
    return part


class _Weights:
    """Random weights by which several components become one number: the same at every call."""

    def __init__(self, seed):
        self._random, self._weights = random.Random(seed), None
        # The first one, for its keys and its shape.
        self._value = None

    def of(self, name, value):
        if self._weights is None:
            count = len(_flat(name, value, finite=False))
            self._weights, self._value = [1.0] if count == 1 else [self._random.gauss(0, 1) for _ in range(count)], value
        parts = _like(name, value, self._value, finite=False)
        return sum(weight * part for weight, part in zip(self._weights, parts))


class _Slope:
    """dJ·d as a function of a list of numbers, and what of a gradient the directions do not test."""

    def __init__(self, point, gradient, derivative, inner, weights, at, to):
        self._derivative, self._inner, self._weights, self._at, self._to = derivative, inner, weights, at, to
        self._value = gradient(_shaped(point, at)) if callable(gradient) else gradient
        # A gradient in another inner product has no components of its own.
        self._parts = None if derivative is not None or inner is not None else _like("gradient", self._value, at, finite=False)
        # Of each component the largest part of dJ·d in any direction.
        self._shares = [0.0] * len(point)

    def __call__(self, d):
        if callable(self._derivative):
            return self._weights.of("derivative", self._derivative(_shaped(d, self._at)))
        if self._derivative is not None:
            return number("derivative", self._derivative)
        if self._parts is None:
            return number("inner", self._inner(self._value, _shaped(d, self._at)))
        slope = _dot(self._parts, d)
        self._shares = [max(share, abs(a * b / slope) if slope else 1.0) for share, a, b in zip(self._shares, self._parts, d)]
        return slope

    def notes(self, along):
        if self._parts is None or len(self._parts) == 1:
            return []
        notes = []
        if any(_is_parallel(self._parts, direction) for direction in along or []):
            notes.append("a direction is the gradient itself: errors at right angles to it are not tested")
        hidden = [k for k, share in enumerate(self._shares) if self._parts[k] and share < self._to]
        if hidden:
            first = ", ".join(str(k + 1) for k in hidden[:5]) + (", ..." if len(hidden) > 5 else "")
            notes.append(f"components {first} of the gradient are less than {self._to:g} of dJ·d: they are not tested; give scales, or directions along them")
        return notes


def _curvature(hessian, d, inner, weights, at, point):
    direction = _shaped(d, at)
    value = hessian(direction)
    parts = _flat("hessian", value, finite=False)
    if len(parts) == 1 and (len(point) > 1 or not hasattr(value, "__len__")):
        # In one dimension H d is a number as d'Hd is: it is H d.
        return parts[0] * d[0] if len(point) == 1 else parts[0]
    if inner is not None:
        return number("inner", inner(value, direction))
    return _dot(_like("hessian", value, at, finite=False), d)


def _dot(one, other):
    return sum(a * b for a, b in zip(one, other))


def _is_parallel(one, other):
    product, sizes = _dot(one, other), _dot(one, one) * _dot(other, other)
    return sizes > 0 and product * product >= sizes * (1 - 1e-12)


def _applied(name, operator, value):
    if not (callable(operator) or hasattr(operator, "__matmul__")):
        raise TypeError(f"{name}: expected a function, or a matrix with `@`, found {operator!r}")
    return operator(value) if callable(operator) else operator @ value


def _product(name, one, other, inner):
    """An inner product with a value whose shape is known, and the sum of the absolute values of its terms."""
    if inner is not None:
        product = number("inner", inner(one, other))
        return product, abs(product)
    one, other = _like(name, one, other, finite=False), _flat(name, other, finite=False)
    return _dot(one, other), sum(abs(a * b) for a, b in zip(one, other))


def _flat(name, value, finite=True):
    """All numbers of a number, a list, an array or a dict of these, in order."""
    if value is None or isinstance(value, (str, bytes, bool)):
        raise TypeError(f"{name}: expected numbers, found {value!r}")
    if isinstance(value, Mapping):
        return [part for key in value for part in _flat(f"{name}[{key!r}]", value[key], finite)]
    if hasattr(value, "reshape") and hasattr(value, "tolist"):
        value = value.reshape(-1).tolist()
    if isinstance(value, (list, tuple)):
        return [part for place, item in enumerate(value) for part in _flat(f"{name}[{place}]", item, finite)]
    if hasattr(value, "tolist"):
        return _flat(name, value.tolist(), finite)
    part = number(name, value)
    if finite and not float("-inf") < part < float("inf"):
        raise ValueError(f"{name}: expected finite numbers, found {part!r}")
    return [part]


def _like(name, value, like, finite=True):
    """The numbers of a value in the order of those of another, whose keys and shapes it has; a list of all numbers will do."""
    if isinstance(value, Mapping) and isinstance(like, Mapping):
        if set(value) != set(like):
            raise ValueError(f"{name}: expected the keys {list(like)}, found {list(value)}")
        return [part for key in like for part in _like(f"{name}[{key!r}]", value[key], like[key], finite)]
    parts, expected = _flat(name, value, finite), len(_flat(name, like, finite=False))
    if len(parts) != expected:
        raise ValueError(f"{name}: expected {expected} numbers, found {len(parts)}")
    _refuse_shape(name, value, like)
    return parts


def _refuse_shape(name, value, like):
    """Refuses a value in another shape; a list of all its numbers will do."""
    shapes = _shape(value), _shape(like)
    if shapes[0] != shapes[1] and min(map(len, shapes)) > 1:
        raise ValueError(f"{name}: expected the shape {shapes[1]}, found {shapes[0]}")


def _shape(value):
    """Without axes of length 1: a column is a list of numbers, too."""
    shape = getattr(value, "shape", None)
    if shape is None and isinstance(value, (list, tuple)) and value:
        shape = (len(value), *_shape(value[0]))
    return tuple(size for size in shape or () if size != 1)


def _shaped(parts, like):
    """The numbers in the shape of a value."""
    return _taken(iter(parts), like)


def _taken(parts, like):
    if isinstance(like, Mapping):
        return {key: _taken(parts, like[key]) for key in like}
    if isinstance(like, (list, tuple)):
        return type(like)(_taken(parts, item) for item in like)
    if hasattr(like, "reshape") and hasattr(like, "astype") and getattr(like, "shape", ()) != ():
        # In the order of C, whatever that of `like` is: `reshape` makes a view of no other.
        shaped = like.astype(float).copy()
        shaped.reshape(-1)[:] = [next(parts) for _ in range(shaped.size)]
        return shaped
    return next(parts)
