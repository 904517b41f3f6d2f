"""Flames and glows have light where alpha is 0: it survives reading, nodes and EXR; each other format has its rule."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from halation import media
from halation.color.display import to_display
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED

FLAME = np.array([0.5, 0.25, 0.125], np.float32)
SIZE = (48, 32)


def flames() -> np.ndarray:
    """Premultiplied: light without cover above, glass below."""
    picture = np.zeros((SIZE[1], SIZE[0], 4), np.float32)
    picture[..., :3] = FLAME
    picture[SIZE[1] // 2 :, :, 3] = 0.5
    return picture


def store(path: Path, array: np.ndarray, format: str, straight: bool) -> Path:
    spec = oiio.ImageSpec(array.shape[1], array.shape[0], 4, format)
    if straight:
        spec.attribute("oiio:UnassociatedAlpha", 1)
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), spec) and output.write_image(array) and output.close()
    return path


def load(path: Path) -> np.ndarray:
    """The numbers as stored."""
    wish = oiio.ImageSpec()
    wish.attribute("oiio:UnassociatedAlpha", 1)
    return oiio.ImageInput.open(str(path), wish).read_image(0, 0, 0, 4, "float")


def decode_srgb(codes):
    return np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)


def write_graph(path: Path, nodes: dict[str, object], links: dict[str, str]) -> Path:
    document = {"halation": 1, "inputs": {"a": {"type": "Image"}}, "outputs": {"image": {}}, "nodes": nodes}
    path.write_text(json.dumps({**document, "links": links}))
    return path


@pytest.fixture
def nothing(tmp_path: Path) -> Path:
    return write_graph(tmp_path / "nothing.json", {}, {"outputs.image": "inputs.a"})


@pytest.mark.parametrize(("name", "format"), [("a.exr", "half"), ("a.exr", "float"), ("a.tif", "float")])
def test_premultiplied_light_comes_back_in_exr(cli, nothing, tmp_path, name, format):
    source, out = store(tmp_path / name, flames(), format, False), tmp_path / "out.exr"
    assert cli("render", nothing, "-i", f"a={source}", "-o", out, "--precision", "float").code == 0
    np.testing.assert_array_equal(load(out), flames())


@pytest.mark.parametrize("format", ["uint8", "uint16"])
def test_premultiplied_tiff_of_integers_keeps_it(cli, nothing, tmp_path, format):
    """A curve has no alpha to be applied under, so light without cover is decoded as it is."""
    source, out = store(tmp_path / "a.tif", flames(), format, False), tmp_path / "out.exr"
    assert cli("render", nothing, "-i", f"a={source}", "-o", out, "--precision", "float").code == 0
    np.testing.assert_allclose(load(out)[0, 0], [*decode_srgb(load(source)[0, 0, :3]), 0.0], atol=1e-6)


@pytest.mark.parametrize("name", ["a.png", "a.tif", "a.tga", "a.bmp", "a.webp"])
def test_hidden_color_of_straight_files_is_not_light(cli, nothing, tmp_path, name):
    """Their color is multiplied by alpha to be light: 0."""
    source, out = store(tmp_path / name, flames(), "uint8", True), tmp_path / "out.exr"
    assert cli("render", nothing, "-i", f"a={source}", "-o", out).code == 0
    assert not load(out)[: SIZE[1] // 2].any() and load(out)[-1, 0, 0] > 0.1


NODES = {
    "exposure": ({"type": "exposure", "values": {"stops": 1.0}}, "image", 2.0),
    "saturation": ({"type": "saturation", "values": {}}, "image", None),
    "levels": ({"type": "levels", "values": {}}, "image", 1.0),
    "blur": ({"type": "gaussian_blur", "values": {}}, "image", 1.0),
    "transform": ({"type": "transform", "values": {}}, "image", 1.0),
}


@pytest.mark.parametrize("name", NODES)
def test_nodes_keep_it(cli, tmp_path, name):
    node, socket, factor = NODES[name]
    graph = write_graph(tmp_path / "a.json", {"n": node}, {f"n.{socket}": "inputs.a", "outputs.image": "n.out"})
    source, out = store(tmp_path / "a.exr", flames(), "float", False), tmp_path / "out.exr"
    result = cli("render", graph, "-i", f"a={source}", "-o", out, "--precision", "float")
    assert result.code == 0, result.err
    pixel = load(out)[2, SIZE[0] // 2]
    if factor is None:
        assert pixel[:3].min() > 0.01 and pixel[3] == 0.0
    else:
        np.testing.assert_allclose(pixel, [*(FLAME * factor), 0.0], atol=2e-3)


def test_it_is_added_over_a_background(cli, tmp_path):
    graph = write_graph(
        tmp_path / "a.json",
        {"wall": {"type": "constant", "values": {"color": [0.1, 0.1, 0.1, 1.0]}}, "over": {"type": "merge"}},
        {"over.a": "inputs.a", "over.b": "wall.out", "outputs.image": "over.out"},
    )
    source, out = store(tmp_path / "a.exr", flames(), "float", False), tmp_path / "out.exr"
    result = cli("render", graph, "-i", f"a={source}", "-o", out, "--precision", "float")
    assert result.code == 0, result.err
    np.testing.assert_allclose(load(out)[2, 2, :3], FLAME + 0.1, atol=1e-5)


@pytest.mark.parametrize(
    ("name", "rule"), [("o.png", "hidden"), ("o.tif", "hidden"), ("o.jpg", "lit"), ("o.dpx", "lit")]
)
def test_what_formats_for_screens_do_with_it(cli, nothing, tmp_path, name, rule):
    """With alpha: its color stays in the file under an alpha of 0. Without: it is seen over black, as light."""
    source, out = store(tmp_path / "a.exr", flames(), "float", False), tmp_path / name
    words = ("--view", "none", "--dither", "none")
    assert cli("render", nothing, "-i", f"a={source}", "-o", out, *words).code == 0
    pixel, shown = load(out)[2, 2], to_display(FLAME[None, None], "none", bits=32)[0, 0]
    np.testing.assert_allclose(pixel[:3], shown, atol=0.02 if rule == "lit" else 0.51 / 255)
    assert (len(pixel) == 4 and pixel[3] == 0.0) if rule == "hidden" else len(pixel) == 3
    again = media.read_layer(out, "", Kind.IMAGE, sandbox=UNRESTRICTED).array[2, 2]
    assert again[:3].any() == (rule == "lit")


def test_webp_keeps_alpha_and_not_what_it_hides(cli, nothing, tmp_path):
    source, out = store(tmp_path / "a.exr", flames(), "float", False), tmp_path / "o.webp"
    assert cli("render", nothing, "-i", f"a={source}", "-o", out, "--view", "none").code == 0
    assert load(out)[2, 2, 3] == 0.0 and abs(load(out)[-2, 2, 3] - 0.5) < 0.01
