"""What the package promises; run by `.ci/wheel` with the wheel installed, and NumPy, pandas and Polars where they can be had."""

import gc
import json
import math
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

import pytest

import convergence_study as cs

H = [0.25, 0.125, 0.0625, 0.03125, 0.015625]
SECOND = [1.1 * h**2 * (1 + 0.3 * h) for h in H]
PROGRAM = [sys.executable, "-m", "convergence_study"]


def run(*arguments, cwd, status=0, **more):
    done = subprocess.run([*PROGRAM, *arguments], cwd=cwd, capture_output=True, text=True, **more)
    assert done.returncode == status, done.stdout + done.stderr
    return done.stdout + done.stderr


def test_a_table_has_a_verdict_a_rate_and_a_reason():
    v = cs.judge(H, SECOND, order=2)
    assert v.verdict == "pass" and v.code == "agrees" and v.advice is None and v.order == 2
    assert v.interval[0] < v.rate < v.interval[1] and abs(v.rate - 2) < 0.01 and len(v.pairwise) == 4
    low = cs.judge(H, [h**1.5 for h in H], order=2)
    assert low.verdict == "fail" and low.code == "too-low" and "lies below the band" in low.advice
    assert cs.judge(H, [h**3 for h in H], order=">=2").verdict == "pass"
    assert cs.judge(H[:2], SECOND[:2], order=2).verdict == "inconclusive"
    assert cs.judge(H, SECOND).verdict == "inconclusive"
    assert cs.judge(H[::-1], SECOND[::-1], order=2).rate == v.rate
    with pytest.raises(TypeError, match="ask .verdict"):
        assert v


def test_an_assertion_says_table_rate_reason_and_advice():
    assert cs.assert_order(H, SECOND, order=2) is None
    with pytest.raises(AssertionError) as failed:
        cs.assert_order(H, [h**1.5 for h in H], order=2)
    for part in ["0.25  1.2500e-1", "1.500000", "claimed 2 ± 0.25: too low", "too-low: The whole interval"]:
        assert part in str(failed.value)
    with pytest.raises(AssertionError, match="inconclusive"):
        cs.assert_order(H[:2], SECOND[:2], order=2)


def test_orders_that_a_tool_has_printed_as_converged_do_not_pass():
    # Orders 75.976 and NaN of polaris: an error that falls by 22 digits, and then vanishes.
    errors = [1.0, 2**-75.976, math.nan]
    assert cs.judge([4, 2, 1], errors, order=2).verdict == "fail"
    assert cs.judge([2, 1], errors[:2], order=2).verdict != "pass"


def test_arrays_series_and_frames_are_read():
    expected = cs.judge(H, SECOND, order=2)
    for library, of in [("numpy", "array"), ("pandas", "Series"), ("polars", "Series")]:
        array = getattr(pytest.importorskip(library), of)
        assert cs.judge(array(H), array(SECOND), order=2).interval == expected.interval
    table = {"h": H, "L2": SECOND, "H1": H}
    for frame in [dict, pytest.importorskip("pandas").DataFrame, pytest.importorskip("polars").DataFrame]:
        found = cs.judge(frame(table), order={"L2": 2, "H1": 1})
        assert list(found) == ["L2", "H1"] and found["L2"].interval == expected.interval
    cs.assert_order(table, order={"L2": 2, "H1": 1})
    with pytest.raises(ValueError, match="L2, H1; found `L3`"):
        cs.assert_order(table, order={"L3": 2})


def test_python_rust_and_the_command_line_find_the_same_bits(tmp_path):
    rows = [f"{h!r},{e:.17e}" for h, e in zip(H, SECOND)]
    (tmp_path / "errors.csv").write_text("\n".join(["h,L2", *rows]))
    out = subprocess.run([*PROGRAM, "rates", "errors.csv", "--order", "2", "--format", "json"], cwd=tmp_path, capture_output=True)
    [told] = json.loads(out.stdout)["rates"]
    v = cs.judge(H, SECOND, order=2)
    assert (v.verdict, v.rate, v.pairwise, v.code) == (told["verdict"], told["fitted"], told["pairwise"], told["code"])
    assert list(v.interval) == told["interval"]
    # As in `tests/asserted.rs` of the crate.
    found = cs.judge([0.25, 0.125, 0.0625, 0.03125], [0.041, 0.0103, 0.00257, 0.000642], order=2)
    assert (found.rate, found.interval) == (1.9993524479350309, (1.992143758083014, 2.006561137787048))


def test_a_power_of_ten_changes_no_verdict_and_no_interval():
    for unit in [1e-200, 1e-20, 1e-9, 1e9, 1e200]:
        for order in [1.5, 2, 2.2]:
            v, scaled = cs.judge(H, SECOND, order=order), cs.judge(H, [unit * e for e in SECOND], order=order)
            assert (v.verdict, v.code) == (scaled.verdict, scaled.code)
            assert scaled.interval == pytest.approx(v.interval, abs=1e-9)


