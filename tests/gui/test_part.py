"""Zoomed in, a value is dragged: only what can be seen is computed, and nobody could tell."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from halation.authoring.commands import SetValue
from halation.authoring.edits.element_id import ElementId
from halation.authoring.preview import work as rounds
from halation.document import save
from halation.editor.window.status import _figures
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import catalogue
from halation.resources.sandbox import UNRESTRICTED

SIZE = (800, 500)
STOPS = Port("light", "stops")


def made(folder: Path) -> Path:
    """Noise, light, a blur and colors, of more pixels than the viewer has."""
    node, last = catalogue(), Port("noise", "out")
    graph = Graph(settings=Settings(SIZE)).add("noise", node["noise"]()).add_output("image", Output())
    for name, type in (("light", "exposure"), ("blur", "gaussian_blur"), ("color", "saturation")):
        graph = graph.add(name, node[type]()).connect(last, Port(name, "image"))
        last = Port(name, "out")
    path = folder / "large.json"
    save(graph.connect(last, Port("outputs", "image")), path, sandbox=UNRESTRICTED)
    return path


@pytest.fixture
def resting(monkeypatch: pytest.MonkeyPatch):
    """`resting(seconds)` says how long a graph must stay as it is before the rest is computed."""
    return lambda seconds: monkeypatch.setattr(rounds, "REST", seconds)


def picture(ui, name: str) -> np.ndarray:
    """The panel of the viewer as the window shows it, without the mouse over it."""
    ui.wait(3)
    left, top, right, bottom = (round(part) for part in ui.editor.places["viewer panel"])
    return ui.pixels(name)[top:bottom, left:right].astype(int)


def held(ui) -> None:
    """Begin to drag the light: the mouse stays down."""
    ui.session.select([ElementId("light")])
    ui.settled()
    left, y = ui.at("field light.stops", (0.5, 0.5))
    ui.drag((left, y), (left + 20, y), release=False)
    ui.until(lambda: ui.editor.preview.completing)


def near(ui, zoom: float = 3.0, pan: tuple[float, float] = (150.0, 80.0)) -> None:
    ui.editor.viewer.zoom, ui.editor.viewer.pan = zoom, pan
    ui.settled()


def test_what_is_seen_is_the_same_before_and_after_the_rest_is_there(gui, tmp_path, resting):
    def body(ui) -> None:
        ui.settled()
        near(ui)
        before = picture(ui, "before.png")
        resting(1000.0)
        held(ui)
        preview, seen = ui.editor.preview, ui.editor.preview.find_visible_image("A")
        width, height = seen.texture.size
        assert seen.partial and width * height < 0.5 * SIZE[0] * SIZE[1]
        assert not preview.find_whole_image("A").partial and preview.find_whole_image("A").key != seen.key
        assert _figures(ui.editor).startswith(f"region {width}\u00d7{height} ")
        dragged = picture(ui, "part.png")
        assert (dragged != before).any(axis=2).mean() > 0.9
        ui.ctx.mouse_up(0)
        resting(0.0)
        ui.settled()
        assert (
            preview.find_visible_image("A") is preview.find_whole_image("A")
            and preview.find_whole_image("A").size == SIZE
        )
        assert "region" not in _figures(ui.editor)
        np.testing.assert_array_equal(picture(ui, "whole.png"), dragged)
        ui.keys("Ctrl+Z")
        ui.settled()
        np.testing.assert_array_equal(picture(ui, "undone.png"), before)

    gui(body, made(tmp_path), likes={"proxy_while_dragging": False})


def test_the_mouse_pans_and_zooms_while_a_part_is_shown(gui, tmp_path, resting):
    def body(ui) -> None:
        ui.settled()
        near(ui)
        resting(1000.0)
        held(ui)
        ui.ctx.mouse_up(0)
        ui.until(lambda: ui.editor.preview.completing)
        first = ui.editor.preview.find_visible_image("A")
        x, y = ui.at("viewer panel")
        ui.drag((x, y), (x + 180.0, y + 90.0), button=2)
        ui.until(lambda: ui.editor.preview.completing)
        second = ui.editor.preview.find_visible_image("A")
        assert second.partial and second.start != first.start
        ui.move((5.0, 5.0))
        panned, look = picture(ui, "panned.png"), (ui.editor.viewer.zoom, ui.editor.viewer.pan)
        ui.move("viewer panel")
        ui.wheel(3)
        ui.until(lambda: ui.editor.preview.completing)
        ui.move((5.0, 5.0))
        closer = picture(ui, "closer.png")
        resting(0.0)
        ui.settled()
        np.testing.assert_array_equal(picture(ui, "closer_whole.png"), closer)
        near(ui, *look)
        np.testing.assert_array_equal(picture(ui, "panned_whole.png"), panned)
        resting(1000.0)
        ui.session.apply(SetValue(STOPS, 1.5))
        ui.wait(2)
        ui.until(lambda: ui.editor.preview.completing)
        ui.editor.viewer.fit()
        resting(0.0)
        ui.settled()
        assert ui.editor.preview.find_visible_image("A").texture.size == SIZE

    gui(body, made(tmp_path), likes={"proxy_while_dragging": False})


@pytest.mark.parametrize("compare", ["wipe", "beside", "difference"])
def test_both_sides_are_compared_in_part(gui, tmp_path, resting, compare):
    def body(ui) -> None:
        ui.session.views.show(Port("light", "out"), "B")
        ui.editor.viewer.toggle_comparison(compare)
        ui.settled()
        near(ui)
        resting(1000.0)
        ui.session.apply(SetValue(STOPS, 1.5))
        ui.wait(2)
        ui.until(lambda: ui.editor.preview.completing)
        assert ui.editor.preview.find_visible_image("A").partial and ui.editor.preview.find_visible_image("B").partial
        parts = picture(ui, "parts.png")
        resting(0.0)
        ui.settled()
        assert not ui.editor.preview.find_visible_image("B").partial
        np.testing.assert_array_equal(picture(ui, "wholes.png"), parts)

    gui(body, made(tmp_path))


def test_numbers_of_the_whole_picture_wait_for_it(gui, tmp_path, resting):
    def body(ui) -> None:
        ui.settled()
        near(ui)
        resting(1000.0)
        ui.session.apply(SetValue(STOPS, 1.5))
        ui.wait(2)
        ui.until(lambda: ui.editor.preview.completing)
        ui.move("viewer panel")
        ui.wait(3)
        pixel, preview = ui.editor.viewer.pixel, ui.editor.preview
        ui.keys("Ctrl+C")
        copied = ui.editor.clipboard.get()
        ui.editor.viewer.saving = True
        ui.wait(5)
        assert ui.editor.dialogs.browse is None, "there is no picture as yet that could be saved"
        resting(0.0)
        ui.until(lambda: ui.editor.dialogs.browse is not None)
        ui.editor.dialogs.close()
        ui.settled()
        numbers = ui.ask(lambda: ui.editor.probe.read_pixel(preview.find_whole_image("A").texture, *pixel))
        assert [float(part) for part in copied.split(": ")[1].split()] == pytest.approx(numbers, abs=0.0)
        # How to show data depends on all of it.
        ui.editor.viewer.meaning = "field"
        ui.session.apply(SetValue(STOPS, 2.5))
        while ui.editor.preview.busy:
            ui.wait(1)
            assert not ui.editor.preview.find_visible_image("A").partial

    gui(body, made(tmp_path))
