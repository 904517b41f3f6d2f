"""Strokes painted on the picture with the mouse: one step of undo each, after which all pixels are as before."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from gui_driver import Ui
from halation import document
from halation.authoring.edits.element_id import ElementId
from halation.editor.window import frame_updater
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import Kind, PaintStroke, PaintTool, catalogue, name_paint_strokes, paint_strokes_of
from halation.resources.sandbox import UNRESTRICTED

PORT = Port("paint", "strokes")


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A checkerboard with one stroke."""
    graph = Graph(settings=Settings((320, 180), frames=(1, 48)), outputs={"image": Output(Kind.IMAGE)})
    strokes = name_paint_strokes(scratch=PaintStroke(points=(0.1, 0.1, 1.0, 0.3, 0.1, 1.0), color=(1.0, 0.0, 0.0)))
    graph = graph.add("checker", catalogue()["checker"]()).add("paint", catalogue()["paint"](strokes=strokes))
    graph = graph.connect(Port("checker", "out"), Port("paint", "image"))
    graph = graph.connect(Port("paint", "out"), Port("outputs", "image"))
    document.save(graph, tmp_path / "graph.json", sandbox=UNRESTRICTED)
    return tmp_path / "graph.json"


def start(ui: Ui) -> int:
    """Select the node; how many steps the history has."""
    ui.session.select([ElementId("paint")])
    ui.settled()
    ui.move(at(ui, 0.05, 0.95))
    ui.settled()
    return len(ui.session.history.steps)


def at(ui: Ui, x: float, y: float) -> tuple[float, float]:
    """A point of the picture, by fractions."""
    return ui.at("viewer image", (x, y))


def strokes(ui: Ui) -> tuple[PaintStroke, ...]:
    return paint_strokes_of(ui.session.graph.value(PORT))


def read_picture(ui: Ui) -> np.ndarray:
    """The pixels that the viewer shows, as they were computed."""
    ui.settled()
    image = ui.editor.preview.find_whole_image("A")
    assert image is not None
    return ui.ask(lambda: ui.editor.probe.read_region(image.texture, (0, 0, *image.texture.size)).copy())


