"""Tests of derivatives: right ones pass, wrong ones fail, what nothing tests is said."""

import math

import pytest

import convergence_study as cs

M = [0.3, -0.4, 0.9]


def misfit(m):
    return sum(math.sin((k + 1) * x) ** 2 for k, x in enumerate(m))


def gradient(m):
    return [(k + 1) * math.sin(2 * (k + 1) * x) for k, x in enumerate(m)]


def hessian(d):
    return [2 * (k + 1) ** 2 * math.cos(2 * (k + 1) * x) * part for k, (x, part) in enumerate(zip(M, d))]


def test_right_derivatives_pass_in_every_form():
    cs.taylor(misfit, gradient, M).assert_passes()
    cs.taylor(misfit, gradient(M), M, hessian=hessian).assert_passes()
    slope = lambda d: sum(a * b for a, b in zip(gradient(M), d))
    cs.taylor(misfit, derivative=slope, at=M).assert_passes()
    cs.taylor(misfit, derivative=slope([1, 2, 3]), at=M, directions=[[1, 2, 3]]).assert_passes()
    cs.taylor(misfit, gradient, M, hessian=lambda d: sum(a * b for a, b in zip(hessian(d), d))).assert_passes()
    # A gradient in another inner product.
    riesz = lambda m: [part / 2 for part in gradient(m)]
    inner = lambda g, d: 2 * sum(a * b for a, b in zip(g, d))
    cs.taylor(misfit, riesz, M, inner=inner).assert_passes()
    assert cs.taylor(misfit, riesz, M).verdict == "fail"
    # One number, and a dict.
    cs.taylor(math.exp, math.exp, 0.3, hessian=lambda d: math.exp(0.3) * d).assert_passes()
    parts = {"a": 0.3, "b": [0.5, 0.7]}
    product = lambda m: math.exp(m["a"]) * math.sin(m["b"][0]) * m["b"][1] ** 3
    grad = lambda m: {
        "a": product(m),
        "b": [product(m) / math.tan(m["b"][0]), 3 * product(m) / m["b"][1]],
    }
    cs.taylor(product, grad, parts).assert_passes()


@pytest.mark.parametrize("place", range(3))
@pytest.mark.parametrize("factor", [1 + 1e-3, 1 + 1e-5, -1, 0])
def test_a_wrong_component_fails(place, factor):
    def wrong(m):
        found = gradient(m)
        found[place] *= factor
        return found

    found = cs.taylor(misfit, wrong, M)
    assert found.verdict == "fail" and "is wrong" in repr(found)
    with pytest.raises(AssertionError, match="the differences of J tend to"):
        found.assert_passes()


def test_the_gradient_of_another_point_and_a_wrong_hessian_fail():
    assert cs.taylor(misfit, gradient([part + 1e-4 for part in M]), M).verdict == "fail"
    lacks = lambda d: [*hessian(d)[:2], 0.0]
    found = cs.taylor(misfit, gradient, M, hessian=lacks)
    assert found.verdict == "fail"
    findings = [[one["finding"] for one in direction["derivatives"]] for direction in found.directions]
    assert findings == [["right", "wrong"]] * 3


def test_tangents_of_several_components():
    values = lambda m: [math.exp(m[0]) * m[1], math.sin(m[2])]
    tangent = lambda d: [math.exp(M[0]) * (d[0] * M[1] + d[1]), math.cos(M[2]) * d[2]]
    cs.taylor(values, derivative=tangent, at=M).assert_passes()
    wrong = lambda d: [tangent(d)[0], -tangent(d)[1]]
    assert cs.taylor(values, derivative=wrong, at=M).verdict == "fail"


