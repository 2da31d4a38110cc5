"""Chromium without a window, and what is wrong with a page in it."""

import base64
from pathlib import Path
from urllib.parse import unquote, urldefrag, urlparse

from selenium.webdriver import Chrome, ChromeOptions
from selenium.webdriver.chrome.service import Service

OPTIONS = ("--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
           "--disable-dev-shm-usage")  # fmt: skip
KINDS = {"console-api": "console", "javascript": "exception"}  # of what a page says, by where it comes from
WIDTHS = (360, 800, 1400)
OPEN = "return document.querySelectorAll('details').forEach(one => one.open = true)"
IMAGES = "return Promise.all([...document.images].map(one => one.decode().then(() => '', () => one.currentSrc))).then(all => all.filter(one => one))"
LINKS = "return [...document.querySelectorAll('a[href]')].map(one => one.href)"
WIDER = "return document.documentElement.scrollWidth > window.innerWidth ? document.documentElement.scrollWidth : 0"
PALE = Path(__file__).with_name("pale.js").read_text(encoding="utf-8")


def started(profile: Path) -> Chrome:
    """A browser with a profile of its own; `with` ends it."""
    options = ChromeOptions()
    for option in (*OPTIONS, f"--user-data-dir={profile}"):
        options.add_argument(option)
    options.set_capability("goog:loggingPrefs", {"browser": "WARNING"})
    return Chrome(service=Service("/usr/bin/chromedriver"), options=options)


def leads_nowhere(browser: Chrome) -> list[str]:
    """Links of the shown page to files or places in files that are not there; links elsewhere than to files count."""
    found = []
    for link in dict.fromkeys(browser.execute_script(LINKS)):
        address, anchor = urldefrag(link)
        file = Path(unquote(urlparse(address).path))
        there = urlparse(address).scheme == "file" and file.is_file()
        if not there or (anchor and f'id="{anchor}"' not in file.read_text(encoding="utf-8")):
            found.append(f"link to nothing: {link}")
    return found


def faults(browser: Chrome, page: Path) -> list[str]:
    """All that is wrong with a page: what it says on the console, images and links to nothing, what is wider than the window, texts too pale in light or in
    dark, a print of no page."""
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "screen", "features": []})
    browser.get_log("browser")  # what another page has said
    browser.get(page.as_uri())
    found = [f"no image: {one}" for one in browser.execute_script(IMAGES)] + leads_nowhere(browser)
    for width in WIDTHS:
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
        browser.execute_script(OPEN)
        if wide := browser.execute_script(WIDER):
            found.append(f"{wide} wide in a window of {width}")
        found += [f"no image at {width}: {one}" for one in browser.execute_script(IMAGES)]
    grounds = set()
    for scheme in ("light", "dark"):
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "screen", "features": [{"name": "prefers-color-scheme", "value": scheme}]})
        grounds.add(browser.execute_script("return getComputedStyle(document.documentElement).backgroundColor"))
        found += [f"too pale in {scheme}: {one}" for one in browser.execute_script(PALE)]
    found += ["the same ground in light and dark"] if len(grounds) < 2 else []
    printed = base64.b64decode(browser.execute_cdp_cmd("Page.printToPDF", {"printBackground": True})["data"])
    found += [] if printed.startswith(b"%PDF") and len(printed) > 1000 else ["no print"]
    return found + [f"{KINDS.get(said['source'], 'log')}: {said['message']}" for said in browser.get_log("browser")]
