"""The arguments of the package: counts, tables and their indices, claims; copies; what `rates` returns."""

import copy
import inspect
import itertools
import json
import math
import pickle
import subprocess
import sys

import pytest

import convergence_study as cs

N = [10, 20, 40, 80]
H = [1 / n for n in N]
E = [3.1 * h**2 * (1 + 0.2 * h) for h in H]
# Exact numbers: all of them have a short decimal form.
STEPS = [0.4, 0.2, 0.1, 0.05]
SQUARES = [0.16, 0.04, 0.01, 0.0025]


def refusal(*arguments, function=cs.judge, **options):
    with pytest.raises((ValueError, TypeError)) as refused:
        function(*arguments, **options)
    assert "--" not in str(refused.value) and "the data frame" not in str(refused.value)
    return str(refused.value)


def test_levels_that_are_counts_are_refused_with_the_way_out():
    text = refusal(N, E, order=2)
    assert text.startswith("h: expected steps, which fall with the errors; found 10, 20, 40, 80, which grow where the errors fall\n")
    assert "n=[10, 20, 40, 80]  #" in text and "n=[10, 20, 40, 80], dim=2  # all, in the plane" in text and "nothing converges" in text
    along = cs.judge(n=N, errors=E, order=2)
    assert along.verdict == "pass" and along.rate == cs.judge(H, E, order=2).rate
    # Cells in the plane: half the rate in their number.
    cells = cs.judge(n=[n * n for n in N], errors=E, order=2, dim=2)
    assert cells.verdict == "pass" and cells.rate == pytest.approx(along.rate, abs=1e-12)
    assert [row.split()[0] for row in (str(along), str(cells))] == ["1/n", "n^(-1/2)"]
    # As a table, with the same bits.
    table = cs.judge({"n": [n * n for n in N], "L2": E}, order=2, dim=2)["L2"]
    assert table.interval == cells.interval and table.to_dict()["steps"] == cells.to_dict()["steps"]
    # Steps of whole numbers are steps, and errors that grow with steps that are no counts are a finding.
    assert cs.judge([800, 400, 200, 100], [64, 16, 4, 1], order=2).verdict == "pass"
    assert cs.judge([1.5, 3, 6], [4, 2, 1], order=2).code == "grows"
    assert cs.judge([8, 4, 2], [1, math.nan, 1], order=2).verdict == "fail"


def test_tables_are_refused_in_words_of_python_with_calls_that_work():
    table = {"n": N, "L2": E}
    text = refusal(table, order={"L2": 2})
    assert text.startswith("h: expected dim=D for h = n^(-1/D)") and "step=COLUMN" in text
    places = {1: "along an edge", 2: "all, in the plane", 3: "all, in space"}
    assert text.splitlines()[1:] == [f"  judge(table, order={{'L2': 2}}, dim={dim})  # {place}" for dim, place in places.items()]
    # Cells that are counted as the comment says have the order of their steps.
    for call, dim in zip(text.splitlines()[1:], places):
        counted = {"n": [n**dim for n in N], "L2": E}
        assert eval(call.strip(), {"judge": cs.judge, "table": counted})["L2"].verdict == "pass", call
    # Levels that halve the step, two columns of steps, one name twice.
    levels = {"level": [0, 1, 2, 3], "L2": SQUARES}
    text = refusal(levels, order=2)
    assert "judge(table, order=2, ratio=2)  # if each row halves the step" in text
    assert cs.judge(levels, order=2, ratio=2)["L2"].verdict == "pass"
    assert "step='dx'" in refusal({"dx": STEPS, "dt": [0.3, 0.1, 0.02, 0.01], "L2": SQUARES}, order=2)
    assert refusal({"h": [0.2, 0.1, 0.1], "L2": [4, 1, 1]}, order=2).startswith("h: expected steps that fall or rise from row to row")
    assert refusal({"h": STEPS, "L2": [1, 2, 3]}, order=2) == "h: expected 4 cells in each column, found 3 in `L2`"
    assert refusal({"h": [0.2, 0, 0.1], "L2": [4, 1, 1]}, order=2) == "h: expected steps, finite numbers > 0 in each row, found `0` in `h`"
    # What is no number is a level that failed.
    failed = cs.judge({"h": STEPS, "L2": [1, "x", 2, 3]}, order=2)["L2"]
    assert failed.verdict == "fail" and failed.reason == "an error is NaN or infinite"


