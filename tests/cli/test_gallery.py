"""`halation gallery`: contact sheets, and the one that the README shows.

After a change that is meant to be seen, or with new nodes, renew docs/images:
    HALATION_RENEW=1 python -m pytest tests/cli/test_gallery.py
"""

from __future__ import annotations

import os
from pathlib import Path
from types import MappingProxyType

import cv2
import numpy as np
import OpenImageIO as oiio
import pytest
from halation import document, nodes, presets
from halation.cli import gallery
from halation.graph import Graph, problems
from halation.media.comparison.contact_sheet import write_sheet
from halation.nodes import Kind, Node, Source, catalogue
from halation.presets import sample
from halation.reference import specimen
from halation.renderer import Renderer
from halation.resources.sandbox import UNRESTRICTED

RENEW = bool(os.environ.get("HALATION_RENEW"))
IMAGES = Path(__file__).parents[2] / "docs" / "images"
EVERY = 18
"""Of so many pictures of a sheet one is made again."""
ROW = "heartbeat"
"""The animated preset whose row is made again: it renders in half a second, and no two of its pictures are alike."""
STAND_IN = np.full((270, 480, 3), (1.0, 0.0, 1.0), np.float32)
"""What a sheet shows in place of a picture that is not made again."""


def described(file: Path) -> list[str]:
    """What a sheet says that it shows."""
    return oiio.ImageBuf(str(file)).spec()["ImageDescription"].split(", ")


def test_it_writes_three_sheets(cli, graphs, tmp_path, monkeypatch):
    few = MappingProxyType({id: catalogue()[id] for id in ("exposure", "luminance_statistics", "noise")})
    moving = graphs("two.json", settings={"frames": [1, 8]})
    monkeypatch.setattr(presets, "paths", lambda: (graphs("one.json"), moving))
    monkeypatch.setattr(nodes, "catalogue", lambda: few)
    folder = tmp_path / "a" / "b"
    result = cli("gallery", "-o", folder)
    assert (result.code, result.out) == (0, "")
    assert {item.name for item in folder.iterdir()} == {"nodes.jpg", "presets.jpg", "time.jpg"}
    assert described(folder / "nodes.jpg") == [*few] and described(folder / "presets.jpg") == ["one", "two"]
    assert described(folder / "time.jpg") == ["two"]
    lines = result.err.splitlines()
    assert len(lines) == 4 and lines[1].startswith("presets ") and lines[3].endswith(str(folder / "nodes.jpg"))
    found = cli("gallery", "--output", folder, "--json").json["sheets"]
    assert [(item["sheet"], item["pictures"]) for item in found] == [
        (str(folder / "presets.jpg"), ["one", "two"]),
        (str(folder / "time.jpg"), ["two"]),
        (str(folder / "nodes.jpg"), [*few]),
    ]


def test_it_says_where_it_cannot_write(cli, shot):
    result = cli("gallery", "-o", shot / "out")
    assert result.code == 1 and result.err.startswith(f"halation: {shot / 'out'}: the folder cannot be created (")


@pytest.mark.parametrize("id", catalogue())
def test_every_node_has_all_that_it_needs(id):
    graph = specimen.show_on_sample(catalogue()[id], sample())
    assert [problem for problem in problems(graph) if problem.severity == "error"] == []
    drawn = specimen.drawable_outputs(catalogue()[id])
    assert (*graph.outputs,) == (drawn[:1] if issubclass(catalogue()[id], Source) else drawn)
    needed = {name for name, socket in catalogue()[id].inputs.items() if not socket.optional}
    assert needed <= {target.socket for target in graph.links if target.node == specimen.NODE}


def test_what_a_node_makes_is_made_visible(renderer: Renderer) -> None:
    """Light through the view, what is finished as it is, data by its range, numbers in words."""

    def made(id: str) -> np.ndarray:
        return gallery.render_node(catalogue()[id], renderer, sample())

    assert made("tone_map").mean() > 0.1
    assert np.allclose(made("ramp")[100, (0, -1)], [[0.0] * 3, [1.0] * 3], atol=0.01)
    distance = made("distance_field")
    assert distance.min() == 0.0 and distance.max() == 1.0 and np.ptp(distance, axis=2).max() == 0.0
    assert made("luminance_statistics").max() > 0.7 > 0.1 > np.median(made("luminance_statistics"))
    assert gallery.to_display_light(Kind.VECTOR, np.array([[[0.0, 0.0, 1.0]]], np.float32)) == pytest.approx(
        np.array([[[0.214, 0.214, 1.0]]]), abs=1e-3
    )


