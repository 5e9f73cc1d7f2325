"""Stages the pages of the site for mdBook: python .ci/site_pages.py BOOK DIR, in the root of the repository

SUMMARY.md of the folder BOOK lists all pages. Those of other folders are taken from where they are. In each page, a link to
a page of the site leads to that page, every other link into the repository leads to GitHub, and pictures are copied.
"""

import posixpath
import re
import shutil
import sys
from pathlib import Path

REPOSITORY = "https://github.com/thermobeam/thermobeam"

# Code stays as it is; a picture or a link, `![text](target)`, `](target)`; the target of a reference, `[name]: target`.
PARTS = re.compile(
    r"(?P<code>^ *```.*?^ *```|(?P<ticks>`+)(?!`).*?(?<!`)(?P=ticks)(?!`))"
    r"|(?P<picture>!\[[^\]]*\]\()(?P<file>[^)\s]+)"
    r"|(?P<link>\]\(|^\[[^\]]+\]: )(?P<target>[^)\s]+)",
    re.MULTILINE | re.DOTALL,
)


def outside(path: str) -> str:
    """Where a file of the repository that is not in the book is on the site."""
    path = path.removeprefix("crates/")
    return posixpath.join(posixpath.dirname(path), "index.md") if path.endswith("/README.md") else path


class Site:
    """The pages of the site and their titles, by their paths in the repository."""

    def __init__(self, book: str, folder: Path):
        self.book, self.folder = book, folder
        self.pages, self.titles = {f"{book}/SUMMARY.md": "SUMMARY.md"}, {}
        for title, target in re.findall(r"\[([^]]+)\]\(([^)]+)\)", Path(book, "SUMMARY.md").read_text(encoding="utf-8")):
            path = posixpath.normpath(posixpath.join(book, target))
            if not Path(path).is_file():
                sys.exit(f"error: {book}/SUMMARY.md: expected a page, found no {path}")
            self.pages[path], self.titles[path] = self.place(path), title

    def place(self, path: str) -> str:
        """Where a page or a picture of the repository is on the site."""
        return path.removeprefix(self.book + "/") if path.startswith(self.book + "/") else outside(path)

    def link(self, page: str, target: str) -> str:
        """The target of a link of a page, on the site."""
        for kind in ["blob", "tree"]:
            target = re.sub(f"^{REPOSITORY}/{kind}/main/", "/", target)
        if re.match(r"[a-z]+:|#", target):
            return target
        target, mark, anchor = target.partition("#")
        path = posixpath.normpath(posixpath.join(posixpath.dirname(page), target) if target[0] != "/" else target[1:])
        if path in self.pages:
            return self.relative(page, self.pages[path]) + mark + anchor
        return f"{REPOSITORY}/{'tree' if Path(path).is_dir() else 'blob'}/main/{path}{mark}{anchor}"

    def picture(self, page: str, target: str) -> str:
        """The target of a picture of a page, which is copied to the site."""
        path = posixpath.normpath(posixpath.join(posixpath.dirname(page), target))
        if not Path(path).is_file():
            return target
        copy = self.folder / self.place(path)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, copy)
        return self.relative(page, self.place(path))

    def relative(self, page: str, place: str) -> str:
        """The path from a page to a place on the site."""
        return posixpath.relpath(place, posixpath.dirname(self.pages[page]) or ".")

    def stage(self, page: str):
        """Writes a page; one that does not begin with a heading gets its title of the summary."""

        def part(match: re.Match) -> str:
            if match["code"]:
                return match[0]
            if match["picture"]:
                return match["picture"] + self.picture(page, match["file"])
            return match["link"] + self.link(page, match["target"])

        staged = self.folder / self.pages[page]
        staged.parent.mkdir(parents=True, exist_ok=True)
        text = PARTS.sub(part, Path(page).read_text(encoding="utf-8"))
        staged.write_text(text if text.startswith("# ") else f"# {self.titles[page]}\n\n{text}", encoding="utf-8")


def main():
    site = Site(sys.argv[1], Path(sys.argv[2]))
    for page in site.pages:
        site.stage(page)


if __name__ == "__main__":
    main()