def test_every_refusal_of_a_table_is_in_words_of_python():
    columns = {"n": N, "level": [0, 1, 2, 3], "dx": STEPS, "log h": [-1.0, -2.0, -3.0, -4.0]}
    columns |= {"steps": N, "u": [3.1, 3.04, 3.01, 3.0025], "drag": [3.1, 3.04, 3.01, 3.0025], "w": [1.0, 3.0, 2.0, 4.0]}
    chosen = [{}, {"dim": 2}, {"ratio": 2}, {"dim": 2, "ratio": 2}, {"step": "L9"}, {"columns": ["L9"]}, {"columns": ["u", "u"]}, {"names": ["a"]}]
    texts, calls = set(), set()
    for names in itertools.chain(itertools.combinations(columns, 2), itertools.combinations(columns, 3)):
        for options in chosen:
            table = {name: columns[name] for name in names}
            try:
                cs.judge(table, order=2, **options)
            except ValueError as error:
                texts.add(str(error))
                for call in str(error).splitlines()[1:]:
                    # Each call that is offered is accepted.
                    assert len(eval(call.strip(), {"judge": cs.judge, "table": table})) > 0, call
                    calls.add(call)
    assert len(texts) > 20 and len(calls) > 8
    assert not [text for text in texts if "--" in text or "data frame" in text or " = ..." in text or "standard input" in text]


def test_offers_are_the_call_as_it_was_made_with_other_arguments(convergence):
    both = {"level": [0, 1, 2, 3], "L2": SQUARES}
    text = refusal(both, order=2, ratio=2, dim=2)
    assert text.splitlines() == ["h: expected one of dim=... and ratio=..., found both", "  judge(table, order=2, ratio=2)"]
    values = {"h": STEPS, "it's": [3.1, 3.04, 3.01, 3.0025]}
    tending = cs.judge(values, order=2)["it's"]
    assert (tending.verdict, tending.code) == ("fail", "too-low") and tending.advice.startswith("The errors tend to about 3, not to zero")
    two = {"it's": STEPS, "2": [0.3, 0.1, 0.02, 0.01], "L2": SQUARES}
    text = refusal(two, order=2, names=["it's dt", "dx", "L2"], step="no")
    assert text == "h: expected step=no, the name or number of a column, found it's dt, dx, L2"
    assert refusal({"N": N, "dt": H, "L2": E}, order=2).splitlines()[-1] == "  judge(table, order=2, step='dt')"
    for function, name in [(cs.assert_order, "assert_order"), (convergence.assert_order, "convergence.assert_order")]:
        assert f"\n  {name}(table, order=2, dim=1)  # along an edge" in refusal({"n": N, "L2": E}, function=function, order=2)


