"""Tries the page in a real browser: `page_browser.py BROWSER PAGE PROGRAM [PICTURES]`.

Every table below crates/convergence-study/tests/public, and the examples of the page, get in the page what PROGRAM prints. With
PICTURES, a folder, the page is drawn there: light, dark and narrow.
"""

import base64
import fcntl
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PATIENCE = 20.0
"""Seconds that an answer may take."""


class Browser:
    """Chromium without a window, spoken to through two pipes."""

    def __init__(self, program: str, profile: str):
        read_theirs, self.writer = os.pipe()
        self.reader, write_theirs = os.pipe()
        options = ["--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe", f"--user-data-dir={profile}", "about:blank"]

        def pipes() -> None:
            # Where the browser expects them; a descriptor that stood there is not lost.
            reads, writes = fcntl.fcntl(read_theirs, fcntl.F_DUPFD, 10), fcntl.fcntl(write_theirs, fcntl.F_DUPFD, 10)
            os.dup2(reads, 3)
            os.dup2(writes, 4)

        self.process = subprocess.Popen([program, *options], preexec_fn=pipes, close_fds=False, stderr=subprocess.DEVNULL)
        os.close(read_theirs)
        os.close(write_theirs)
        self.rest = b""
        self.last = 0
        self.session = None
        self.requests: list[str] = []
        self.errors: list[str] = []

    def message(self) -> dict:
        while b"\0" not in self.rest:
            part = os.read(self.reader, 1 << 20)
            if not part:
                raise RuntimeError("the browser has ended")
            self.rest += part
        one, self.rest = self.rest.split(b"\0", 1)
        return json.loads(one)

    def call(self, method: str, **params) -> dict:
        self.last += 1
        question = {"id": self.last, "method": method, "params": params}
        if self.session:
            question["sessionId"] = self.session
        data = json.dumps(question).encode() + b"\0"
        while data:
            data = data[os.write(self.writer, data) :]
        while True:
            answer = self.message()
            self.note(answer)
            if answer.get("id") == self.last:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]

    def note(self, event: dict) -> None:
        params = event.get("params", {})
        if event.get("method") == "Network.requestWillBeSent":
            self.requests.append(params["request"]["url"])
        if event.get("method") == "Runtime.exceptionThrown":
            self.errors.append(json.dumps(params["exceptionDetails"])[:400])
        if event.get("method") == "Log.entryAdded" and params["entry"]["level"] == "error":
            self.errors.append(params["entry"]["text"])

    def open(self, address: str) -> None:
        self.session = None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ["Page", "Runtime", "Network", "Log"]:
            self.call(f"{domain}.enable")
        self.call("Page.navigate", url=address)
        self.wait("document.body && document.body.dataset.ready === 'true'", "the page is not ready")

    def value(self, expression: str):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression[:80]}: {json.dumps(result['exceptionDetails'])[:400]}")
        return result["result"].get("value")

    def wait(self, condition: str, complaint: str) -> None:
        end = time.monotonic() + PATIENCE
        while not self.value(condition):
            if time.monotonic() > end:
                raise SystemExit(f"error: {complaint} after {PATIENCE} s; {self.errors}")
            time.sleep(0.01)

    def close(self) -> None:
        self.process.kill()
        self.process.wait()


ANSWERED = "byId('answer').getAttribute('aria-busy') === 'false'"


def ask(browser: Browser, text: str, order: str) -> dict | None:
    """What the page has been told of a text; `None` if it shows a message of its own."""
    browser.value(
        f"clearOptions(); byId('order').value = {json.dumps(order)}; byId('text').value = {json.dumps(text)}; last = null; ask(); 0"
    )
    browser.wait(ANSWERED, "no answer")
    return browser.value("last")


