"""What a user does on the page of `serve`."""

from __future__ import annotations

import time
from pathlib import Path

from browser.chromium import Page
from browser.use import set_scheme

SECONDS = 900.0  # of a machine with other work


def until(page: Page, condition: str) -> None:
    """Wait for a JavaScript expression to hold."""
    end = time.monotonic() + SECONDS
    while not page.evaluate(condition):
        assert time.monotonic() < end, (
            f"never: {condition}; {page.evaluate('document.body.innerText')[:1500]}"
        )
        time.sleep(0.3)


def drop(page: Page, *paths: Path, field: str = "#files") -> None:
    """Choose files, as a drop does."""
    page.call("DOM.enable")
    root = page.call("DOM.getDocument")["root"]["nodeId"]
    node = page.call("DOM.querySelector", nodeId=root, selector=field)["nodeId"]
    page.call("DOM.setFileInputFiles", nodeId=node, files=[str(path) for path in paths])


def sized(page: Page, width: int, dark: bool) -> None:
    """A window of this width, in the light or in the dark."""
    page.resize(width)
    set_scheme(page, "dark" if dark else "light")


def connect(page: Page) -> None:
    """Let it ask the server: pages of a report are looked at without a network."""
    whole = {"latency": 0, "downloadThroughput": -1, "uploadThroughput": -1}
    page.call("Network.emulateNetworkConditions", offline=False, **whole)