def test_what_is_judged_has_no_truth_value():
    values = [1.1, 1.05, 1.025, 1.0125]
    for found in (
        cs.judge(H, SECOND, order=2),
        cs.judge({"h": H, "L2": SECOND}, order=2),
        cs.rates("h L2\n0.4 0.16\n0.2 0.04\n0.1 0.01\n", order=1),
        cs.limit([0.4, 0.2, 0.1, 0.05], values, order=2),
        cs.study(lambda n: 1 / n, order=1),
    ):
        with pytest.raises(TypeError, match="no truth value"):
            assert found


def test_complex_errors_are_refused_and_not_cut():
    np = pytest.importorskip("numpy")
    errors = np.array([complex(error, 1) for error in SECOND])
    for found in (errors, list(errors), list(errors.astype(np.complex64))):
        with pytest.raises(ValueError, match="expected a number"):
            cs.judge(H, found, order=2)
    with pytest.raises(ValueError, match="expected a number"):
        cs.study(lambda n: np.sqrt(np.complex128(1j) / n), order=2)


def test_an_error_that_may_change_its_sign_is_named():
    h = [0.1, 0.05, 0.025, 0.0125]
    v = cs.judge(h, [abs(x**2 - 24.2 * x**3) for x in h], order=2)
    assert v.verdict != "pass" and "may change its sign between levels" in v.advice


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (dict(h=H, errors=SECOND[:3]), "errors: expected as many numbers as h has, 5; found 3"),
        (dict(h=[], errors=[]), "h: expected the step of each level, found none"),
        (dict(h=H, errors="abcde"), "errors: expected a sequence of numbers, found 'abcde'"),
        (dict(h=H, errors=[1, 2, "x", 4, 5]), r"errors\[2\]: expected a number, found 'x'"),
        (dict(h=H, errors=[1, 2, None, 4, 5]), r"errors\[2\]: expected a number, found None"),
        (dict(h=H, errors=[[1, 2]] * 5), r"errors\[0\]: expected a number, found \[1, 2\]"),
        (dict(h=[1, math.nan], errors=[1, 2]), r"h\[1\]: expected a finite number > 0, found NaN"),
        (dict(h=[1, -1], errors=[1, 2]), r"h\[1\]: expected a finite number > 0, found -1"),
        (dict(h=5, errors=[1]), "h: expected a sequence of numbers, found 5"),
        (dict(h=H, errors=SECOND, order="two"), "order: expected a number > 0"),
        (dict(h=H, errors=SECOND, order=math.nan), "order: expected a number > 0"),
        (dict(h=H, errors=SECOND, tolerance=0.7), "tolerance = 0.7: the tolerance is too wide"),
        (dict(h=H), "errors: expected the errors at the steps h"),
        (dict(h={"h": H, "L2": [1]}), "h: expected 5 cells in each column, found 1 in `L2`"),
    ],
)
def test_what_is_no_table_is_refused_by_name(arguments, told):
    with pytest.raises(ValueError, match=told):
        cs.judge(**{"order": 2, **arguments})


def test_a_million_levels_and_a_hundred_thousand_calls():
    assert cs.judge([1 / n for n in range(1, 1_000_001)], [1.0] * 1_000_000, order=1).verdict != "pass"
    peaks = []
    for _ in range(3):
        for _ in range(35_000):
            cs.judge(H, SECOND, order=2)
        gc.collect()
        peaks.append(int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize())
    assert peaks[2] - peaks[0] < 1 << 20, peaks


def test_a_study_adds_levels_until_it_is_decided(capfd, tmp_path):
    levels = []

    def solve(n):
        levels.append(n)
        return {"h": 2 / n, "L2": n**-2.0, "H1": n**-1.0}

    r = cs.study(solve, order={"L2": 2, "H1": 1})
    assert r.verdict == "pass" and levels == [8, 16, 32, 64] and "decided after 4 levels" in r.summary
    assert abs(r.rates["L2"].rate - 2) < 1e-6 and list(dict(r.table()))[:3] == ["h", "L2", "rate L2"]
    assert list(r.table()["h"]) == [0.25, 0.125, 0.0625, 0.03125]
    assert "<svg" in r._repr_html_() and "too low" in repr(cs.study(solve, [8, 16, 32], order={"H1": 2}))
    r.report(tmp_path / "report")
    assert "decided after 4 levels" in (tmp_path / "report/index.html").read_text()
    late = cs.study(lambda n: n**-2.0 + 1.5 * n**-3.0 * (-1) ** int(math.log2(n)), order=2)
    assert late.verdict != "fail" and "levels" in late.summary
    absent = cs.study(solve, [8, 16, 32, 64], order={"L3": 2})
    assert absent.verdict == "fail" and "no level has an error `L3`; there are L2, H1" in repr(absent)
    assert capfd.readouterr() == ("", "")
    with pytest.raises(ZeroDivisionError):
        cs.study(lambda n: 1 / 0, order=2)
    for arguments in [dict(n=[0]), dict(n=[8, 8]), dict(n=[]), dict(budget=0), dict(n="many")]:
        with pytest.raises(ValueError, match=next(iter(arguments))):
            cs.study(solve, **{"order": 2, **arguments})
    with pytest.raises(ValueError, match=r"solve\(8\)\[\"L2\"\]: expected a number"):
        cs.study(lambda n: {"L2": "1e-3"}, order=2)
    with pytest.raises(ValueError, match=r"solve\(8\): expected a number, found \[1\]"):
        cs.study(lambda n: [1], order=2)


