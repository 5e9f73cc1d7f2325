"""Norms of errors at points."""

import math

import pytest

import convergence_study as cs

LEVELS = [16, 32, 64, 128, 256]


def errors(n):
    """Of a derivative: of second order inside, of first order at the ends."""
    h = 1 / n
    u = [math.exp(i * h) for i in range(n + 1)]
    inside = [(u[i + 1] - u[i - 1]) / (2 * h) for i in range(1, n)]
    slopes = [(u[1] - u[0]) / h, *inside, (u[n] - u[n - 1]) / h]
    return cs.norms([a - b for a, b in zip(slopes, u)], weights=h, boundary=[0, n])


def test_norms_are_those_of_the_definitions():
    found = cs.norms([3, -4, 1], [0.5, 0.5, 1], [False, True, False])
    assert found == {"L1": 4.5, "L2": math.sqrt(0.5 * 25 + 1), "max": 4, "max inside": 3}
    assert cs.norms([3, -4]) == {"L1": 3.5, "L2": math.sqrt(12.5), "max": 4}
    assert cs.norms([3, -4, 1], 2, [1]) == cs.norms([3, -4, 1], [2, 2, 2], [False, True, False])
    assert all(math.isnan(norm) for norm in cs.norms([3, float("nan")]).values())


def test_arrays_have_norms():
    numpy = pytest.importorskip("numpy")
    found = cs.norms(numpy.array([[1.0, -2.0], [3.0, 4.0]]), numpy.float64(0.25), numpy.array([[False, False], [False, True]]))
    assert found == {"L1": 2.5, "L2": math.sqrt(7.5), "max": 4, "max inside": 3}
    assert found == cs.norms(numpy.array([1.0, -2.0, 3.0, 4.0]), 0.25, numpy.array([3]))


def test_a_maximum_without_its_ends_does_not_hide_them():
    alone = cs.study(errors, n=LEVELS, order={"max inside": 2})
    assert alone.verdict == "inconclusive" and alone.rates["max inside"].verdict == "pass"
    assert "the boundary loses the order: max has the rate 1.00" in str(alone)
    orders = {"max inside": 2, "max": 1, "L2": 1.5, "L1": 2}
    assert cs.study(errors, n=LEVELS, order=orders).verdict == "pass"
    assert cs.study(errors, n=LEVELS, order=2).verdict == "fail"


def test_what_does_not_fit_is_named():
    for arguments, message in [
        (([1, 2], [1]), "weights: expected 2 numbers, found 1"),
        (([1, 2], -1), r"weights\[0\]: expected a finite number >= 0, found -1"),
        (([1, 2], None, [2]), r"boundary\[0\]: expected a place from 0 to 1, found 2"),
        (([1, 2, 3], None, [1, 0, 1]), r"boundary\[2\]: expected each place once, or True and False"),
        (([1, 2], None, [True]), "boundary: expected 2, one for each error, found 1"),
        (([[1, 2, 3], [4, 5, 6]], None, [[True] * 2, [False] * 2, [True] * 2]), r"boundary: expected the shape \(2, 3\), found \(3, 2\)"),
        (([1], None, [0]), "boundary: expected a point that is not at it, found none"),
        (([],), "errors: expected at least one, found none"),
    ]:
        with pytest.raises(ValueError, match=message):
            cs.norms(*arguments)
    with pytest.raises(TypeError, match="boundary: expected true or false"):
        cs.norms([1], None, "ends")
