"""The editor on a real X display with a window manager: keys, buttons and the wheel as the window system sends them.

It needs Xvfb, openbox and xdotool, which Debian and Ubuntu have as packages.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from halation import document, presets
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import Kind, catalogue
from halation.resources.sandbox import UNRESTRICTED

TOOLS = ("Xvfb", "openbox", "xdotool")
PATIENCE = 45.0
"""Seconds of real time after which what never became true fails the test."""

pytestmark = pytest.mark.skipif(
    not all(map(shutil.which, TOOLS)), reason="this system has no Xvfb, openbox and xdotool, with which to press keys"
)


@dataclass
class Desktop:
    """A display with an editor on it, seen through the report that the editor writes."""

    environment: dict[str, str]
    report: Path

    def xdotool(self, *words: object) -> None:
        """Do something with mouse or keyboard."""
        subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True, timeout=PATIENCE)

    @property
    def facts(self) -> dict[str, Any]:
        """What the editor wrote in its last frame."""
        with suppress(OSError, ValueError):
            return json.loads(self.report.read_text("utf-8"))
        return {}

    def until(self, question: Callable[[dict[str, Any]], object]) -> dict[str, Any]:
        """Wait until something is true of the report."""
        end = time.monotonic() + PATIENCE
        while not (facts := self.facts) or not question(facts):
            assert time.monotonic() < end, f"this never became true; { {**facts, 'places': sorted(facts['places'])} }"
            time.sleep(0.05)
        return facts

    def point_at(self, place: str, x: float = 0.5, y: float = 0.5) -> None:
        """Move the mouse to a place of the editor."""
        left, top, right, bottom = self.find_still_place(place)
        since, across, down = self.facts["frame"], round(left + (right - left) * x), round(top + (bottom - top) * y)
        # Relative to the window: its own report of where it is counts the frame around it twice under some managers.
        self.xdotool("search", "--name", "Halation$", "mousemove", "--window", "%1", across, down)
        # An editor that is idle draws a few frames for a move, and none where the mouse is there already.
        end = time.monotonic() + 2.0
        self.until(lambda facts: facts["frame"] > since + 1 or time.monotonic() > end)

    def find_still_place(self, place: str) -> list[float]:
        """Where a place is when it has stopped moving."""
        before: list[float] = []
        while (here := self.until(lambda facts: place in facts["places"])["places"][place]) != before:
            before = here
            time.sleep(0.3)
        return here


@contextmanager
def run_process(*words: object, **options: Any) -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(list(map(str, words)), text=True, **options)
    try:
        yield process
    finally:
        process.terminate()
        with suppress(subprocess.TimeoutExpired):
            process.wait(10.0)
        process.kill()
        process.wait()


@contextmanager
def open_display() -> Iterator[dict[str, str]]:
    """A display of its own, with a number that nobody uses, and a window manager."""
    reader, writer = os.pipe()
    words = ("Xvfb", "-displayfd", writer, "-screen", "0", "1366x768x24", "-noreset")
    with run_process(*words, pass_fds=(writer,), stderr=subprocess.DEVNULL):
        os.close(writer)
        with os.fdopen(reader) as lines:
            number = lines.readline().strip()
        environment = {**os.environ, "DISPLAY": f":{number}", "LP_NUM_THREADS": "2"}
        with run_process("openbox", env=environment, stderr=subprocess.DEVNULL):
            yield environment


@pytest.mark.timeout(300)
def test_an_artist_at_a_real_display(tmp_path: Path) -> None:
    graph, saved, report = tmp_path / "look.json", tmp_path / "saved look.json", tmp_path / "report.json"
    board = Graph(settings=Settings((320, 180)), outputs={"image": Output(Kind.IMAGE)})
    board = board.add("board", catalogue()["checker"]()).connect(Port("board", "out"), Port("outputs", "image"))
    document.save(board, graph, sandbox=UNRESTRICTED)
    script = Path(__file__).parents[1] / "display_editor.py"
    words = (sys.executable, script, graph, report, tmp_path / "state")
    with open_display() as environment, run_process(*words, env=environment) as editor:
        desk = Desktop(environment, report)
        desk.until(lambda facts: "viewer image" in facts["places"])

        desk.point_at("viewer image")  # the wheel zooms in steps, none of which is lost
        zoom = desk.facts["zoom"]
        desk.xdotool("click", "--repeat", 4, "--delay", 20, 4)
        desk.until(lambda facts: facts["zoom"] > max(zoom, 0.01))

        desk.point_at("Graph", 0.5, 0.9)  # the name is typed at once, whether or not the list is open
        desk.xdotool("key", "Tab")
        desk.xdotool("type", "--delay", 15, "vignette")
        desk.xdotool("key", "Return")
        desk.until(lambda facts: any("vignette" in name for name in facts["selection"]))
        desk.until(lambda facts: facts["steps"][-1].startswith("Add"))

        desk.point_at("Viewer", 0.5, 0.5)
        desk.xdotool("key", "f")
        desk.point_at("handle vignette.center")
        desk.xdotool("mousedown", 1, "mousemove_relative", 40, 20, "mousemove_relative", 32, 22, "mouseup", 1)
        desk.until(lambda facts: facts["steps"][-1] == "Set vignette.center")

        desk.xdotool("key", "ctrl+shift+s")  # a path with a blank, behind the chord that asks for it
        desk.xdotool("key", "ctrl+a")
        desk.xdotool("type", "--delay", 10, str(saved))
        desk.xdotool("key", "Return")
        facts = desk.until(lambda facts: facts["path"] == str(saved))
        assert facts["steps"][-1] == "Set vignette.center"  # no letter of the path ran as a shortcut

        desk.point_at("Graph", 0.5, 0.9)
        desk.xdotool("key", "alt+F4")  # the window manager asks the window to close
        assert editor.wait(PATIENCE) == 0
    node = document.load(saved, sandbox=UNRESTRICTED).nodes["vignette"]
    assert node.center != (0.5, 0.5)  # type: ignore[union-attr]


@pytest.mark.timeout(300)
def test_a_panel_is_torn_off_and_the_window_has_all_of_its_pixels_after_its_size_has_changed(tmp_path: Path) -> None:
    report = tmp_path / "report.json"
    script = Path(__file__).parents[1] / "display_editor.py"
    words = (sys.executable, script, presets.paths()[0], report, tmp_path / "state", "tears_off")
    with open_display() as environment, run_process(*words, env=environment):
        desk = Desktop(environment, report)
        desk.point_at("viewer image")  # the window manager has taken over the window by then
        desk.xdotool("search", "--name", "Halation$", "windowmove", 0, 0, "windowsize", 800, 600)
        desk.until(lambda facts: facts["places"]["Scopes"][2] <= 800)
        left, top, *_ = map(round, desk.find_still_place("Scopes"))  # its tab, dragged out, becomes a window
        desk.xdotool("search", "--name", "Halation$", "mousemove", "--window", "%1", left + 36, top + 12)
        desk.xdotool("mousedown", 1, *(50 * ("mousemove_relative", 10, 4, "sleep", 0.02)))
        desk.until(lambda facts: facts["windows"] == 2 and facts["places"]["Scopes"][0] > left)
        desk.xdotool("mouseup", 1)
        for width, height in ((1000, 600), (1250, 720), (900, 560)):
            before = desk.facts["size"]
            desk.xdotool("search", "--name", "Halation$", "windowsize", width, height)
            since = desk.until(lambda facts, before=before: facts["size"] != before)["frame"]
            desk.until(lambda facts, since=since: facts["frame"] > since + 5 and facts["black"] < 0.1)