def test_step_columns_names_floor_and_tolerance_mean_what_they_mean_for_rates():
    table = {"a": STEPS, "b": [0.3, 0.15, 0.075, 0.0375], "c": SQUARES, "d": STEPS}
    found = cs.judge(table, order=2, step="b", columns=["c"])
    assert list(found) == ["c"] and found["c"].to_dict()["steps"] == table["b"] and str(found["c"]).split()[0] == "b"
    assert list(cs.judge(table, order=2, step=2, columns="c")) == ["c"]
    # What is not judged stands in the result, and does not decide.
    assert found["c"].left_out == {"a": "no order is claimed", "d": "no order is claimed"} == found["c"].to_dict()["left_out"]
    cs.assert_order(table, order=2, step="b", columns=["c"])
    with pytest.raises(AssertionError, match="^d: fail: 1.000, claimed 2"):
        cs.assert_order(table, order=2, step="b", columns=["c", "d"])
    assert set(cs.judge(table, step="b", columns=["a", "c"])) == {"a", "c"}
    renamed = cs.judge(table, order={"L2": 2}, step="dt", names=["x", "dt", "L2", "H1"])
    assert list(renamed) == ["L2"] and renamed["L2"].verdict == "pass" and renamed["L2"].to_dict()["steps"] == table["b"]
    assert set(renamed["L2"].left_out) == {"x", "H1"}
    assert refusal(table, order=2, step="b", names=["a", "b"]) == "h: expected names=...: 4 names, found 2"
    # The last level is round-off.
    steps, errors = [0.8, *STEPS], [0.64, *SQUARES[:-1], 0.009]
    assert cs.judge(steps, errors, order=2).verdict != "pass"
    floored = cs.judge(steps, errors, order=2, floor=0.009)
    text = "\n".join(["h,e", *(f"{h},{e}" for h, e in zip(steps, errors))])
    [told] = cs.rates(text, order=2, floor=0.009)["rates"]
    assert floored.verdict == told["verdict"] == "pass" and floored.rate == told["fitted"] == pytest.approx(2)
    assert "_ set aside: not above the floor 9e-3" in str(floored)
    assert cs.judge(STEPS, [h**1.9 for h in STEPS], order=2, tolerance=0.05).verdict == "fail"
    assert cs.judge(STEPS, [h**1.9 for h in STEPS], order=2, tolerance=0.2).verdict == "pass"


@pytest.mark.parametrize(
    ("options", "start"),
    [
        (dict(h=H, n=N, errors=E), "n: expected either steps h or counts n, found both"),
        (dict(h=H, errors=E, dim=2), "dim: expected only with counts n=[...] or a table, found 2"),
        (dict(n=N, errors=E, dim=0), "dim: expected a finite number > 0, found 0"),
        (dict(n=N, errors=E, dim="2"), "dim: expected a finite number > 0, found '2'"),
        (dict(n=[10, -1], errors=[1, 2]), "n[1]: expected a finite number > 0, found -1"),
        (dict(n=5, errors=[1]), "n: expected a sequence of numbers, found 5"),
        (dict(n=N), "errors: expected the errors at the counts n, found None"),
        (dict(), "h: expected steps, or a table with a column of steps, found None"),
        (dict(h=H, errors=E, step="h"), "step: expected only with a table in place of h and errors, found 'h'"),
        (dict(h={"h": H, "L2": E}, ratio=1), "ratio: expected a finite number > 1, found 1"),
        (dict(h={"h": H, "L2": E}, columns=[1.5]), "columns: expected names of columns, found [1.5]"),
        (dict(h={"h": H, "L2": E}, step="k"), "h: expected step=k, the name or number of a column, found h, L2"),
        (dict(h=H, errors=E, floor=-1), "floor"),
        (dict(h=H, errors=E, tolerance="x"), "tolerance: expected a number, found 'x'"),
        (dict(function=cs.rates, path_or_text="h e\n1 1", dim=0), "dim: expected a finite number > 0, found 0"),
    ],
)
def test_what_is_no_argument_is_refused_by_name(options, start):
    assert refusal(order=2, **options).startswith(start)


def test_no_order_is_claimed_and_nothing_is_said_about_one():
    v = cs.judge(STEPS, SQUARES)
    assert (v.verdict, v.order, v.reason) == ("inconclusive", None, "no order is claimed")
    assert v.rate == pytest.approx(2) and v.advice == "Claim what theory says: order=2, for example."
    assert "error: inconclusive: 2.000000 ± 0.0000005: no order is claimed\n" in str(v) and "positive numbers" not in str(v)
    found = cs.limit(STEPS, [3 + e for e in SQUARES])
    assert found.reason == "observed order 2.0000 ± 0.00005" and "claim" not in repr(found)
    assert cs.limit(n=N, values=[3 + h * h for h in H]).value == pytest.approx(3, abs=1e-9)
    for arguments, start in [((H,), "values: expected the values"), ((None, E), "h: expected steps, or counts as n=[...]")]:
        assert refusal(*arguments, function=cs.limit).startswith(start)
    with pytest.raises(AssertionError, match="error: inconclusive: 2.000: no order is claimed"):
        cs.assert_order(STEPS, SQUARES)


