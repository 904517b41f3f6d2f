"""Color of files is finite once it is read, so that shaders do not test it; arrays and data may have holes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.custom_nodes import Code, node_type
from halation.graph import Graph, Input, Output, Port
from halation.nodes import Kind
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.renderer import Renderer, RenderRequest

CROSS = "image_at(pixel) + image_at(pixel + ivec2(1, 0)) + image_at(pixel - ivec2(1, 0))"
COLOR = f"vec4 cross_sum(vec4 image) {{\n    return {CROSS};\n}}"
DEPTH = f"float cross_sum(float image) {{\n    return {CROSS};\n}}"
HOLES = {(0, 0): np.nan, (3, 4): np.inf, (4, 4): -np.inf, (7, 8): np.nan, (6, 2): 3e38, (6, 3): 3e38}


def make_graph(code: str, kind: Kind, width: int) -> Graph:
    graph = Graph().add_input("image", Input(kind, width)).add_output("out", Output(kind, width))
    graph = graph.add("user", node_type(Code("glsl", code))())
    return graph.connect(Port("inputs", "image"), Port("user", "image")).connect(
        Port("user", "out"), Port("outputs", "out")
    )


def write(path: Path, channels: tuple[str, ...]) -> np.ndarray:
    """A file of 32-bit floats with holes; what it holds."""
    array = np.random.default_rng(3).uniform(0.1, 2.0, (8, 9, len(channels))).astype(np.float32)
    for (y, x), number in HOLES.items():
        array[y, x, 0] = number
    spec = oiio.ImageSpec(9, 8, len(channels), "float")
    spec.channelnames = channels
    file = oiio.ImageOutput.create(str(path))
    assert file.open(str(path), spec) and file.write_image(array) and file.close()
    return array


def add_neighbors(array: np.ndarray) -> np.ndarray:
    """Each pixel and those beside it; the first and last of a row are repeated."""
    wide = np.pad(array.astype(np.float64), ((0, 0), (1, 1), (0, 0)), "edge")
    return wide[:, :-2] + wide[:, 1:-1] + wide[:, 2:]


def test_color_of_a_file_has_no_holes(renderer: Renderer, tmp_path: Path) -> None:
    """A broken pixel is the mean of its neighbors (OpenImageIO, BOX3), and only itself is what changes."""
    array = write(tmp_path / "a.exr", ("R", "G", "B", "A"))
    filled = oiio.ImageBufAlgo.fixNonFinite(oiio.ImageBuf(array), oiio.NONFINITE_BOX3, nthreads=1).get_pixels("float")
    assert np.isfinite(filled).all()
    request = RenderRequest({"image": tmp_path / "a.exr"})
    drawn = renderer.render(make_graph(COLOR, Kind.IMAGE, 4), request)["out"]
    wanted = add_neighbors(filled)
    usual = wanted < 1e30
    assert usual.sum() > 200 and drawn[usual] == pytest.approx(wanted[usual], rel=1e-5, abs=1e-5)


def test_data_and_arrays_have_holes_that_count_as_zero(renderer: Renderer, tmp_path: Path) -> None:
    """In data of a file NaN is 0 already; infinity is 0 for a neighbor. In an array both are."""
    depth = write(tmp_path / "z.exr", ("Z",))
    wanted = add_neighbors(np.where(np.isfinite(depth), depth, 0.0))
    usual = np.abs(wanted) < 1e30
    for source in (tmp_path / "z.exr", depth):
        request = RenderRequest({"image": source})
        drawn = renderer.render(make_graph(DEPTH, Kind.FIELD, 1), request)["out"]
        assert drawn[..., :1][usual] == pytest.approx(wanted[usual], rel=1e-5, abs=1e-5)


def test_data_that_is_shown_as_color_keeps_its_infinity(renderer: Renderer, tmp_path: Path) -> None:
    """Depth in an image is gray: its infinity stays where it is, and is no neighbor."""
    depth = write(tmp_path / "z.exr", ("Z",))
    request = RenderRequest({"image": tmp_path / "z.exr"})
    drawn = renderer.render(make_graph(COLOR, Kind.IMAGE, 4), request)["out"][..., :1]
    wanted = add_neighbors(np.where(np.isfinite(depth), depth, 0.0))
    usual = np.abs(wanted) < 1e30
    assert drawn[usual] == pytest.approx(wanted[usual], rel=1e-5, abs=1e-5)


@pytest.mark.parametrize("sigma", [2.0, 20.0])
def test_what_code_makes_has_holes_that_no_blur_spreads(renderer: Renderer, tmp_path: Path, sigma: float) -> None:
    """Sums of three may be infinite, or larger than a blur can add up."""
    array = write(tmp_path / "a.exr", ("R", "G", "B", "A"))
    made = renderer.render(make_graph(COLOR, Kind.IMAGE, 4), RenderRequest({"image": array}))["out"]
    is_hole = ~(np.abs(made) < 2.0**127).all(axis=2)
    assert 0 < is_hole.sum() < 10
    blur = Graph().add_input("image", Input(Kind.IMAGE)).add("blur", GaussianBlur(sigma=sigma))
    both = make_graph(COLOR, Kind.IMAGE, 4).add("blur", GaussianBlur(sigma=sigma))
    both = both.connect(Port("user", "out"), Port("blur", "image")).connect(Port("blur", "out"), Port("outputs", "out"))
    blur = blur.connect(Port("inputs", "image"), Port("blur", "image")).add_output("out", Output(Kind.IMAGE))
    blur = blur.connect(Port("blur", "out"), Port("outputs", "out"))
    drawn = renderer.render(both, RenderRequest({"image": array}))["out"]
    made[is_hole] = 0.0
    np.testing.assert_array_equal(drawn, renderer.render(blur, RenderRequest({"image": made}))["out"])
    assert np.isfinite(drawn).all()
