"""Large pictures are read smaller than they are: against the filters of OpenImageIO."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from conftest import Run
from halation.compiler.lowering import pictures
from halation.graph import Graph, Input, Output, Port
from halation.media import LayerRequest
from halation.media.pictures import reduced_reader
from halation.media.pictures.reduced_reader import read_reduced
from halation.nodes import Kind
from halation.nodes.color.exposure import Exposure
from halation.resources.sandbox import UNRESTRICTED
from oiio_pictures import make_buffer, write_with_attributes

FILES = {
    "scan lines": ("a.exr", {"format": "float"}),
    "tiles": ("a.exr", {"format": "float", "tile": 16}),
    "half": ("a.exr", {"format": "half"}),
}


@pytest.fixture(autouse=True)
def _many_bands(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reduced_reader, "_BAND", 2000)


def make_light(height: int, width: int) -> np.ndarray:
    return np.random.default_rng(1).gamma(0.6, 1.0, (height, width, 4)).astype(np.float32)


def shrink(light: np.ndarray, scale: float) -> np.ndarray:
    """The box filter of OpenImageIO."""
    small = oiio.ROI(0, round(light.shape[1] * scale), 0, round(light.shape[0] * scale))
    return oiio.ImageBufAlgo.resize(make_buffer(light), filtername="box", filterwidth=1.0, roi=small).get_pixels(
        oiio.FLOAT
    )


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("reduction", [2, 4, 8])
def test_color_is_the_mean_of_each_square(tmp_path: Path, name: str, reduction: int) -> None:
    file, attributes = FILES[name]
    light = make_light(64, 96)
    path = write_with_attributes(tmp_path / file, light, **attributes)
    pixels = read_reduced(path, LayerRequest("", Kind.IMAGE), reduction, UNRESTRICTED)
    expected = shrink(light, 1 / reduction)
    precision = 1e-3 if name == "half" else 1e-6
    np.testing.assert_allclose(pixels.array, expected, rtol=precision, atol=precision)
    assert pixels.array.dtype == (np.float16 if name == "half" else np.float32)


@pytest.mark.parametrize("reduction", [2, 4, 8])
def test_data_is_never_mixed(tmp_path: Path, reduction: int) -> None:
    depth = np.arange(64 * 96, dtype=np.float32).reshape(64, 96, 1)
    path = write_with_attributes(tmp_path / "a.exr", depth, format="float")
    pixels = read_reduced(path, LayerRequest("", Kind.FIELD, 1), reduction, UNRESTRICTED)
    middle = reduction // 2
    np.testing.assert_array_equal(pixels.array, depth[middle::reduction, middle::reduction])


def test_sides_that_no_square_divides(tmp_path: Path) -> None:
    light = make_light(65, 103)
    path = write_with_attributes(tmp_path / "a.exr", light, format="float")
    pixels = read_reduced(path, LayerRequest("", Kind.IMAGE), 8, UNRESTRICTED)
    assert pixels.array.shape == (8, 13, 4)  # a row is left out, and a column is missing
    squares = light[:64, :96].reshape(8, 8, 12, 8, 4).mean((1, 3), dtype=np.float64)
    np.testing.assert_allclose(pixels.array[:, :12], squares, rtol=1e-6)
    last = np.concatenate([light[:64, 96:], light[:64, -1:]], 1).reshape(8, 8, 8, 4).mean((1, 2), dtype=np.float64)
    np.testing.assert_allclose(pixels.array[:, 12], last, rtol=1e-6)


@pytest.mark.parametrize("scale", [0.5, 0.25])
def test_a_proxy_of_a_large_file(tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch, scale: float) -> None:
    monkeypatch.setattr(pictures, "LARGE_PICTURE", 64 * 96)
    light = make_light(64, 96)
    write_with_attributes(tmp_path / "a.exr", light, format="float")
    ends = {"image": Input(Kind.IMAGE, file="a.exr")}
    graph = Graph(inputs=ends, outputs={"image": Output()}, folder=str(tmp_path))
    graph = graph.add("light", Exposure(stops=1.0)).connect(Port("inputs", "image"), Port("light", "image"))
    graph = graph.connect(Port("light", "out"), Port("outputs", "image"))
    expected = shrink(light, scale) * (2.0, 2.0, 2.0, 1.0)
    np.testing.assert_allclose(run(graph, scale=scale), expected, rtol=2e-3, atol=2e-3)
    assert run(graph).shape == light.shape