def test_a_study_takes_steps():
    steps = []

    def solve(h):
        steps.append(h)
        return {"L2": h**2}

    r = cs.study(solve, h=[0.05, 0.1, 0.2], order={"L2": 2})
    assert r.verdict == "pass" and steps == [0.2, 0.1, 0.05] and list(r.table()["h"]) == steps
    own = cs.study(lambda h: {"dt": 3 * h, "L2": h**2}, h=[0.2, 0.1, 0.05], order=2)
    assert own.to_dict()["levels"][0] == {"dt": pytest.approx(0.6), "L2": pytest.approx(0.04)} and str(own).splitlines()[1].split()[0] == "dt"
    assert refusal(solve, [0.1, 0.05], function=cs.study, order=2) == "n[0]: expected a whole number > 0, found 0.1; give steps as h=[...]"
    wrong = [([], "h: expected"), ([0.1, 0.1], "h[1]: expected each"), ([0.1, math.nan], "h[1]: expected a finite number > 0")]
    for h, start in [*wrong, (5, "h: expected a sequence")]:
        assert refusal(solve, h=h, function=cs.study, order=2).startswith(start)
    assert refusal(solve, [8], h=[0.1], function=cs.study, order=2) == "h: expected either n or h, found both"
    assert refusal(solve, name=3, function=cs.study, order=2) == "name: expected a text, found 3"
    # Round-off on the finest level.
    late = lambda n: max(n**-4.0, 1e-6)
    assert cs.study(late, [4, 8, 16, 32, 64], order=4).verdict != "pass"
    assert cs.study(late, [4, 8, 16, 32, 64], order=4, floor=1e-6).verdict == "pass"


def test_the_first_line_of_a_failure_is_the_verdict():
    for call in [lambda: cs.assert_order(STEPS, STEPS, order=2), lambda: cs.study(lambda h: h, h=STEPS, order=2).assert_passes()]:
        with pytest.raises(AssertionError) as failed:
            call()
        assert str(failed.value).splitlines()[0] == "error: fail: 1.000, claimed 2 ± 0.25: too low"
    # Of several errors the first that fails.
    table = {"h": STEPS, "L2": SQUARES, "max": STEPS, "H1": [1, 1.5, 0.3, 0.1]}
    with pytest.raises(AssertionError) as failed:
        cs.assert_order(table, order={"L2": 2, "H1": 1, "max": 2})
    assert str(failed.value).splitlines()[0].startswith("max: fail: 1.000, claimed 2 ± 0.25: too low")
    with pytest.raises(AssertionError, match="^no order is claimed"):
        cs.assert_order(table, order={})
    at_least = cs.judge(STEPS, [h**3 for h in STEPS], order=">=2")
    assert "claimed at least 2 ± 0.25: at least 1.75\n" in str(at_least)


def test_inconclusive_is_allowed_where_that_is_said():
    cs.assert_order(STEPS[:2], SQUARES[:2], order=2, allow_inconclusive=True)
    cs.study(lambda n: n**-2.0, [8, 16], order=2, allow_inconclusive=True).assert_passes()
    with pytest.raises(AssertionError, match="error: inconclusive"):
        cs.study(lambda n: n**-2.0, [8, 16], order=2).assert_passes()
    with pytest.raises(AssertionError, match="fail"):
        cs.assert_order(STEPS, STEPS, order=2, allow_inconclusive=True)


