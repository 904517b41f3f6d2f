"""Color of videos, against the formulas of the standards written out here once more."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from halation.resources.sandbox import UNRESTRICTED
from hypothesis import given
from hypothesis import strategies as st
from scipy.ndimage import map_coordinates

av: Any = pytest.importorskip("av", reason="PyAV is not installed: pip install halation[video]")

from halation import media  # noqa: E402
from halation.color.encoding import Encoding  # noqa: E402
from halation.media.video.signals import LUMA, chroma_to_rgb, decode_transfer, rgb_to_chroma  # noqa: E402
from halation.media.video.writer import to_exact_rate  # noqa: E402
from halation.nodes import Kind  # noqa: E402
from videos import write_frames  # noqa: E402

WIDTH, HEIGHT = 48, 34
WEIGHTS = {1: (0.2126, 0.0722), 5: (0.299, 0.114), 9: (0.2627, 0.0593)}
SUBSAMPLED = {"420": (2, 2), "422": (2, 1), "444": (1, 1)}


def random_frame(pixels: str, bits: int, seed: int) -> tuple[Any, list[np.ndarray]]:
    """A frame of noise and its planes."""
    random = np.random.default_rng(seed)
    frame = av.VideoFrame(WIDTH, HEIGHT, pixels)
    planes: list[np.ndarray] = []
    for plane in frame.planes:
        dtype = np.dtype("u1" if bits == 8 else "<u2")
        rows = np.zeros((plane.height, plane.line_size // dtype.itemsize), dtype)
        rows[:, : plane.width] = random.integers(0, 1 << bits, (plane.height, plane.width))
        plane.update(rows)
        planes.append(rows[:, : plane.width].astype(np.float64))
    return frame, planes


def by_the_standard(planes: list[np.ndarray], matrix: int, limited: bool, bits: int, form: str) -> np.ndarray:
    """R'G'B' in double precision: the matrix of the definition of Y', Cb and Cr, turned around."""
    red, blue = WEIGHTS[matrix]
    luma = np.array([red, 1.0 - red - blue, blue])
    definition = np.stack(
        [
            luma,
            (np.array([0, 0, 1]) - luma) / (2.0 * (1.0 - blue)),
            (np.array([1, 0, 0]) - luma) / (2.0 * (1.0 - red)),
        ]
    )
    step = 2.0 ** (bits - 8)
    numbers = [(planes[0] - 16 * step) / (219 * step) if limited else planes[0] / (2.0**bits - 1)]
    across, down = SUBSAMPLED[form]
    rows, columns = np.mgrid[0:HEIGHT, 0:WIDTH]
    for plane in planes[1:]:
        chroma = (plane - 128 * step) / (224 * step) if limited else (plane - 2.0 ** (bits - 1)) / (2.0**bits - 1)
        at = [(rows - 0.5 * (down - 1)) / down, columns / across]  # in the middle of rows, over the left column
        numbers.append(map_coordinates(chroma, at, order=1, mode="nearest"))
    return np.stack(numbers, axis=2) @ np.linalg.inv(definition).T


@pytest.mark.parametrize("matrix", WEIGHTS)
@pytest.mark.parametrize("limited", [True, False])
@pytest.mark.parametrize(("form", "bits"), [("420", 8), ("422", 10), ("444", 12), ("444", 8), ("420", 16)])
def test_planes_become_rgb_by_the_matrix_of_the_tags(
    tmp_path: Path, matrix: int, limited: bool, form: str, bits: int
) -> None:
    pixels = f"yuv{form}p" if bits == 8 else f"yuv{form}p{bits}le"
    frame, planes = random_frame(pixels, bits, matrix)
    color = {"colorspace": matrix, "color_range": 1 if limited else 2}
    path = write_frames(tmp_path / "a.mkv", [frame], "ffv1", color=color)
    found = media.read_layer(path, "", Kind.VECTOR, 3, sandbox=UNRESTRICTED).array
    assert np.abs(found - by_the_standard(planes, matrix, limited, bits, form)).max() < 4e-6


def test_without_tags_small_pictures_are_bt601_and_large_ones_bt709(tmp_path: Path) -> None:
    for width, height, matrix in ((720, 576, 5), (1280, 720, 1)):
        gray = np.full((height, width, 3), 128, np.uint8)
        frame = av.VideoFrame.from_ndarray(gray, "rgb24").reformat(format="yuv444p")
        rows = np.full((height, frame.planes[2].line_size), 200, np.uint8)
        frame.planes[2].update(rows)
        path = write_frames(tmp_path / f"{height}.mkv", [frame], "ffv1", color={"colorspace": 2, "color_range": 1})
        found = media.read_layer(path, "", Kind.VECTOR, 3, sandbox=UNRESTRICTED).array[height // 2, width // 2]
        luma = np.frombuffer(frame.planes[0], np.uint8)[0]
        expected = (luma - 16.0) / 219.0 + 2.0 * (1.0 - WEIGHTS[matrix][0]) * (200 - 128) / 224.0
        assert found[0] == pytest.approx(expected, abs=1e-5)


@given(st.sampled_from(list(LUMA)), st.lists(st.floats(0.0, 1.0, width=32), min_size=3, max_size=3))
def test_the_way_there_and_back(matrix: int, color: list[float]) -> None:
    rgb = np.array([[color]], np.float32)
    assert np.abs(chroma_to_rgb(*rgb_to_chroma(rgb, matrix), matrix) - rgb).max() < 2e-6


def test_curves_are_those_of_the_standards() -> None:
    light = np.linspace(0.0, 1.0, 101)
    bt1886 = light ** (1 / 2.4)
    for number in (1, 6, 14, 15):
        assert np.abs(decode_transfer(bt1886.astype(np.float32), number) - light).max() < 1e-6
    assert decode_transfer(np.array([0.5, 0.5, 0.25], np.float32), 8).tolist() == [0.5, 0.5, 0.25]
    assert np.abs(decode_transfer(np.array([0.5]), 4) - 0.5**2.2) < 1e-6
    # BT.2408, table 1: 203 cd/m2 is 58 % of PQ and 75 % of HLG; PQ ends at 10000 cd/m2; 75 % of HLG are 26.5 % light.
    assert decode_transfer(np.array([0.58068888]), 16)[0] == pytest.approx(1.0, abs=1e-3)
    assert decode_transfer(np.array([1.0]), 16)[0] == pytest.approx(10000.0 / 203.0, rel=1e-5)
    assert decode_transfer(np.array([0.75]), 18)[0] == pytest.approx(1.0, abs=1e-6)
    assert decode_transfer(np.array([1.0]), 18)[0] == pytest.approx(1.0 / 0.265, rel=2e-3)
    for number in (1, 4, 5, 13, 16, 18):
        assert np.allclose(decode_transfer(-bt1886, number), -decode_transfer(bt1886, number))


def test_wide_primaries_become_those_of_the_working_space(tmp_path: Path) -> None:
    """BT.2087: white stays white, and BT.2020 green lies outside of BT.709."""
    frame = av.VideoFrame.from_ndarray(np.array([[[255, 255, 255], [0, 255, 0]]] * 2, np.uint8).repeat(16, 1), "rgb24")
    color = {"colorspace": 0, "color_range": 2, "color_primaries": 9, "color_trc": 8}
    path = write_frames(tmp_path / "a.mkv", [frame.reformat(format="bgr0")], "ffv1", color=color)
    found = media.read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED).array
    assert found[0, 2, :3] == pytest.approx([1.0, 1.0, 1.0], abs=1e-3)
    assert found[0, -2, :3] == pytest.approx([-0.5876, 1.1329, -0.1006], abs=2e-3)


@pytest.mark.parametrize("precision", ["half", "float"])
def test_a_lossless_video_is_the_same_as_png_files_to_the_bit(tmp_path: Path, precision: Any) -> None:
    random = np.random.default_rng(3)
    pictures = [random.random((31, 45, 4)).astype(np.float32) for _ in range(3)]
    video = media.VideoWriter(tmp_path / "a.mkv", (45, 31), 24.0, deep=precision == "float", sandbox=UNRESTRICTED)
    for number, picture in enumerate(pictures, 1):
        picture[..., :3] *= picture[..., 3:]
        layers, kinds = {"image": picture}, {"image": Kind.IMAGE}
        video.add(layers, kinds)
        media.write_picture(tmp_path / f"{number}.png", layers, kinds=kinds, precision=precision, sandbox=UNRESTRICTED)
    video.close()
    for number in (3, 1, 2):
        still = media.read_layer(tmp_path / f"{number}.png", "", Kind.IMAGE, sandbox=UNRESTRICTED).array
        assert np.array_equal(
            media.read_layer(tmp_path / "a.mkv", "", Kind.IMAGE, frame=number, sandbox=UNRESTRICTED).array, still
        )


@pytest.mark.parametrize(
    ("name", "codec", "tolerance"),
    [
        ("a.mp4", "h264", 0.03),
        ("a.mp4", "h265", 0.03),
        ("a.mov", "prores", 0.01),
        ("a.mov", "prores4444", 0.01),
        ("a.mov", "qtrle", 0.0045),
        ("a.webm", "vp9", 0.03),
        ("a.mkv", "ffv1", 0.0045),
    ],
)
def test_colors_survive_every_codec(tmp_path: Path, name: str, codec: str, tolerance: float) -> None:
    """Flat fields of color, so that nothing but matrix, range and curve is left to go wrong."""
    colors = np.array([[0.9, 0.1, 0.1], [0.1, 0.8, 0.2], [0.1, 0.2, 0.9], [0.5, 0.5, 0.5], [1.0, 1.0, 1.0], [0, 0, 0]])
    light = colors.repeat(16, 0)[None].repeat(32, 0).astype(np.float32)
    video = media.VideoWriter(
        tmp_path / name, (96, 32), 24.0, codec=codec, encoding=Encoding("none"), sandbox=UNRESTRICTED
    )
    for _ in range(3):
        video.add({"image": light}, {"image": Kind.IMAGE})
    video.close()
    found = media.read_layer(tmp_path / name, "", Kind.IMAGE, frame=2, sandbox=UNRESTRICTED).array[16, 8::16, :3]
    assert np.abs(np.asarray(found) - colors).max() < tolerance
    other = [frame.to_ndarray(format="rgb24") for frame in av.open(str(tmp_path / name)).decode(video=0)]  # swscale's
    encoded = np.where(colors <= 0.0031308, 12.92 * colors, 1.055 * colors ** (1 / 2.4) - 0.055)
    assert np.abs(other[1][16, 8::16] / 255.0 - encoded).max() < 0.03


@pytest.mark.parametrize("name", ["a.mp4", "a.mov", "a.mkv", "a.webm"])
def test_tags_say_what_is_in_the_file(tmp_path: Path, name: str) -> None:
    video = media.VideoWriter(tmp_path / name, (64, 32), 30000 / 1001, sandbox=UNRESTRICTED)
    video.add({"image": np.zeros((32, 64, 4), np.float32)}, {"image": Kind.IMAGE})
    video.close()
    with av.open(str(tmp_path / name)) as file:
        stream = file.streams.video[0]
        frame = next(file.decode(stream))
        rgb = name.endswith("mkv")
        said = (frame.colorspace, frame.color_range, frame.color_primaries, frame.color_trc)
        assert tuple(map(int, said)) == ((0, 2, 1, 13) if rgb else (1, 1, 1, 13))
        assert abs(float(stream.average_rate) - 30000 / 1001) < 0.01


def test_rates_are_those_of_the_trade() -> None:
    assert [str(to_exact_rate(rate)) for rate in (24.0, 25, 23.976, 29.97, 59.94, 30000 / 1001, 12.5)] == [
        "24",
        "25",
        "24000/1001",
        "30000/1001",
        "60000/1001",
        "30000/1001",
        "25/2",
    ]
