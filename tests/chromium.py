"""A headless Chromium driven over its DevTools protocol: opens a page, runs scripts, clicks, takes pictures.

``websockets`` comes with viser. Nothing may leave the machine: every request that is no file, data or blob is
kept in :attr:`Tab.requests` for the test to judge.
"""

import base64
import contextlib
import io
import itertools
import json
import shutil
import subprocess
import time
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image
from websockets.sync.client import ClientConnection, connect

SIZE = (1100, 700)
BINARY = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")

_ARGUMENTS = (
    "--headless=new", "--no-sandbox", "--no-first-run", "--disable-quic", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
    "--remote-debugging-port=0", f"--window-size={SIZE[0]},{SIZE[1]}",
)  # fmt: skip

needs_chromium = pytest.mark.skipif(BINARY is None, reason="no Chromium on PATH to open the page in")


class Tab:
    """One page of the browser.

    Attributes:
        requests: addresses asked for that are no files, data or blobs.
        errors: exceptions of the page's scripts.
    """

    def __init__(self, channel: ClientConnection) -> None:
        self._channel, self._numbers = channel, itertools.count(1)
        self.requests: list[str] = []
        self.errors: list[str] = []
        for domain in ("Network", "Page", "Runtime"):
            self._call(f"{domain}.enable")
        self._call(
            "Emulation.setDeviceMetricsOverride",
            width=SIZE[0], height=SIZE[1], deviceScaleFactor=1, mobile=False,
        )  # fmt: skip

    def open(self, page: Path) -> None:
        """Load a file and wait for it."""
        self._call("Page.navigate", url=page.resolve().as_uri())
        self.wait("document.readyState === 'complete'")

    def value(self, script: str) -> Any:
        """The value of an expression on the page."""
        answer = self._call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def wait(self, script: str, seconds: float = 120.0) -> None:
        """Wait until an expression is true."""
        limit = time.monotonic() + seconds
        while not self.value(script):
            assert time.monotonic() < limit, f"{script}: not true in {seconds} s"
            time.sleep(0.1)

    def click(self, x: float, y: float) -> None:
        """Press and release the left button."""
        for kind in ("mousePressed", "mouseReleased"):
            self._call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def picture(self) -> NDArray[np.uint8]:
        """What is seen (H, W, 3)."""
        data = base64.b64decode(self._call("Page.captureScreenshot", format="png")["data"])
        return np.asarray(Image.open(io.BytesIO(data)).convert("RGB"))

    def _call(self, method: str, **parameters: Any) -> dict[str, Any]:
        number = next(self._numbers)
        self._channel.send(json.dumps({"id": number, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self._channel.recv(timeout=120))
            if answer.get("id") == number:
                assert "error" not in answer, answer["error"]
                return dict(answer["result"])
            self._note(answer)

    def _note(self, event: dict[str, Any]) -> None:
        if event["method"] == "Network.requestWillBeSent":
            address = event["params"]["request"]["url"]
            if not address.startswith(("file:", "data:", "blob:")):
                self.requests.append(address)
        elif event["method"] == "Runtime.exceptionThrown":
            self.errors.append(str(event["params"]["exceptionDetails"]))


@contextlib.contextmanager
def tab(folder: Path) -> Iterator[Tab]:
    """Start a Chromium with its profile in ``folder``, and end it."""
    assert BINARY is not None
    process = subprocess.Popen(
        [BINARY, *_ARGUMENTS, f"--user-data-dir={folder}", "about:blank"],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    try:
        note, limit = folder / "DevToolsActivePort", time.monotonic() + 60
        while not (note.exists() and note.read_text().strip()):
            assert process.poll() is None, "Chromium ended at once"
            assert time.monotonic() < limit, "Chromium opened no port in 60 s"
            time.sleep(0.05)
        port = note.read_text().split()[0]
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/json", timeout=60) as answer:
            targets = json.load(answer)
        address = next(target["webSocketDebuggerUrl"] for target in targets if target["type"] == "page")
        with connect(address, max_size=None) as channel:
            yield Tab(channel)
    finally:
        process.terminate()
        process.wait(30)
