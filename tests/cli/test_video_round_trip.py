"""Video for a BT.1886 display through a graph that changes nothing comes back with its codes, in every format."""

from __future__ import annotations

import json
from pathlib import Path

import av
import numpy as np
import OpenImageIO as oiio
import pytest
from halation import media
from halation.color.display import to_display
from halation.color.encoding import Encoding
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED
from videos import write_frames

WIDTH, HEIGHT, PATCH = 256, 64, 16
COLORS = np.random.default_rng(7).integers(0, 256, (HEIGHT // PATCH, WIDTH // PATCH, 3), np.uint8)
RGB = COLORS.repeat(PATCH, 0).repeat(PATCH, 1)
VIDEO = (1, 6, 14, 15)


@pytest.fixture
def graph(tmp_path: Path) -> Path:
    path = tmp_path / "nothing.json"
    path.write_text(
        '{"halation": 1, "inputs": {"a": {"type": "Image"}}, "outputs": {"image": {}}, '
        '"links": {"outputs.image": "inputs.a"}}'
    )
    return path


def make_video(path: Path, transfer: int, pixels: str = "bgr0") -> tuple[Path, np.ndarray]:
    """A lossless video, and its codes 0..255 as it decodes to: inside of patches, where chroma is flat."""
    frame = av.VideoFrame.from_ndarray(RGB, "rgb24")
    matrix = 0 if pixels == "bgr0" else 1
    frame = frame.reformat(format=pixels, dst_colorspace=1 if matrix else None)
    color = {"colorspace": matrix, "color_range": 1 if matrix else 2, "color_primaries": 1, "color_trc": transfer}
    write_frames(path, [frame], "ffv1", color=color)
    return path, media.read_layer(path, "", Kind.VECTOR, 3, sandbox=UNRESTRICTED).array[..., :3] * 255


def inside(array: np.ndarray) -> np.ndarray:
    return array[PATCH // 2 :: PATCH, PATCH // 2 :: PATCH]


@pytest.mark.parametrize("transfer", VIDEO)
@pytest.mark.parametrize("pixels", ["bgr0", "yuv420p", "yuv422p10le", "yuv444p"])
@pytest.mark.parametrize("target", ["a.png", "a.tif", "a.mkv"])
def test_codes_come_back(cli, graph, tmp_path, transfer, pixels, target):
    source, codes = make_video(tmp_path / "in.mkv", transfer, pixels)
    out = tmp_path / target
    result = cli("render", graph, "-i", f"a={source}", "-o", out, "--frames", "1")
    assert result.code == 0 and "made for a screen of video (BT.1886)" in result.err
    if target.endswith("mkv"):
        found = media.read_layer(out, "", Kind.VECTOR, 3, sandbox=UNRESTRICTED).array[..., :3] * 255
    else:
        found = oiio.ImageInput.open(str(out)).read_image(0, 0, 0, 3, "uint8").astype(float)
    assert np.abs(inside(found) - inside(np.clip(codes, 0, 255))).max() <= 1.0
    if pixels == "bgr0":
        np.testing.assert_array_equal(found, RGB)


def test_the_video_that_is_written_is_tagged_as_the_one_that_was_read(cli, graph, tmp_path):
    source, _ = make_video(tmp_path / "in.mkv", 1)
    for name in ("a.mp4", "a.mov", "a.mkv"):
        out = tmp_path / name
        assert cli("render", graph, "-i", f"a={source}", "-o", out, "--frames", "1").code == 0
        with av.open(str(out)) as container:
            frame = next(container.decode(video=0))
        assert (int(frame.color_primaries), int(frame.color_trc)) == (1, 1)
        again = media.read_layer(out, "", Kind.IMAGE, sandbox=UNRESTRICTED).array[..., :3]
        light = media.read_layer(source, "", Kind.IMAGE, sandbox=UNRESTRICTED).array[..., :3]
        difference = inside(again) ** (1 / 2.4) - inside(light) ** (1 / 2.4)
        assert np.abs(difference * 255).max() <= (1.0 if name == "a.mkv" else 6.0)  # the others are lossy


def test_light_is_that_of_the_display(tmp_path):
    """ITU-R BT.1886: a power of 2.4."""
    source, codes = make_video(tmp_path / "in.mkv", 1)
    light = media.read_layer(source, "", Kind.IMAGE, sandbox=UNRESTRICTED).array[..., :3]
    np.testing.assert_allclose(light, (codes.astype(np.float64) / 255) ** 2.4, atol=1e-6)
    encoded = to_display(light, "bt1886", bits=32)
    np.testing.assert_allclose(encoded, codes / 255, atol=2e-4)
    np.testing.assert_array_equal(Encoding("bt1886", dither="blue").to_codes(light, 8), RGB)


def test_beside_pictures_for_a_screen_srgb_is_written(cli, tmp_path):
    path, photo = tmp_path / "merge.json", tmp_path / "in.png"
    path.write_text(
        '{"halation": 1, "inputs": {"a": {"type": "Image"}, "b": {"type": "Image"}}, "outputs": {"image": {}}, '
        '"nodes": {"mix": {"type": "mix_images", "values": {"factor": 0.5}}}, '
        '"links": {"outputs.image": "mix.out", "mix.a": "inputs.a", "mix.b": "inputs.b"}}'
    )
    oiio.ImageBuf(RGB).write(str(photo))
    source, _ = make_video(tmp_path / "in.mkv", 1)
    words = ("-i", f"a={source}", "-i", f"b={photo}", "--frame", "1", "-o", tmp_path / "out.png", "--json")
    assert json.loads(cli("render", path, *words).out)["views"] == {"image": "none"}


def test_a_video_in_srgb_comes_back_too(cli, graph, tmp_path):
    source, _ = make_video(tmp_path / "in.mkv", 13)
    out = tmp_path / "out.png"
    result = cli("render", graph, "-i", f"a={source}", "-o", out, "--frame", "1", "--json")
    assert json.loads(result.out)["views"] == {"image": "none"}
    np.testing.assert_array_equal(oiio.ImageInput.open(str(out)).read_image(0, 0, 0, 3, "uint8"), RGB)


def test_what_was_written_for_video_comes_back_and_can_be_made_again(cli, graph, tmp_path):
    source, _ = make_video(tmp_path / "in.mkv", 1)
    first, second = tmp_path / "one.png", tmp_path / "two.png"
    assert cli("render", graph, "-i", f"a={source}", "-o", first, "--frame", "1").code == 0
    assert cli("reproduce", first).code == 0
    assert "kept" in cli("render", graph, "-i", f"a={source}", "-o", first, "--frame", "1", "--resume").err
    assert cli("render", graph, "-i", f"a={first}", "-o", second).code == 0
    np.testing.assert_array_equal(oiio.ImageInput.open(str(second)).read_image(0, 0, 0, 3, "uint8"), RGB)
