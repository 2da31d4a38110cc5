"""Chromium without a window, driven through two pipes, and what is wrong with a page in it."""

import base64
import fcntl
import json
import os
import select
import subprocess
import time
from pathlib import Path
from types import TracebackType
from typing import Any
from urllib.parse import unquote, urldefrag, urlparse

OPTIONS = ("--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
           "--disable-dev-shm-usage", "--remote-debugging-pipe")  # fmt: skip
WIDTHS = (360, 800, 1400)
PATIENCE_S = 60.0
OPEN = "document.querySelectorAll('details').forEach(one => one.open = true)"
IMAGES = "Promise.all([...document.images].map(one => one.decode().then(() => '', () => one.currentSrc))).then(all => all.filter(one => one))"
LINKS = "[...document.querySelectorAll('a[href]')].map(one => one.href)"
WIDER = "document.documentElement.scrollWidth > window.innerWidth ? document.documentElement.scrollWidth : 0"
# Texts of less than 4.5 times the contrast of their ground (WCAG 2.1, 1.4.3), without transparency.
PALE = """(() => {
  const numbers = colour => colour.match(/[\\d.]+/g).map(Number);
  const light = ([r, g, b]) => [r, g, b].map(c => c / 255).map(c => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
    .reduce((sum, c, k) => sum + c * [0.2126, 0.7152, 0.0722][k], 0);
  const ground = one => { for (; one; one = one.parentElement) { const found = numbers(getComputedStyle(one).backgroundColor); if (found[3] !== 0) return found; } return [255, 255, 255]; };
  const pale = [...document.querySelectorAll('body *')].filter(one => [...one.childNodes].some(node => node.nodeType === 3 && node.data.trim())).filter(one => {
    const [a, b] = [light(numbers(getComputedStyle(one).color)), light(ground(one))].sort((x, y) => y - x);
    return (a + 0.05) / (b + 0.05) < 4.5; });
  return [...new Set(pale.map(one => one.tagName + '.' + one.className))]; })()"""


class Browser:
    """A browser with one page; `with` ends it."""

    def __init__(self, profile: Path) -> None:
        """Start it with a profile of its own. A message is JSON ended by a zero byte, to its descriptor 3 and from its descriptor 4."""
        (theirs_in, self.into), (self.out, theirs_out) = os.pipe(), os.pipe()
        given = [fcntl.fcntl(one, fcntl.F_DUPFD, 10) for one in (theirs_in, theirs_out)]
        command = ["bash", "-c", f'exec "$@" 3<&{given[0]} 4>&{given[1]}', "bash", "/usr/bin/chromium", *OPTIONS, f"--user-data-dir={profile}"]
        self.process = subprocess.Popen(command, pass_fds=given, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for one in (theirs_in, theirs_out, *given):
            os.close(one)
        self.rest, self.count, self.events = b"", 0, list[dict[str, Any]]()
        self.session: dict[str, str] = {}
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = {"sessionId": self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]}
        for domain in ("Page", "Runtime", "Log"):
            self.ask(f"{domain}.enable")

    def __enter__(self) -> "Browser":
        """The browser itself."""
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        """End the browser."""
        self.process.terminate()
        self.process.wait(PATIENCE_S)
        os.close(self.into)
        os.close(self.out)

    def _message(self) -> dict[str, Any]:
        """The next message; raises TimeoutError."""
        until = time.monotonic() + PATIENCE_S
        while b"\0" not in self.rest:
            if not select.select([self.out], [], [], until - time.monotonic())[0] or not (read := os.read(self.out, 1 << 20)):
                raise TimeoutError("Chromium says nothing: is it there (ci/setup --test)?")
            self.rest += read
        head, _, self.rest = self.rest.partition(b"\0")
        return json.loads(head)

    def ask(self, method: str, **parameters: Any) -> dict[str, Any]:
        """A command's answer; what is told meanwhile is kept in `events`."""
        self.count += 1
        os.write(self.into, json.dumps({"id": self.count, "method": method, "params": parameters, **self.session}).encode() + b"\0")
        while (message := self._message()).get("id") != self.count:
            self.events.append(message)
        if "error" in message:
            raise RuntimeError(f"{method}: {message['error']}")
        return message["result"]

    def value(self, script: str) -> Any:
        """What an expression comes to in the page, promises waited for."""
        return self.ask("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)["result"].get("value")

    def show(self, page: Path) -> None:
        """Load a file and wait until all of it is there."""
        self.events.clear()
        self.ask("Page.navigate", url=page.as_uri())
        while all(event.get("method") != "Page.loadEventFired" for event in self.events):
            self.events.append(self._message())

    def said(self) -> list[str]:
        """Errors and warnings since the page was shown."""
        bad = ("error", "warning", "assert")
        told = [(event["method"], event["params"]) for event in self.events if "method" in event]
        return [*(f"console: {found['args']}" for name, found in told if name == "Runtime.consoleAPICalled" and found["type"] in bad),
                *(f"log: {found['entry']['text']}" for name, found in told if name == "Log.entryAdded" and found["entry"]["level"] in bad),
                *(f"exception: {found['exceptionDetails']}" for name, found in told if name == "Runtime.exceptionThrown")]  # fmt: skip


def leads_nowhere(browser: Browser) -> list[str]:
    """Links of the shown page to files or places in files that are not there; links elsewhere than to files count."""
    found = []
    for link in dict.fromkeys(browser.value(LINKS)):
        address, anchor = urldefrag(link)
        file = Path(unquote(urlparse(address).path))
        there = urlparse(address).scheme == "file" and file.is_file()
        if not there or (anchor and f'id="{anchor}"' not in file.read_text(encoding="utf-8")):
            found.append(f"link to nothing: {link}")
    return found


def faults(browser: Browser, page: Path) -> list[str]:
    """All that is wrong with a page: what it says on the console, images and links to nothing, what is wider than the window, texts too pale in light or in
    dark, a print of no page."""
    browser.ask("Emulation.setEmulatedMedia", media="screen", features=[])
    browser.show(page)
    found = [f"no image: {one}" for one in browser.value(IMAGES)] + leads_nowhere(browser)
    for width in WIDTHS:
        browser.ask("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=False)
        browser.value(OPEN)
        if wide := browser.value(WIDER):
            found.append(f"{wide} wide in a window of {width}")
        found += [f"no image at {width}: {one}" for one in browser.value(IMAGES)]
    grounds = set()
    for scheme in ("light", "dark"):
        browser.ask("Emulation.setEmulatedMedia", media="screen", features=[{"name": "prefers-color-scheme", "value": scheme}])
        grounds.add(browser.value("getComputedStyle(document.documentElement).backgroundColor"))
        found += [f"too pale in {scheme}: {one}" for one in browser.value(PALE)]
    found += ["the same ground in light and dark"] if len(grounds) < 2 else []
    printed = base64.b64decode(browser.ask("Page.printToPDF", printBackground=True)["data"])
    found += [] if printed.startswith(b"%PDF") and len(printed) > 1000 else ["no print"]
    return found + browser.said()
