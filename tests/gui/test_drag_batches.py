"""A whole drag between two frames, as a slow machine gets it: what is held follows the mouse to where it is let go."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
from gui_events import Keyboard, Script, play
from halation import document
from halation.authoring.edits.element_id import ElementId
from halation.editor.shared.window_commands import PanelTitle
from halation.editor.window.window import Window
from halation.graph import Graph, Key, Keys, Output, Port, Settings
from halation.nodes import Kind, catalogue
from halation.resources.sandbox import UNRESTRICTED

Point = tuple[float, float]
NODE = Port("vignette", "center")


@pytest.fixture
def look(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A checkerboard through a vignette, which has a place and an animated number."""
    monkeypatch.setenv("HALATION_STATE", str(tmp_path / "state"))
    graph = Graph(settings=Settings((320, 180), frames=(1, 24)), outputs={"image": Output(Kind.IMAGE)})
    graph = graph.add("board", catalogue()["checker"]()).add("vignette", catalogue()["vignette"]())
    graph = graph.connect(Port("board", "out"), Port("vignette", "image"))
    graph = graph.connect(Port("vignette", "out"), Port("outputs", "image"))
    graph = graph.animate(Port("vignette", "amount"), Keys((Key(1, 0.2), Key(11, 0.6), Key(21, 0.4))))
    document.save(graph, tmp_path / "look.json", sandbox=UNRESTRICTED)
    return tmp_path / "look.json"


def middle(window: Window, place: str) -> Point:
    left, top, right, bottom = window.editor.places[place]
    return (left + right) / 2, (top + bottom) / 2


def rest(window: Window, keyboard: Keyboard, frames: int = 12):
    """A question: whether the window has taken all events, and some frames have passed since."""
    last = [window.frames]

    def is_at_rest() -> bool:
        if not keyboard.is_idle:
            last[0] = window.frames
        return window.frames > last[0] + frames

    return is_at_rest


def shift(point: Point, x: float, y: float) -> Point:
    return point[0] + x, point[1] + y


def drag_by(window: Window, keyboard: Keyboard, place: str, x: float, y: float = 0.0) -> None:
    """Drag a place in three moves."""
    start = middle(window, place)
    keyboard.drag(start, shift(start, x / 2, y / 2), shift(start, x, y))


def test_a_handle_on_the_picture(tmp_path: Path, look: Path) -> None:
    def script(window: Window, keyboard: Keyboard) -> Script:
        session = window.editor.session
        session.select([ElementId("vignette")])
        keyboard.move(*middle(window, "Graph"))
        yield lambda: "handle vignette.center" in window.editor.places
        yield rest(window, keyboard)
        left, top, right, bottom = window.editor.places["viewer image"]
        drag_by(window, keyboard, "handle vignette.center", 0.17 * (right - left), -0.13 * (bottom - top))
        yield rest(window, keyboard)
        assert session.graph.value(NODE) == pytest.approx((0.67, 0.37), abs=0.02)
        assert session.history.steps == ("Set vignette.center",)

    play(script, tmp_path, look)


def test_a_number(tmp_path: Path, look: Path) -> None:
    def script(window: Window, keyboard: Keyboard) -> Script:
        session = window.editor.session
        session.select([ElementId("vignette")])
        yield lambda: "field vignette.roundness" in window.editor.places
        yield rest(window, keyboard)
        before = session.graph.value(Port("vignette", "roundness"))
        drag_by(window, keyboard, "field vignette.roundness", 40.0)
        yield rest(window, keyboard)
        assert session.graph.value(Port("vignette", "roundness")) > before
        assert len(session.history.steps) == 1

    play(script, tmp_path, look)


def test_a_node_and_a_link(tmp_path: Path, look: Path) -> None:
    def script(window: Window, keyboard: Keyboard) -> Script:
        session = window.editor.session
        yield rest(window, keyboard, 40)
        before = session.positions[ElementId("vignette")]
        start = middle(window, "title vignette")
        keyboard.drag(start, shift(start, 20.0, 10.0), shift(start, 40.0, 30.0))
        yield rest(window, keyboard)
        after = session.positions[ElementId("vignette")]
        assert after[0] > before[0] and after[1] > before[1]
        ends = [middle(window, name) for name in ("pin out board.out", "pin in outputs.image")]
        keyboard.drag(*ends)
        yield rest(window, keyboard)
        assert session.graph.links[Port("outputs", "image")] == Port("board", "out")

    play(script, tmp_path, look)


def test_a_key_and_the_ruler(tmp_path: Path, look: Path) -> None:
    def script(window: Window, keyboard: Keyboard) -> Script:
        session = window.editor.session
        window.editor.commands.show_panel(PanelTitle.ANIMATION)
        yield lambda: "key vignette.amount 11" in window.editor.places
        yield rest(window, keyboard)
        start, end = middle(window, "key vignette.amount 11"), middle(window, "key vignette.amount 21")
        width = (end[0] - start[0]) / 10
        keyboard.drag(start, shift(start, width, 0.0), shift(start, 4 * width, 0.0))
        yield rest(window, keyboard)
        assert session.graph.animation[Port("vignette", "amount")].frames == (1.0, 15.0, 21.0)
        one, last = middle(window, "ruler 1"), middle(window, "ruler 24")
        keyboard.drag(shift(one, 30.0, 0.0), last)
        yield rest(window, keyboard)
        assert session.time.frame == 24

    play(script, tmp_path, look)


def test_a_key_goes_to_the_panel_that_the_mouse_has_just_reached(tmp_path: Path, look: Path) -> None:
    def script(window: Window, keyboard: Keyboard) -> Script:
        session = window.editor.session
        keyboard.move(*middle(window, "viewer image"))
        yield rest(window, keyboard)
        left, top, right, bottom = window.editor.places["Graph"]
        keyboard.move((left + right) / 2, top + 0.9 * (bottom - top))
        keyboard.press("Tab")
        keyboard.type("blur")
        keyboard.press("Enter")
        yield rest(window, keyboard)
        assert any("blur" in name for name in session.graph.nodes)

    play(script, tmp_path, look)


def test_a_double_click_counts_when_it_was_made_not_when_frames_come(tmp_path: Path, look: Path) -> None:
    def script(window: Window, keyboard: Keyboard) -> Script:
        session = window.editor.session
        session.views.show(Port("board", "out"))
        keyboard.move(*middle(window, "title vignette"))
        yield rest(window, keyboard, 40)
        keyboard.click(count=2)
        before = window.frames

        def is_slow() -> bool:
            time.sleep(0.2)  # a frame of a busy machine
            return window.frames > before + 8

        yield is_slow
        assert session.views.find_port("A") == Port("vignette", "out")

    play(script, tmp_path, look)
