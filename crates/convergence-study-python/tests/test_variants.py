"""`study(..., variants=module)`: in which part of a solver the order is lost."""

import copy
import functools
import importlib
import importlib.util
import json
import os
import pathlib
import shutil
import subprocess
import sys

import pytest

import convergence_study as cs

pytest_plugins = ["pytester"]

# Programs with mistakes on request, and the files of their solutions.
WHERE = pathlib.Path(__file__).with_name("where")

NAMED = "the order is lost at the face x_min: it comes back where the solution is flat there"


def manufactured(folder, name, *options):
    """The text of a module."""
    shutil.copy(WHERE / f"{name}.toml", folder)
    words = [sys.executable, "-m", "convergence_study", "manufacture", f"{name}.toml", *options, "--language", "python", "--out", ".", "-q"]
    subprocess.run(words, cwd=folder, check=True, capture_output=True)
    return (folder / f"{name}.py").read_text()


@pytest.fixture(scope="session")
def modules(tmp_path_factory):
    """The modules with variants, by name, and that of the rod without."""
    folder = tmp_path_factory.mktemp("modules")
    texts = {name: manufactured(folder, name, "--variants") for name in ("rod", "plane")}
    return {**texts, "bare": manufactured(folder, "rod")}


@pytest.fixture
def folder(tmp_path, monkeypatch, modules):
    """A folder with modules and solvers that can be imported."""
    pytest.importorskip("numpy")
    fill(tmp_path, modules)
    monkeypatch.syspath_prepend(str(tmp_path))
    yield tmp_path
    for name in ("rod", "rod_solver", "plane", "plane_solver"):
        sys.modules.pop(name, None)


def fill(folder, modules):
    for name in ("rod", "plane"):
        (folder / f"{name}.py").write_text(modules[name])
        for file in (f"{name}.toml", f"{name}_solver.py"):
            shutil.copy(WHERE / file, folder)


def located(mistake, n=None, *, program="rod", **options):
    module, solver = importlib.import_module(program), importlib.import_module(f"{program}_solver")
    solve = functools.partial(solver.solve, mistake=mistake)
    return cs.study(solve, n, order=options.pop("order", 2), variants=module, **options)


def faces(*names):
    return [{"part": "face", "name": name} for name in names]


@pytest.mark.parametrize(
    ("program", "mistake", "named"),
    [
        ("rod", "value", faces("x_min")),
        ("rod", "flux", faces("x_max")),
        ("rod", "both", faces("x_min", "x_max")),
        ("rod", "coefficient", [{"part": "coordinate", "name": "x"}]),
        ("rod", "source", [{"part": "time", "name": "t"}]),
        ("rod", "euler", [{"part": "time", "name": "t"}]),
        ("rod", "initial", [{"part": "initial"}]),
        ("plane", "slope", faces("x_max")),
        ("plane", "upwind", [{"part": "coordinate", "name": "y"}]),
    ],
)
def test_each_planted_mistake_is_named(folder, program, mistake, named):
    # What names the mistake needs few of the levels that a budget allows; those of the plane are costly.
    found = located(mistake, [8, 16, 32, 64], program=program, budget=2 if program == "plane" else 8)
    assert found.where["named"] == named, str(found)


def test_the_face_with_the_mistake_is_named_and_the_failure_shows_the_table(folder):
    found = located("value", n=[8, 16, 32, 64], name="rod")
    assert found.where["named"] == [{"part": "face", "name": "x_min"}] and NAMED in found.where["conclusion"]
    names = [variant["name"] for variant in found.where["variants"]]
    assert names == ["constant_x", "constant_t", "flat_x_min", "flat_x_max", "flat_x", "flat_initial", "flat_everywhere"]
    with pytest.raises(AssertionError) as failed:
        found.assert_passes()
    lines = str(failed.value).splitlines()
    assert lines[0].startswith("L2: fail: ") and NAMED in lines[-1] and "look at the condition value at x_min" in lines[-1]
    table = lines[-9:-1]
    assert table[0].split() == ["variant", "rate", "order"] and [row.split()[0] for row in table[1:]] == names
    assert table[3].endswith("  back") and table[4].endswith("  lost")
    # The module is that of the file again.
    import rod
    import rod_solver

    assert "MANUFACTURE_VARIANT" not in os.environ and not rod._VARIANT and rod_solver.exact_T is rod.exact_T
    assert cs.study(rod_solver.solve, order=2).verdict == "pass"


def test_parameters_that_were_set_keep_their_values(folder):
    import rod
    import rod_solver

    seen = set()

    def solve(n):
        seen.add(rod.parameter_k)
        return rod_solver.solve(n, "value")

    rod.set_parameter("k", 0.9)
    found = cs.study(solve, [8, 16, 32, 64], order=2, variants=rod)
    assert found.where["named"] == faces("x_min") and seen == {0.9} and rod.parameter_k == 0.9


def test_the_command_names_the_same_part(folder):
    (folder / "run.py").write_text("import sys, json, rod_solver\nprint(json.dumps({'errors': rod_solver.solve(int(sys.argv[1]), 'value')}))\n")
    study = '[study]\nid = "rod"\nclaim = "c"\ntier = "quick"\nkind = "program"\n[program]\nmanufacture = "rod.toml"\n'
    study += f'command = [{json.dumps(sys.executable)}, "run.py", "{{n}}"]\n[refine]\nn = [8, 16, 32, 64]\n[[expect]]\nerror = "L2"\norder = 2\n'
    (folder / "study.toml").write_text(study)
    words = [sys.executable, "-m", "convergence_study", "study", "study.toml", "--where", "--format", "json"]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
    assert done.returncode == 1, done.stderr
    by_command, here = json.loads(done.stdout)["studies"][0]["where"], located("value", n=[8, 16, 32, 64]).where
    assert by_command["named"] == here["named"] and by_command["conclusion"] == here["conclusion"]