def printed(program: str, text: str, order: str) -> tuple[int, str, str]:
    orders = [word for one in order.split() for word in ["--order", one]]
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "text").write_text(text, encoding="utf-8")
        done = subprocess.run([program, "rates", "text", *orders], cwd=folder, capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


def compare(browser: Browser, program: str, name: str, text: str, order: str) -> str:
    """Asks both; returns `judged` or `refused`."""
    status, words, complaint = printed(program, text, order)
    found = ask(browser, text, order)
    assert found is not None, f"{name}: the page shows {browser.value('byId(`answer`).textContent')}"
    if status == 2:
        first = complaint.split("\n")[0].replace("error: ", "", 1)
        said = found.get("refused", {}).get("message", "")
        assert said.split("\n")[0] == first, f"{name}: the program refuses by {first!r}, the page by {said!r}"
        shown = browser.value("byId('answer').querySelector('pre').textContent")
        # Words between back quotes are code.
        plain = said.replace("`", "") if said.count("`") % 2 == 0 else said
        assert shown == plain, f"{name}: the page shows {shown!r} for {said!r}"
        return "refused"
    ours = words.replace("convergence-study rates text", "convergence-study rates FILE")
    theirs = found.get("text", found)
    assert without_name(theirs) == without_name(ours), f"{name}:\n--- program\n{ours}\n--- page\n{theirs}"
    assert found["verdict"] == ["pass", "fail"][status] or found["verdict"] == "inconclusive" and status == 1, name
    shown = browser.value("byId('answer').querySelector('.verdict').textContent")
    assert shown == f"{found['verdict']} {found['sentence']}", f"{name}: {shown!r}"
    assert browser.value("document.querySelectorAll('img.figure').length") == len(found["tables"]), name
    drawn = "[...document.querySelectorAll('img.figure')].every((one) => one.complete && one.naturalWidth > 0)"
    browser.wait(drawn, f"{name}: a figure that is not drawn")
    return "judged"


def without_name(text: str) -> str:
    return text.replace("rates text:", "rates FILE:")


def examples(browser: Browser) -> list[tuple[str, str, str]]:
    every = browser.value("EXAMPLES")
    return [(name, one["text"], one["order"]) for name, one in every.items()]


def links(browser: Browser, page: str, text: str) -> None:
    """A link brings back text, options and verdict."""
    ask(browser, text, "2")
    browser.value("byId('tolerance').value = '0.2'; byId('floor').value = '1e-12'; ask(); 0")
    browser.wait(ANSWERED, "no answer")
    before = browser.value("last.text")
    fragment = browser.value("fragment()")
    browser.open(f"{page}#{fragment}")
    browser.wait("last !== null && " + ANSWERED, "a link is not judged")
    assert browser.value("last.text") == before
    assert browser.value("byId('text').value") == text
    assert browser.value("byId('floor').value") == "1e-12"
    browser.open(f"{page}#not-a-table")
    assert "cut" in browser.value("byId('answer').textContent")


def hostile(browser: Browser) -> None:
    """No text is run as markup, reaches a terminal's controls, or stops the page."""
    script = "<img src=x onerror='window.harmed = 1'><script>window.harmed = 1</script>"
    rows = "".join(f"{0.1 / 2**k}, {0.01 / 4**k}\n" for k in range(5))
    ask(browser, f"h, {script}\n{rows}", "2")
    ask(browser, f"# {script}\nh, L2\n{rows}\n# {script}\nh, L2\n{rows}", "2")
    ask(browser, f"h, \x1b[31mred\x1b[0m\u202e\n{rows}", "2")
    assert "\x1b" not in browser.value("byId('answer').textContent")
    assert browser.value("window.harmed") is None
    assert browser.value("byId('answer').querySelectorAll('script, [onerror]').length") == 0
    browser.value("takeFile(new File(['h, L2\\n' + '0.1, 0.01\\n'.repeat(1e6)], 'large.csv'))")
    said = browser.value("byId('answer').textContent")
    assert "at most 4194304 bytes; found 10000006" in said, said
    assert ask(browser, f"h, L2\n{rows}", "2")["verdict"] == "pass"


def speed(browser: Browser) -> None:
    rows = "".join(f"{0.1 / 1.1**k}, {0.01 / 1.21**k}\n" for k in range(100))
    text = json.dumps(f"h, L2\n{rows}")
    start = f"byId('order').value = '2'; byId('text').value = {text};"
    timed = """new Promise((done) => {
        const begin = performance.now();
        const look = new MutationObserver(() => {
            if (byId('answer').getAttribute('aria-busy') === 'false') { look.disconnect(); done(performance.now() - begin); }
        });
        look.observe(byId('answer'), { attributes: true });
        ask();
    })"""
    times = [browser.value(f"{start} {timed}") for _ in range(5)]
    print(f"100 rows: {min(times):.0f} ms; 100,000 rows: ", end="")
    browser.value("byId('text').value = 'h, L2\\n' + Array.from({length: 1e5}, (_, k) => `${1 / (k + 1)}, ${1 / (k + 1) ** 2}`).join('\\n'); 0")
    print(f"{browser.value(timed):.0f} ms")


def pictures(browser: Browser, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name, width, height, scheme in [("light", 1280, 900, "light"), ("dark", 1280, 900, "dark"), ("narrow", 390, 1500, "light")]:
        browser.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        browser.value("example('lost')")
        browser.wait(ANSWERED, "no answer")
        time.sleep(0.3)
        data = browser.call("Page.captureScreenshot", format="png")["data"]
        Path(folder, f"{name}.png").write_bytes(base64.b64decode(data))
    browser.value("byId('text').value = 'h, L2\\n0.1, 1e-2\\n0.05, 2x\\n'; ask(); 0")
    browser.wait(ANSWERED, "no answer")
    data = browser.call("Page.captureScreenshot", format="png")["data"]
    Path(folder, "refused.png").write_bytes(base64.b64decode(data))


def main() -> None:
    program, page = sys.argv[1], Path(sys.argv[2]).resolve().as_uri()
    judge = str(Path(sys.argv[3]).resolve())
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(program, profile)
        try:
            browser.open(page)
            tables = examples(browser)
            for one in sorted(Path("crates/convergence-study/tests/public").glob("*.[tmc]*")):
                tables.append((one.name, one.read_text(encoding="utf-8"), "2"))
            counts = {"judged": 0, "refused": 0}
            for name, text, order in tables:
                counts[compare(browser, judge, name, text, order)] += 1
            print(f"the page says what the program says: {counts['judged']} tables judged, {counts['refused']} refused")
            links(browser, page, tables[0][1])
            hostile(browser)
            speed(browser)
            outside = [url for url in browser.requests if not url.startswith(("file:", "blob:", "data:"))]
            assert outside == [], f"the page asks for {outside}"
            assert browser.errors == [], browser.errors
            if len(sys.argv) > 4:
                pictures(browser, Path(sys.argv[4]))
        finally:
            browser.close()


main()