def test_what_nothing_tests_is_said_and_is_no_pass():
    line = cs.taylor(lambda m: 3 * m[0] - m[1], [3, -1], [0.2, 0.4])
    assert line.verdict == "inconclusive" and "nothing is tested" in repr(line)
    extremum = cs.taylor(lambda m: math.cos(m), lambda m: -math.sin(m), 0.0)
    assert extremum.verdict == "inconclusive" and "zero along this direction" in repr(extremum) and "drawn 6 times" in repr(extremum)
    # A line in one place, and no failure: sin has no curvature at 0.
    cs.taylor(math.sin, math.cos, 0.0).assert_passes()
    along = cs.taylor(misfit, gradient, M, directions=[gradient(M)])
    assert along.verdict == "pass" and along.notes[0].startswith("a direction is the gradient itself")
    with pytest.raises(TypeError, match="no truth value"):
        bool(along)


def test_noise_is_said_with_what_it_allows():
    noisy = lambda m: round(misfit(m), 7)
    found = cs.taylor(noisy, gradient, M)
    assert found.verdict == "inconclusive" and "J has noise of" in repr(found) and "to=1e" in repr(found)
    assert cs.taylor(noisy, gradient, M, to=0.1).verdict != "fail"


def test_an_adjoint_that_is_none_fails():
    matrix = [[1.0, 2.0, 0.5], [0.0, -1.0, 3.0]]
    forward = lambda v: [sum(a * b for a, b in zip(row, v)) for row in matrix]
    backward = lambda w: [sum(matrix[i][j] * w[i] for i in range(2)) for j in range(3)]
    cs.adjoint(forward, backward, [0] * 3, [0] * 2)
    for wrong in (lambda w: [-part for part in backward(w)], lambda w: [*backward(w)[:2], 0.0], lambda w: [math.nan] * 3, lambda w: [math.inf, 0.0, 0.0]):
        with pytest.raises(AssertionError, match="<w, A v> ="):
            cs.adjoint(forward, wrong, [0] * 3, [0] * 2)
    with pytest.raises(AssertionError, match="nothing is tested"):
        cs.adjoint(lambda v: [0.0, 0.0], lambda w: [0.0] * 3, [0] * 3, [0] * 2)
    with pytest.raises(AssertionError, match="they differ by"):
        cs.adjoint(lambda v: [0.0, 0.0], backward, [0] * 3, [0] * 2)
    with pytest.raises(TypeError, match="A: expected a function, or a matrix with `@`, found 2.0"):
        cs.adjoint(2.0, backward, [0] * 3, [0] * 2)


def test_components_that_are_too_small_to_be_tested_are_said():
    J = lambda m: 1e6 * math.exp(m[0]) + 1e-3 * math.sin(m[1])
    wrong = lambda m: [1e6 * math.exp(m[0]), 2e-3]
    found = cs.taylor(J, wrong, [0.1, 0.2])
    assert "components 2 of the gradient are less than 1e-06 of dJ·d: they are not tested" in repr(found)
    assert not cs.taylor(misfit, gradient, M).notes
    # Along the component alone the mistake is seen.
    assert cs.taylor(J, wrong, [0.1, 0.2], directions=[[0, 1]]).verdict != "pass"


@pytest.mark.parametrize(
    "options, message",
    [
        ({"gradient": None}, "gradient: expected either"),
        ({"derivative": abs}, "found both"),
        ({"at": None}, "at: expected numbers"),
        ({"at": [math.nan]}, r"at\[0\]: expected finite"),
        ({"gradient": [1, 2]}, "gradient: expected 3 numbers"),
        ({"directions": 0}, "directions: expected a whole number"),
        ({"directions": [[0, 0, 0]]}, "none that is zero"),
        ({"directions": [[1, 0, 0], [1, 0, 0]]}, "directions: expected each direction once"),
        ({"seed": -1}, "seed: expected a whole number >= 0"),
        ({"scales": [1]}, "scales: expected 3 numbers"),
        ({"gradient": [1j, 2, 3]}, r"gradient\[0\]: expected a number"),
        ({"to": 2}, "to: expected a number between"),
    ],
)
def test_arguments_are_refused_by_name(options, message):
    arguments = {"gradient": gradient, "at": M, **options}
    with pytest.raises((ValueError, TypeError), match=message):
        cs.taylor(misfit, **arguments)


