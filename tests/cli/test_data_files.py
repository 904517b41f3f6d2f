"""Data in formats for screens is its number times the largest integer: no view changes it, and who renders is told."""

from __future__ import annotations

import json
from pathlib import Path

import av
import numpy as np
import OpenImageIO as oiio
import pytest
from halation.media import holds_light, write_picture
from halation.media.comparison.data_range import find_data_range
from halation.media.pictures.thumbnail import read_thumbnail
from halation.media.video.codecs import WRITABLE
from halation.media.video.writer import VideoWriter
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED

LEVELS = (0.0, 0.02, 0.18, 0.25, 0.5, 0.735, 1.0)


@pytest.fixture
def matte(tmp_path: Path) -> Path:
    """A graph whose output is a number everywhere."""
    path = tmp_path / "matte.json"
    path.write_text(
        '{"halation": 1, "settings": {"size": [32, 16]}, "outputs": {"matte": {"type": "Field"}}, '
        '"nodes": {"level": {"type": "math", "values": {"b": 0.5}}}, '
        '"links": {"outputs.matte": "level.out"}}'
    )
    return path


def load(path: Path, format: str = "uint8") -> np.ndarray:
    return oiio.ImageInput.open(str(path)).read_image(0, 0, 0, 3, format)


@pytest.mark.parametrize("ending", ["png", "tif", "webp"])
@pytest.mark.parametrize("level", LEVELS)
def test_a_matte_is_its_number(tmp_path, ending, level):
    field = {"matte": np.full((8, 8, 1), level, np.float32)}
    for view in ("", "none", "ACES"):
        write_picture(tmp_path / f"a.{ending}", field, kinds={"matte": Kind.FIELD}, view=view, sandbox=UNRESTRICTED)
        assert np.abs(load(tmp_path / f"a.{ending}").astype(float) - 255 * level).max() <= 0.5 + (ending == "webp")


@pytest.mark.parametrize(("ending", "step"), [("png", 1 / 65535), ("tif", 1 / 65535), ("dpx", 1 / 65535)])
def test_sixteen_bits_too(tmp_path, ending, step):
    ramp = np.linspace(-0.1, 1.1, 512, dtype=np.float32)[None, :, None].repeat(4, axis=0)
    path = tmp_path / f"a.{ending}"
    write_picture(path, {"m": ramp}, kinds={"m": Kind.FIELD}, precision="float", sandbox=UNRESTRICTED)
    np.testing.assert_allclose(load(path, "float")[..., :1], np.clip(ramp, 0.0, 1.0), atol=0.51 * step)


def test_ten_bits_and_jpeg_and_radiance(tmp_path):
    ramp = np.linspace(0.0, 1.0, 512, dtype=np.float32)[None, :, None].repeat(8, axis=0)
    for ending, step in (("dpx", 0.51 / 1023), ("jpg", 2.5 / 255), ("hdr", 0.01)):
        path = tmp_path / f"a.{ending}"
        write_picture(path, {"m": ramp}, kinds={"m": Kind.FIELD}, sandbox=UNRESTRICTED)
        np.testing.assert_allclose(load(path, "float")[..., :1], ramp, atol=step)


def test_data_that_is_not_finite_is_written(tmp_path):
    numbers = np.array([[[np.nan], [np.inf], [-np.inf], [-3.0], [7.0]]], np.float32)
    write_picture(tmp_path / "a.png", {"m": numbers}, kinds={"m": Kind.FIELD}, sandbox=UNRESTRICTED)
    assert load(tmp_path / "a.png")[0, :, 0].tolist() == [0, 255, 0, 0, 255]


def test_a_video_of_a_matte_is_its_number(tmp_path):
    ramp = np.linspace(0.0, 1.0, 64, dtype=np.float32)[None, :, None].repeat(16, axis=0)
    path = tmp_path / "a.mkv"
    video = VideoWriter(path, (64, 16), 24, sandbox=UNRESTRICTED)
    video.add({"m": ramp}, {"m": Kind.FIELD})
    video.close()
    with av.open(str(path)) as container:
        codes = next(container.decode(video=0)).to_ndarray(format="rgb24")
    np.testing.assert_allclose(codes / 255.0, ramp.repeat(3, axis=2), atol=0.51 / 255)


def test_rendering_says_so(cli, matte, tmp_path):
    out = tmp_path / "matte.png"
    result = cli("render", matte, "-o", out)
    assert result.code == 0 and "output 'matte' is data: its numbers are written" in result.err
    assert set(np.unique(load(out))) <= {127, 128}
    result = cli("render", matte, "-o", tmp_path / "m.exr", "--json")
    assert json.loads(result.out)["data"] == [] and json.loads(result.out)["views"] == {}
    assert cli("render", matte, "-o", out, "--view", "ACES").code == 0
    assert set(np.unique(load(out))) <= {127, 128}
    assert "view: none, since it is data" in cli("explain", matte).out


def test_a_solid_matte_is_as_bright_where_it_is_looked_at(tmp_path):
    for level in LEVELS:
        low, high = find_data_range(np.full((4, 4, 1), level, np.float32))
        assert (low, high) == (0.0, 1.0)
        write_picture(
            tmp_path / "a.exr", {"Z": np.full((4, 4, 1), level)}, kinds={"Z": Kind.FIELD}, sandbox=UNRESTRICTED
        )
        assert np.abs(read_thumbnail(tmp_path / "a.exr", 4, 4, UNRESTRICTED) - 255.0 * level).max() <= 0.5


def test_formats_that_hold_light():
    assert [ending for ending in (".exr", ".HDR") if holds_light(f"a{ending}")] == [".exr", ".HDR"]
    assert not any(holds_light(f"a{ending}") for ending in (".png", ".jpeg", ".tiff", ".webp", ".dpx", *WRITABLE))