def test_module_and_fixture_have_the_same_signatures(convergence):
    for name in ["judge", "assert_order", "limit", "study"]:
        assert inspect.signature(getattr(convergence, name)) == inspect.signature(getattr(cs, name)), name
    assert convergence.judge(n=N, errors=E, order=2).verdict == "pass"
    assert convergence.limit(STEPS, [3 + e for e in SQUARES]).value == pytest.approx(3, abs=1e-9)
    table = {"n": [n * n for n in N], "L2": E, "H1": H, "max": E}
    found = convergence.assert_order(table, order={"L2": 2, "H1": 1}, dim=2)
    assert found.verdict == "pass" and list(found.rates) == ["L2", "H1"]
    assert convergence.study(lambda h: h**2, h=STEPS, order=2, name="square").id.endswith("signatures-square")
    with pytest.raises(TypeError, match="unexpected keyword argument 'dimension'"):
        convergence.assert_order(table, order=2, dimension=2)


def test_an_index_is_the_step():
    pandas = pytest.importorskip("pandas")
    expected = cs.judge(STEPS, SQUARES, order=2)
    series = pandas.Series(SQUARES, index=STEPS)
    found = cs.judge(series, order=2)
    assert (found.name, found.interval) == ("error", expected.interval)
    assert cs.judge(errors=series.rename("L2"), order=2).name == "L2"
    frame = pandas.DataFrame({"L2": SQUARES, "H1": STEPS}, index=STEPS)
    assert cs.judge(frame, order={"L2": 2, "H1": 1})["L2"].interval == expected.interval
    assert str(cs.judge(frame.rename_axis("dx"), order={"L2": 2})["L2"]).split()[0] == "dx"
    cs.assert_order(pandas.DataFrame({"L2": E}, index=pandas.Index(N, name="n")), order=2, dim=1)
    assert cs.limit(pandas.Series([3 + e for e in SQUARES], index=STEPS)).value == pytest.approx(3, abs=1e-9)
    # Numbers of rows are no steps, also after a selection.
    table = pandas.DataFrame({"h": [*STEPS, 0.9], "L2": [*SQUARES, 7.0]})
    assert cs.judge(table[table.h < 0.5], order=2)["L2"].interval == expected.interval
    assert cs.judge(table[table.h < 0.3].sort_values("h"), order=2)["L2"].to_dict()["steps"] == STEPS[1:]
    counts = pandas.DataFrame({"dofs": [25, 100, 400, 1600], "L2": SQUARES})
    assert cs.judge(counts[counts.dofs > 25], order=2, dim=2)["L2"].to_dict()["steps"] == [0.1, 0.05, 0.025]
    assert refusal(pandas.Series(SQUARES), order=2).startswith("h: expected a series whose index is the step")
    assert "dim=2" in refusal(pandas.Series(E, index=N), order=2)
    two = pandas.DataFrame({"L2": SQUARES}, index=pandas.MultiIndex.from_arrays([STEPS, STEPS], names=["h", "dt"]))
    assert refusal(two, order=2) == "h: expected one index, the step; found 2: h, dt"
    assert refusal(frame.rename_axis("L2"), order=2).startswith("h: expected one step; found an index and a column of the name `L2`")


def test_the_coordinate_of_a_dataset_is_the_step():
    xarray = pytest.importorskip("xarray")
    data = xarray.Dataset({"L2": ("h", SQUARES), "H1": ("h", STEPS)}, coords={"h": STEPS})
    found = cs.judge(data, order={"L2": 2, "H1": 1})
    assert found["L2"].interval == cs.judge(STEPS, SQUARES, order=2).interval
    assert cs.judge(data["L2"], order=2).name == "L2"
    two = xarray.Dataset({"L2": (("h", "dt"), [[1.0, 2.0]])}, coords={"h": [0.1], "dt": [0.1, 0.2]})
    assert refusal(two, order=2).startswith("h: expected one index, the step; found 2")


