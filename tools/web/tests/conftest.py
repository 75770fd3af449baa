"""The page in headless Chromium, made by `cargo page`, and the command line beside it, which is the judge.

Every visit is held to one rule: no console message, no error, nothing that the content policy refuses, and no
request but for the page itself. It has no builtin of JavaScript that the oldest browsers of docs/page.md lack.
"""

import collections
import functools
import http.server
import os
import re
import shutil
import subprocess
import threading
import time
from pathlib import Path

import pytest
from playwright.sync_api import expect, sync_playwright

ROOT = Path(__file__).parents[3]
TARGET = ROOT / os.environ.get("CARGO_TARGET_DIR", "target")
PROGRAM = Path(os.environ.get("MIXER_COMMAND", TARGET / "debug/cargo-mixer"))

# Seconds until what was waited for is taken for missing: a machine may be busy with much else.
PATIENCE = 120
expect.set_options(timeout=PATIENCE * 1000)

# Chromium drops the eleventh file that a page saves within a second, and says nothing: `kBurstDownloadLimit` in
# third_party/blink/renderer/core/frame/local_frame.cc. A hand is slower, a test is not.
BURST = 10
BURST_SECONDS = 1.1

# What Chromium would fetch for itself is switched off: a test's machine may have no network.
QUIET = ["--no-sandbox", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-quic"]

# A policy's refusal becomes a message of the console; the moment of the first verdict is kept.
POLICY = """addEventListener("securitypolicyviolation", ({ violatedDirective, blockedURI }) =>
  console.error(`policy: ${violatedDirective} ${blockedURI}`));"""
# Builtins that are younger than Chrome 103, Firefox 113 or Safari 16.4, by the support tables of MDN (browser-compat-data 8.1.9).
YOUNG = {
    "Array": "fromAsync", "Array.prototype": "toReversed toSorted toSpliced with", "Map": "groupBy", "Object": "groupBy",
    "ArrayBuffer.prototype": "detached maxByteLength resizable resize transfer transferToFixedLength",
    "Map.prototype": "getOrInsert getOrInsertComputed", "WeakMap.prototype": "getOrInsert getOrInsertComputed",
    "Promise": "try withResolvers", "Math": "f16round sumPrecise", "JSON": "isRawJSON rawJSON", "RegExp": "escape", "Error": "isError",
    "Set.prototype": "difference intersection isDisjointFrom isSubsetOf isSupersetOf symmetricDifference union",
    "String.prototype": "isWellFormed toWellFormed", "Uint8Array": "fromBase64 fromHex",
    "Uint8Array.prototype": "setFromBase64 setFromHex toBase64 toHex",
    "Uint8Array.prototype.__proto__": "toReversed toSorted with", "Date.prototype": "toTemporalInstant",
    "[].keys().__proto__.__proto__": "drop every filter find flatMap forEach includes join map reduce some take toArray",
    "globalThis": "Iterator Float16Array Temporal DisposableStack AsyncDisposableStack SuppressedError",
}
OLD = "".join(f"for (const name of {names.split()}) delete {of}[name];" for of, names in YOUNG.items())
VERDICT = """
addEventListener("DOMContentLoaded", () => {
  const status = document.getElementById("status");
  const look = () => { if (status.textContent.includes("compiles")) globalThis.verdictMs ??= performance.now(); };
  if (status) new MutationObserver(look).observe(status, { childList: true });
});
"""


@pytest.fixture(scope="session")
def site():
    """The folder of the page: that of `MIXER_PAGE`, which `tests/run` has made for all workers, or one made here."""
    if made := os.environ.get("MIXER_PAGE"):
        return Path(made)
    folder = TARGET / "web-tests"
    subprocess.run(["cargo", "page", "-o", folder], cwd=ROOT, check=True)
    return folder


@pytest.fixture(scope="session")
def server(site):
    """Serves the page; `address`, and the paths that were asked for."""

    class Handler(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass

        def do_GET(self):
            self.server.paths.append(self.path)
            super().do_GET()

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Handler, directory=site))
    server.paths = []
    server.address = f"http://127.0.0.1:{server.server_port}/"
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield server
    server.shutdown()
    assert set(server.paths) <= {"/", "/sw.js"}


@pytest.fixture(scope="session")
def browser():
    names = [os.environ.get("MIXER_CHROMIUM"), "chromium", "chromium-browser", "google-chrome"]
    found = next((path for name in names if name and (path := shutil.which(name))), None)
    assert found, "no chromium in PATH or MIXER_CHROMIUM: apt-get install chromium"
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=found, args=QUIET)
        yield browser
        browser.close()


@pytest.fixture
def shell(tmp_path):
    """Runs a line of the command line in a folder of its own."""

    environment = {**os.environ, "PATH": f"{PROGRAM.parent}{os.pathsep}{os.environ['PATH']}"}

    def run(line, text=""):
        done = subprocess.run(["sh", "-ec", line], cwd=tmp_path, input=text, capture_output=True, text=True, env=environment)
        assert done.returncode == 0, f"{line}\n{done.stderr}"
        return done.stdout

    run.folder, run.environment = tmp_path, environment
    return run


