"""The plugin: verdicts of a run of pytest, its report, and numbers that must not move."""

import importlib.util
import json

import pytest

import convergence_study as cs
from convergence_study.pytest_plugin import Run, id_of

pytest_plugins = ["pytester"]

TESTS = """
H = [0.4, 0.2, 0.1, 0.05]

def test_passes(convergence):
    convergence.assert_order(H, [h**2 for h in H], order=2)

def test_study(convergence):
    assert convergence.study(lambda n: {"L2": n**-2.0}, order={"L2": 2}).verdict == "pass"
"""


@pytest.fixture
def project(pytester):
    pytester.mkdir("tests")
    (pytester.path / "tests/test_orders.py").write_text(TESTS)
    return pytester


def add(project, text):
    with (project.path / "tests/test_orders.py").open("a") as file:
        file.write(text)


def test_fail_and_inconclusive_fail_unless_that_is_allowed(project):
    add(project, "\ndef test_fails(convergence):\n    convergence.assert_order(H, H, order=2)\n")
    add(project, "\ndef test_unsure(convergence):\n    convergence.assert_order(H[:2], H[:2], order=1)\n")
    allowed = "convergence.assert_order(H[:2], H[:2], order=1, allow_inconclusive=True)"
    add(project, f"\ndef test_allowed(convergence):\n    {allowed}\n")
    found = project.runpytest_subprocess("--convergence-report", "out")
    found.assert_outcomes(passed=3, failed=2)
    found.stdout.fnmatch_lines(["*error: fail: 1.0000* ± *, claimed 2 ± 0.25: too low", "*too-low: The whole interval*"])
    found.stdout.fnmatch_lines(["*levels: A rate with an interval needs three levels*", "report: out/index.html"])
    page = (project.path / "out/index.html").read_text()
    assert "test-orders-test-fails" in page.replace("_", "-") and (project.path / "out/README.md").is_file()
    assert '"test_orders' not in page and 'type="inconclusive"' in (project.path / "out/junit.xml").read_text()


def test_studies_with_floors_and_samples_have_pictures_of_their_own(project):
    floor = "lambda n: {'L2': n**-2.0}, order={'L2': 2}, floor=1e-9"
    samples = "lambda n, seed: (1 + seed % 3 / 10) / n, n=[4, 8, 16, 32], order=1, samples=10"
    for name, study in [("floor", floor), ("samples", samples)]:
        add(project, f"\ndef test_{name}(convergence):\n    convergence.study({study})\n")
    found = project.runpytest_subprocess("--convergence-report", "out")
    found.stdout.fnmatch_lines(["report: out/index.html"])
    pictures = {path.name for path in (project.path / "out/figures").rglob("*.svg")}
    assert {f"test-orders-test-{name}-errors.svg" for name in ["floor", "samples"]} <= pictures, pictures


def test_every_call_has_an_id_of_its_own(project):
    tests = "\n@pytest.mark.parametrize('a', ['+', '-'])\ndef test_two(convergence, a):\n"
    call = "    convergence.assert_order(H, [h**2 for h in H], order=2)\n"
    add(project, "\nimport pytest\n" + tests + call + call)
    assert project.runpytest_subprocess("--convergence-bless").ret == 0
    ids = json.loads((project.path / "tests/convergence.json").read_text())["studies"]
    assert sorted(ids)[2:] == ["test-orders-test-two---", "test-orders-test-two----2", *(f"test-orders-test-two----c981b0{k}" for k in ["", "-2"])]
    # An id does not depend on which tests are run.
    assert id_of("a.py::f[a_b]") != id_of("a.py::f[a-b]")
    for selected in ["+", "-"]:
        assert project.runpytest_subprocess(f"tests/test_orders.py::test_two[{selected}]").ret == 0