def compare(name: str, sheet: gallery.Sheet, folder: Path) -> None:
    """Mean difference below 6/255 around every point, but for what stands in for a picture: devices round differently.

    Around it JPEG mixes colors, so the comparison keeps away by a block.
    """
    red, green, blue = (sheet.light[..., channel] for channel in range(3))
    stands_in = (red > 0.99) & (green < 0.01) & (blue > 0.99)
    where = cv2.dilate(stands_in.astype(np.uint8), np.ones((33, 33), np.uint8)) == 0
    write_sheet(folder / "sheet.jpg", sheet.light, sandbox=UNRESTRICTED)
    there, made = cv2.imread(str(IMAGES / f"{name}.jpg")), cv2.imread(str(folder / "sheet.jpg"))
    assert there.shape == made.shape and stands_in.any() and where.mean() > 0.05
    difference = cv2.absdiff(there, made).max(2) * where.astype(np.float32)
    assert cv2.blur(difference, (99, 99)).max() < 6.0, "it looks otherwise now: look at it, then renew it"


@pytest.fixture(scope="module", autouse=RENEW)
def renewed(renderer: Renderer) -> None:
    makers = {"nodes": gallery.make_node_sheet, "presets": gallery.make_preset_sheet, "time": gallery.make_time_sheet}
    for name, make in makers.items():
        sheet = make(renderer)
        write_sheet(IMAGES / f"{name}.jpg", sheet.light, ", ".join(sheet.names), sandbox=UNRESTRICTED)


def test_the_sheet_of_presets_is_current(renderer: Renderer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Some pictures are made again and compared: thumbnails hold how each preset looks."""
    paths, frames_of = presets.paths(), gallery.render_display_frames
    assert described(IMAGES / "presets.jpg") == [path.stem for path in paths]
    assert (IMAGES / "presets.jpg").stat().st_size < 900_000
    chosen = [document.load(path, sandbox=UNRESTRICTED) for path in paths[::EVERY]]

    def some(graph: Graph, engine: Renderer, frames: list[int]) -> dict[int, np.ndarray]:
        if graph in chosen:
            return frames_of(graph, engine, frames)
        return dict.fromkeys(frames, STAND_IN)

    monkeypatch.setattr(gallery, "render_display_frames", some)
    compare("presets", gallery.make_preset_sheet(renderer), tmp_path)


def test_the_sheet_of_time_is_current(renderer: Renderer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One row is made again and compared."""
    names, frames_of = described(IMAGES / "time.jpg"), gallery.render_display_frames
    assert names == [*gallery.load_animated_presets()] and (IMAGES / "time.jpg").stat().st_size < 900_000
    chosen = gallery.load_animated_presets()[ROW]

    def some(graph: Graph, engine: Renderer, frames: list[int]) -> dict[int, np.ndarray]:
        if graph == chosen:
            return frames_of(graph, engine, frames)
        return dict.fromkeys(frames, STAND_IN)

    monkeypatch.setattr(gallery, "render_display_frames", some)
    compare("time", gallery.make_time_sheet(renderer), tmp_path)


@pytest.mark.large
def test_the_sheet_of_nodes_is_current(renderer: Renderer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It may lack nodes that are newer. Some pictures are made again and compared."""
    ids, picture_of = tuple(described(IMAGES / "nodes.jpg")), gallery.render_node
    assert {*ids} <= {*catalogue()} and (IMAGES / "nodes.jpg").stat().st_size < 10_000 * len(ids)

    def some(node: type[Node], engine: Renderer, sample: Path) -> np.ndarray:
        if node.id in ids[::EVERY]:
            return picture_of(node, engine, sample)
        return STAND_IN

    monkeypatch.setattr(gallery, "render_node", some)
    compare("nodes", gallery.make_node_sheet(renderer, ids=ids), tmp_path)
