"""How a graph manages color, in the editor: the panel of the graph, the inspector of a file, the menu of views."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from halation.authoring.commands import SetColorSettings, SetInput
from halation.authoring.edits.element_id import ElementId
from halation.color.management import get_color_manager
from halation.media import read_layer
from halation.nodes import ColorSettings, Kind
from halation.resources.sandbox import UNRESTRICTED
from house_config import HOUSE, write_house
from OpenImageIO import ImageOutput, ImageSpec


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A graph that shows a picture whose name a file rule of the house config knows."""
    monkeypatch.delenv("OCIO", raising=False)
    write_house(tmp_path)
    spec = ImageSpec(64, 36, 3, "float")
    made = ImageOutput.create(str(tmp_path / "plates_a.exr"))
    assert made.open(str(tmp_path / "plates_a.exr"), spec)
    made.write_image(np.linspace(0.2, 0.7, 64 * 36 * 3, dtype=np.float32).reshape(36, 64, 3))
    made.close()
    tree = {
        "halation": 1,
        "inputs": {"beauty": {"type": "Image", "file": "plates_a.exr"}},
        "outputs": {"image": {"type": "Image"}},
        "nodes": {"e": {"type": "exposure"}},
        "links": {"e.image": "inputs.beauty", "outputs.image": "e.out"},
    }
    path = tmp_path / "graph.json"
    path.write_text(json.dumps(tree))
    return path


def middle(ui) -> np.ndarray:
    """The pixel in the middle of the picture that is seen."""
    shown = ui.editor.preview.find_whole_image("A")
    assert shown is not None
    return ui.ask(lambda: np.array(ui.editor.probe.read_pixel(shown.texture, 32, 18)))[:3]


def test_config_and_working_space(gui, file, tmp_path) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.session.select(())
        ui.wait(3)
        assert "field color config" in ui.editor.places and "field working space" in ui.editor.places
        before = middle(ui)
        ui.session.apply(SetColorSettings(config="house.ocio"))
        ui.session.apply(SetColorSettings(working="scene_linear"))
        ui.settled()
        color = ColorSettings(str(tmp_path / "house.ocio"), "scene_linear")
        manager = get_color_manager(color, UNRESTRICTED)
        plate = read_layer(tmp_path / "plates_a.exr", "", Kind.IMAGE, manager=manager, sandbox=UNRESTRICTED)
        expected = plate.array[18, 32, :3]
        assert np.allclose(middle(ui), expected, rtol=2e-3) and not np.allclose(before, expected, rtol=0.1)
        assert ui.editor.coloring.manager is manager and not ui.editor.coloring.fault
        ui.editor.viewer.view, ui.editor.viewer.display = "Warm", "Screen"
        ui.wait(4)
        ui.click("button view")
        ui.wait(3)
        ui.shot("color_views")
        ui.keys("Escape")
        ui.keys("Ctrl+Z")
        ui.settled()
        assert ui.session.root.settings.color.working == ""

    gui(body, file)


def test_the_space_of_a_file_is_said_and_can_be_chosen(gui, file) -> None:
    def body(ui) -> None:
        ui.session.apply(SetColorSettings(config="house.ocio"))
        ui.session.select((ElementId("inputs.beauty"),))
        ui.settled()
        before = middle(ui)
        ui.session.apply(SetInput("beauty", color_space="house dim"))
        ui.settled()
        assert not np.allclose(middle(ui), before, rtol=0.05)
        ui.shot("color_input")
        ui.click("field inputs.beauty space")
        ui.wait(3)
        ui.shot("color_spaces")
        ui.keys("Escape")

    gui(body, file)


def test_a_broken_config_is_said_and_nothing_stops(gui, file, tmp_path) -> None:
    def body(ui) -> None:
        ui.settled()
        ui.session.select(())
        ui.session.apply(SetColorSettings(config="gone.ocio"))
        ui.wait(10)
        assert "there is no such color config" in ui.editor.coloring.fault
        ui.shot("color_broken")
        ui.click("button view")
        ui.keys("Escape")
        write_house(tmp_path, "gone.ocio", HOUSE)
        ui.wait(10)
        assert not ui.editor.coloring.fault
        ui.session.apply(SetColorSettings(config=""))
        ui.settled()

    gui(body, file)


def test_a_broken_environment_is_survived(gui, file, monkeypatch) -> None:
    monkeypatch.setenv("OCIO", "/gone.ocio")

    def body(ui) -> None:
        ui.wait(20)
        assert "$OCIO" in ui.editor.coloring.fault
        assert "$OCIO" in (ui.editor.preview.fault("A") or "")
        ui.click("button view")
        ui.keys("Escape")
        ui.session.select((ElementId("inputs.beauty"),))
        ui.wait(5)

    gui(body, file)
