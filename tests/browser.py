"""A Chromium without a window, for tests of pages: it is spoken to through two pipes, in the DevTools protocol."""

from __future__ import annotations

import base64
import fcntl
import json
import os
import shutil
import subprocess
import tempfile
from pathlib import Path
from types import TracebackType
from typing import Any, Self

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
WORDS = (
    "--headless=new",
    "--no-sandbox",
    "--remote-debugging-pipe",
    "--no-first-run",
    "--disable-dev-shm-usage",
    "--disk-cache-size=1",
    "--use-fake-device-for-media-stream",
    "--use-fake-ui-for-media-stream",
)
"""The camera is a moving picture of Chromium."""
DRIVERS = {
    "swiftshader": ("--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
    "mesa": ("--use-angle=gl-egl", "--ignore-gpu-blocklist", "--ozone-platform=headless"),
}
"""Who draws in the processor: SwiftShader, the same everywhere, or Mesa's llvmpipe in a twentieth of the time."""

_ABOVE = 10
"""Ends of pipes are copied to numbers from here on, so that none of them is 3 or 4 already."""


class Browser:
    """A browser with one page. What the page prints to its console, faults included, is in `messages`."""

    def __init__(self, width: int = 1280, height: int = 800, driver: str = "swiftshader") -> None:
        assert CHROMIUM is not None
        self.messages: list[str] = []
        self._profile = tempfile.TemporaryDirectory(prefix="browser-", ignore_cleanup_errors=True)
        (read_end, self._commands), (answers, write_end) = os.pipe(), os.pipe()
        ends = [fcntl.fcntl(end, fcntl.F_DUPFD, _ABOVE) for end in (read_end, write_end)]
        words = [
            CHROMIUM,
            *WORDS,
            *DRIVERS[driver],
            f"--user-data-dir={self._profile.name}",
            f"--window-size={width},{height}",
        ]
        # The browser reads its file 3 and writes its file 4.
        shell = ["bash", "-c", 'exec "$@" 3<&{} 4>&{} 2>/dev/null'.format(*ends), "bash", *words, "about:blank"]
        self._process = subprocess.Popen(shell, pass_fds=ends, start_new_session=True)
        for end in (read_end, write_end, *ends):
            os.close(end)
        self._answers = os.fdopen(answers, "rb")
        self._number, self._rest, self._is_loaded = 0, b"", False
        targets = self._call("Target.getTargets")["targetInfos"]
        page = next(target["targetId"] for target in targets if target["type"] == "page")
        self._session = ""
        self._session = self._call("Target.attachToTarget", targetId=page, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self._call(f"{domain}.enable")
        self._call("Emulation.setFocusEmulationEnabled", enabled=True)  # or a page hears nothing of what is focused

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, fault: BaseException | None, at: TracebackType | None) -> None:
        os.close(self._commands)  # it ends where nobody speaks to it any more
        try:
            self._process.wait(20)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._answers.close()
        self._profile.cleanup()

    def open(self, page: Path | str) -> None:
        """Load a page, from a file or an address, with all that it names."""
        self.messages.clear()
        self._is_loaded = False
        self._call("Page.navigate", url=page.resolve().as_uri() if isinstance(page, Path) else page)
        while not self._is_loaded:
            self._note(self._read())

    def prepare(self, code: str) -> None:
        """Run JavaScript in each page that is opened from now on, before its own."""
        self._call("Page.addScriptToEvaluateOnNewDocument", source=f"{{ {code} }}")

    def run(self, code: str) -> Any:
        """The value of JavaScript in the page; a promise is awaited."""
        answer = self._call("Runtime.evaluate", expression=code, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def wait_until(self, condition: str) -> None:
        """Return as soon as the condition holds in the page."""
        look = f"const look = () => ({condition}) ? done() : setTimeout(look, 20); look();"
        self.run(f"new Promise(done => {{ {look} }})")

    def show_at(self, width: int, height: int, is_phone: bool = False) -> None:
        """Give the page a window of this size."""
        scale = 2 if is_phone else 1
        self._call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=scale,
                   mobile=is_phone)  # fmt: skip

    def prefer_scheme(self, scheme: str) -> None:
        """Open pages as for a user who likes the `light` or the `dark` scheme better."""
        self._call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])

    def take_picture(self, path: Path) -> None:
        """Write what the window shows as PNG."""
        path.write_bytes(base64.b64decode(self._call("Page.captureScreenshot")["data"]))

    def choose_file(self, selector: str, path: Path) -> None:
        """Choose a file in an input of the page."""
        root = self._call("DOM.getDocument")["root"]["nodeId"]
        node = self._call("DOM.querySelector", nodeId=root, selector=selector)["nodeId"]
        self._call("DOM.setFileInputFiles", nodeId=node, files=[str(path.resolve())])

    def _call(self, method: str, **arguments: Any) -> dict[str, Any]:
        self._number += 1
        message: dict[str, Any] = {"id": self._number, "method": method, "params": arguments}
        if method.partition(".")[0] != "Target":
            message["sessionId"] = self._session
        os.write(self._commands, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._read()
            if answer.get("id") == self._number:
                assert "error" not in answer, answer["error"]
                return answer["result"]
            self._note(answer)

    def _read(self) -> dict[str, Any]:
        while b"\0" not in self._rest:
            part = self._answers.read1(1 << 20)
            assert part, "the browser has ended"
            self._rest += part
        message, _, self._rest = self._rest.partition(b"\0")
        return json.loads(message)

    def _note(self, event: dict[str, Any]) -> None:
        content = event.get("params", {})
        if event.get("method") == "Page.loadEventFired":
            self._is_loaded = True
        elif event.get("method") == "Runtime.consoleAPICalled":
            self.messages.append(" ".join(str(part.get("value", part)) for part in content["args"]))
        elif event.get("method") == "Runtime.exceptionThrown":
            self.messages.append(json.dumps(content["exceptionDetails"]))
        elif event.get("method") == "Log.entryAdded":
            self.messages.append(content["entry"]["text"])