def objects():
    yield cs.judge(STEPS, SQUARES, order=2)
    yield cs.judge(STEPS, [1, math.nan, 0.3, 0.1], order=">=1.5", floor=1e-3)
    yield cs.judge({"dx": STEPS, "L2": SQUARES})["L2"]
    yield cs.limit(STEPS, [3 + e for e in SQUARES], order=2)
    yield cs.limit(STEPS[:3], [1, 2, 1])
    yield cs.study(lambda n: {"L2": n**-2.0 + 1.5 * n**-3.0, "H1": n**-1.0}, order={"L2": 2, "H1": ">=1"})
    yield cs.study(lambda h: {"L2": h}, h=STEPS, order=2, floor=1e-3, name="wrong", allow_inconclusive=True)
    yield cs.study(lambda n: {"L2": n**-2.0}, [8, 16], order={"L3": 2})


@pytest.mark.parametrize("found", list(objects()), ids=lambda found: type(found).__name__)
def test_results_are_copied_pickled_and_put_into_dicts(found):
    for again in [pickle.loads(pickle.dumps(found)), copy.copy(found), copy.deepcopy(found)]:
        assert type(again) is type(found) and repr(again) == repr(found) and again.to_dict() == found.to_dict()
        if not isinstance(found, cs.Limit):
            assert again._repr_html_() == found._repr_html_()
    dictionary = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    for name in set(dictionary) - {"rates", "levels", "steps", "errors", "pairwise"}:
        value = getattr(found, name)
        assert dictionary[name] == (list(value) if isinstance(value, tuple) else value), name
    if isinstance(found, cs.Study):
        assert dictionary["rates"] == {name: json.loads(json.dumps(rate.to_dict())) for name, rate in found.rates.items()}


def test_rates_returns_what_the_program_prints(tmp_path):
    path = tmp_path / "errors.csv"
    path.write_text("h,L2,H1,u\n" + "".join(f"{h},{e},{h},{3 + e}\n" for h, e in zip(STEPS, SQUARES)))
    arguments = ["--order", "L2=2", "--order", "H1=>=1", "--values", "u", "--format", "json"]
    printed = subprocess.run([sys.executable, "-m", "convergence_study", "rates", path, *arguments], capture_output=True, check=False).stdout
    options = dict(order={"L2": 2, "H1": ">=1"}, values=["u"])
    assert cs.rates(path, **options) == cs.rates(str(path), **options) == cs.rates(path.read_text(), **options) == json.loads(printed)
    assert [rate["norm"] for rate in json.loads(printed)["rates"]] == ["L2", "H1", "u"]
    assert cs.rates(path)["verdict"] == "inconclusive" and cs.rates(path, order=3, columns="L2")["verdict"] == "fail"
    counts = "n L2\n10 0.16\n20 0.04\n40 0.01\n"
    text = refusal(counts, function=cs.rates, order=2)
    assert text.startswith("text:1:1: expected dim=D") and "\n  rates(text, order=2, dim=2)  # all, in the plane" in text
    assert cs.rates(counts, order=2, dim=1)["verdict"] == "inconclusive"
    assert cs.rates("level L2\n0 0.16\n1 0.04\n2 0.01\n", ratio=2)["step"] == "2^(-level)"
    path.write_text(counts)
    repeated = "text:4:1: expected steps that fall or rise from row to row, found `h`"
    assert f"\n  rates({str(path)!r}, order=2, dim=2)  #" in refusal(path, function=cs.rates, order=2)
    assert refusal("h L2\n0.2 4\n0.1 1\n0.1 1\n", function=cs.rates, order=2).startswith(repeated)
    found = refusal("h L2\n0.2 4\n0.1 1\n", function=cs.rates, order={"L3": ">=2"})
    assert found == "order={'L3': '>=2'}: expected a column of errors: L2; found `L3`, did you mean `L2`?"
    # The table is in lines 3 to 6.
    lines = "h L2\n0.2 4\nh L2\n0.2 4\n0.1 1\n0.05 0.25\n"
    for given in ["3-6", ["3-6"]]:
        result = cs.rates(lines, order=2, lines=given)
        assert result["verdict"] == "pass" and len(result["rates"][0]["levels"]) == 3
    assert refusal(lines, function=cs.rates, lines="6-3") == "lines: expected the first and the last line, from 1, as in 3-9; found \"6-3\""
    # A name may have a comma.
    named = cs.rates("0.2 4\n0.1 1\n", names=["h", "e, max"], columns=["e, max"], order={"e, max": 2})
    assert [rate["norm"] for rate in named["rates"]] == ["e, max"]
    assert refusal(tmp_path / "no.csv", function=cs.rates).startswith("path_or_text: expected an existing file")
    assert refusal(counts, function=cs.rates, order="two").startswith("order: expected a number > 0")
    assert refusal(counts, function=cs.rates, order=-1).startswith("order: expected a number > 0")
    assert refusal(3, function=cs.rates) == "path_or_text: expected a path or a text, found 3"


