"""How the canvas is looked at: panning, the overview, pictures on nodes, measurements, and colors set on nodes."""

from __future__ import annotations

from gui_canvas import chain, empty, show
from halation import presets
from halation.authoring.commands import SetValue
from halation.authoring.edits.element_id import ElementId
from halation.editor.canvas.brush import READABLE
from halation.graph import Port
from imgui_bundle import imgui


def test_the_minimap_is_there_only_while_something_is_out_of_view(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom", "clip"))
        ui.editor.store.change(minimap=True)
        ui.editor.canvas.fit()
        ui.wait(4)
        assert "minimap" not in ui.editor.places
        ui.editor.canvas.zoom = 3.0
        ui.wait(3)
        assert "minimap" in ui.editor.places
        ui.editor.canvas.fit()
        ui.wait(4)
        assert "minimap" not in ui.editor.places
        ui.click("legend")
        assert imgui.is_popup_open("", int(imgui.PopupFlags_.any_popup)), "the question mark says what colors mean"

    gui(body, size=(1400, 900))


def test_the_canvas_moves_on_while_something_is_dragged_to_its_border(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom"))
        view, before = ui.editor.canvas, ui.session.position(ElementId("bloom"))
        center, zoom = view.center, view.zoom
        x, y = ui.at("title bloom", (0.3, 0.5))
        low = 4.0
        ui.drag((x, y), (low + 6.0, y), release=False)
        ui.until(lambda: view.center[0] < center[0] - 100.0)
        ui.ctx.mouse_up(0)
        ui.wait(3)
        moved = before[0] - ui.session.position(ElementId("bloom"))[0]
        assert moved > (x - low - 6.0) / zoom + 90.0, "it stays under the pointer while the canvas moves"
        still = view.center
        ui.wait(10)
        assert view.center == still

    gui(body)


def test_the_wheel_pans_with_shift_or_sideways(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure"))
        view = ui.editor.canvas
        ui.move(empty(ui))
        center, zoom = view.center, view.zoom
        with ui.held("Shift"):
            ui.wheel(1)
        assert view.zoom == zoom and view.center[1] == center[1] and view.center[0] != center[0]
        center = view.center
        ui.ctx.mouse_wheel_x(1)
        ui.wait(3)
        assert view.zoom == zoom and view.center[0] != center[0]

    gui(body)


def test_the_overview_is_dragged(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom", "clip", "vignette"), 1.0)
        ui.editor.store.change(minimap=True)
        ui.wait(3)
        view = ui.editor.canvas
        ui.drag(ui.at("minimap", (0.3, 0.5)), ui.at("minimap", (0.4, 0.5)), release=False)
        first = view.center
        ui.move("minimap", (0.8, 0.5))
        ui.wait(3)
        ui.ctx.mouse_up(0)
        ui.wait(3)
        assert view.center[0] > first[0] + 100.0
        assert ui.session.selection == frozenset()

    gui(body)


def test_costs_are_written_above_nodes_while_they_are_measured(gui) -> None:
    def body(ui) -> None:
        ui.editor.dialogs.open.clear()
        ui.settled()
        assert not any(name.startswith("cost ") for name in ui.editor.places)
        ui.editor.store.change(timings=True)
        ui.wait(3)
        ui.ask(ui.editor.preview.clear)
        ui.settled()
        measured = ui.editor.preview.timings.keys() & ui.session.graph.nodes.keys()
        assert measured
        assert measured == {name.removeprefix("cost ") for name in ui.editor.places if name.startswith("cost ")}
        ui.shot("canvas_costs.png")

    gui(body, _preset("neon_edges"))


def test_a_color_is_chosen_on_a_node_and_picked_from_the_picture(gui) -> None:
    def body(ui) -> None:
        ui.editor.dialogs.open.clear()
        ui.settled()
        port = Port("paper", "color")
        ui.editor.canvas.fit((ElementId("paper"),))
        ui.wait(4)
        ui.move(f"widget {port}")
        ui.wait(3)
        ui.click(f"widget {port}")
        ui.wait(4)
        ui.shot("canvas_color.png")
        before, steps = ui.session.graph.value(port), ui.session.history.position
        ui.click(f"button pick canvas {port} picker")
        ui.until(lambda: ui.editor.viewer.picking == str(port))
        ui.wait(3)
        ui.click("viewer image", fraction=(0.4, 0.6))
        ui.until(lambda: ui.session.graph.value(port) != before)
        assert ui.session.history.position == steps + 1

    gui(body, _preset("emboss_and_edges"))


def test_a_picture_has_its_place_from_when_it_is_there(gui) -> None:
    def body(ui) -> None:
        ui.editor.dialogs.open.clear()
        ui.settled()
        ui.until(lambda: not ui.editor.preview.busy and "drawn" in ui.editor.preview.thumbnails)
        ui.wait(5)
        shown = {key for key in ui.session.graph.nodes if f"picture {key}" in ui.editor.places}
        assert shown == ui.editor.preview.thumbnails & ui.session.graph.nodes.keys()
        assert "gray" not in shown, "it is part of a larger step"
        before = dict(ui.editor.canvas.sizes)
        for step in range(6):
            ui.session.apply(SetValue(Port("gray", "saturation"), 0.1 * step, merge="drag"))
            ui.wait(2)
            assert ui.editor.canvas.sizes == before
        pins = ui.at("pin out gray.out"), ui.at("pin in gray.image")
        ui.session.views.show(Port("gray", "out"))
        ui.until(lambda: "picture gray" in ui.editor.places)
        assert (ui.at("pin out gray.out"), ui.at("pin in gray.image")) == pins, "a picture moves no pin"
        ui.editor.store.change(thumbnails=False)
        ui.until(lambda: not any(name.startswith("picture ") for name in ui.editor.places))

    gui(body, _preset("emboss_and_edges"), size=(1600, 1000))


def test_titles_stay_readable_however_far_away(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom"), 0.2)
        assert READABLE >= 11.0
        _, top, _, bottom = ui.editor.places["title exposure"]
        assert bottom - top > READABLE * 1.3, "the header grows with its title"
        ui.shot("canvas_far.png")
        ui.click("title exposure")
        assert ui.session.selection == {"exposure"}

    gui(body)


def _preset(stem: str):
    return next(path for path in presets.paths() if path.stem == stem)
