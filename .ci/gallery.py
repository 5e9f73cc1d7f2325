"""The codes of the gallery: python3 .ci/gallery.py HARNESS [--wheel FILE] [--install] [--write]

Each code of .ci/gallery_codes.py runs where its software is there, and must pass; with one line changed it must fail. The
rows of the page `book/src/gallery.md` must be what was found. `--write` writes these rows, and the page of each code with
its figure. PyPI's packages go to a folder of their own; Debian's are installed with `--install`.

Prints a line `pass: ...`, `FAIL: ...` or `skipped: ...` for each thing that is seen.
"""

import argparse
import functools
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from html.parser import HTMLParser
from pathlib import Path

from gallery_codes import CODES, Code

ROOT = Path(__file__).resolve().parent.parent
BOOK = ROOT / "crates/convergence-study/book/src"
PAGE = BOOK / "gallery.md"
PAGES = BOOK / "gallery"
# The line above the rows of the page.
HEAD = "| --- | --- | --: | --- | --- | --- |"
MOST_LINES, MOST_LINES_FOR_THE_HARNESS = 60, 10
HARNESS_MARK = "For the harness:"
APT = ["apt-get", "-o", "DPkg::Lock::Timeout=600"]
# The language of a block of code, by the ending of the file.
LANGUAGES = {
    **{".edp": "cpp", ".cpp": "cpp", ".cc": "cpp", ".f90": "fortran", ".m": "matlab", ".jl": "julia", ".py": "python"},
    **{".toml": "toml", ".txt": "cmake"},
}


@dataclass
class Found:
    """What one run of a code says: verdict, rates and figure, and its words as Markdown."""

    verdict: str
    rates: list
    words: str
    figure: Path

    def cell(self):
        """The verdict and each rate, with the order claimed in brackets."""
        return ": ".join(filter(None, [self.verdict, ", ".join(map(in_words, self.rates))]))

    def is_failure_of_a_rate(self):
        """Whether a rate was found and is wrong: a program that no longer runs is no finding."""
        return self.verdict == "fail" and any(row["verdict"] == "fail" and row["fitted"] is not None for row in self.rates)


class Failed(Exception):
    """A command that ended without an answer."""


def in_words(rate):
    """A rate, with the order claimed in brackets. Without its sign where it is zero."""
    fitted = "no rate" if rate["fitted"] is None else f"{round(rate['fitted'], 3) + 0.0:.3f}"
    return f"{rate['norm']} {fitted} ({rate['order']:g})"


def said(line):
    print(line, flush=True)


def lines_of(code):
    """All lines of a program that are not blank, and those that are there for the harness only."""
    lines = [line for line in (ROOT / "studies/programs" / code.program).read_text().splitlines() if line.strip()]
    if code.is_test:
        return len(lines), sum(bool(re.search(r"\bconvergence\b", line)) for line in lines if not line.startswith('"""'))
    marks = [number for number, line in enumerate(lines) if HARNESS_MARK in line]
    return len(lines), len(lines) - marks[0] - 1 if marks else 0