def test_the_package_has_its_version():
    metadata = pytest.importorskip("importlib.metadata")
    assert cs.__version__ == metadata.version("convergence-study")


def test_a_name_or_a_step_that_is_given_twice_is_refused():
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame([[h, h * h, h] for h in STEPS], columns=["h", "e", "e"])
    assert refusal(table, order=2) == "expected each name of a column once, found `e` twice"
    assert refusal([0.4, 0.2, 0.2, 0.1], SQUARES, order=2) == "h: expected each step once, found 0.2 twice"
    with pytest.raises(ValueError, match="each name of an error once, found `1` twice"):
        cs.study(lambda n: {1: n**-2.0, "1": 1 / n}, [4, 8, 16], order=2)


def test_columns_of_a_table_are_held_against_each_other_as_by_rates():
    h = [0.4, 0.2, 0.1, 0.05, 0.025]
    square = [1.0371 * x**2 for x in h]
    equal = {"h": h, "L2": square, "H1": list(square)}
    for order in (2, {"L2": 2, "H1": 2}):
        found = cs.judge(equal, order=order)
        assert {one.verdict for one in found.values()} == {"inconclusive"}
        assert "equal to `H1` in all digits" in str(found["L2"])
    assert cs.judge(equal, order={"L2": 2})["L2"].verdict == "pass"
    boundary = {"h": h, "max": [1.0371 * x for x in h], "max inside": square}
    with pytest.raises(ValueError, match="table: the boundary loses the order: .*; claim both"):
        cs.judge(boundary, order={"max inside": 2})
    both = cs.judge(boundary, order={"max": 1, "max inside": 2})
    assert {one.verdict for one in both.values()} == {"pass"}


def test_no_column_of_a_table_is_left_out_in_silence():
    h, errors = [0.2, 0.1, 0.05, 0.025, 0.0125], [2.8e-2, 7e-3, 1.75e-3, 4.375e-4, 1.09375e-4]
    cs.assert_order({"h": h, "L2": errors, "note": list("abcde"), "converged": [True] * 5, "iterations": [3, 3, 4, 4, 5]}, order=2)
    counted = cs.judge({"h": h, "L2": errors, "H1": h, "iterations": [3, 3, 4, 4, 5]}, order={"L2": 2})["L2"]
    because = "whole numbers that do not fall, under a name of a count, level or cost"
    assert counted.left_out == {"iterations": because, "H1": "no order is claimed"}
    for again in [pickle.loads(pickle.dumps(counted)), copy.deepcopy(counted)]:
        assert again.left_out == counted.left_out
    lost = [[0.3 * x for x in h], [4.7e-3 + x * x for x in h], errors[:-1] + [float("nan")], errors[:-1] + [None], errors[:-1] + ["diverged"]]
    columns = [(name, numbers) for name in ["k", "n", "nodes", "time", "cond", "ref", "exact", "order", "residual"] for numbers in lost]
    for name, cells in [*columns, ("converged", [True] * 4 + [False]), ("status", ["ok"] * 4 + ["diverged"])]:
        with pytest.raises((AssertionError, ValueError)):
            cs.assert_order({"h": h, "L2": errors, name: cells}, order=2)
    with pytest.raises(ValueError, match="one of the steps, in space or in time, found `N`, `dt`"):
        cs.judge({"N": [16, 32, 64, 128, 256], "dt": h, "L2": errors}, order=2)