def test_values_have_a_limit():
    found = cs.limit([0.2, 0.1, 0.05, 0.025], [3 + h * h for h in (0.2, 0.1, 0.05, 0.025)], order=2)
    assert found.interval[0] <= 3 <= found.interval[1] and abs(found.value - 3) < 1e-9 and abs(found.order - 2) < 1e-6
    assert found.gci > 0 and found.verdict == "pass"
    unclaimed = cs.limit([0.2, 0.1, 0.05, 0.025], [3 + h * h for h in (0.2, 0.1, 0.05, 0.025)])
    assert unclaimed.value == pytest.approx(3, abs=1e-9) and unclaimed.verdict == "inconclusive"
    none = cs.limit([0.2, 0.1, 0.05], [1, 2, 1])
    assert none.value is None and "oscillate" in none.reason


def test_the_program_is_there_and_its_guards_end_what_it_has_started(tmp_path):
    run("new", "program", "mine", "--out", "studies", cwd=tmp_path)
    assert "pass" in run("study", "studies/mine.toml", cwd=tmp_path)
    (tmp_path / "studies/mine.py").write_text(
        "import os, pathlib, time\npathlib.Path('pid').write_text(str(os.getpid()))\ntime.sleep(60)\n"
    )
    harness = subprocess.Popen([*PROGRAM, "study", "studies/mine.toml", "--jobs", "1"], cwd=tmp_path)
    started = wait_for(lambda: (tmp_path / "pid").is_file() and (tmp_path / "pid").read_text())
    harness.send_signal(signal.SIGKILL)
    harness.wait()
    wait_for(lambda: not pathlib.Path(f"/proc/{started}").exists())


def blocks(page):
    """Language and text of each block, with the text of a block of output right after it."""
    parts = [part.split("\n", 1) for part in page.read_text().split("```")[1::2]]
    following = [*parts[1:], ["", ""]]
    return [(language, text, output if kind == "text" else "") for (language, text), (kind, output) in zip(parts, following)]


def test_what_the_pages_show_works_as_it_is_pasted(tmp_path):
    crates = pathlib.Path(__file__).parents[2]
    own, harness = crates / "convergence-study-python/README.md", crates / "convergence-study/README.md"
    pasted = []
    for page in [own, harness, *sorted((crates / "convergence-study/book/src").glob("*.md"))]:
        for language, text, output in blocks(page):
            is_test = "(convergence)" in text
            if (module := re.match(r"# (\w+\.py)\b", text)) and "convergence_study" not in text:
                (tmp_path / module[1]).write_text(text)  # Blocks after it import it.
                continue
            if "variants=" in text:
                continue  # It needs a module: test_variants.py runs it.
            if language == "python" and (is_test or "convergence_study" in text):
                # A block may begin with the name of its file.
                name = text.split("\n")[0].removeprefix("# ") if text.startswith("# test_") else "test_it.py"
                command = [sys.executable, "-m", "pytest", "-q", name] if is_test else [sys.executable, name]
                (tmp_path / name).write_text(text)
            elif language == "sh" and "new program" in text and page.name == "README.md":
                command = ["sh", "-e", "-c", text]
            else:
                continue
            done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, env={**os.environ, "COLUMNS": "120"})
            assert done.returncode == int("FAILED" in output), text + done.stdout + done.stderr
            assert set(output.splitlines()) - {"..."} <= set(done.stdout.splitlines()), done.stdout
            assert page.name != "README.md" or len(text.splitlines()) <= 6, text
            shutil.rmtree(tmp_path / "studies", ignore_errors=True)
            pasted.append(page)
    assert pasted.count(own) == 4


def test_the_page_of_the_package_stands_alone():
    page = (pathlib.Path(__file__).parents[1] / "README.md").read_text()
    assert len(page.splitlines()) <= 50 and "pip install convergence-study\n" in page
    assert "](" in page and not [link for link in page.split("](")[1:] if not link.startswith("https://")]


def wait_for(found):
    until = time.monotonic() + 20
    while not found():
        assert time.monotonic() < until
        time.sleep(0.05)
    return found()


def test_a_notebook_shows_table_and_picture(tmp_path):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    source = pathlib.Path(__file__).with_name("notebook.ipynb")
    notebook = nbformat.read(source, as_version=4)
    nbclient.NotebookClient(notebook, timeout=120).execute()
    shown = [output["data"]["text/html"] for cell in notebook.cells for output in cell.get("outputs", []) if "data" in output]
    assert len(shown) == 2 and all("<pre" in html and "<svg" in html for html in shown)
    assert "error: pass" in shown[0] and "L2: fail" in shown[1] and "too-low" in shown[1]
    if folder := os.environ.get("CONVERGENCE_NOTEBOOK"):
        pathlib.Path(folder, "notebook.html").write_text("\n".join(shown))
