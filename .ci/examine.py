"""What a wheel or an sdist must have, and must not have: python .ci/examine.py FILE FOLDER...

The licences, complete metadata, no compiled file in an sdist, and nowhere the name of one of the folders, which mean
nothing on another machine. A wheel for manylinux2014 asks for no symbol of a glibc newer than 2.17.
"""

import re
import sys
import tarfile
import zipfile
from email.parser import Parser
from pathlib import Path

METADATA = {
    "Author": "developers",
    "License-Expression": "MIT OR Apache-2.0",
    "Requires-Python": ">=3.9",
    "Description-Content-Type": "text/markdown",
}
CLASSIFIERS = ["Development Status ::", "Operating System ::", "Programming Language :: Rust", "Typing :: Typed"]
ADDRESSES = ["Homepage", "Documentation", "Repository", "Issues", "Changelog"]
OLDEST_GLIBC = (2, 17)


def contents(path: Path) -> dict[str, bytes]:
    """The files of an archive by their names."""
    if path.suffix == ".whl":
        with zipfile.ZipFile(path) as archive:
            return {name: archive.read(name) for name in archive.namelist() if not name.endswith("/")}
    with tarfile.open(path) as archive:
        members = [member for member in archive.getmembers() if member.isfile()]
        return {member.name: archive.extractfile(member).read() for member in members}


def complaints(path: Path, folders: list[str]):
    """What is wrong with an archive, one text each."""
    files = contents(path)
    is_wheel = path.suffix == ".whl"
    for licence in ["LICENSE-APACHE", "LICENSE-MIT"]:
        depth = "/licenses/" if is_wheel else "/"
        if not any(name.endswith(depth + licence) for name in files):
            yield f"found no {licence}"
    metadata = [name for name in files if name.endswith(".dist-info/METADATA" if is_wheel else "/PKG-INFO")]
    if not metadata:
        yield "found no metadata"
        return
    header = Parser().parsestr(files[metadata[0]].decode())
    for key, part in METADATA.items():
        if part not in (header[key] or ""):
            yield f"metadata: found {key} {header[key]}; expected {part}"
    for part in CLASSIFIERS:
        if not any(part in value for value in header.get_all("Classifier", [])):
            yield f"metadata: found no classifier {part}"
    for name in ADDRESSES:
        if not any(value.startswith(name + ",") for value in header.get_all("Project-URL", [])):
            yield f"metadata: found no address of {name}"
    for name, content in files.items():
        for folder in folders:
            if (folder.rstrip("/") + "/").encode() in content:
                yield f"{name}: found the folder {folder} of this machine"
        if not is_wheel and re.search(r"\.(so|pyd|pyc|o|rlib)$|/target/", name):
            yield f"{name}: found a file that the machine has made"
    if is_wheel and "manylinux" in path.name:
        symbols = {match for content in files.values() for match in re.findall(rb"GLIBC_(\d+)\.(\d+)", content)}
        newest = max((int(major), int(minor)) for major, minor in symbols)
        print(f"{path.name}: newest symbol GLIBC_{newest[0]}.{newest[1]}")
        if "manylinux2014" in path.name and newest > OLDEST_GLIBC:
            yield f"found GLIBC_{newest[0]}.{newest[1]}; expected at most 2.17"
    if is_wheel and "musllinux" in path.name:
        libraries = [content for name, content in files.items() if name.endswith(".so")]
        if not libraries or any(b"libc.so.6\0" in content or b"GLIBC_" in content for content in libraries):
            yield "found a library that needs glibc; expected musl"


def main() -> int:
    path, folders = Path(sys.argv[1]), sys.argv[2:]
    found = list(complaints(path, folders))
    for complaint in found:
        print(f"error: {path.name}: {complaint}", file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
