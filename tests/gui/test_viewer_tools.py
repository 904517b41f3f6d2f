"""Handles, measuring, scopes and saving in the viewer, moved by mouse and keyboard."""

from __future__ import annotations

from pathlib import Path

import halation as hal
import numpy as np
import OpenImageIO as oiio
import pytest
from gui_viewer import HEIGHT, PRESET, WIDTH, hover, inside, seen, shown_plainly
from halation import document
from halation.authoring.commands import AddInput, AddNode
from halation.authoring.edits.element_id import ElementId
from halation.editor.viewer.geometry import Sight
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import Light, LightKind, catalogue, lights_of, number_lights
from halation.resources.sandbox import UNRESTRICTED
from imgui_bundle import imgui


def test_a_region_is_drawn_resized_and_cleared(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        viewer = ui.editor.viewer
        outside = seen(ui, 0.8, 0.85)
        hover(ui)
        ui.keys("Shift+R")
        ui.drag(inside(ui, 0.2, 0.3), inside(ui, 0.5, 0.6))
        assert viewer.region == pytest.approx((0.2, 0.3, 0.5, 0.6), abs=0.01)
        assert (seen(ui, 0.8, 0.85) < outside).all()
        ui.drag(inside(ui, 0.5, 0.6), inside(ui, 0.7, 0.8))
        assert viewer.region == pytest.approx((0.2, 0.3, 0.7, 0.8), abs=0.02)
        ui.click("button viewer.region")
        assert viewer.region is None and not ui.session.dirty

    gui(body, PRESET)


def test_a_position_is_dragged_on_the_picture_as_one_step(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.session.select({ElementId("vignette")})
        ui.wait(3)
        ui.drag("handle vignette.center", inside(ui, 0.7, 0.25))
        ui.settled()
        assert ui.session.graph.value(Port("vignette", "center")) == pytest.approx((0.7, 0.25), abs=0.01)
        assert len(ui.session.history.steps) == 1
        ui.session.undo()
        assert ui.session.graph.value(Port("vignette", "center")) == (0.5, 0.5)

    gui(body, PRESET)


def test_a_light_is_dragged_on_the_picture(gui, tmp_path: Path) -> None:
    node, start = catalogue(), Light(place=(0.0, 0.0, 1.0))
    graph = Graph(settings=Settings((64, 36))).add_output("image", Output())
    graph = graph.add("lit", node["deferred_lighting"](lights=number_lights((Light(LightKind.SUN), start))))
    graph = graph.add("camera", node["camera"](eye=(0.0, -5.0, 1.0), target=(0.0, 0.0, 1.0)))
    graph = graph.connect(Port("camera", "camera"), Port("lit", "camera"))
    document.save(
        graph.connect(Port("lit", "out"), Port("outputs", "image")), tmp_path / "graph.json", sandbox=UNRESTRICTED
    )

    def body(ui) -> None:
        ui.session.select([ElementId("lit")])
        ui.settled()
        steps = len(ui.session.history.steps)
        ui.drag("handle lit.lights lamp_2", inside(ui, 0.7, 0.5))
        ui.settled()
        sun, light = lights_of(ui.session.graph.value(Port("lit", "lights")))
        assert sun == Light(LightKind.SUN)
        assert light.place == pytest.approx((0.2 * 5.0 * 36.0 / 50.0, 0.0, 1.0), abs=0.1)
        assert len(ui.session.history.steps) == steps + 1
        assert "field lit.lights.lamp_2.reach" in ui.editor.places
        ui.keys("Ctrl+Z")
        assert lights_of(ui.session.graph.value(Port("lit", "lights")))[1] == start

    gui(body, tmp_path / "graph.json")


def test_the_table_measures_rectangles_and_markers(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        viewer = ui.editor.viewer
        (across, down), line = viewer.panel, imgui.get_text_line_height()
        ui.click(inside(ui, 0.3, 0.3), keys="Ctrl")
        assert viewer.table and viewer.markers[0] == pytest.approx((0.3, 0.3), abs=0.01)
        ui.settled()
        assert viewer.panel[0] == across and viewer.panel[1] < down - 5 * line, "the picture makes room for it"
        ui.drag(inside(ui, 0.2, 0.2), inside(ui, 0.4, 0.6), keys="Ctrl")
        ui.settled()
        assert viewer.measured == pytest.approx((0.2, 0.2, 0.4, 0.6), abs=0.02)
        assert ui.editor.preview.find_whole_image("inputs.beauty") is not None
        assert "Viewer" not in ui.editor.faults

    gui(body, PRESET)


def test_scopes_follow_the_picture(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.editor.viewer.scopes = {"histogram", "waveform", "parade", "vectorscope"}
        ui.wait(30)
        places = [
            tuple(int(part) for part in ui.editor.places[f"scope {name}"])
            for name in ("histogram", "waveform", "parade", "vectorscope")
        ]

        def scopes() -> list[np.ndarray]:
            window = ui.pixels()
            return [window[top:bottom, left:right] for left, top, right, bottom in places]

        before = scopes()
        assert all(scope.max() > 150 for scope in before)
        ui.editor.viewer.exposure = 3.0
        ui.until(lambda: all((now != then).any() for now, then in zip(scopes(), before, strict=True)))
        assert "Scopes" not in ui.editor.faults

    gui(body, PRESET)


def test_the_first_node_that_makes_infinity_is_found(gui) -> None:
    def body(ui) -> None:
        session = ui.session
        ui.editor.dialogs.open.clear()
        broken = np.ones((8, 16, 4), np.float32)
        broken[3, 5] = np.inf
        session.apply(AddInput("light", "Image"))
        session._bound["light"] = broken  # files are repaired when they are read
        session.views.show(Port("inputs", "light"))
        ui.settled()
        ui.until(lambda: "viewer find" in ui.editor.places)
        ui.click("viewer find")
        ui.until(lambda: not ui.editor.viewer.finding)
        assert session.active == "inputs.light"
        assert any("inputs.light" in one.sentence and "5, 3" in one.sentence for one in ui.editor.log.entries)

    gui(body)


def test_what_is_seen_is_saved(gui, tmp_path: Path) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.editor.viewer.exposure = 1.0
        ui.editor.viewer.channels = "green"
        ui.editor.viewer.view = "none"
        ui.editor.viewer.region = (0.4, 0.4, 0.6, 0.6)  # only helps to judge
        ui.click("button viewer.save")
        browse = ui.editor.dialogs.browse
        assert browse is not None and browse.saving and browse.name.endswith(".png")
        browse.then(tmp_path / "seen.png")
        ui.editor.dialogs.browse = None

    gui(body, PRESET)
    saved = oiio.ImageBuf(str(tmp_path / "seen.png"))
    pixels = saved.get_pixels(oiio.UINT8)
    assert (saved.spec().width, saved.spec().height) == (WIDTH, HEIGHT)
    lit = 2.0 * hal.render(hal.load(PRESET))["image"][..., 1:2].repeat(3, axis=2)
    assert np.abs(pixels - shown_plainly(lit)).max() <= 1


def test_says_why_there_is_nothing(gui) -> None:
    def body(ui) -> None:
        ui.editor.dialogs.open.clear()
        ui.wait(3)
        assert "viewer message" in ui.editor.places
        noise = ui.session.apply(AddNode("noise"))
        ui.session.views.show(Port(noise, "value"))
        ui.settled()
        assert "viewer message" not in ui.editor.places
        low, high = ui.editor.viewer.span
        assert 0.0 < low < high < 1.0  # measured
        ui.session.views.show(Port(ui.session.apply(AddNode("read_image")), "out"))
        ui.settled()
        assert "viewer message" in ui.editor.places

    gui(body)


def test_at_any_size_tools_and_numbers_fit(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        for scale in (1.0, 2.0):
            ui.editor.store.change(ui_scale=scale)
            ui.settled()
            hover(ui)
            right = ui.editor.places["viewer panel"][2]
            tools = [box for name, box in ui.editor.places.items() if name.startswith("button viewer")]
            assert tools and all(box[2] <= right for box in tools)
            sight = Sight.of((0.0, 0.0), ui.editor.viewer.panel, (WIDTH, HEIGHT), 0.0, (0.0, 0.0))
            assert sight.zoom > 0.1
        assert "Viewer" not in ui.editor.faults

    gui(body, PRESET, size=(700, 600))


def test_keys_keep_and_recall_what_is_viewed(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.session.views.show(Port("halo", "glow"))
        hover(ui)
        ui.keys("Ctrl+3")
        ui.session.views.show(Port("outputs", "image"))
        ui.keys("3")
        assert ui.session.views.find_port("A") == Port("halo", "glow")

    gui(body, PRESET)


def test_a_color_is_picked_from_the_picture(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        constant = ui.session.apply(AddNode("constant"))
        ui.session.views.show(Port("inputs", "beauty"))
        ui.settled()
        hover(ui, 0.3, 0.7)
        ui.keys("Ctrl+C")
        expected = [float(part) for part in ui.editor.clipboard.get().split(": ")[1].split()]
        ui.editor.viewer.picking = f"{constant}.color"
        ui.wait(2)
        ui.click(inside(ui, 0.3, 0.7))
        assert ui.editor.viewer.picking == ""
        assert ui.session.graph.value(Port(constant, "color"))[:3] == pytest.approx(expected[:3], rel=1e-6)

    gui(body, PRESET)


def test_everything_that_is_hidden_in_a_narrow_panel_is_in_its_menu(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        assert "button viewer.save" not in ui.editor.places
        ui.click("button more tools")
        ui.click("menu viewer.table")
        assert ui.editor.viewer.table

    gui(body, PRESET, size=(600, 600))


def test_slow_pictures_are_coarser_while_something_is_dragged(gui) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.session.select({ElementId("vignette")})
        ui.wait(3)
        ui.editor.viewer.pace.took(1.0, 0.5)
        ui.drag("handle vignette.center", inside(ui, 0.7, 0.25), release=False)
        ui.until(lambda: ui.editor.preview.find_whole_image("A").scale < 1.0)
        assert ui.editor.preview.find_whole_image("A").full_size == (WIDTH, HEIGHT)
        ui.ctx.mouse_up(0)
        ui.settled()
        assert ui.editor.preview.find_whole_image("A").scale == 1.0

    gui(body, PRESET)