def test_operators_that_change_their_argument_or_return_one_buffer_are_judged_by_what_they_return():
    np = pytest.importorskip("numpy")

    def scaled(factor):
        def in_place(v):
            v *= factor
            return v

        return in_place

    cs.adjoint(scaled(2), scaled(2), np.zeros(4), np.zeros(4))
    for wrong in (scaled(3), lambda w: w / 3):
        with pytest.raises(AssertionError, match="<w, A v> ="):
            cs.adjoint(scaled(2), wrong, np.zeros(4), np.zeros(4))
    buffer = np.empty(4)
    cs.adjoint(lambda v: np.multiply(2, v, out=buffer), lambda w: np.multiply(2, w, out=buffer), np.zeros(4), np.zeros(4))


def test_what_belongs_together_has_the_same_keys_and_shape():
    J = lambda m: math.exp(m["a"]) * math.sin(m["b"])
    slope = {"b": math.exp(0.3) * math.cos(0.7), "a": math.exp(0.3) * math.sin(0.7)}
    at = {"a": 0.3, "b": 0.7}
    cs.taylor(J, slope, at).assert_passes()
    assert cs.taylor(J, {"a": slope["b"], "b": slope["a"]}, at).verdict == "fail"
    with pytest.raises(ValueError, match="gradient: expected the keys"):
        cs.taylor(J, {"x": slope["a"], "y": slope["b"]}, at)
    with pytest.raises(AssertionError, match="<w, A v> ="):
        swapped = lambda v: {"b": v["a"] * 2, "a": v["b"] * 3}
        cs.adjoint(swapped, swapped, at, at)
    np = pytest.importorskip("numpy")
    with pytest.raises(ValueError, match=r"A: expected the shape \(3, 2\), found \(2, 3\)"):
        cs.adjoint(lambda v: v, lambda w: w, np.zeros((2, 3)), np.zeros((3, 2)))


def test_arrays_in_the_order_of_fortran_are_filled():
    np = pytest.importorskip("numpy")
    at = np.asfortranarray([[0.1, 0.2], [0.3, 0.4]])
    cs.taylor(lambda m: np.sum(np.sin(m) ** 2), lambda m: np.sin(2 * m), at).assert_passes()
    with pytest.raises(AssertionError, match="<w, A v> ="):
        cs.adjoint(lambda v: v, lambda w: w.T[::-1], at, at)


def test_a_part_that_allows_any_adjoint_is_refused():
    with pytest.raises(ValueError, match="to: expected a number between 0 and 1"):
        cs.adjoint(lambda v: v, lambda w: [-part for part in w], [0], [0], to=2)


def test_exceptions_of_functions_are_raised():
    def stops(m):
        raise RuntimeError("the solver has stopped")

    with pytest.raises(RuntimeError, match="has stopped"):
        cs.taylor(stops, gradient, M)


def test_arrays_of_any_shape_keep_it():
    np = pytest.importorskip("numpy")
    at = np.array([[1, 2], [3, 4]])

    def J(m):
        assert m["a"].shape == (2, 2) and m["a"].dtype == float and np.shape(m["b"]) == ()
        return np.sum(np.sin(m["a"]) ** 2) * m["b"]

    gradient = lambda m: {"a": np.sin(2 * m["a"]) * m["b"], "b": np.sum(np.sin(m["a"]) ** 2)}
    both = {"a": at, "b": np.float64(2.0)}
    cs.taylor(J, gradient, both, directions=np.int64(3)).assert_passes()
    cs.taylor(J, gradient, both, directions=np.eye(5)[:4]).assert_passes()
    matrix = np.arange(6.0).reshape(2, 3)
    cs.adjoint(matrix, matrix.T, np.zeros(3), np.zeros(2))
    with pytest.raises(AssertionError):
        cs.adjoint(matrix, matrix.T * 1.001, np.zeros(3), np.zeros(2))
