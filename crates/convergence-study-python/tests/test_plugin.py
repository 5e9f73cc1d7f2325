"""The plugin: verdicts of a run of pytest, its report, and numbers that must not move."""

import json

import pytest

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


def test_every_call_has_an_id_of_its_own(project):
    tests = "\n@pytest.mark.parametrize('a', ['+', '-'])\ndef test_two(convergence, a):\n"
    call = "    convergence.assert_order(H, [h**2 for h in H], order=2)\n"
    add(project, "\nimport pytest\n" + tests + call + call)
    assert project.runpytest_subprocess("--convergence-bless").ret == 0
    ids = json.loads((project.path / "tests/convergence.json").read_text())["studies"]
    assert sorted(ids)[2:] == ["test-orders-test-two---", "test-orders-test-two----2", "test-orders-test-two----3", "test-orders-test-two----4"]


def test_numbers_are_guarded_once_they_are_blessed(project):
    baseline = project.path / "tests/convergence.json"
    assert project.runpytest_subprocess().ret == 0 and not baseline.exists()
    blessed = project.runpytest_subprocess("--convergence-bless")
    assert blessed.ret == 0 and len(json.loads(baseline.read_text())["studies"]) == 2
    assert project.runpytest_subprocess().ret == 0
    tests = project.path / "tests/test_orders.py"
    tests.write_text(TESTS.replace('n**-2.0}, order={"L2": 2}', '1.01 * n**-2.0}, order={"L2": 2}, tolerance=0.4'))
    moved = project.runpytest_subprocess()
    assert moved.ret == 1
    moved.assert_outcomes(passed=2)
    moved.stdout.fnmatch_lines(["*expect.L2.tolerance*0.25*0.4*", "*error L2, n = 8*"])
    refused = project.runpytest_subprocess("--convergence-bless")
    assert refused.ret == 1
    refused.stdout.fnmatch_lines(["*a changed claim needs a reason; repeat it with --convergence-bless --convergence-reason TEXT*"])
    assert project.runpytest_subprocess("--convergence-bless", "--convergence-reason", "a new mesh").ret == 0
    assert "a new mesh" in baseline.read_text() and project.runpytest_subprocess().ret == 0
    baseline.write_text("{")
    broken = project.runpytest_subprocess()
    assert broken.ret == 1
    broken.stdout.fnmatch_lines(["*convergence.json*"])
