"""Lights in the inspector: rows, buttons, menus, and the fields of the selected one."""

from __future__ import annotations

from halation.authoring.commands import ReplaceGraph
from halation.authoring.edits.element_id import ElementId
from halation.graph import Graph, Port
from halation.nodes import Light, LightKind, catalogue, lights_of, number_lights
from toy_nodes import Lamps, Tint


def start(ui, *lights: Light) -> int:
    """Add a node with lights, and select it; how many steps the history has."""
    node = Lamps(lights=number_lights(lights)) if lights else Lamps()
    graph = Graph().add("lamps", node).add("tint", Tint())
    for id in ("convolve3x3", "vignette"):
        graph = graph.add(id, catalogue()[id]())
    ui.session.apply(ReplaceGraph("Add", graph))
    ui.editor.dialogs.open.clear()
    return select(ui, "lamps")


def select(ui, key: str) -> int:
    ui.session.select([ElementId(key)])
    ui.wait(3)
    return len(ui.session.history.steps)


def of(ui) -> tuple[Light, ...]:
    """The lights of the node."""
    return lights_of(ui.session.graph.value(Port("lamps", "lights")))


def names(ui) -> list[str]:
    """The names of the lights of the node."""
    return [*ui.session.graph.value(Port("lamps", "lights"))]


def test_lights(gui) -> None:
    def body(ui) -> None:
        steps = start(ui)

        ui.click("button add lamps.lights")
        ui.click("menu Sun")
        assert names(ui) == ["lamp_1", "sun_1"] and of(ui)[1].kind is LightKind.SUN
        assert "name lamps.lights.sun_1.reach" not in ui.editor.places
        ui.click("field lamps.lights.sun_1.kind")
        ui.ctx.item_click("//$FOCUSED/spot##1")
        ui.wait(3)
        assert (of(ui)[1].kind, of(ui)[1].intensity) == (LightKind.SPOT, 10.0)
        assert len(ui.session.history.steps) == steps + 2

        ui.reveal("field lamps.lights.sun_1.intensity")
        x, y = ui.at("field lamps.lights.sun_1.intensity")
        ui.drag((x, y), (x - 90.0, y))
        assert of(ui)[1].intensity < 0.0
        assert len(ui.session.history.steps) == steps + 3
        ui.keys("Ctrl+Z")
        assert of(ui)[1].intensity == 10.0
        inner = "field lamps.lights.sun_1.inner"
        ui.reveal(inner)
        ui.drag(inner, ui.at(inner, (1.0, 0.5)), release=False)
        assert of(ui)[1].inner > 30.0
        ui.keys("Escape")
        ui.ctx.mouse_up(0)
        ui.wait(3)
        assert (of(ui)[1].inner, of(ui)[1].outer) == (20.0, 30.0)

        ui.reveal("field lamps.lights.sun_1.reach")
        ui.click("field lamps.lights.sun_1.reach")
        ui.type("7", enter=False)
        ui.reveal("item lamps.lights lamp_1")
        ui.click("item lamps.lights lamp_1")
        assert [light.reach for light in of(ui)] == [0.0, 7.0]
        ui.click("on lamps.lights sun_1")
        assert [light.on for light in of(ui)] == [True, False]
        ui.click("solo lamps.lights lamp_1")
        assert [light.solo for light in of(ui)] == [True, False]
        ui.click("item lamps.lights sun_1")
        ui.reveal("name lamps.lights.sun_1.reach")
        ui.double_click("name lamps.lights.sun_1.reach")
        assert of(ui)[1].reach == 0.0
        ui.reveal("field lamps.lights.sun_1 name")
        ui.click("field lamps.lights.sun_1 name")
        ui.keys("Ctrl+A")
        ui.type("beam")
        assert names(ui) == ["beam", "lamp_1"] and ui.editor.items["lamps.lights"] == "beam"
        ui.click("button duplicate lamps.lights")
        assert names(ui) == ["beam", "beam_2", "lamp_1"] and of(ui)[0] == of(ui)[1]
        for _ in range(3):
            ui.click("button remove lamps.lights")
        assert of(ui) == () and not ui.editor.faults
        ui.double_click("name lamps.lights")
        assert of(ui) == (Light(),)

    gui(body, size=(1400, 900))


def test_a_field_of_a_light_gets_keys(gui) -> None:
    def body(ui) -> None:
        start(ui, Light(intensity=3.0), Light())
        ui.click("diamond lamps.lights.lamp_1.intensity")
        port = Port("lamps", "lights.lamp_1.intensity")
        assert ui.session.graph.animation[port].evaluate(1) == 3.0
        ui.click("item lamps.lights lamp_2")
        ui.click("button remove lamps.lights")
        assert port in ui.session.graph.animation

    gui(body, size=(1400, 1200))


def test_the_values_of_a_light_pass_the_clipboard(gui) -> None:
    def body(ui) -> None:
        start(ui, Light(intensity=3.0))
        ui.click("name lamps.lights.lamp_1.intensity", button=1)
        ui.click("menu Copy Value")
        for name in ("intensity", "reach", "place"):
            ui.click(f"name lamps.lights.lamp_1.{name}", button=1)
            ui.click("menu Reset" if name == "intensity" else "menu Paste Value")
        assert of(ui) == (Light(reach=3.0),)
        assert "lamps.lights.lamp_1.place: 3.0 does not fit" in ui.editor.log.entries[-1].sentence

    gui(body)


def test_many_lights_are_scrolled_to(gui) -> None:
    def body(ui) -> None:
        start(ui, *(Light(),) * 1024)
        left, top, right, bottom = ui.editor.places["field lamps.lights"]
        assert bottom - top < (right - left) * 1.2
        drawn = [place for place in ui.editor.places if place.startswith("item lamps.lights ")]
        assert len(drawn) <= 10
        ui.click("item lamps.lights lamp_7")
        ui.click("button remove lamps.lights")
        ui.click("item lamps.lights lamp_8")
        for _ in range(3):
            ui.click("button duplicate lamps.lights")
        assert len(of(ui)) == 1024
        assert ui.editor.places["item lamps.lights lamp_7"][3] <= ui.editor.places["button add lamps.lights"][1] + 1
        ui.wheel(-100)

    gui(body)
