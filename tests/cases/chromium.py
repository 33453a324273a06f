"""Debian's chromium, driven through a pipe with the DevTools protocol: no further library, no network port."""

from __future__ import annotations

import base64
import contextlib
import json
import os
import select
import subprocess
import sys
import tempfile
import time
from pathlib import Path

#: Seconds after which a browser that does not answer counts as hung.
_PATIENCE = 60.0
#: What a browser answers whose page goes on to its next address, as a window's does that has used its key.
_REPLACED = "Inspected target navigated or closed"
#: The protocol's file descriptors are 3 and 4: puts the two pipes there and becomes the browser.
_LAUNCH = """
import fcntl, os, sys
pipes = [fcntl.fcntl(int(number), fcntl.F_DUPFD, 10) for number in sys.argv[1:3]]
for place, pipe in zip((3, 4), pipes):
    os.dup2(pipe, place)
    os.close(pipe)
os.execv(sys.argv[3], sys.argv[3:])
"""


class Browser:
    """One headless browser with one page; close it, or use it as a context.

    Parameters
    ----------
    program : str
        Path of chromium.
    width, height : int
        Of the window.

    Attributes
    ----------
    requests : list of str
        Addresses of everything that the page has asked the network or the disk for.
    complaints : list of str
        Errors and warnings on the page's console, and uncaught exceptions.
    downloads : Path
        Folder where downloads arrive.
    """

    def __init__(self, program: str, width: int = 1300, height: int = 900):
        self._folder = tempfile.TemporaryDirectory(prefix="fegear-browser-", ignore_cleanup_errors=True)
        self.downloads = Path(self._folder.name) / "downloads"
        self.downloads.mkdir()
        self.requests, self.complaints, self._events, self._next, self._rest = [], [], [], 0, b""
        to_read, self._write = os.pipe()
        self._read, to_write = os.pipe()
        command = [
            sys.executable, "-c", _LAUNCH, str(to_read), str(to_write), program, "--headless=new", "--no-sandbox",
            "--disable-gpu", "--remote-debugging-pipe", "--no-first-run", "--disable-extensions", "--disable-sync",
            "--disable-background-networking", "--disable-component-update", "--disable-dev-shm-usage",
            f"--user-data-dir={self._folder.name}/profile", f"--window-size={width},{height}", "about:blank",
        ]  # fmt: skip
        self._process = subprocess.Popen(
            command, pass_fds=(to_read, to_write), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            env=os.environ | {"HOME": self._folder.name}, start_new_session=True,
        )  # fmt: skip
        os.close(to_read)
        os.close(to_write)
        try:
            self._session = None
            pages = [t for t in self("Target.getTargets")["targetInfos"] if t["type"] == "page"]
            found = self("Target.attachToTarget", targetId=pages[0]["targetId"], flatten=True)
            self._session = found["sessionId"]
            for domain in ("Page", "Runtime", "Network", "Log"):
                self(f"{domain}.enable")
            self("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(self.downloads), eventsEnabled=True)
            self.size(width, height)
        except BaseException:
            self.close()
            raise

    @property
    def pid(self) -> int:
        """Of the browser's first process."""
        return self._process.pid

    def __enter__(self) -> Browser:
        return self

    def __exit__(self, *_exception: object) -> None:
        self.close()

    def close(self) -> None:
        """End the browser and remove what it left."""
        with contextlib.suppress(OSError):
            os.close(self._write)
        try:
            self._process.wait(20)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        with contextlib.suppress(OSError):
            os.close(self._read)
        self._folder.cleanup()

    # ---- the protocol ------------------------------------------------------------------------------------------------
    def __call__(self, method: str, **parameters: object) -> dict:
        """Call a method of the protocol and return its result."""
        self._next += 1
        message = {"id": self._next, "method": method, "params": parameters}
        if self._session and not method.startswith(("Target.", "Browser.")):
            message["sessionId"] = self._session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self._write, data) :]
        end = time.monotonic() + _PATIENCE
        while True:
            answer = self._message(end)
            if answer.get("id") == self._next:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]

    def _message(self, end: float) -> dict:
        while b"\0" not in self._rest:
            if not select.select([self._read], [], [], max(0.0, end - time.monotonic()))[0]:
                raise TimeoutError("the browser does not answer")
            data = os.read(self._read, 1 << 20)
            if not data:
                raise RuntimeError("the browser has ended")
            self._rest += data
        one, self._rest = self._rest.split(b"\0", 1)
        message = json.loads(one)
        self._note(message.get("method", ""), message.get("params", {}))
        return message

    def _note(self, method: str, told: dict) -> None:
        if method == "Network.requestWillBeSent":
            self.requests.append(told["request"]["url"])
        elif method == "Runtime.exceptionThrown":
            details = told["exceptionDetails"]
            self.complaints.append(details.get("exception", {}).get("description", details["text"]))
        elif method == "Runtime.consoleAPICalled" and told["type"] in ("error", "warning", "assert"):
            self.complaints.append(" ".join(str(a.get("value", a.get("description"))) for a in told["args"]))
        elif method == "Log.entryAdded" and told["entry"]["level"] in ("error", "warning"):
            self.complaints.append(told["entry"]["text"])
        elif method == "Browser.downloadProgress" and told["state"] == "completed":
            self._events.append(method)

    # ---- what a reader does ------------------------------------------------------------------------------------------
    def run(self, script: str) -> object:
        """Evaluate JavaScript (promises are awaited) and return its value."""
        answer = self("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(answer["exceptionDetails"].get("exception", {}).get("description", "script failed"))
        return answer["result"].get("value")

    def until(self, script: str, patience: float = _PATIENCE) -> None:
        """Wait until a condition holds; of a page that another one takes the place of meanwhile it is asked again."""
        end = time.monotonic() + patience
        while not self._holds(script):
            if time.monotonic() > end:
                raise TimeoutError(f"waited in vain for {script}")
            time.sleep(0.05)

    def _holds(self, script: str) -> object:
        try:
            return self.run(script)
        except RuntimeError as problem:
            if _REPLACED in str(problem):
                return False
            raise

    def open(self, path: Path) -> None:
        """Open a file and wait until the page says that its plots are drawn."""
        self("Page.navigate", url="about:blank")  # else the browser scrolls to where it was on the same page
        self("Page.navigate", url=path.absolute().as_uri())
        self.until("document.readyState === 'complete' && document.documentElement.dataset.ready !== undefined")

    def size(self, width: int, height: int) -> None:
        """Give the window a size."""
        self("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def media(self, **features: str) -> None:
        """Set media features, ``prefers_color_scheme="dark"`` for one."""
        told = [{"name": name.replace("_", "-"), "value": value} for name, value in features.items()]
        self("Emulation.setEmulatedMedia", features=told)

    def click(self, script: str) -> None:
        """Click in the middle of the element that a script finds, with the mouse."""
        self.run(f"({script}).scrollIntoView({{block: 'center', behavior: 'instant'}})")
        self.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
        where = self.run(f"(() => {{ const b = ({script}).getBoundingClientRect();"
                         "return [b.x + b.width / 2, b.y + b.height / 2]; })()")  # fmt: skip
        for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
            self("Input.dispatchMouseEvent", type=kind, x=where[0], y=where[1], button="left", clickCount=1)

    def click_until(self, script: str, condition: str) -> None:
        """Click, and again where a bar that was laid out anew meanwhile was missed, until a condition holds."""
        for patience in (0.2 * _PATIENCE, 0.4 * _PATIENCE, _PATIENCE):
            self.click(script)
            try:
                self.until(condition, patience)
            except TimeoutError:
                if patience == _PATIENCE:
                    raise
            else:
                return

    def downloaded(self, name: str) -> bytes:
        """Wait for a download and return what arrived."""
        end = time.monotonic() + _PATIENCE
        path = self.downloads / name
        while not path.is_file():
            if time.monotonic() > end:
                raise TimeoutError(f"no download {name} arrived")
            self.run("0")
            time.sleep(0.05)
        return path.read_bytes()

    def picture(self, path: Path, *, whole: bool = True) -> None:
        """Save a screenshot of the window or of the whole page."""
        answer = self("Page.captureScreenshot", captureBeyondViewport=whole, **(
            {"clip": self._whole()} if whole else {}))  # fmt: skip
        path.write_bytes(base64.b64decode(answer["data"]))

    def _whole(self) -> dict:
        size = self("Page.getLayoutMetrics")["cssContentSize"]
        return {"x": 0, "y": 0, "width": size["width"], "height": size["height"], "scale": 1}
