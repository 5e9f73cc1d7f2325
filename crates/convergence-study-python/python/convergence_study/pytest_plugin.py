"""A plugin of pytest: the fixture `convergence`, a report on all verdicts of a run, and numbers that must not change.

    def test_order(convergence):
        convergence.assert_order(h, errors, order=2)
        convergence.study(solve, order={"L2": 2})

Numbers and claims are guarded if `tests/convergence.json` exists, which `--convergence-bless` writes. Workers of pytest-xdist send their
studies to the process that has started them.
"""

import functools
import hashlib
import itertools
import pickle
import re

import pytest

from . import _judging, _native

# The studies of a worker, in what it sends.
SENT = "convergence_studies"
# Between the node id of a test and the number of its call.
CALL = ", call "


def pytest_addoption(parser):
    group = parser.getgroup("convergence", "convergence studies")
    group.addoption("--convergence-report", metavar="DIR", help="write the report on all verdicts: page, Markdown, JUnit")
    group.addoption("--convergence-bless", action="store_true", help="take the numbers for tests/convergence.json")
    loosened = "with --convergence-bless: take also looser claims, changed settings, and what is gone"
    group.addoption("--convergence-loosened", action="store_true", help=loosened)


def pytest_configure(config):
    config.convergence = Run(config)
    config.pluginmanager.register(config.convergence, "convergence-run")


@pytest.fixture
def convergence(request):
    """Asserts orders of convergence, and keeps the results for the report and the baseline of the run."""
    return Convergence(request.config.convergence, request.node.nodeid)


class Convergence:
    """The fixture of a test: the functions of `convergence_study` with the same arguments.

    Each call of `assert_order` and `study` is one study of the report and the baseline, named after the test; both assert that it passes,
    and return it. `judge` and `limit` return what they find, which is not kept.
    """

    def __init__(self, run, test):
        self._run, self._test, self._calls = run, test, 0
        self.judge, self.limit = _judging.judge, _judging.limit
        self.assert_order = like(_judging.assert_order, self._assert_order)
        self.study = like(_judging.study, self._study)

    def _assert_order(self, h=None, errors=None, order=None, tolerance=None, *, floor=0.0, allow_inconclusive=False, **table):
        __tracebackhide__ = True
        found, _ = _judging.judged("convergence.assert_order", h, errors, order, tolerance, floor=floor, **table)
        return self._kept(_native.study_of(found, self._options(None, floor=floor, allow_inconclusive=allow_inconclusive)))

    def _study(self, solve, n=None, order=None, budget=60.0, tolerance=None, name=None, *, h=None, variants=None, **more):
        __tracebackhide__ = True
        options = self._options(name, budget=budget, **more)
        return self._kept(_judging.studied(solve, n, h, order, tolerance, options, variants))

    def _options(self, name, **more):
        test = self._test if self._calls == 0 else f"{self._test}{CALL}{self._calls + 1}"
        return _judging.options(self._run.free_id(self._test if name is None else f"{self._test}-{name}"), test, **more)

    def _kept(self, found):
        __tracebackhide__ = True
        self._calls += 1
        self._run.studies.append(found)
        found.assert_passes()
        return found


def like(public, method):
    """The method with name, signature and description of a function of the package."""

    @functools.wraps(public)
    def call(*arguments, **options):
        __tracebackhide__ = True
        return method(*arguments, **options)

    return call


def id_of(test):
    """The id of the first study of a test, by its node id: names of files distinguish studies in baseline and report."""
    name = test.replace("::", "-").replace("tests/", "", 1).replace(".py", "")
    plain = re.sub("[^a-z0-9.]", "-", name.lower()).lstrip("-.")
    # Without other characters, parameters may be alike: an id must not depend on which tests are run.
    lossy = re.search(r"[^\w./\[\]-]", name, re.ASCII) or re.search("[_/]", name.partition("[")[2])
    if len(plain) > 90 or lossy:
        plain = f"{plain[:80]}-{hashlib.sha256(test.encode()).hexdigest()[:6]}"
    return plain


