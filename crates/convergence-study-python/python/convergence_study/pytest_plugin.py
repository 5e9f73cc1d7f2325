"""A plugin of pytest: the fixture `convergence`, a report on all verdicts of a run, and numbers that must not change.

    def test_order(convergence):
        convergence.assert_order(h, errors, order=2)
        convergence.study(solve, order={"L2": 2})

Numbers and claims are guarded if `tests/convergence.json` exists, which `--convergence-bless` writes.
"""

import itertools
import re

import pytest

from ._native import finish, of_table, study


def pytest_addoption(parser):
    group = parser.getgroup("convergence", "convergence studies")
    group.addoption("--convergence-report", metavar="DIR", help="write the report on all verdicts: page, Markdown, JUnit")
    group.addoption("--convergence-bless", action="store_true", help="take numbers and claims for tests/convergence.json")
    group.addoption("--convergence-reason", metavar="TEXT", help="why claims have changed; the baseline keeps it")


def pytest_configure(config):
    config.convergence_studies = []


class Convergence:
    """The fixture of a test: each call is one study of the report, named after the test."""

    def __init__(self, studies, name):
        self._studies, self._name = studies, name

    def assert_order(self, h, errors, order, tolerance=0.25, allow_inconclusive=False):
        """As `convergence_study.assert_order`; with `allow_inconclusive` only the verdict fail is a failure."""
        __tracebackhide__ = True
        return self._judged(of_table(self._id(), h, errors, order, tolerance), allow_inconclusive)

    def study(self, solve, n="auto", order=None, budget=60.0, tolerance=0.25, allow_inconclusive=False):
        """As `convergence_study.study`, and asserts that it passes."""
        __tracebackhide__ = True
        return self._judged(study(solve, n, order, budget, tolerance, self._id()), allow_inconclusive)

    def _id(self):
        # Names of files distinguish studies in baseline and report.
        name = re.sub("[^a-z0-9.]", "-", self._name.lower()).lstrip("-.")[:90]
        taken = {found.id for found, _ in self._studies}
        names = itertools.chain([name], (f"{name}-{k}" for k in itertools.count(2)))
        return next(free for free in names if free not in taken)

    def _judged(self, found, allow_inconclusive):
        __tracebackhide__ = True
        self._studies.append((found, allow_inconclusive))
        if not (allow_inconclusive and found.verdict == "inconclusive"):
            found.assert_passes()
        return found


@pytest.fixture
def convergence(request):
    """Asserts orders of convergence, and keeps the results for the report and the baseline of the run."""
    name = request.node.nodeid.replace("::", "-").replace("tests/", "", 1).replace(".py", "")
    return Convergence(request.config.convergence_studies, name)


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session):
    config = session.config
    # A worker of pytest-xdist sees only some of the tests.
    if not config.convergence_studies or hasattr(config, "workerinput"):
        return
    option, baseline = config.getoption, config.rootpath / "tests" / "convergence.json"
    bless, reason, report = (option(f"--convergence-{name}") for name in ("bless", "reason", "report"))
    try:
        config.convergence_lines, is_well = finish(config.convergence_studies, baseline, bless, reason, report)
    except (OSError, ValueError) as error:
        config.convergence_lines, is_well = [str(error)], False
    if not is_well and session.exitstatus == 0:
        session.exitstatus = 1


def pytest_terminal_summary(terminalreporter, config):
    lines = getattr(config, "convergence_lines", [])
    if lines:
        terminalreporter.section("convergence")
        for line in lines:
            terminalreporter.write_line(line)