@pytest.fixture
def visit(browser, server, shell):
    """Opens the page as `visit(**options of the browser's context)`."""
    contexts, wrong = [], []

    def open_page(address=server.address, context=None, init="", **options):
        if context is None:
            context = browser.new_context(**{"viewport": {"width": 1400, "height": 900}, **options})
            contexts.append(context)
            context.set_default_timeout(PATIENCE * 1000)
            context.add_init_script(OLD + POLICY + VERDICT + init)
            context.on("console", lambda message: wrong.append(f"console: {message.text}"))
            context.on("weberror", lambda error: wrong.append(f"error: {error.error}"))
            context.on("request", lambda request: asked(request.url))
        desk = Desk(context.new_page(), shell)
        desk.page.goto(address)
        for worker in desk.page.workers:
            worker.evaluate(POLICY)
        return desk

    def asked(url):
        if not url.split("#")[0].removeprefix("blob:").startswith((server.address, "file:", "null/")):
            wrong.append(f"request: {url}")

    yield open_page
    for context in contexts:
        context.close()
    assert wrong == []


@pytest.fixture
def desk(visit):
    """The page, as at a first visit."""
    return visit().ready()


class Desk:
    """What a user does on the page, and what is seen of it."""

    def __init__(self, page, shell):
        self.page, self.shell = page, shell
        self.see, self.click = page.locator, page.click
        self.saved = collections.deque([-BURST_SECONDS] * BURST, BURST)

    def says(self, text):
        return self.shows("#status", text)

    def ready(self):
        return self.says("Ready")

    def settled(self):
        """Waits until all that is shown, and every file to take along, is of what was put in."""
        self.until(lambda: self.page.evaluate("() => isSettled()"), lambda: self.see("#status").text_content())
        return self

    def compiles(self, name=""):
        return self.settled().says(f"{name} compiles" if name else "compiles")

    def shows(self, element, text):
        """Waits for a text in one of the elements; what is there instead is told in few words."""
        there = lambda: " | ".join(self.see(element).all_text_contents())
        self.until(lambda: text in there(), lambda: f"{element} has no `{text}`: {there()[:600]}")
        return self

    def tells(self, code):
        """Waits for the sentence of a code, which the page does not name."""
        expect(self.see(f"#faults [data-code={code}]").first).to_be_visible()
        return self

    def drop(self, *files):
        """Drops files, each a path or (name, bytes), as a hand does; the command line has them, too."""
        files = [(file.name, file.read_bytes()) if isinstance(file, Path) else file for file in files]
        for name, content in files:
            (self.shell.folder / name).write_bytes(content)
        transfer = self.page.evaluate_handle(
            """(files) => {
                const transfer = new DataTransfer();
                for (const [name, text] of files) transfer.items.add(new File([Uint8Array.from(text, (c) => c.charCodeAt(0))], name));
                return transfer;
            }""",
            [[name, content.decode("latin-1")] for name, content in files],
        )
        self.see("#drop").dispatch_event("drop", {"dataTransfer": transfer})
        return self

    def opened(self, part):
        """A part of the page, with what it is folded in opened."""
        self.see(part).evaluate("(part) => { for (let box = part; box; box = box.parentElement) if (box.tagName === 'DETAILS') box.open = true; }")
        return self.settled().see(part)

    def link(self, output):
        """The link of a file to take along."""
        return self.opened(f"[data-output='{output}']")

    def save(self, output):
        """Follows the link of a file; the name and the bytes of what was saved."""
        link = self.link(output)
        expect(link).to_have_attribute("href", re.compile("^blob:"))
        time.sleep(max(0, self.saved[0] + BURST_SECONDS - time.monotonic()))
        with self.page.expect_download() as download:
            link.click()
        self.saved.append(time.monotonic())
        return download.value.suggested_filename, Path(download.value.path()).read_bytes()

    def run_shown(self):
        """Runs the very words that the page shows; what they print."""
        return self.shell(self.see("#command").text_content())

    def file(self, name):
        return (self.shell.folder / name).read_bytes()

    def text(self):
        return self.see("#editor textarea").input_value()

    def replace(self, old, new):
        """Writes `new` over `old` in the editor, key by key."""
        at = self.text().index(old)
        self.see("#editor textarea").evaluate("(area, [from, to]) => { area.focus(); area.setSelectionRange(from, to); }", [at, at + len(old)])
        self.page.keyboard.type(new) if new else self.page.keyboard.press("Delete")
        return self

    def faults(self):
        return self.see("#faults li").all_text_contents()

    def still(self):
        """Waits until the sliders' newest position is drawn."""
        self.settled().until(lambda: self.page.evaluate("() => hand.frames > 0 && !hand.busy && !hand.stale"))
        return self

    @staticmethod
    def until(holds, told=lambda: "it did not come to that"):
        end = time.monotonic() + PATIENCE
        while not holds():
            assert time.monotonic() < end, told()
            time.sleep(0.05)