def test_numbers_are_guarded_once_they_are_blessed(project):
    baseline = project.path / "tests/convergence.json"
    assert project.runpytest_subprocess().ret == 0 and not baseline.exists()
    blessed = project.runpytest_subprocess("--convergence-bless")
    assert blessed.ret == 0 and len(json.loads(baseline.read_text())["studies"]) == 2
    assert project.runpytest_subprocess().ret == 0
    tests = project.path / "tests/test_orders.py"
    looser = TESTS.replace("order=2)", "order=2, tolerance=0.4)")
    tests.write_text(looser.replace('n**-2.0}, order={"L2": 2}', '1.01 * n**-2.0}, order={"L2": 2}, tolerance=0.4'))
    moved = project.runpytest_subprocess()
    assert moved.ret == 1
    moved.assert_outcomes(passed=2, errors=1)
    claim = "rate error has a looser claim: was 2 ± 0.25, is 2 ± 0.4"
    # Time decides how many levels a study adds: its rate is no number of the baseline, its claim is a setting.
    settings = "test-study: settings have changed: hash *"
    moved.stdout.fnmatch_lines([f"*{claim}*", f"*{settings}", "*error L2, n = 8*"])
    refused = project.runpytest_subprocess("--convergence-bless")
    assert refused.ret == 1
    refused.stdout.fnmatch_lines(["*not blessed: less would be guarded; if that is meant: --convergence-bless --convergence-loosened*"])
    loosened = bless(project, "--convergence-loosened")
    loosened.stdout.fnmatch_lines([f"loosened: *{claim}*", f"loosened: *{settings}"])
    assert project.runpytest_subprocess().ret == 0
    baseline.write_text("{")
    broken = project.runpytest_subprocess()
    assert broken.ret == 1
    broken.stdout.fnmatch_lines(["*convergence.json*"])


def bless(project, *options):
    blessed = project.runpytest_subprocess("--convergence-bless", *options)
    assert blessed.ret == 0
    return blessed


def test_a_guarded_test_that_is_deleted_is_named_by_a_whole_run(project):
    add(project, "\ndef test_b(convergence):\n    for _ in range(2):\n        convergence.assert_order(H, H, order=1)\n")
    bless(project)
    (project.path / "tests/test_orders.py").write_text(TESTS)
    whole = project.runpytest_subprocess("--convergence-report", "out")
    whole.assert_outcomes(passed=2, errors=1)
    assert whole.ret == 1
    whole.stdout.fnmatch_lines(["1 guarded test is gone: test_b", "  restore what was deleted, or accept it with --convergence-bless*"])
    assert "2 studies deleted" in (project.path / "out/README.md").read_text()
    # A selection does not see it.
    workers = [["-n", "2"]] if importlib.util.find_spec("xdist") else []
    test = "tests/test_orders.py::test_study"
    for selection in [["-k", "passes"], ["tests"], [test], ["--deselect", test], *workers]:
        selected = project.runpytest_subprocess(*selection)
        assert selected.ret == 0
        selected.stdout.no_fnmatch_line("*guarded test*")
    assert project.runpytest_subprocess("--convergence-bless").ret == 1
    bless(project, "--convergence-loosened").stdout.no_fnmatch_line("*guarded test*")
    again = project.runpytest_subprocess()
    assert again.ret == 0
    again.stdout.no_fnmatch_line("*guarded test*")


def run_edited(project, old, new):
    """A run after a change of the tests, which does not agree with the baseline."""
    tests = project.path / "tests/test_orders.py"
    text = tests.read_text()
    assert old in text
    tests.write_text(text.replace(old, new))
    edited = project.runpytest_subprocess()
    assert edited.ret == 1
    return edited


def test_all_guarded_tests_may_be_gone_and_calls_are_counted(project):
    add(project, "\ndef test_b(convergence):\n    for _ in range(2):\n        convergence.assert_order(H, H, order=1)\n")
    bless(project)
    fewer = run_edited(project, "range(2)", "range(1)")
    fewer.stdout.fnmatch_lines(["1 guarded test is gone: test_b, call 2"])
    (project.path / "tests/test_orders.py").unlink()
    none = project.runpytest_subprocess()
    assert none.ret == 1
    none.stdout.fnmatch_lines(["3 guarded tests are gone: test_b, test_passes, test_study"])


def test_a_guarded_test_that_may_be_inconclusive_now_is_named(project):
    add(project, "\ndef test_b(convergence):\n    convergence.study(lambda n: 1 / n, order=1)\n")
    bless(project)
    freed = run_edited(project, "lambda n: 1 / n, order=1", "lambda n: 0.0, order=1, allow_inconclusive=True")
    freed.stdout.fnmatch_lines(["1 guarded test is gone: test_b (may be inconclusive now)"])
    assert project.runpytest_subprocess("--convergence-bless").ret == 1
    bless(project, "--convergence-loosened")
    assert project.runpytest_subprocess().ret == 0