def test_a_tolerance_is_less_than_the_order_and_small_orders_have_small_ones():
    slow = [h**0.05 for h in H]
    for order in (0.27, ">=0.27", 0.1, ">=0.1"):
        assert cs.judge(H, slow, order=order).verdict != "pass"
    with pytest.raises(ValueError, match="tolerance: expected a number less than the order 0.27, found 0.3"):
        cs.judge(H, slow, order=0.27, tolerance=0.3)
    assert cs.judge(H, [h**2 for h in H], order=2, tolerance=None).verdict == "pass"


def test_rates_of_samples_and_of_errors_near_round_off():
    rows = [(h, k, h * (1 + 0.01 * math.sin(7 * k + 1 / h))) for h in H for k in range(12)]
    text = "h seed error\n" + "".join(f"{h} {k} {error:.6e}\n" for h, k, error in rows)
    with pytest.raises(ValueError, match="fall or rise"):
        cs.rates(text, order=1)
    assert cs.rates(text, order=1, samples="mean")["verdict"] == "pass"
    assert cs.rates(text, order=2, samples="rms")["verdict"] == "fail"
    with pytest.raises(ValueError, match="samples: expected mean, rms or weak"):
        cs.rates(text, order=1, samples="median")
    for name, value in {"floor": 1e-9, "values": ["error"], "ratio": 2}.items():
        with pytest.raises(ValueError, match=f"{name}: expected none beside samples"):
            cs.rates(text, order=1, samples="mean", **{name: value})
    fine = [0.5**k for k in range(1, 11)]
    noise = [4e-16, 3e-16, 5e-16, 2e-16, 4e-16, 6e-16, 3e-16, 4e-16, 5e-16, 2e-16]
    text = "h L2\n" + "".join(f"{h} {0.3 * h**6 + e:.6e}\n" for h, e in zip(fine, noise))
    [told] = cs.rates(text, order=6)["rates"]
    assert told["code"] == "round-off" and told["verdict"] == "inconclusive"
    assert cs.rates(text, order=6, floor=told["offered_floor"])["verdict"] == "pass"
    [told] = cs.rates(text, order=6, scale=1e-9)["rates"]
    assert told["code"] != "round-off"


def test_high_orders_begin_with_coarser_levels_and_no_level_is_added_below_the_floor():
    for order, first in [(2, 8), (7, 4), (10, 2)]:
        study = cs.study(lambda n: n**-order, order=order)
        assert study.verdict == "pass" and study.table()["h"][0] == 1 / first, order
    calls = []

    def first_order(n):
        calls.append(n)
        return 1 / n

    study = cs.study(first_order, order=2, floor=0.008)
    assert calls == [8, 16, 32, 64] and "the next error would be below the floor" in study.summary
    assert study.verdict == "fail"


def test_factors_are_claimed_of_errors_that_fall_exponentially():
    text = "n,e\n" + "".join(f"{n},{2.0 * 3.0**-n:.10e}\n" for n in range(2, 9))
    for factor, verdict in [(3, "pass"), (">=3", "pass"), ({"e": 3}, "pass"), (5, "fail"), (">=5", "fail")]:
        found = cs.rates(text, factor=factor, step="n")
        assert found["verdict"] == verdict, factor
    assert found["rates"][0]["factor"]["fitted"] == pytest.approx(3)
    for name, value in {"order": 2, "dim": 1, "ratio": 2, "samples": "mean"}.items():
        with pytest.raises(ValueError, match=f"{name}: expected none beside factor, found {value!r}"):
            cs.rates(text, factor=3, **{name: value})
    with pytest.raises(ValueError, match="factor > 1"):
        cs.rates(text, factor=0.5, step="n")
    with pytest.raises(ValueError, match="expected step=COLUMN, the count or degree that the factor is about"):
        cs.rates("n,cells,e\n2,4,1e-1\n4,16,1e-2\n8,64,1e-3\n", factor=3)