def test_a_drag_paints_a_stroke_and_undo_takes_it_back_to_the_bit(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        steps, before = start(ui), read_picture(ui)
        ui.editor.viewer.brush.color = (0.0, 0.5, 1.0)
        ui.drag(at(ui, 0.3, 0.5), at(ui, 0.7, 0.6))
        painted = read_picture(ui)
        ui.shot("brush.png")
        assert len(ui.session.history.steps) == steps + 1 and list(ui.session.graph.value(PORT)) == [
            "scratch",
            "stroke_1",
        ]
        rows = strokes(ui)[1].rows
        assert rows[0] == pytest.approx((0.3, 0.5, 1.0), abs=0.01) and rows[-1] == pytest.approx(
            (0.7, 0.6, 1.0), abs=0.01
        )
        assert strokes(ui)[1].color == (0.0, 0.5, 1.0) and strokes(ui)[1].lifetime == "all"
        assert (painted != before).any()
        ui.keys("Ctrl+Z")
        assert list(ui.session.graph.value(PORT)) == ["scratch"]
        np.testing.assert_array_equal(read_picture(ui), before)
        ui.keys("Ctrl+Shift+Z")
        np.testing.assert_array_equal(read_picture(ui), painted)

    gui(body, path)


def test_the_picture_follows_the_pointer(gui, path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A frame of the window waits for the picture of the stroke, so that it is never more than two frames behind."""
    # on a busy machine a picture may take longer than a user should wait
    monkeypatch.setattr(frame_updater, "STROKE_BUDGET", 60.0)

    def body(ui: Ui) -> None:
        start(ui)
        ui.drag(at(ui, 0.1, 0.2), at(ui, 0.9, 0.8))  # the programs are there afterwards
        ui.settled()
        ui.drag(at(ui, 0.1, 0.5), at(ui, 0.2, 0.5), release=False)
        preview, late, revisions = ui.editor.preview, 0, set[int]()
        for number in range(30):
            ui.move(at(ui, 0.2 + 0.02 * number, 0.5 + 0.2 * (number % 2)))
            ui.wait(2)
            late += preview.busy
            image = preview.find_visible_image("A")
            assert image is not None
            revisions.add(image.revision)
        ui.ctx.mouse_up(0)
        assert len(revisions) == 30 and late == 0, (len(revisions), late)

    gui(body, path)


def test_a_clone_copies_from_where_alt_was_clicked(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        steps = start(ui)
        ui.click("brush clone")
        ui.drag(at(ui, 0.5, 0.5), at(ui, 0.6, 0.5))
        assert len(ui.session.history.steps) == steps, "nothing was chosen yet"
        ui.shot("clone_needs.png")
        with ui.held("Alt"):
            ui.click(at(ui, 0.2, 0.1))
        for x in (0.5, 0.7):
            ui.drag(at(ui, x, 0.5), at(ui, x + 0.1, 0.5))
        ui.shot("clone.png")
        assert len(ui.session.history.steps) == steps + 2
        first, second = strokes(ui)[1:]
        assert first.tool is PaintTool.CLONE and first.offset == pytest.approx((-0.3, -0.4), abs=0.01)
        assert second.offset == first.offset

    gui(body, path)


def test_what_is_copied_is_chosen_above_the_picture(gui, path: Path) -> None:
    """A reveal shows `source` at first, a clone what is painted; each tool keeps its own choice."""

    def body(ui: Ui) -> None:
        start(ui)
        ui.click("brush reveal")
        ui.click("brush source")
        ui.click("brush source image")
        ui.drag(at(ui, 0.2, 0.5), at(ui, 0.6, 0.5))
        ui.settled()
        assert (strokes(ui)[-1].tool, strokes(ui)[-1].source) == (PaintTool.REVEAL, "image")
        ui.click("brush clone")
        assert ui.editor.viewer.brush.source == "painted"
        ui.click("brush brush")
        ui.wait(3)
        assert "brush source" not in ui.editor.places

    gui(body, path)


def test_the_brush_is_resized_and_strokes_last_for_a_frame(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        steps, size = start(ui), ui.editor.viewer.brush.size
        ui.move(at(ui, 0.5, 0.5))
        ui.keys("Shift+RightBracket")
        assert ui.editor.viewer.brush.size == pytest.approx(1.15 * size)
        ui.keys("Shift+LeftBracket")
        ui.drag(at(ui, 0.4, 0.5), at(ui, 0.5, 0.5), keys="Shift")
        assert ui.editor.viewer.brush.size == pytest.approx(size + 0.2 * 320 / 180, rel=0.03)
        assert len(ui.session.history.steps) == steps
        ui.session.time.seek(7)
        ui.click("brush range")
        ui.click("brush range here")
        ui.drag(at(ui, 0.4, 0.5), at(ui, 0.5, 0.5))
        assert (strokes(ui)[1].lifetime, strokes(ui)[1].first, strokes(ui)[1].last) == ("range", 7, 7)

    gui(body, path)


def test_a_stroke_is_moved_below_another_in_the_list(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        steps = start(ui)
        ui.editor.viewer.brush.color = (0.0, 0.0, 1.0)
        ui.drag(at(ui, 0.2, 0.1), at(ui, 0.3, 0.1))
        assert [stroke.color for stroke in strokes(ui)] == [(1.0, 0.0, 0.0), (0.0, 0.0, 1.0)]
        ui.click(f"button move up {PORT}")
        assert [stroke.color for stroke in strokes(ui)] == [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0)]
        assert len(ui.session.history.steps) == steps + 2
        ui.keys("Ctrl+Z")
        assert [stroke.color for stroke in strokes(ui)] == [(1.0, 0.0, 0.0), (0.0, 0.0, 1.0)]

    gui(body, path)


def test_without_the_brush_a_drag_pans(gui, path: Path) -> None:
    def body(ui: Ui) -> None:
        steps = start(ui)
        ui.keys("Shift+N")
        assert not ui.editor.viewer.brush.is_on
        ui.drag(at(ui, 0.4, 0.5), at(ui, 0.5, 0.5))
        assert len(ui.session.history.steps) == steps and ui.editor.viewer.pan != (0.0, 0.0)

    gui(body, path)