def test_nothing_is_named_without_a_mistake(folder):
    # A right solver that is undecided is examined, too.
    assert located("", n=[8, 16, 32, 64]).where["named"] == []
    right = located("")
    assert right.verdict == "pass" and right.where is None and right.to_dict()["where"] is None
    # An order that nobody has promised is lost in every part, and none is named.
    everywhere = located("", n=[8, 16, 32, 64], order=3).where
    assert everywhere["named"] == [] and "everywhere" in everywhere["conclusion"]


def test_copies_reports_and_dicts_keep_the_place(folder):
    found = located("value", n=[8, 16, 32, 64], name="rod")
    again = copy.deepcopy(found)
    assert again.where == found.where and str(again) == str(found) and NAMED in str(again)
    assert json.loads(json.dumps(found.to_dict()))["where"] == found.where
    again.report(folder / "report")
    picture = (folder / "report/figures/rod-where.svg").read_text()
    assert "flat_x_min" in picture and "the order claimed, 2" in picture
    assert NAMED in (folder / "report/README.md").read_text()


def test_a_module_without_variants_is_refused_before_anything_is_run(folder, monkeypatch, modules):
    (folder / "rod.py").write_text(modules["bare"])
    import rod

    def never(n):
        raise AssertionError("called")

    with pytest.raises(ValueError, match="variants: expected a module with the variants of a solution.*found rod, which has none; write it again"):
        cs.study(never, order=2, variants=rod)
    with pytest.raises(TypeError, match="variants: expected the module that .*, found 'rod'"):
        cs.study(never, order=2, variants="rod")
    fill(folder, modules)
    rod.__spec__.loader.exec_module(rod)
    monkeypatch.setenv("MANUFACTURE_VARIANT", "flat_x")
    with pytest.raises(ValueError, match="found MANUFACTURE_VARIANT=flat_x in the environment; unset it"):
        cs.study(never, order=2, variants=rod)


def test_a_function_that_ignores_the_variant_is_refused_after_one(folder):
    import rod

    called = []

    def solve(n):
        called.append(os.environ.get("MANUFACTURE_VARIANT", ""))
        # With the noise of an iterative solver.
        return (1 + 1e-9 * len(called)) / n

    with pytest.raises(ValueError, match="variants: the errors do not change with the variant: solve does not use it. Likely reasons"):
        cs.study(solve, [8, 16, 32], order=2, variants=rod)
    # With it flat at both ends the solution has a bubble: it is no polynomial for which schemes are exact.
    assert dict.fromkeys(called) == {"": None, "flat_everywhere": None}


def test_a_variant_that_does_not_run_is_named(folder):
    import rod

    def solve(n):
        if os.environ.get("MANUFACTURE_VARIANT") == "flat_everywhere":
            raise ZeroDivisionError("of no use")
        return 1 / n

    with pytest.raises(RuntimeError, match=r"variants: solve does not run with the variant flat_everywhere: ZeroDivisionError\('of no use'\)"):
        cs.study(solve, [8, 16, 32], order=2, variants=rod)
    assert "MANUFACTURE_VARIANT" not in os.environ and not rod._VARIANT


def test_steps_are_refined_while_a_variant_is_undecided(folder):
    import rod

    steps = []

    def solve(h):
        variant = os.environ.get("MANUFACTURE_VARIANT", "")
        steps.append((variant, h))
        # Undecided at three levels where it is constant in x.
        hidden = 40 * h**4 if variant == "constant_x" else 0.3 * h
        # Another solution has other errors.
        return (h**2 + hidden) * (1 + 0.01 * len(variant))

    cs.study(solve, h=[0.4, 0.2, 0.1], order=2, variants=rod)
    assert [h for variant, h in steps if variant == ""] == [0.4, 0.2, 0.1]
    of_variant = [h for variant, h in steps if variant == "constant_x"]
    assert of_variant[:4] == [0.4, 0.2, 0.1, 0.05]


def test_the_fixture_shows_the_place_as_the_page_says(pytester, modules):
    pytest.importorskip("numpy")
    fill(pytester.path, modules)
    (pytester.path / "solver.py").write_text("import functools, rod_solver\nsolve = functools.partial(rod_solver.solve, mistake='value')\n")
    page = (pathlib.Path(__file__).parents[2] / "convergence-study/book/src/pytest.md").read_text()
    block, shown = next(part for part in zip(page.split("```")[1::2], page.split("```")[3::2]) if "variants=" in part[0])
    (pytester.path / "test_rod.py").write_text(block.removeprefix("python\n"))
    workers = [["-n", "1"]] if importlib.util.find_spec("xdist") else []
    for options in [[], *workers]:
        failed = pytester.runpytest_subprocess("--convergence-report", "out", *options)
        failed.assert_outcomes(failed=1)
        for line in shown.removeprefix("text\n").splitlines():
            assert line in failed.outlines, line
        assert NAMED in (pytester.path / "out/README.md").read_text()
