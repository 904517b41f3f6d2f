"""The window draws only what has changed: its pixels are those of a window that is drawn whole.

The test engine is not used: with it, frames are drawn whole anyway.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gui_driver import headless
from halation import document
from halation.authoring.commands import SetValue
from halation.editor.window.opening import run
from halation.editor.window.painting import measure_window
from halation.editor.window.window import Window
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import Kind
from halation.nodes.color.exposure import Exposure
from halation.nodes.input.noise import Noise
from halation.resources.sandbox import UNRESTRICTED
from imgui_bundle import glfw_utils, imgui

import glfw  # isort: skip

PATIENCE = 4000
"""Frames after which what never became true fails the test."""

Steps = Callable[[Window], Iterator[bool]]
"""Yields True once a step is over; it is asked again in every frame until then."""


@pytest.fixture
def window(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Window:
    """A window with a noise and an exposure."""
    monkeypatch.setenv("HALATION_STATE", str(tmp_path / "state"))
    graph = Graph().add("noise", Noise()).add("exposure", Exposure())
    graph = graph.connect(Port("noise", "out"), Port("exposure", "image")).add_output("image", Output(Kind.IMAGE))
    graph = graph.connect(Port("exposure", "out"), Port("outputs", "image"))
    path = tmp_path / "two.json"
    document.save(replace(graph, settings=Settings((160, 90))), path, sandbox=UNRESTRICTED)
    window = headless(tmp_path, path)
    window.params.fps_idling.enable_idling = False
    return window


def play(window: Window, steps: Steps) -> None:
    """Run a window with a script, of which each frame that is shown runs a part."""
    shown, script, frames = window.params.callbacks.after_swap, iter(()), 0

    def after_swap() -> None:
        nonlocal script, frames
        shown()
        frames += 1
        if frames == 1:
            script = steps(window)
        assert frames < PATIENCE, "the script never ended"
        window.editor.commands.closing |= next(script, None) is None

    window.params.callbacks.after_swap = after_swap
    run(window)


def wait(frames: int) -> Iterator[bool]:
    """Let the window draw."""
    for _ in range(frames):
        yield True


def settle(window: Window) -> Iterator[bool]:
    """Wait until all pictures are there, thumbnails and scopes too, and nothing is drawn any more."""
    rested = 0
    while rested < 20:
        is_resting = not window.editor.preview.busy and not window._updater.is_working
        rested = rested + 1 if is_resting and window._painter.drawn_boxes == () else 0
        yield True


def point(window: Window, place: str, dx: float = 0.0, dy: float = 0.0) -> None:
    """Move the mouse to a place."""
    left, top, right, bottom = window.editor.places[place]
    host: Any = glfw_utils.glfw_window_hello_imgui()
    glfw.set_cursor_pos(host, (left + right) / 2 + dx, (top + bottom) / 2 + dy)


def press(is_down: bool) -> None:
    """Press the left button, or let it go."""
    imgui.get_io().add_mouse_button_event(0, is_down)


def test_pixels_are_those_of_a_window_that_is_drawn_whole(window: Window) -> None:
    differing, partial_acts = list[str](), list[str]()

    def compare(act: str) -> Iterator[bool]:
        painter = window._painter
        while True:  # until nothing comes in between, such as a tooltip that waits for a while
            yield from settle(window)
            yield from wait(20)  # scopes come some frames after the picture, into the same triangles
            partial, lists = (
                window.device.read_window(measure_window()).copy(),
                [drawn.memory for drawn in painter._lists],
            )
            painter.redraw_all()
            yield True
            assert len(painter.drawn_boxes) == 1, "all of it was drawn"
            if lists == [drawn.memory for drawn in painter._lists]:
                break
        differs = np.any(partial != window.device.read_window(measure_window()), axis=2)
        if differs.any():
            rows, columns = (np.flatnonzero(differs.any(axis=1 - axis)) for axis in (0, 1))
            differing.append(f"{act}: rows {rows[0]} to {rows[-1]}, columns {columns[0]} to {columns[-1]}")

    def steps(window: Window) -> Iterator[bool]:
        editor = window.editor
        editor.dialogs.open.clear()
        editor.store.change(reduced_motion=True)  # a cursor that blinks never rests
        yield from compare("start")
        for act, do in (
            ("hover", lambda: point(window, "title exposure")),
            ("press", lambda: press(True)),
            ("drag", lambda: point(window, "title exposure", 60.0, 40.0)),
            ("release", lambda: press(False)),
            ("away", lambda: point(window, "Graph", 0.0, 150.0)),
            ("wheel", lambda: imgui.get_io().add_mouse_wheel_event(0.0, 2.0)),
            ("search", lambda: editor.actions.run("node.add")),
            ("text", lambda: imgui.get_io().add_input_characters_utf8("blur")),
            ("escape", lambda: imgui.get_io().add_key_event(imgui.Key.escape, True)),
            ("escaped", lambda: imgui.get_io().add_key_event(imgui.Key.escape, False)),
            ("picture", lambda: editor.session.apply(SetValue(Port("exposure", "stops"), 1.5))),
            ("undo", lambda: editor.actions.run("edit.undo")),
            ("tooltip", lambda: point(window, "button viewer.fit")),
            ("theme", lambda: editor.store.change(theme="light")),
        ):
            do()
            boxes = []
            for _ in wait(5):
                yield True
                boxes += window._painter.drawn_boxes
            size = imgui.get_io().display_size
            if boxes and all((box[2] - box[0]) * (box[3] - box[1]) < 0.8 * size.x * size.y for box in boxes):
                partial_acts.append(act)
            yield from compare(act)

    play(window, steps)
    assert differing == []
    assert {"hover", "drag", "search", "text", "picture", "tooltip"} <= set(partial_acts)


def test_what_does_not_change_is_not_drawn(window: Window) -> None:
    boxes: list[tuple[int, int, int, int]] = []

    def steps(window: Window) -> Iterator[bool]:
        yield from settle(window)
        point(window, "Graph", 0.0, 150.0)
        yield from settle(window)
        point(window, "title exposure")
        for _ in wait(8):
            yield True
            boxes.extend(window._painter.drawn_boxes)
        for panel in ("Viewer", "Inspector"):  # the hint in the status bar may change
            left, top, right, bottom = window.editor.places[panel]
            assert all(box[2] <= left or box[0] >= right or box[3] <= top or box[1] >= bottom for box in boxes)

    play(window, steps)
    assert boxes, "the node under the pointer is lit"
