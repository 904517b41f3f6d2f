"""OpenEXR's own test images of display windows: the same pixels within the frame, partly, and wholly outside."""

from __future__ import annotations

import tarfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.graph import Graph, Input, Output, Port, Settings
from halation.nodes import catalogue
from halation.renderer import Renderer, RenderRequest
from halation.renderer.jobs.job import OutputSettings, run_job
from halation.resources.picture import MAX_OVERSCAN

ARCHIVE = Path(__file__).parents[1] / "data" / "display_window.tar.xz"
NAMES = tuple(f"t{number:02}" for number in range(1, 17))
NODES = catalogue()

each = pytest.mark.parametrize("name", NAMES)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The unpacked files."""
    unpacked = tmp_path_factory.mktemp("display_window")
    with tarfile.open(ARCHIVE) as archive:
        archive.extractall(unpacked, filter="data")
    yield unpacked


def lay_out(spec: oiio.ImageSpec, pixels: np.ndarray, margin: int = 0) -> np.ndarray:
    """The pixels of a data window on black, as far as `margin` around the display window."""
    canvas = np.zeros((spec.full_height + 2 * margin, spec.full_width + 2 * margin, 3), np.float32)
    left, top = spec.x - spec.full_x + margin, spec.y - spec.full_y + margin
    across, down = (
        slice(max(start, 0), max(min(start + length, side), 0))
        for start, length, side in ((left, spec.width, canvas.shape[1]), (top, spec.height, canvas.shape[0]))
    )
    canvas[down, across] = pixels[down.start - top : down.stop - top, across.start - left : across.stop - left]
    return canvas


def read(path: Path) -> tuple[oiio.ImageSpec, np.ndarray]:
    """The header and the pixels of the data window, by OpenImageIO."""
    buffer = oiio.ImageBuf(str(path))
    return buffer.spec(), buffer.get_pixels(oiio.FLOAT)[..., :3]


def link(file: Path, *, overscan: float, by: tuple[float, float] = (0.0, 0.0)) -> Graph:
    """A graph that moves a file."""
    graph = Graph(settings=Settings(overscan=overscan)).add_input("picture", Input(file=str(file)))
    graph = graph.add("move", NODES["transform"](position=by, kernel="nearest"))
    graph = graph.connect(Port("inputs", "picture"), Port("move", "image"))
    graph = graph.add_output("out", Output(overscan=overscan > 0.0))
    return graph.connect(Port("move", "out"), Port("outputs", "out"))


@each
def test_the_display_window_is_the_frame(renderer: Renderer, folder: Path, name: str) -> None:
    file = folder / f"{name}.exr"
    for overscan in (0.0, 0.5):
        made = renderer.render(link(file, overscan=overscan), RenderRequest(precision="float"))["out"]
        np.testing.assert_array_equal(made[..., :3], lay_out(*read(file)))


@each
def test_the_data_window_arrives_whole_and_is_written_whole(renderer: Renderer, folder: Path, name: str) -> None:
    """As far as the largest overscan goes. Both windows and the pixel aspect are those of the file."""
    file, written = folder / f"{name}.exr", folder / f"{name}_written.exr"
    settings = OutputSettings([("out", written)], precision="float")
    run_job(renderer, link(file, overscan=MAX_OVERSCAN), RenderRequest(), settings, (1,))
    before, pixels = read(file)
    after, kept = read(written)
    assert (after.full_width, after.full_height) == (before.full_width, before.full_height)
    assert after.get_float_attribute("PixelAspectRatio", 1.0) == before.get_float_attribute("PixelAspectRatio", 1.0)
    margin = int(MAX_OVERSCAN * before.full_height)
    np.testing.assert_array_equal(lay_out(after, kept, margin), lay_out(before, pixels, margin))


@each
def test_what_lies_outside_can_be_moved_into_the_frame(renderer: Renderer, folder: Path, name: str) -> None:
    """By where the data window starts, as far as the overscan goes: its first pixel becomes that of the frame."""
    file = folder / f"{name}.exr"
    spec, pixels = read(file)
    reach = int(MAX_OVERSCAN * spec.full_height)
    across, down = (int(np.clip(way, -reach, reach)) for way in (spec.full_x - spec.x, spec.full_y - spec.y))
    graph = link(file, overscan=MAX_OVERSCAN, by=(float(across), float(down)))
    made = renderer.render(graph, RenderRequest(precision="float"))["out"]
    around = lay_out(spec, pixels, reach)
    expected = around[reach - down :, reach - across :][: spec.full_height, : spec.full_width]
    np.testing.assert_array_equal(made[..., :3], expected)