class Run:
    """The studies of a run, and which of its tests still guard what they did: hooks of pytest."""

    def __init__(self, config):
        self._config = config
        self.studies, self._lines = [], []
        self._passed, self._not_collected = set(), []
        self._is_selection = False
        self._is_well = True

    def free_id(self, test):
        """An id for the next study of a test."""
        name, taken = id_of(test), {study.id for study in self.studies}
        names = itertools.chain([name], (f"{name}-{k}" for k in itertools.count(2)))
        return next(free for free in names if free not in taken)

    def pytest_deselected(self, items):
        self._is_selection = self._is_selection or bool(items)

    def pytest_collectreport(self, report):
        if not report.passed:
            self._not_collected.append(report.nodeid)

    def pytest_runtest_logreport(self, report):
        if report.when == "call" and report.passed and not hasattr(report, "wasxfail"):
            self._passed.add(report.nodeid)

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node, error):
        sent = getattr(node, "workeroutput", {}).get(SENT)
        if sent is None:
            self._lines.append("a worker has sent no studies: report and baseline are without them")
        else:
            self.studies.extend(pickle.loads(sent))

    @pytest.hookimpl(trylast=True)
    def pytest_sessionfinish(self, session):
        if hasattr(self._config, "workerinput"):
            self._config.workeroutput[SENT] = pickle.dumps(self.studies)
            return
        try:
            is_well = self._finish(session)
        except (OSError, ValueError) as error:
            self._lines.append(str(error))
            is_well = False
        self._is_well = is_well
        if not is_well and session.exitstatus in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
            session.exitstatus = pytest.ExitCode.TESTS_FAILED

    def _finish(self, session):
        """Compares with the baseline, accepts it if that is wanted, and writes the report; returns whether all is well."""
        option, baseline = self._config.getoption, self._config.rootpath / "tests" / "convergence.json"
        gone = self._gone(session, baseline)
        if not self.studies and not gone:
            return True
        if self._config.pluginmanager.hasplugin("dsession"):
            self._sort()
        names = ("bless", "loosened", "report")
        request = {"baseline": baseline, "gone": list(gone)} | {name: option(f"--convergence-{name}") for name in names}
        lines, is_well = _native.finish(self.studies, request)
        if gone and not (request["bless"] and is_well):
            self._lines.extend(in_words(gone))
        self._lines.extend(lines)
        return is_well

    def _sort(self):
        """The studies of workers come in any order."""
        self.studies.sort(key=lambda study: study.id)
        for first, second in zip(self.studies, self.studies[1:]):
            if first.id == second.id:
                raise ValueError(f"two tests have the id `{first.id}` in different workers of pytest-xdist: rename one of them")

    def _gone(self, session, baseline):
        """The guarded studies whose tests no longer exist, or may be inconclusive now, with these tests; none if only a selection was run.

        A test that was skipped or has failed guards what it did.
        """
        config = self._config
        is_part = self._is_selection or config.option.file_or_dir or config.invocation_params.dir != config.rootpath
        is_part = is_part or any(config.getoption(name, None) for name in ("ignore", "ignore_glob", "lf", "collectonly"))
        is_whole = not is_part and not session.shouldstop and not session.shouldfail
        is_whole = is_whole and session.exitstatus in (0, 1, 5) and not config.pluginmanager.hasplugin("dsession")
        if not is_whole or not baseline.is_file():
            return {}
        ids = {study.id for study in self.studies}
        not_passed = {item.nodeid for item in session.items} - self._passed

        def may_exist(test):
            return test.partition(CALL)[0] in not_passed or any(test.startswith(part) for part in self._not_collected)

        guarded = _native.guarded(baseline)
        free = {study.id for study in self.studies if study._allows_inconclusive()}
        freed = {study: f"{test or study} (may be inconclusive now)" for study, test in guarded if study in free}
        return freed | {study: test or study for study, test in guarded if study not in ids and not may_exist(test)}

    def pytest_terminal_summary(self, terminalreporter):
        if self._lines:
            terminalreporter.section("convergence")
            for line in self._lines:
                terminalreporter.write_line(line)
        if not self._is_well:
            # The last line of pytest counts it: a run that ends with status 1 is not "1 passed".
            terminalreporter.stats.setdefault("error", []).append(not_well(self._lines))


def not_well(lines):
    """The report of an error that no test has: numbers or claims moved, or a file could not be written."""
    why = lines[0] if lines else "studies are not as the baseline has them"
    place = "tests/convergence.json"
    return pytest.TestReport(place, (place, None, "convergence"), {}, "failed", why, "teardown")


def in_words(gone):
    """Lines that name the tests that are gone."""
    tests = sorted(test for test in gone.values() if test.partition(CALL)[0] == test or test.partition(CALL)[0] not in gone.values())
    names = ", ".join(test.partition("::")[2] or test for test in tests)
    count = "1 guarded test is" if len(tests) == 1 else f"{len(tests)} guarded tests are"
    yield f"{count} gone: {names}"
    yield "  restore what was deleted, or accept it with --convergence-bless --convergence-loosened"