def environment(code, harness, venv):
    places = [*code.path_first, harness.parent, venv / "bin"]
    path = os.pathsep.join([*map(str, places), os.environ["PATH"]])
    return {"WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ, "PATH": path, "PYTHONDONTWRITEBYTECODE": "1"}


class Tables(HTMLParser):
    """The tables of the studies of a page, by name: rows of cells, each with whether it is a number. Tables that are folded are left out."""

    def __init__(self):
        super().__init__()
        self.tables, self.name, self.folds, self.is_cell = [], "", 0, False

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.folds += tag == "details"
        self.name = attributes.get("aria-label", self.name)
        if tag == "table":
            self.tables.append((self.name, []))
        elif tag == "tr":
            self.tables[-1][1].append([])
        elif tag in ("th", "td"):
            self.is_cell = True
            self.tables[-1][1][-1].append(["", attributes.get("class") == "number"])

    def handle_endtag(self, tag):
        self.folds -= tag == "details"
        self.is_cell &= tag not in ("th", "td")
        if tag == "table" and self.folds != 1:
            self.tables.pop()

    def handle_data(self, data):
        if self.is_cell:
            self.tables[-1][1][-1][-1][0] += data


def in_markdown(rows):
    """A table whose columns line up, numbers on the right."""
    columns = [([text for text, _ in column], column[0][1]) for column in zip(*rows)]
    widths = [max(2, *map(len, texts)) for texts, _ in columns]
    aligned = [
        [text.rjust(width) if is_number else text.ljust(width) for text in texts] for (texts, is_number), width in zip(columns, widths)
    ]
    rule = ["-" * (width - is_number) + ":" * is_number for (_, is_number), width in zip(columns, widths)]
    head, *body = zip(*aligned)
    return "\n".join("| " + " | ".join(row) + " |" for row in [head, rule, *body])


def report_in_words(report):
    """The tables of rates and of errors of a report."""
    page = Tables()
    page.feed((report / "index.html").read_text())
    tables = [(name, rows) for name, rows in page.tables if name != "Checks"]
    return "\n\n".join(f"**{name}**\n\n{in_markdown(rows)}" for name, rows in tables)


def run(code, folder, env):
    """Runs the commands of a code in a folder with its files. Raises Failed if the last one gives no answer."""
    folder = (folder / code.program).parent
    shutil.rmtree(folder / "report", ignore_errors=True)
    for command in code.commands:
        done = subprocess.run(["sh", "-e", "-c", command], cwd=folder, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode not in ([0, 1] if command == code.commands[-1] else [0]):
            raise Failed(f"`{command}` ended with {done.returncode}: {done.stdout[-3000:]}")
    report = folder / "report"
    if code.sign:
        return Found("fail" if code.sign in done.stdout else "pass", [], "", report)
    if (report / "rates.json").exists():
        result = json.loads((report / "rates.json").read_text())
        return Found(result["verdict"], result["rates"], f"```text\n{done.stdout.strip()}\n```", report / "rates.svg")
    if not (report / "results.json").exists():
        raise Failed(f"`{code.commands[-1]}` has written no report: {done.stdout[-3000:]}")
    result = json.loads((report / "results.json").read_text())
    rates = [rate for study in result["studies"] for rate in study["rates"]]
    figures = sorted((report / "figures").glob("*-errors.svg")) or sorted((report / "figures").glob("*.svg"))
    return Found(result["verdict"], rates, report_in_words(report), figures[0])


def has(code, env):
    return subprocess.run(["sh", "-c", code.needs], env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0


@functools.cache
def update_debian():
    """Asks for Debian's list of packages, once."""
    subprocess.run([*APT, "update"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def make_available(code, env, venv, wheel, install):
    """Installs what a code needs, where that is allowed. Returns what is missing, in words, or nothing."""
    pypi = [*code.pypi, *(["pytest", str(wheel)] if code.is_test and wheel else [])]
    if code.is_test and not wheel:
        return "no wheel"
    if pypi:
        done = subprocess.run([venv / "bin/pip", "install", "--quiet", *pypi], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode:
            return f"{' '.join(code.pypi)} cannot be installed: {done.stdout.strip().splitlines()[-1]}"
    if has(code, env):
        return ""
    if install and code.debian:
        update_debian()
        command = [*APT, "install", "-y", "--no-install-recommends", *code.debian]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if has(code, env):
            return ""
        return f"not there after apt-get install {' '.join(code.debian)}: {done.stdout.strip().splitlines()[-1]}"
    return f"not there (Debian's {' '.join(code.debian)}, with --install)" if code.debian else "not there"


def plant(code, planted):
    """A second copy of all files, with the one line changed."""
    shutil.rmtree(planted, ignore_errors=True)
    shutil.copytree(ROOT / "studies/programs", planted)
    program = planted / code.program
    text = program.read_text()
    if text.count(code.old) < 1:
        raise Failed(f"{code.program} has no `{code.old}` to be changed")
    program.write_text(text.replace(code.old, code.new, 1))


def see(code, place, planted, env):
    """Runs a code as it is and with its mistake. Returns both findings; None where one of them is not what it must be."""
    try:
        right = run(code, place, env)
        if right.verdict != "pass":
            said(f"FAIL: {code.name}: {right.cell()}\n{right.words}")
            return None
        said(f"pass: {code.name}: {right.cell()}")
        plant(code, planted)
        wrong = run(code, planted, env)
        is_found = wrong.verdict == "fail" if code.sign else wrong.is_failure_of_a_rate()
        if not is_found:
            said(f"FAIL: {code.name} does not find {code.mistake}: {wrong.cell()}\n{wrong.words}")
            return None
        said(f"pass: {code.name} finds {code.mistake}: {wrong.cell()}")
        return right, wrong
    except Failed as failed:
        said(f"FAIL: {code.name}: {failed}")
        return None


def row(code, right, wrong):
    total, harness = lines_of(code)
    name = f"[{code.heading}](gallery/{code.name}.md)" if code.has_page else code.heading
    return f"| {name} | {code.solves} | {total} ({harness}) | {right} | {code.mistake} | {wrong} |"


def changed_line(code):
    """The line with the mistake, as a difference."""
    text = (ROOT / "studies/programs" / code.program).read_text()
    before = next(line for line in text.splitlines() if code.old.splitlines()[0] in line)
    return f"```diff\n-{before}\n+{before.replace(code.old, code.new, 1)}\n```"


def page(code, findings):
    """The page of a code: program, study, commands, what they say, and the mistake."""
    programs = ROOT / "studies/programs"
    total, harness = lines_of(code)
    link = lambda file: f"[{Path(file).name}](../../../../../studies/{os.path.normpath(f'programs/{file}')})"
    parts = [f"# {code.heading}: {code.solves}", f"{link(code.program)}: {total} lines, {harness} of them for the harness."]
    for file in [code.program, *code.files]:
        if file != code.program:
            parts.append(f"{link(file)}:")
        parts.append(f"```{LANGUAGES[Path(file).suffix]}\n{(programs / file).read_text().rstrip()}\n```")
    parts += [f"```sh\n{chr(10).join(code.commands)}\n```"]
    if findings:
        right, wrong = findings
        orders = " and ".join(dict.fromkeys(f"{rate['order']:g}" for rate in right.rates))
        parts += [f"**{right.verdict}**", right.words, f"![{code.heading}: errors over the step, and the orders claimed: {orders}]({code.name}.svg)"]
        parts += [f"## With a mistake: {code.mistake}", changed_line(code), f"**{wrong.verdict}**", wrong.words]
    else:
        parts += ["Nobody has run it here.", f"## With a mistake: {code.mistake}", changed_line(code)]
    return "\n\n".join(parts) + "\n"


def write(code, findings):
    """Writes the page and the figure of a code. Pages of codes that were not run stay as they are."""
    file = PAGES / f"{code.name}.md"
    if not code.has_page or file.exists() and not findings:
        return
    file.write_text(page(code, findings))
    if findings:
        shutil.copyfile(findings[0].figure, PAGES / f"{code.name}.svg")


def table(rows):
    """The page with new rows; those of codes that were not run stay."""
    lines = PAGE.read_text().splitlines()
    start = lines.index(HEAD) + 1
    end = next(number for number in range(start, len(lines)) if not lines[number].startswith("|"))
    name = lambda line: re.match(r"\| \[?(.*?)(\]\(| \| )", line)[1]
    old = {name(line): line for line in lines[start:end]}
    new = [rows.get(code.heading) or old.get(code.heading) or row(code, "nobody has run it here", "-") for code in CODES if code.is_shown]
    return "\n".join([*lines[:start], *new, *lines[end:]]) + "\n"


def see_all(codes, options, place):
    """Runs the codes, and writes their pages if that is asked for. Returns the rows of those that ran, by heading."""
    venv = place / "venv"
    subprocess.run([sys.executable, "-m", "venv", venv], check=True)
    # Each copy of the programs has the files for `manufacture` beside it.
    shutil.copytree(ROOT / "studies/programs", place / "right/programs")
    for copy in ["right", "planted"]:
        shutil.copytree(ROOT / "studies/manufactured", place / copy / "manufactured")
    rows = {}
    for code in codes:
        total, harness = lines_of(code)
        is_short = harness <= MOST_LINES_FOR_THE_HARNESS and (total <= MOST_LINES or not code.has_page)
        said(f"{'pass' if is_short else 'FAIL'}: {code.program}: {total} lines, {harness} for the harness")
        env = environment(code, options.harness.resolve(), venv)
        missing = make_available(code, env, venv, options.wheel and options.wheel.resolve(), options.install)
        if missing:
            said(f"skipped: {code.name}: {missing}")
        findings = None if missing else see(code, place / "right/programs", place / "planted/programs", env)
        if findings and code.is_shown:
            rows[code.heading] = row(code, *(finding.cell() for finding in findings))
        if options.write and (findings or missing):
            write(code, findings)
    return rows


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("harness", type=Path)
    parser.add_argument("--wheel", type=Path)
    parser.add_argument("--install", action="store_true")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--only", nargs="*", help="names of codes")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        rows = see_all([code for code in CODES if not options.only or code.name in options.only], options, Path(place))
    if options.write:
        PAGE.write_text(table(rows))
    shown = PAGE.read_text().splitlines()
    for heading, line in rows.items():
        if line in shown:
            said(f"pass: {heading}: the gallery shows what was found")
        else:
            said(f"FAIL: {heading}: the gallery shows another row, mended by --write; expected {line}")


if __name__ == "__main__":
    main()
