"""A small Debian in which programs run without Python, without a network and without this machine's files.

It has a display of this machine, on which its programs open windows; who tries them presses keys and looks at pixels.
"""

from __future__ import annotations

import os
import shlex
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

PATIENCE = 600.0
"""Seconds after which what never came true fails: to start the editor takes a few, and minutes on a busy machine."""

SHAPE = 1366, 768
"""Pixels of the display: that of a laptop."""

HOME = "/home"
"""The home folder of the user there."""

Answer = TypeVar("Answer")
Array = np.ndarray[Any, Any]


class SmallSystem:
    """A small Debian with a home folder, in which programs run without a network and without this machine's files."""

    def __init__(self, root: Path, home: Path, release: Path) -> None:
        self._root, self.home, self._release = root, home, release
        home.mkdir(parents=True, exist_ok=True)

    def list_words(self, *words: str, display: str = "") -> list[str]:
        """The command that runs `words` in the system. The home folder is the only one that can be written."""
        command = ["bwrap", "--ro-bind", str(self._root), "/", "--proc", "/proc", "--dev", "/dev", "--tmpfs", "/tmp"]
        command += ["--tmpfs", "/run", "--bind", str(self.home), HOME, "--ro-bind", str(self._release), "/media"]
        command += ["--unshare-user", "--uid", "1000", "--gid", "1000"]
        command += ["--unshare-net", "--unshare-pid", "--unshare-ipc", "--die-with-parent", "--clearenv"]
        command += ["--chdir", HOME, "--setenv", "HOME", HOME, "--setenv", "PATH", f"{HOME}:/usr/bin:/bin"]
        command += ["--setenv", "LANG", "C.UTF-8"]
        if display:
            command += ["--ro-bind", "/tmp/.X11-unix", "/tmp/.X11-unix", "--setenv", "DISPLAY", display]
        return [*command, *words]

    def run(self, *words: str, display: str = "") -> str:
        """What a program prints there. Raises AssertionError with its last lines where it fails."""
        ended = subprocess.run(self.list_words(*words, display=display), capture_output=True, text=True)
        assert ended.returncode == 0, f"{shlex.join(words)}: {(ended.stderr or ended.stdout)[-600:].strip()}"
        return ended.stdout

    @contextmanager
    def start(self, *words: str, display: str) -> Iterator[subprocess.Popen[bytes]]:
        """Run a program there meanwhile."""
        process = subprocess.Popen(self.list_words(*words, display=display), stdin=subprocess.DEVNULL)
        try:
            yield process
        finally:
            process.terminate()
            process.wait(30)


class Screen:
    """A display with a window manager on this machine, which programs in the system draw on."""

    def __init__(self, folder: Path, stack: ExitStack) -> None:
        self._folder = folder
        reader, writer = os.pipe()
        size = f"{SHAPE[0]}x{SHAPE[1]}x24"
        words = ["Xvfb", "-displayfd", str(writer), "-screen", "0", size, "-fbdir", str(folder), "-noreset"]
        stack.enter_context(_run_meanwhile(words, pass_fds=(writer,)))
        os.close(writer)
        with os.fdopen(reader) as lines:
            self.name = f":{lines.readline().strip()}"
        stack.enter_context(_run_meanwhile(["openbox"], env={**os.environ, "DISPLAY": self.name}))

    def press(self, *words: str) -> None:
        """Do something with keyboard or mouse, in the words of xdotool."""
        subprocess.run(["xdotool", *words], env={**os.environ, "DISPLAY": self.name}, check=True, timeout=PATIENCE)

    def wait_for_window(self, title: str) -> str:
        """The number of the first window whose title matches, as soon as it is there."""
        words = ["xdotool", "search", "--onlyvisible", "--name", title]
        environment = {**os.environ, "DISPLAY": self.name}

        def find_windows() -> list[str]:
            return subprocess.run(words, env=environment, capture_output=True, text=True).stdout.split()

        return wait_until(find_windows, f"no window '{title}' appeared")[0]

    def wait_for_no_window(self, window: str) -> None:
        """Return as soon as a window has been closed."""
        words = ["xdotool", "getwindowname", window]
        environment = {**os.environ, "DISPLAY": self.name}

        def is_closed() -> bool:
            return subprocess.run(words, env=environment, capture_output=True).returncode != 0

        wait_until(is_closed, "the window was never closed")

    def read_pixels(self) -> Array:
        """What the display shows: height x width x 3, of 8 bits."""
        return read_xwd((self._folder / "Xvfb_screen0").read_bytes())

    def wait_for_picture(self, least_colors: int) -> Array:
        """What the display shows as soon as it has so many colors and stands still for a second."""
        last: list[Array] = [np.zeros((1, 1, 3), np.uint8)]

        def is_still() -> bool:
            time.sleep(1.0)
            pixels, before = self.read_pixels(), last[0]
            last[0] = pixels
            return np.array_equal(pixels, before) and count_colors(pixels) >= least_colors

        wait_until(is_still, f"the display never showed {least_colors} colors")
        return last[0]


def read_xwd(content: bytes) -> Array:
    """The pixels of a picture of the X window system (XWDFile.h): height x width x 3, of 8 bits.

    The head are 32-bit numbers, the first one its length; then follow 12 bytes for each color of a palette.
    """
    head = np.frombuffer(content, ">u4", 25)
    width, height, order, row, colors = (int(head[at]) for at in (4, 5, 7, 12, 19))
    assert order == 0 and int(head[11]) == 32, "only pixels of 32 bits, the low byte first, are read"
    pixels = np.frombuffer(content, np.uint8, row * height, int(head[0]) + 12 * colors)
    return pixels.reshape(height, row // 4, 4)[:, :width, 2::-1]


def count_colors(pixels: Array) -> int:
    """How many different colors a picture has."""
    return len(np.unique(pixels.reshape(-1, 3).astype(np.uint32) @ np.array([65536, 256, 1], np.uint32)))


def wait_until(ask: Callable[[], Answer], complaint: str) -> Answer:
    """The first answer that is true. Raises AssertionError after a while."""
    end = time.monotonic() + PATIENCE
    while not (answer := ask()):
        assert time.monotonic() < end, complaint
        time.sleep(0.2)
    return answer


@contextmanager
def _run_meanwhile(words: list[str], **options: Any) -> Iterator[None]:
    process = subprocess.Popen(words, stderr=subprocess.DEVNULL, **options)
    try:
        yield
    finally:
        process.terminate()
        process.wait(30)
