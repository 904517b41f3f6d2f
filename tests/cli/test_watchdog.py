"""Code that never ends, and code that is watched and does."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

HALATION = [sys.executable, "-m", "halation.cli"]
ENDLESS = """vec4 spin(vec4 image) {
    float x = image.r;
    while (true) {
        while (true) { x = fract(x * 1.7 + 0.1); if (x > 5.0) break; }
        x += 0.01; if (x > 7.0) break;
    }
    return vec4(x);
}"""


def graph(folder: Path, code: str) -> Path:
    tree = {
        "halation": 1,
        "settings": {"size": [640, 480]},
        "outputs": {"image": {"type": "Image"}},
        "nodes": {"ramp": {"type": "ramp"}, "user": {"type": "glsl", "code": code.split("\n")}},
        "links": {"user.image": "ramp.out", "outputs.image": "user.out"},
    }
    path = folder / "graph.json"
    path.write_text(json.dumps(tree))
    return path


def render(*words: object, text: str | None = None) -> subprocess.CompletedProcess[str]:
    command = [*HALATION, "render", *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=100, input=text)


def test_code_that_never_ends_is_stopped(tmp_path: Path) -> None:
    out = tmp_path / "out.exr"
    ended = render(graph(tmp_path, ENDLESS), "-o", out, "--timeout", 1, "--json")
    assert ended.returncode == 5 and not out.exists()
    said = json.loads(ended.stdout)["error"]
    assert said["kind"] == "DeviceError"
    assert said["message"].startswith("node 'user': its code has not ended after 1 seconds")


@pytest.mark.parametrize("piped", [False, True])
def test_code_that_ends_is_only_watched(tmp_path: Path, piped: bool) -> None:
    """What the other process says and how it ends is what this one says, also where the graph comes through a pipe."""
    code = "vec4 f(vec4 image, float k /* = 1 */) {\n for (int i = 0; i < 2; ++i) image *= k;\n return image;\n}"
    path, out = graph(tmp_path, code), tmp_path / "o.exr"
    text = path.read_text() if piped else None
    ended = render("-" if piped else path, "-o", out, "--set", "user.k=0.5", "--json", text=text)
    assert ended.returncode == 0 and json.loads(ended.stdout)["written"] == [str(out)] and out.exists()
    wrong = render("-" if piped else path, "-o", tmp_path / "o.nothing", text=text)
    assert wrong.returncode == 2 and "o.nothing" in wrong.stderr and wrong.stderr.count("halation:") == 1


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
def test_an_interrupt_reaches_the_code(tmp_path: Path) -> None:
    """As from a terminal: both processes hear it, and both are gone when the command is."""
    command = [*HALATION, "render", str(graph(tmp_path, ENDLESS)), "-o", str(tmp_path / "out.exr")]
    started = subprocess.Popen(
        [*command, "--timeout", "3"],
        start_new_session=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    time.sleep(2.0)
    os.killpg(started.pid, signal.SIGINT)
    _, said = started.communicate(timeout=60)
    # Where the device hears nothing before its pass is over, the watchdog is the one that ends it.
    assert started.returncode in (130, 5) and "halation: " in said


SLOW = """vec4 spin(vec4 image) {
    float x = image.r;
    for (int i = 0; i < 60000; ++i) for (int j = 0; j < 400; ++j) x = fract(x * 1.7 + 0.1);
    return vec4(x);
}"""


def test_helpers_that_share_frames_are_watched_for_as_long_as_was_asked_for(tmp_path: Path) -> None:
    path, out = graph(tmp_path, SLOW), tmp_path / "out.##.exr"
    words = (path, "-o", out, "--frames", "1-2", "-j", 2, "--size", "16x16")
    stopped = render(*words, "--timeout", "0.01", "--json")
    assert stopped.returncode == 5 and not list(tmp_path.glob("*.exr"))
    error = json.loads(stopped.stdout)["error"]
    assert error["kind"] == "DeviceError" and "has not ended after 0.01 seconds" in error["message"]
    ended = render(*words, "--timeout", 0, "--json")
    assert ended.returncode == 0 and json.loads(ended.stdout)["frames"] == [1, 2], ended.stderr


def test_code_that_never_ends_stops_all_helpers(tmp_path: Path) -> None:
    started = time.monotonic()
    ended = render(graph(tmp_path, ENDLESS), "-o", tmp_path / "o.##.exr", "--frames", "1-2", "-j", 2, "--timeout", 1)
    assert ended.returncode == 5 and "its code has not ended after 1 seconds" in ended.stderr
    assert time.monotonic() - started < 60.0
