"""How far a painted stroke is behind the pointer. Run it as `.venv/bin/python tests/bench/painting.py`; it prints JSON.

The pointer draws a stroke of 150 frames of the window on a picture of 1920x1080 that has twenty strokes already. For
each place that it was at: after how many frames, and milliseconds, the picture that the window shows is painted there.
Two frames are wanted; `scale` is the resolution of the pictures while the pointer moved, 1 for full size.

`--full` forbids a lower resolution while something is dragged.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

sys.path.append(str(Path(__file__).parents[1]))

import numpy as np
from gui_driver import headless
from halation import document
from halation.authoring.edits.element_id import ElementId
from halation.editor.window.opening import run
from halation.editor.window.window import Window
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import Kind, PaintStroke, name_paint_strokes
from halation.nodes.color.exposure import Exposure
from halation.nodes.filter.paint import Paint
from halation.nodes.input.noise import Noise
from halation.resources.sandbox import UNRESTRICTED
from imgui_bundle import glfw_utils, imgui

import glfw  # isort: skip

FRAMES = 150
MARK = 0.5
"""A change of the picture by so much is paint."""


def make_graph() -> Graph:
    """A dark picture with twenty strokes of forty points."""
    rng, strokes = np.random.default_rng(1), dict[str, PaintStroke]()
    for number in range(1, 21):
        turns = rng.uniform(0.0, 6.0) + np.cumsum(rng.normal(0.0, 0.3, 40))
        x, y = np.cumsum([0.007 * np.cos(turns), 0.0125 * np.sin(turns)], axis=1) + rng.uniform(0.1, 0.9, (2, 1))
        points = tuple(float(part) for row in zip(x, y, np.ones(40), strict=True) for part in row)
        strokes[f"stroke_{number}"] = PaintStroke(points=points, size=0.03, color=(0.05, 0.1, 0.05))
    graph = Graph(settings=Settings((1920, 1080)), outputs={"image": Output(Kind.IMAGE)})
    graph = graph.add("noise", Noise()).add("dark", Exposure(stops=-6.0))
    graph = graph.add("paint", Paint(strokes=name_paint_strokes(**strokes)))
    for source, target in (("noise.out", "dark.image"), ("dark.out", "paint.image"), ("paint.out", "outputs.image")):
        graph = graph.connect(Port(*source.split(".")), Port(*target.split(".")))
    return graph


class StrokeWatch:
    """Moves the pointer frame by frame, and notes when the picture is painted where it was."""

    def __init__(self, window: Window, *, coarse: bool) -> None:
        self._window, self._coarse, self._frame = window, coarse, 0
        self._seen = -1
        self._waiting: list[tuple[int, float, tuple[float, float]]] = []
        self.frames, self.seconds, self.scales = list[int](), list[float](), list[float]()

    def draw(self) -> Iterator[bool]:
        """Wait for the first picture, draw the stroke, then wait for the rest of it; yields for each frame."""
        editor = self._window.editor
        editor.dialogs.open.clear()
        editor.store.change(proxy_while_dragging=self._coarse)
        editor.session.select([ElementId("paint")])
        rested = 0
        while rested < 20:
            rested = 0 if editor.preview.busy else rested + 1
            yield True
        for number in range(FRAMES):
            at = 0.15 + 0.7 * number / FRAMES, 0.5 + 0.3 * math.sin(number / 12.0)
            self._move(at)
            if number == 3:
                imgui.get_io().add_mouse_button_event(0, True)
            yield True
            self._frame += 1
            if number > 5:
                self._waiting.append((self._frame, time.perf_counter(), at))
            self._look()
        for _ in range(60):
            yield True
            self._frame += 1
            self._look()
        imgui.get_io().add_mouse_button_event(0, False)
        yield True

    def _move(self, at: tuple[float, float]) -> None:
        left, top, right, bottom = self._window.editor.places["viewer image"]
        host: Any = glfw_utils.glfw_window_hello_imgui()
        glfw.set_cursor_pos(host, left + at[0] * (right - left), top + at[1] * (bottom - top))

    def _look(self) -> None:
        """Take what is painted by now from the list of what is waited for."""
        image = self._window.editor.preview.find_visible_image("A")
        if image is None or image.revision == self._seen or not self._waiting:
            return
        self._seen = image.revision
        (width, height), (x0, y0) = image.texture.size, image.start
        places = [(int(x * image.size[0]) - x0, int(y * image.size[1]) - y0) for _, _, (x, y) in self._waiting]
        left, right = max(min(x for x, _ in places), 0), min(max(x for x, _ in places), width - 1)
        top, bottom = max(min(y for _, y in places), 0), min(max(y for _, y in places), height - 1)
        box = (left, top, right - left + 1, bottom - top + 1)
        pixels = self._window.editor.probe.read_region(image.texture, box)
        for entry, (x, y) in zip(list(self._waiting), places, strict=True):
            if left <= x <= right and top <= y <= bottom and pixels[y - top, x - left, 0] > MARK:
                self._waiting.remove(entry)
                self.frames.append(self._frame - entry[0])
                self.seconds.append(time.perf_counter() - entry[1])
                self.scales.append(image.size[0] / 1920)


def measure(folder: Path, *, coarse: bool) -> dict[str, Any]:
    """The delays of one stroke."""
    path = folder / "graph.json"
    document.save(make_graph(), path, sandbox=UNRESTRICTED)
    window = headless(folder, path)
    window.params.fps_idling.enable_idling = False
    watch = StrokeWatch(window, coarse=coarse)
    shown, script = window.params.callbacks.after_swap, iter(watch.draw())

    def after_swap() -> None:
        shown()
        window.editor.commands.closing |= next(script, None) is None

    window.params.callbacks.after_swap = after_swap
    run(window)
    frames, delays = np.array(watch.frames), 1000.0 * np.array(watch.seconds)
    return {
        "places": len(frames),
        "frames": {
            "median": _round(np.median(frames)),
            "p95": _round(np.quantile(frames, 0.95)),
            "most": int(max(frames)),
        },
        "milliseconds": {"median": _round(np.median(delays)), "p95": _round(np.quantile(delays, 0.95))},
        "scale": {"median": _round(np.median(watch.scales)), "least": _round(min(watch.scales))},
    }


def _round(number: Any) -> float:
    return round(float(number), 2)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--full", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        print(json.dumps(measure(Path(folder), coarse=not options.full), indent=2))
