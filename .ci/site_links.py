"""No link and no picture of a built site is dead: python .ci/site_links.py DIR, in the root of the repository

On the site, the file and the anchor exist; a link to a file or a folder of the repository names one that git has.
"""

import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

REPOSITORY = "https://github.com/thermobeam/thermobeam"

# The attribute of an element that loads or leads to something.
SOURCES = {"a": "href", "img": "src", "link": "href", "script": "src"}


class Page(HTMLParser):
    """The anchors and the links of a page."""

    def __init__(self, path: Path):
        super().__init__()
        self.anchors, self.links = set(), []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        self.anchors.update(value for name, value in attrs if name in ("id", "name"))
        link = values.get(SOURCES.get(tag, ""))
        if link is not None:
            self.links.append(link)


def files_of_git() -> tuple[set[str], set[str]]:
    """The files and the folders that git has."""
    files = set(subprocess.run(["git", "ls-files", "-z"], check=True, capture_output=True, text=True).stdout.split("\0"))
    return files, {str(parent) for file in files for parent in Path(file).parents}


class Check:
    """A built site, and what its links may lead to."""

    def __init__(self, site: Path):
        self.site = site
        self.pages = {path: Page(path) for path in sorted(site.rglob("*.html"))}
        self.files, self.folders = files_of_git()

    def complaint(self, page: Path, link: str) -> str:
        """What is wrong with a link of a page; empty if nothing is."""
        for kind, known in [("blob", self.files), ("tree", self.folders)]:
            start = f"{REPOSITORY}/{kind}/main/"
            if link.startswith(start):
                path = unquote(urlsplit(link.removeprefix(start)).path).rstrip("/")
                return "" if path in known else f"found no {path} in git"
        parts = urlsplit(link)
        if parts.scheme:
            return ""
        target = (page.parent / unquote(parts.path)).resolve() if parts.path else page
        if target.is_dir():
            target = target / "index.html"
        if self.site not in target.parents or not target.is_file():
            return "found no such file on the site"
        if parts.fragment and target in self.pages and unquote(parts.fragment) not in self.pages[target].anchors:
            return f"found no such anchor on {target.relative_to(self.site)}"
        return ""

    def complaints(self) -> list[str]:
        """What is wrong with all links, a line each."""
        found = []
        for path, page in self.pages.items():
            for link in page.links:
                complaint = self.complaint(path, link)
                if complaint:
                    found.append(f"error: {path.relative_to(self.site)}: {link}: {complaint}")
        return found


def main() -> int:
    check = Check(Path(sys.argv[1]).resolve())
    complaints = check.complaints()
    for complaint in complaints:
        print(complaint, file=sys.stderr)
    if complaints:
        return 1
    links = sum(len(page.links) for page in check.pages.values())
    print(f"{check.site}: {len(check.pages)} pages, {links} links and pictures, none dead")
    return 0 if links else 1


if __name__ == "__main__":
    sys.exit(main())