def test_a_test_that_was_not_run_is_not_gone(project):
    (project.path / "tests/test_b.py").write_text("def test_b(convergence):\n    convergence.assert_order([4, 2, 1], [4, 2, 1], order=1)\n")
    bless(project)
    tests, skipped = project.path / "tests/test_orders.py", "import pytest\n\npytest.skip(allow_module_level=True)\n"
    tests.write_text(skipped + TESTS)
    module = project.runpytest_subprocess()
    assert module.ret == 0
    tests.write_text(TESTS.replace("def test_study(convergence):", "def test_study(convergence):\n    import pytest\n    pytest.skip()"))
    assert project.runpytest_subprocess().ret == 0
    tests.write_text(TESTS + "\ndef test_fails():\n    assert False\n")
    failed = project.runpytest_subprocess("-x")
    for run in [module, failed]:
        run.stdout.no_fnmatch_line("*guarded test*")


def test_workers_of_xdist_report_bless_and_guard(project):
    pytest.importorskip("xdist")
    baseline = project.path / "tests/convergence.json"
    tests = "\nimport pytest\n@pytest.mark.parametrize('a', ['+', '-', 'x', 'y'])\ndef test_two(convergence, a):\n"
    add(project, tests + "    convergence.assert_order(H, H, order=1)\n")
    bless(project)
    expected = baseline.read_text()
    baseline.unlink()
    blessed = bless(project, "-n", "2", "--convergence-report", "out")
    blessed.stdout.fnmatch_lines(["baseline: blessed*", "report: out/index.html"])
    assert baseline.read_text() == expected and len(json.loads(expected)["studies"]) == 6
    page = (project.path / "out/junit.xml").read_text()
    assert "test-orders-test-passes" in page and "test-orders-test-two-x-" in page
    tests = project.path / "tests/test_orders.py"
    tests.write_text(tests.read_text().replace('n**-2.0}', '1.01 * n**-2.0}'))
    moved = project.runpytest_subprocess("-n", "2")
    assert moved.ret == 1
    moved.assert_outcomes(passed=6, errors=1)
    moved.stdout.fnmatch_lines(["baseline: test-orders-test-study: error L2, n = 8 moved*"])


def test_studies_of_workers_have_an_order_and_ids_of_their_own():
    run = Run(None)
    run.studies = [cs.study(lambda n: n**-2.0, [4, 8, 16], order=2, name=name) for name in "bca"]
    run._sort()
    assert [study.id for study in run.studies] == ["a", "b", "c"]
    run.studies.append(run.studies[1])
    with pytest.raises(ValueError, match="two tests have the id `b` in different workers of pytest-xdist"):
        run._sort()


def test_studies_of_a_worker_that_ended_are_missed(project):
    pytest.importorskip("xdist")
    add(project, "\ndef test_ends(convergence):\n    import os\n    os._exit(3)\n")
    ended = project.runpytest_subprocess("-n", "1", "--convergence-report", "out")
    assert ended.ret == 1
    ended.stdout.fnmatch_lines(["a worker has sent no studies: report and baseline are without them"])


def test_the_summary_of_a_failure_is_its_verdict_and_the_step_is_h(project, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    call = "convergence.study(lambda n: n**-1.0, [8, 16, 32, 64], order=2)"
    (project.path / "tests/test_bad.py").write_text(f"def test_upwind(convergence):\n    {call}\n")
    failed = project.runpytest_subprocess("-rf")
    failed.stdout.fnmatch_lines(["FAILED tests/test_bad.py::test_upwind - AssertionError: error: fail: 1.000, claimed 2 ± 0.25: too low"])
    failed.stdout.fnmatch_lines(["E  *       h       error      rate"])
    failed.stdout.no_fnmatch_line("*step*error*rate*")


def test_the_fixture_judges_tables_with_a_floor(project):
    body = """
def test_table(convergence):
    table = {"n": [4, 16, 64, 256, 1024], "L2": [4.0, 1.0, 0.25, 0.0625, 0.06]}
    convergence.assert_order(table, order={"L2": 2}, dim=2, floor=0.0625 - 1e-9)
    assert convergence.judge(table, order={"L2": 2}, dim=2)["L2"].verdict != "pass"
"""
    (project.path / "tests/test_table.py").write_text(body)
    bless(project)
    guarded = json.loads((project.path / "tests/convergence.json").read_text())["studies"]["test-table-test-table"]
    assert guarded["test"] == "tests/test_table.py::test_table" and guarded["numbers"]["rate L2"][2] == "2 ± 0.25"
    # A floor that is taken away is a changed setting.
    body = body.replace("0.0625, 0.06]", "0.0625, 0.015625]").replace(", floor=0.0625 - 1e-9", "")
    (project.path / "tests/test_table.py").write_text(body)
    changed = project.runpytest_subprocess()
    assert changed.ret == 1
    changed.stdout.fnmatch_lines([f"baseline: test-table-test-table: settings have changed: hash {guarded['settings']}, now *"])
