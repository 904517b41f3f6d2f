"""Renders in the real window: dropped, shown in the inspector, overridden; cryptomattes picked by clicking."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from exr_files import write_exr
from halation.authoring.commands import SetValue
from halation.editor.window.dropped_files import take_files
from halation.graph import Port
from halation.presets import sample

SAMPLE = Path(str(sample()))


def drop(ui, path: Path = SAMPLE) -> str:
    """Drop a file on the canvas; the node that it becomes, once its file is known."""
    ui.editor.dialogs.open.clear()
    ui.ask(lambda: take_files(ui.editor, ui.window._contexts.documents, [path]))
    known(ui)
    return ui.session.active


def known(ui) -> None:
    """Wait until all files have been looked at, and all pictures are there."""
    ui.wait(3)
    ui.until(lambda: not ui.editor.renders.is_busy)
    ui.settled()


def press(ui, place: str) -> None:
    """Scroll the inspector to a place, and click it."""
    ui.reveal(place)
    ui.click(place)


def pixels(ui) -> np.ndarray:
    """What the viewer shows, from the graphics card."""
    shown = ui.editor.preview.find_whole_image("A")
    width, height = shown.texture.size
    return ui.ask(lambda: ui.editor.probe.read_region(shown.texture, (0, 0, width, height)))


def test_a_render_that_is_dropped_works_at_once(gui) -> None:
    def body(ui) -> None:
        node = drop(ui)
        assert ui.session.graph.nodes[node].id == "read_render" and len(ui.session.history.steps) == 1
        ui.shot("render.png")
        for name in ("color", "albedo", "depth", "normal", "position", "velocity", "object_id"):
            ui.session.views.show(Port(node, name))
            ui.settled()
            assert ui.editor.preview.find_whole_image("A").port.socket == name and not ui.editor.preview.faults
            assert np.ptp(np.nan_to_num(pixels(ui), posinf=0.0)) > 0.1
        assert "name neon.depth_layer" in ui.editor.places and "name neon.uv_layer" not in ui.editor.places

    gui(body, size=(1400, 1400))


def test_a_plain_picture_stays_one(gui, tmp_path) -> None:
    path = write_exr(tmp_path / "plain.exr", {"RGBA": np.ones((4, 6, 4), np.float32)}, {"RGBA": "float"})

    def body(ui) -> None:
        node = drop(ui, path)
        assert ui.session.graph.nodes[node].id == "read_image"

    gui(body)


def test_another_layer_for_depth_changes_what_is_shown(gui) -> None:
    def body(ui) -> None:
        node = drop(ui)
        ui.session.views.show(Port(node, "depth"))
        ui.settled()
        before = pixels(ui)[..., 0]
        press(ui, f"field {node}.depth_layer")
        ui.until(lambda: f"layer {node}.depth_layer Object Index" in ui.editor.places)
        ui.click(f"layer {node}.depth_layer Object Index")
        known(ui)
        assert ui.session.graph.value(Port(node, "depth_layer")) == "Object Index"
        after = pixels(ui)[..., 0]
        assert set(np.unique(after)) <= set(range(64)) and (before != after).any()
        ui.keys("Ctrl+Z")
        known(ui)
        assert (pixels(ui)[..., 0] == before).all()

        ui.session.apply(SetValue(Port(node, "depth_is"), "inverse"))
        known(ui)
        assert pixels(ui)[..., 0] == pytest.approx(1.0 / before, rel=1e-5)

    gui(body, size=(1400, 1400))


def test_a_layer_that_is_not_there_is_a_sentence(gui) -> None:
    def body(ui) -> None:
        node = drop(ui)
        ui.session.apply(SetValue(Port(node, "depth_layer"), "Depht"))
        known(ui)
        said = ui.editor.preview.faults[node]
        assert "no layer 'Depht': did you mean 'Depth'?" in said
        ui.shot("render_fault.png")
        press(ui, f"field {node}.depth_layer")
        ui.until(lambda: f"layer {node}.depth_layer " in ui.editor.places)
        ui.click(f"layer {node}.depth_layer ")
        known(ui)
        assert not ui.editor.preview.faults and ui.session.graph.value(Port(node, "depth_layer")) == ""

    gui(body, size=(1400, 1400))


def test_what_is_ambiguous_is_listed_and_can_be_used(gui, tmp_path) -> None:
    rng = np.random.default_rng(3)
    layers = {
        "beauty": rng.random((6, 8, 4), np.float32),
        "depth": rng.random((6, 8, 1), np.float32) + 1.0,
        "foo": rng.random((6, 8, 3), np.float32),
        "worldNormals": rng.random((6, 8, 3), np.float32),
        "normalsCS": rng.random((6, 8, 3), np.float32),
    }
    path = write_exr(tmp_path / "open.exr", layers, dict.fromkeys(layers, "float"))

    def body(ui) -> None:
        node = drop(ui, path)
        ui.shot("render_open.png")
        for name in ("foo", "worldNormals", "normalsCS"):
            assert f"button use {node} {name}" in ui.editor.places
        press(ui, f"button use {node} foo")
        ui.click("menu position")
        known(ui)
        assert ui.session.graph.value(Port(node, "position_layer")) == "foo"
        press(ui, f"button use {node} normalsCS")
        ui.click("menu normal")
        known(ui)
        ui.session.views.show(Port(node, "normal"))
        ui.settled()
        assert (pixels(ui)[..., :3] == layers["normalsCS"]).all()
        assert f"button use {node} worldNormals" in ui.editor.places
        ui.shot("render_chosen.png")

    gui(body, size=(1400, 1400))


def strongest(path: Path) -> tuple[np.ndarray, dict[int, str]]:
    """Ids of the first rank straight from the file, and what they are called."""
    import json

    file, part = oiio.ImageInput.open(str(path)), 0
    manifest = json.loads(file.spec().get_string_attribute("cryptomatte/542cafa/manifest"))
    while file.seek_subimage(part, 0):
        if "CryptoObject00" in file.spec().channelnames[0]:
            ranks = np.asarray(file.read_image(part, 0, 0, 4, "float"))
            ids = np.ascontiguousarray(ranks[..., 0]).view(np.uint32)
            return np.where(ranks[..., 1] > 0.0, ids, 0), {int(bits, 16): name for name, bits in manifest.items()}
        part += 1
    raise AssertionError("no cryptomatte")


def test_a_click_picks_what_is_there(gui) -> None:
    ids, names = strongest(SAMPLE)

    def at(name: str) -> tuple[float, float]:
        """The middle of a pixel deep inside an object, as a fraction."""
        inside = np.vectorize(lambda bits: names.get(bits) == name)(ids)
        for _ in range(3):
            inside[1:-1, 1:-1] &= inside[:-2, 1:-1] & inside[2:, 1:-1] & inside[1:-1, :-2] & inside[1:-1, 2:]
        row, column = np.argwhere(inside)[len(np.argwhere(inside)) // 2]
        return (column + 0.5) / ids.shape[1], (row + 0.5) / ids.shape[0]

    def body(ui) -> None:
        render = drop(ui)
        press(ui, f"button matte {render}")
        known(ui)
        node = ui.session.active
        pick = Port(node, "pick")
        ui.session.views.show(Port(node, "colors"))
        ui.settled()
        ui.move("viewer image", at("monkey"))
        known(ui)
        assert "matte name" in ui.editor.places
        steps = len(ui.session.history.steps)
        ui.click("viewer image", fraction=at("monkey"))
        assert ui.session.graph.value(pick) == "monkey"
        ui.click("viewer image", fraction=at("wall"))
        assert ui.session.graph.value(pick) == "monkey, wall" and len(ui.session.history.steps) == steps + 2
        ui.shot("matte.png")
        ui.click("viewer image", fraction=at("monkey"))
        assert ui.session.graph.value(pick) == "wall"
        ui.keys("Ctrl+Z")
        assert ui.session.graph.value(pick) == "monkey, wall"
        x, y = ui.at("viewer image", at("wall"))
        ui.drag((x, y), (x + 30.0, y + 20.0))
        assert ui.session.graph.value(pick) == "monkey, wall" and ui.editor.viewer.pan != (0.0, 0.0)

        press(ui, f"name {pick} ball")
        assert ui.session.graph.value(pick) == "monkey, wall, ball"
        ui.click(f"search {pick}")
        ui.type("ring", enter=False)
        assert [place for place in ui.editor.places if place.startswith(f"name {pick} ")] == [
            f"name {pick} ring_blue",
            f"name {pick} ring_pink",
        ]
        press(ui, f"button None {pick}")
        assert ui.session.graph.value(pick) == ""

    gui(body, size=(1400, 1400))
