"""The inspector: values of the selection are dragged, typed, chosen, reset, linked and exposed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from halation import document
from halation.authoring.commands import AddComment, AddFrame, AddNode, ExposeValue, MakeGroup, ReplaceGraph, SetValue
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.values import find_control
from halation.graph import Graph, Group, Output, Port, Settings
from halation.media import write_picture
from halation.nodes import Kind, catalogue
from halation.resources.sandbox import UNRESTRICTED
from imgui_bundle import imgui
from toy_nodes import Tint


def made() -> Graph:
    """Noise through a grade and a tone map."""
    node = catalogue()
    graph = Graph(settings=Settings((64, 36)))
    for id in ("noise", "grade", "tone_map", "vignette", "convolve3x3"):
        graph = graph.add(id, node[id]())
    graph = graph.add_output("image", Output(Kind.IMAGE, 4))
    for source, target in (
        ("noise.out", "grade.image"),
        ("grade.out", "tone_map.image"),
        ("tone_map.out", "outputs.image"),
        ("noise.value", "tone_map.average"),
    ):
        graph = graph.connect(Port.parse(source), Port.parse(target))
    return graph


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "graph.json"
    document.save(made(), path, sandbox=UNRESTRICTED)
    return path


def value(ui, port: str):
    return ui.session.graph.value(Port.parse(port))


def select(ui, *keys: str) -> int:
    """Select elements; how many steps the history has."""
    ui.session.select([*map(ElementId, keys)])
    ui.wait(3)
    return len(ui.session.history.steps)


def test_a_drag_is_one_step(gui, file) -> None:
    def body(ui) -> None:
        steps = select(ui, "tone_map")
        left, _, right, _ = ui.editor.places["field tone_map.exposure"]
        start, end = ui.at("field tone_map.exposure"), ui.at("field tone_map.exposure", (0.75, 0.5))
        ui.drag(start, end, release=False)
        assert ui.editor.interface.dragging
        ui.ctx.mouse_up(0)
        ui.wait(3)
        assert value(ui, "tone_map.exposure") == pytest.approx(12.0 * (end[0] - start[0]) / (right - left), abs=0.5)
        assert len(ui.session.history.steps) == steps + 1
        ui.keys("Ctrl+Z")
        assert value(ui, "tone_map.exposure") == 0.0
        ui.drag(start, end, release=False)
        ui.keys("Escape")
        ui.ctx.mouse_up(0)
        ui.wait(3)
        assert value(ui, "tone_map.exposure") == 0.0

    gui(body, file)


def test_numbers_are_typed(gui, file) -> None:
    def body(ui) -> None:
        steps = select(ui, "tone_map")
        ui.click("field tone_map.exposure")
        ui.type("-1.5EV")
        assert value(ui, "tone_map.exposure") == -1.5
        ui.click("field tone_map.exposure")
        ui.type("*2+1")
        assert value(ui, "tone_map.exposure") == -2.0
        assert len(ui.session.history.steps) == steps + 2

        ui.click("field tone_map.bias")
        ui.type("7")
        assert value(ui, "tone_map.bias") == 0.85
        ui.keys("Escape")
        assert value(ui, "tone_map.bias") == 0.85

        ui.click("field tone_map.key")
        ui.type("0.25", enter=False)
        ui.ctx.key_press(imgui.Key.up_arrow)
        ui.wait(3)
        assert value(ui, "tone_map.key") == 0.26
        ui.keys("Tab")
        ui.type("20")
        assert (value(ui, "tone_map.key"), value(ui, "tone_map.nits")) == (0.26, 20.0)

    gui(body, file)


def test_what_is_typed_is_kept_when_something_else_is_selected(gui, file) -> None:
    def body(ui) -> None:
        select(ui, "tone_map")
        ui.click("field tone_map.exposure")
        ui.type("3", enter=False)
        ui.session.select([ElementId("grade")])
        ui.wait(3)
        assert value(ui, "tone_map.exposure") == 3.0
        ui.click("field grade.gain", fraction=(0.03, 0.5))
        ui.ctx.item_click("//$FOCUSED/##grade.gain picker light#1")
        ui.wait(3)
        ui.type("0.25", enter=False)
        ui.click("name grade.lift")
        assert value(ui, "grade.gain") == (1.0, 0.25, 1.0, 1.0)

    gui(body, file)


def test_reset_switch_and_choice(gui, file) -> None:
    def body(ui) -> None:
        ui.session.apply(SetValue(Port("tone_map", "bias"), 0.6))
        select(ui, "tone_map")
        ui.double_click("name tone_map.bias")
        assert value(ui, "tone_map.bias") == 0.85
        ui.click("field tone_map.clip", fraction=(0.05, 0.5))
        assert value(ui, "tone_map.clip") is False
        ui.click("field tone_map.operator")
        ui.ctx.key_chars("hab")
        ui.wait(3)
        ui.keys("Enter")
        assert value(ui, "tone_map.operator") == "hable"
        ui.move("field tone_map.operator")
        with ui.held("Ctrl"):
            ui.wheel(1)
        assert value(ui, "tone_map.operator") == "khronos neutral"

    gui(body, file, size=(1400, 1000))


def test_links(gui, file) -> None:
    def body(ui) -> None:
        select(ui, "tone_map")
        ui.click("chip tone_map.average")
        assert ui.session.selection == {"noise"}
        select(ui, "tone_map")
        ui.click("button unlink tone_map.average")
        assert ui.session.graph.links.get(Port("tone_map", "average")) is None
        ui.click("field tone_map.average")
        ui.type("0.5")
        assert value(ui, "tone_map.average") == 0.5

    gui(body, file)


def test_colors(gui, file) -> None:
    def body(ui) -> None:
        steps = select(ui, "grade")
        ui.click("field grade.gain", fraction=(0.03, 0.5))
        ui.ctx.item_click("//$FOCUSED/##grade.gain picker hex")
        ui.wait(3)
        ui.type("#ff0000")
        assert value(ui, "grade.gain") == (1.0, 0.0, 0.0, 1.0)
        ui.ctx.item_click("//$FOCUSED/##grade.gain picker stops")
        ui.wait(3)
        ui.type("2")
        assert value(ui, "grade.gain") == (4.0, 0.0, 0.0, 1.0)
        assert len(ui.session.history.steps) == steps + 2
        ui.click("button pick grade.gain picker")
        assert ui.editor.viewer.picking == "grade.gain"

    gui(body, file)


def test_controls(gui, file) -> None:
    def body(ui) -> None:
        select(ui, "tone_map")
        ui.click("name tone_map.exposure", button=1)
        ui.click("menu Expose as Control")
        assert find_control(ui.session.graph, Port("tone_map", "exposure")) == "exposure"
        ui.click("button control tone_map.exposure")
        ui.type("brightness")
        assert find_control(ui.session.graph, Port("tone_map", "exposure")) == "brightness"
        select(ui)
        ui.click("field tone_map.exposure")
        ui.type("2")
        assert value(ui, "tone_map.exposure") == 2.0

    gui(body, file)


def test_several_nodes_are_changed_together(gui, file) -> None:
    def body(ui) -> None:
        ui.session.apply(SetValue(Port("vignette", "amount"), 0.25))
        steps = select(ui, "grade", "vignette")
        ui.click("field vignette.amount")
        ui.type("*0.5")
        assert (value(ui, "grade.amount"), value(ui, "vignette.amount")) == (0.5, 0.125)
        assert len(ui.session.history.steps) == steps + 1
        ui.double_click("name vignette.amount")
        assert (value(ui, "grade.amount"), value(ui, "vignette.amount")) == (1.0, 0.5)

    gui(body, file)


def test_names_ends_and_groups(gui, file) -> None:
    def body(ui) -> None:
        select(ui, "noise")
        ui.click("field noise name")
        ui.type("grain")
        assert "grain" in ui.session.graph.nodes
        select(ui, "outputs.image")
        assert not ui.editor.faults
        ui.click("field outputs.image layer")
        ui.type("beauty")
        assert ui.session.graph.outputs["image"].layer == "beauty"
        select(ui)
        ui.click("field size", fraction=(0.2, 0.5))
        ui.type("128")
        assert ui.session.graph.settings.size == (128, 36)
        select(ui, "grade", "vignette")
        id = ui.session.apply(MakeGroup())
        assert isinstance(ui.session.graph.nodes[id], Group)
        select(ui, id)
        ui.click(f"button enter {id}")
        assert ui.session.place == (id,)

    gui(body, file)


def test_files(gui, tmp_path: Path) -> None:
    picture = tmp_path / "picture.exr"
    write_picture(
        picture,
        {"beauty": np.full((8, 16, 4), 0.5, np.float32), "depth": np.ones((8, 16, 1), np.float32)},
        kinds={"beauty": Kind.IMAGE, "depth": Kind.FIELD},
        sandbox=UNRESTRICTED,
    )
    path = tmp_path / "graph.json"
    document.save(Graph().add("read", catalogue()["read_image"]()), path, sandbox=UNRESTRICTED)

    def body(ui) -> None:
        select(ui, "read")
        ui.click("field read.path", fraction=(0.2, 0.5))
        ui.type("pictur.exr")
        ui.click("field read.path", fraction=(0.2, 0.5))
        ui.type("picture.exr")
        ui.wait(30)
        ui.click("field read.layer")
        ui.wait(5)
        ui.ctx.item_click("//$FOCUSED/##layer depth")
        ui.wait(3)
        assert value(ui, "read.layer") == "depth"
        ui.click("button browse read.path")
        assert ui.editor.dialogs.browse is not None

    gui(body, path)


def test_positions_are_put_on_the_picture(gui, file) -> None:
    def body(ui) -> None:
        graph = ui.session.graph.connect(Port("tone_map", "out"), Port("vignette", "image"))
        ui.session.apply(ReplaceGraph("Link", graph.connect(Port("vignette", "out"), Port("outputs", "image"))))
        select(ui, "vignette")
        ui.settled()
        ui.click("button place vignette.center")
        assert ui.editor.viewer.picking == "vignette.center"
        left, top, right, bottom = ui.editor.places["viewer image"]
        ui.click((left + (right - left) * 0.25, top + (bottom - top) * 0.75))
        assert value(ui, "vignette.center") == pytest.approx((0.25, 0.75), abs=0.03)
        assert ui.editor.viewer.picking == ""

    gui(body, file)


def test_curves_and_ramps(gui, file) -> None:
    def body(ui) -> None:
        ui.session.apply(ReplaceGraph("Add", ui.session.graph.add("tint", Tint())))
        steps = select(ui, "tint")
        ui.drag(ui.at("field tint.curve", (0.5, 0.2)), ui.at("field tint.curve", (0.5, 0.55)))
        curve = value(ui, "tint.curve")
        assert (len(curve), len(ui.session.history.steps)) == (6, steps + 1)
        assert curve[2] == pytest.approx(0.5, abs=0.02) and 0.2 < curve[3] < 0.5
        ui.click("field tint.curve", button=1, fraction=(0.5, 0.55))
        assert value(ui, "tint.curve") == (0.0, 0.0, 1.0, 1.0)
        ui.click("field tint.ramp", fraction=(0.5, 0.15))
        assert len(value(ui, "tint.ramp")) == 15
        assert value(ui, "tint.ramp")[5:] == pytest.approx((0.5, 0.5, 0.5, 0.5, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0), abs=0.02)
        ui.shot("curves.png")

    gui(body, file, size=(1400, 1200))


def test_it_draws_every_node(gui, file) -> None:
    def body(ui) -> None:
        for id, kind in catalogue().items():
            node = ui.session.apply(AddNode(id))
            for name in (*kind.values,)[:1]:
                ui.session.apply(ExposeValue(Port(node, name)))
            select(ui, node)
            assert not ui.editor.faults, id
            ui.session.apply(ReplaceGraph("again", made()))  # a canvas with all nodes takes three times as long
        ui.session.apply(AddFrame("around"))
        select(ui, "frames.f1")
        ui.session.apply(AddComment((0.0, 0.0), "words"))
        select(ui, "comments.c1")
        select(ui)
        assert not ui.editor.faults

    gui(body, file)


def test_the_graph_itself(gui, file) -> None:
    def body(ui) -> None:
        select(ui)
        ui.click("button add input")
        ui.click("menu Field")
        assert ui.session.graph.inputs["field"].kind is Kind.FIELD
        ui.session.bind("field", "depth.exr")
        select(ui, "inputs.field")
        ui.click("field inputs.field name")
        ui.type("depth")
        ui.click("field inputs.depth doc")
        ui.type("How far away.")
        assert ui.session.graph.inputs["depth"].doc == "How far away."
        assert ui.session.bindings == {"depth": "depth.exr"}
        ui.click("chip inputs.depth bound")
        assert ui.session.bindings == {}
        select(ui)
        ui.click("button remove inputs.depth")
        assert not ui.session.graph.inputs
        ui.session.apply(ExposeValue(Port("grade", "amount")))
        ui.wait(3)
        ui.click("more controls.amount", fraction=(0.1, 0.5))
        ui.click("field controls.amount name")
        ui.type("strength")
        assert list(ui.session.graph.controls) == ["strength"]
        assert not ui.editor.faults

    gui(body, file, size=(1400, 1200))


def test_values_pass_the_clipboard(gui, file) -> None:
    def body(ui) -> None:
        select(ui, "grade")
        ui.session.apply(SetValue(Port("grade", "gain"), (2.0, 1.0, 0.5, 1.0)))
        ui.wait(3)
        ui.click("name grade.gain", button=1)
        ui.click("menu Copy Value")
        ui.click("name grade.lift", button=1)
        ui.click("menu Paste Value")
        assert value(ui, "grade.lift") == (2.0, 1.0, 0.5, 1.0)
        ui.click("name grade.amount", button=1)
        ui.click("menu Paste Value")
        assert value(ui, "grade.amount") == 1.0
        assert "takes a number" in ui.editor.log.entries[-1].sentence

    gui(body, file)


def test_keys_go_where_the_pointer_is_after_a_slider_was_dragged(gui, file) -> None:
    def body(ui) -> None:
        select(ui, "tone_map")
        ui.drag(ui.at("field tone_map.exposure"), ui.at("field tone_map.exposure", (0.75, 0.5)))
        ui.move("node tone_map", (1.3, 0.7))
        ui.wait(2)
        place = ui.editor.places["node tone_map"]
        ui.wheel(-3)
        ui.settled()
        assert ui.editor.places["node tone_map"] != place
        ui.keys("Home")
        ui.settled()
        assert ui.editor.places["node tone_map"] == pytest.approx(place, abs=1.0)
        ui.drag(ui.at("field tone_map.exposure", (0.75, 0.5)), ui.at("field tone_map.exposure"))
        ui.move("node tone_map", (1.3, 0.7))
        ui.keys("Tab")
        ui.wait(3)
        assert "search fxaa" in ui.editor.places

    gui(body, file)
