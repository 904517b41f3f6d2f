"""Color wheels of the inspector, and temperature and swatches of the picker, by mouse and keyboard."""

from __future__ import annotations

from pathlib import Path

import pytest
from gui_driver import Ui
from halation import document
from halation.authoring.commands import ReplaceGraph
from halation.authoring.edits.element_id import ElementId
from halation.graph import Graph, Key, Keys, Output, Port, Settings
from halation.nodes import Kind, catalogue
from halation.resources.sandbox import UNRESTRICTED

GAIN = Port("grade", "gain")
KELVIN = "//$FOCUSED/##grade.gain picker kelvin"


@pytest.fixture
def look(tmp_path: Path) -> Path:
    graph = Graph(settings=Settings((64, 36), frames=(1, 10)), outputs={"image": Output(Kind.IMAGE)})
    graph = graph.add("board", catalogue()["checker"]()).add("grade", catalogue()["grade"]())
    graph = graph.connect(Port("board", "out"), Port("grade", "image"))
    graph = graph.connect(Port("grade", "out"), Port("outputs", "image"))
    document.save(graph, tmp_path / "graph.json", sandbox=UNRESTRICTED)
    return tmp_path / "graph.json"


def start(ui: Ui) -> int:
    ui.session.select([ElementId("grade")])
    ui.settled()
    return len(ui.session.history.steps)


def edit(ui: Ui, graph: Graph) -> None:
    ui.session.apply(ReplaceGraph("Change", graph))
    ui.session.seal()


def beside(ui: Ui, place: str, x: float, y: float) -> tuple[float, float]:
    """A point at a distance from the middle of a place, in pixels."""
    across, down = ui.at(place)
    return across + x, down + y


def test_a_wheel_moves_the_balance_and_its_number_the_level(gui, look: Path) -> None:
    def body(ui: Ui) -> None:
        steps = start(ui)
        ui.drag("wheel grade.gain", beside(ui, "wheel grade.gain", 24.0, 0.0))
        red, green, blue, alpha = ui.session.graph.value(GAIN)
        assert red > 1.05 and green == pytest.approx(blue, abs=0.01) and green < 1.0 and alpha == 1.0
        assert (red + green + blue) / 3.0 == pytest.approx(1.0) and len(ui.session.history.steps) == steps + 1
        ui.shot("wheels.png")
        ui.click("wheel grade.gain level")
        ui.type("1.5")
        assert ui.session.graph.value(GAIN)[:3] == pytest.approx((red + 0.5, green + 0.5, blue + 0.5))
        ui.double_click("wheel grade.gain")
        assert ui.session.graph.value(GAIN) == pytest.approx((1.5, 1.5, 1.5, 1.0))
        steps = len(ui.session.history.steps)
        ui.drag("wheel grade.lift", beside(ui, "wheel grade.lift", 0.0, 30.0), release=False)
        assert ui.session.graph.value(Port("grade", "lift")) != (0.0, 0.0, 0.0, 0.0)
        ui.keys("Escape")
        ui.ctx.mouse_up(0)
        ui.wait(3)
        assert ui.session.graph.value(Port("grade", "lift")) == (0.0, 0.0, 0.0, 0.0)
        assert len(ui.session.history.steps) == steps

    gui(body, look)


def test_a_wheel_sets_keys_and_steps_aside_for_a_link(gui, look: Path) -> None:
    def body(ui: Ui) -> None:
        start(ui)
        grey = (1.0, 1.0, 1.0, 1.0)
        edit(ui, ui.session.graph.animate(GAIN, Keys((Key(1, grey), Key(9, grey)))))
        ui.session.time.seek(5)
        ui.settled()
        ui.drag("wheel grade.gain", beside(ui, "wheel grade.gain", -20.0, 0.0))
        keys = ui.session.graph.animation[GAIN]
        assert keys.frames == (1.0, 5.0, 9.0) and keys.keys[1].value[0] < 1.0
        edit(ui, ui.session.graph.connect(Port("board", "out"), Port("grade", "lift")))
        ui.wait(3)
        assert "wheel grade.lift" not in ui.editor.places and "wheel grade.gamma" in ui.editor.places

    gui(body, look)


def test_the_picker_takes_a_temperature_and_keeps_colors(gui, look: Path) -> None:
    def body(ui: Ui) -> None:
        start(ui)
        ui.click("field grade.gain", fraction=(0.03, 0.5))
        ui.ctx.item_click(KELVIN)
        ui.wait(3)
        ui.type("2856")
        warm = ui.session.graph.value(GAIN)
        assert warm[0] > 1.0 > warm[1] > warm[2]
        ui.click("button keep grade.gain picker")
        assert ui.editor.store.current.swatches == (warm,)
        ui.wait(2)
        ui.shot("picker.png")
        ui.ctx.item_click(KELVIN)
        ui.wait(3)
        ui.type("9000")
        assert ui.session.graph.value(GAIN)[2] > 1.0
        ui.click("swatch grade.gain picker 0")
        assert ui.session.graph.value(GAIN) == warm
        ui.click("swatch grade.gain picker 0", button=1)
        assert ui.editor.store.current.swatches == ()

    gui(body, look)
