"""Lights in the inspector: rows, buttons, menus, and the fields of the selected one."""

from __future__ import annotations

from halation.authoring.commands import ReplaceGraph
from halation.authoring.edits.element_id import ElementId
from halation.graph import Graph, Port
from halation.nodes import Light, LightKind, catalogue, lights_of, numbers_of
from toy_nodes import Lamps, Tint


def start(ui, *lights: Light) -> int:
    """Add a node with lights, and select it; how many steps the history has."""
    node = Lamps(lights=numbers_of(lights)) if lights else Lamps()
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


def test_lights(gui) -> None:
    def body(ui) -> None:
        steps = start(ui)

        ui.click("button add lamps.lights")
        ui.click("menu Sun")
        assert [light.kind for light in of(ui)] == [LightKind.POINT, LightKind.SUN]
        assert "name lamps.lights 1 reach" not in ui.editor.places
        ui.click("field lamps.lights 1 kind")
        ui.ctx.item_click("//$FOCUSED/Spot##1")
        ui.wait(3)
        assert (of(ui)[1].kind, of(ui)[1].intensity) == (LightKind.SPOT, 10.0)
        assert len(ui.session.history.steps) == steps + 2

        x, y = ui.at("field lamps.lights 1 intensity")
        ui.drag((x, y), (x - 90.0, y))
        assert of(ui)[1].intensity < 0.0
        assert len(ui.session.history.steps) == steps + 3
        ui.keys("Ctrl+Z")
        assert of(ui)[1].intensity == 10.0
        ui.drag("field lamps.lights 1 inner", ui.at("field lamps.lights 1 inner", (1.0, 0.5)), release=False)
        assert of(ui)[1].inner == of(ui)[1].outer > 30.0
        ui.keys("Escape")
        ui.ctx.mouse_up(0)
        ui.wait(3)
        assert (of(ui)[1].inner, of(ui)[1].outer) == (20.0, 30.0)

        ui.click("field lamps.lights 1 reach")
        ui.type("7", enter=False)
        ui.click("light lamps.lights 0")
        assert [light.reach for light in of(ui)] == [0.0, 7.0]
        ui.click("eye lamps.lights 1")
        assert [light.on for light in of(ui)] == [True, False]
        ui.click("light lamps.lights 1", button=1)
        ui.click("menu Move Up")
        assert [light.kind for light in of(ui)] == [LightKind.SPOT, LightKind.POINT]
        ui.double_click("name lamps.lights 0 reach")
        assert of(ui)[0].reach == 0.0
        ui.click("button remove lamps.lights")
        ui.click("button remove lamps.lights")
        assert of(ui) == () and not ui.editor.faults
        ui.double_click("name lamps.lights")
        assert of(ui) == (Light(),)

    gui(body, size=(1400, 1200))


def test_the_values_of_a_light_pass_the_clipboard(gui) -> None:
    def body(ui) -> None:
        start(ui, Light(intensity=3.0))
        ui.click("name lamps.lights 0 intensity", button=1)
        ui.click("menu Copy Value")
        for name in ("intensity", "reach", "place"):
            ui.click(f"name lamps.lights 0 {name}", button=1)
            ui.click("menu Reset" if name == "intensity" else "menu Paste Value")
        assert of(ui) == (Light(reach=3.0),)
        assert "place: 3.0 does not fit" in ui.editor.log.entries[-1].sentence

    gui(body)


def test_many_lights_are_scrolled_to(gui) -> None:
    def body(ui) -> None:
        start(ui, *(Light(),) * 1024)
        left, top, right, bottom = ui.editor.places["field lamps.lights"]
        assert bottom - top < (right - left) * 1.2
        drawn = [place for place in ui.editor.places if place.startswith("light lamps.lights ")]
        assert len(drawn) <= 10
        ui.click("light lamps.lights 6")
        ui.click("button remove lamps.lights")
        ui.click("light lamps.lights 7")
        for _ in range(3):
            ui.click("button duplicate lamps.lights")
        assert len(of(ui)) == 1024
        assert ui.editor.places["light lamps.lights 8"][3] <= ui.editor.places["button add lamps.lights"][1] + 1
        ui.wheel(-100)

    gui(body)
