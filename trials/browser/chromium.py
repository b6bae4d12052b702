"""Chromium without a window, spoken to through two pipes in its own DevTools protocol."""

from __future__ import annotations

import json
import os
import select
import shutil
import subprocess
import tempfile
import time
from base64 import b64decode
from typing import Any

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


def find() -> str | None:
    return os.environ.get("CHROMIUM") or next((path for name in NAMES if (path := shutil.which(name))), None)


class Page:
    """One page. Use as a context; `events` are all that the browser told meanwhile."""

    def __init__(self, program: str, seconds: float = 60.0) -> None:
        self.seconds = seconds
        self.events: list[dict[str, Any]] = []
        self._buffer, self._number, self._session, self._target = b"", 0, None, ""
        self._profile = tempfile.mkdtemp(prefix="chromium-")
        to_browser, self._out = os.pipe()
        self._in, from_browser = os.pipe()
        # Away from 3 and 4, where the browser expects its ends.
        ends = [os.dup2(end, 60 + place) for place, end in enumerate((to_browser, from_browser))]
        self._process = subprocess.Popen(
            [
                program, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                "--hide-scrollbars", "--no-first-run", "--disable-background-networking",
                f"--user-data-dir={self._profile}",
                "--remote-debugging-pipe", "about:blank",
            ],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, pass_fds=(3, 4),
            preexec_fn=lambda: [os.dup2(end, place) for place, end in zip((3, 4), ends)],
        )  # fmt: skip
        for end in (to_browser, from_browser, *ends):
            os.close(end)

    def __enter__(self) -> Page:
        pages = [t for t in self.call("Target.getTargets")["targetInfos"] if t["type"] == "page"]
        self._attach(pages[0]["targetId"])
        return self

    def anew(self) -> Page:
        """An empty page in place of this one: cheaper than another browser."""
        self._session, old = None, self._target
        new = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.call("Target.closeTarget", targetId=old)
        self.events.clear()
        self._attach(new)
        return self

    def _attach(self, target: str) -> None:
        self._target = target
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.call("Emulation.setFocusEmulationEnabled", enabled=True)
        nothing = {"latency": 0, "downloadThroughput": 0, "uploadThroughput": 0}
        self.call("Network.emulateNetworkConditions", offline=True, **nothing)

    def __exit__(self, *error: object) -> None:
        self._process.terminate()
        try:
            self._process.wait(20)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._in)
        os.close(self._out)
        shutil.rmtree(self._profile, ignore_errors=True)

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Answer of the browser; events that come before it are kept."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._out, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._read()
            if answer.get("id") == self._number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self.events.append(answer)

    def open(self, address: str, width: int, height: int = 900) -> None:
        self.resize(width, height)
        self.load("Page.navigate", url=address)

    def resize(self, width: int, height: int = 900) -> None:
        size = {"width": width, "height": height}
        self.call("Emulation.setDeviceMetricsOverride", deviceScaleFactor=1, mobile=width < 600, **size)

    def load(self, method: str, **parameters: Any) -> None:
        """What loads a page, done whole: until then the one before answers."""
        before = len(self.events)
        self.call(method, **parameters)
        while not any(event.get("method") == "Page.loadEventFired" for event in self.events[before:]):
            self.events.append(self._read())

    def picture(self, **part: Any) -> bytes:
        """PNG of the whole page, or of a part."""
        shot = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=True, **part)
        return b64decode(shot["data"])

    def decode_images(self) -> None:
        """Wait until all are there, or known to be broken."""
        self.evaluate("Promise.all([...document.images].map(image => image.decode().catch(() => null)))")

    def press(self, key: str, code: int) -> None:
        """A key down and up, where the focus is."""
        typed = {"text": "\r"} if key == "Enter" else {}
        for kind in ("keyDown", "keyUp"):
            pressed = {"type": kind, "key": key, "code": key, "windowsVirtualKeyCode": code}
            self.call("Input.dispatchKeyEvent", **pressed, **typed)

    def evaluate(self, script: str) -> Any:
        """Value of a JavaScript expression, which may be a promise."""
        answer = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(str(answer["exceptionDetails"]))
        return answer["result"].get("value")

    def _read(self) -> dict[str, Any]:
        until = time.monotonic() + self.seconds
        while b"\0" not in self._buffer:
            if not select.select([self._in], [], [], max(0.0, until - time.monotonic()))[0]:
                raise TimeoutError(f"Chromium said nothing for {self.seconds:g} s")
            more = os.read(self._in, 1 << 20)
            if not more:
                raise RuntimeError("Chromium ended")
            self._buffer += more
        whole, _, self._buffer = self._buffer.partition(b"\0")
        return json.loads(whole)
