"""Makes one file of the page: `page_file.py MODULE CRATE FILE [OLD NEW]`.

The module is compressed and written as base64. The policy in the file allows its own script and style, and nothing from elsewhere.
With OLD and NEW the script has NEW in place of OLD: a defect that the trial must find.
"""

import base64
import gzip
import hashlib
import re
import sys
from pathlib import Path

LARGEST = 1_000_000
"""Bytes that the file may have."""


def source(text: str) -> str:
    """The source of a policy that allows this text."""
    digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
    return f"'sha256-{digest}'"


def page(module: bytes, crate: Path, planted: list[str]) -> str:
    parts = {name: (crate / "page" / name).read_text(encoding="utf-8") for name in ("page.html", "page.css", "page.js", "worker.js")}
    # The colours are those of a report.
    colours = crate.parent / "convergence-study/src/report/templates/colours.css"
    parts["page.css"] = colours.read_text(encoding="utf-8") + parts["page.css"]
    if planted:
        old, new = planted
        assert old in parts["page.js"], f"page.js has no {old!r}"
        parts["page.js"] = parts["page.js"].replace(old, new)
    version = re.search(r'^version = "(.+)"$', Path("Cargo.toml").read_text(encoding="utf-8"), re.M)
    assert version, "no version in Cargo.toml"
    policy = "; ".join(
        [
            "default-src 'none'",
            f"script-src {source(parts['page.js'])} 'wasm-unsafe-eval'",
            f"style-src {source(parts['page.css'])}",
            "worker-src blob:",
            "img-src data:",
            "base-uri 'none'",
            "form-action 'none'",
        ]
    )
    words = {
        "policy": policy,
        "version": version[1],
        "style": parts["page.css"],
        "script": parts["page.js"],
        "worker": parts["worker.js"],
        "module": base64.b64encode(gzip.compress(module, 9, mtime=0)).decode(),
    }
    return re.sub(r"\{(policy|version|style|script|worker|module)\}", lambda name: words[name[1]], parts["page.html"])


def main() -> None:
    module, crate, file = map(Path, sys.argv[1:4])
    text = page(module.read_bytes(), crate, sys.argv[4:])
    size = len(text.encode())
    if size > LARGEST:
        sys.exit(f"error: {file}: expected at most {LARGEST} bytes, found {size}")
    file.write_text(text, encoding="utf-8")
    print(f"{file}: {size} bytes")


main()
