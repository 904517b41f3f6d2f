"""Files of 8 and 10 bits are dithered: no bands, the mean is the number, and exact codes stay."""

from __future__ import annotations

from itertools import pairwise

import halation as hal
import numpy as np
import OpenImageIO as oiio
import pytest
from halation.color.dithering import make_dither
from halation.color.encoding import Encoding
from halation.media import write_picture
from halation.media.video.writer import VideoWriter
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED

IMAGE = {"": Kind.IMAGE}
BLUE = Encoding("none", dither="blue")
BLOCK = 16
ALLOWED = 0.1
"""Codes by which the mean of a block may be off."""


def encode_srgb(light):
    """IEC 61966-2-1, in float64."""
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def decode_srgb(codes):
    return np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)


def average_blocks(array):
    height, width = (side // BLOCK * BLOCK for side in array.shape)
    return array[:height, :width].reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK).mean((1, 3))


def load(path, bits=8):
    format = "uint8" if bits == 8 else "uint16"
    codes = oiio.ImageInput.open(str(path)).read_image(0, 0, 0, 3, format).astype(np.float64)
    return codes if bits == 8 else codes * (1023 / 65535)


@pytest.fixture
def ramp():
    """A dark ramp, 1120 x 256: 32 codes of 8 bits, 35 pixels each."""
    codes = np.linspace(2.0, 34.0, 1120) / 255.0
    light = np.broadcast_to(decode_srgb(codes)[None, :, None], (256, 1120, 3))
    return np.ascontiguousarray(light), light[..., 0]


@pytest.mark.parametrize(("ending", "bits"), [("png", 8), ("tif", 8), ("dpx", 10)])
@pytest.mark.parametrize("frame", [1, 2, 77])
def test_the_mean_of_every_block_is_that_of_the_ramp(tmp_path, ramp, ending, bits, frame):
    light, exact = ramp
    path = tmp_path / f"a.{ending}"
    layers = {"": light.astype(np.float32)}
    write_picture(path, layers, kinds=IMAGE, encoding=BLUE, frame=frame, sandbox=UNRESTRICTED)
    codes = load(path, bits)
    wanted = encode_srgb(exact) * (255 if bits == 8 else 1023)
    assert np.abs(average_blocks(codes[..., 1]) - average_blocks(wanted)).max() <= ALLOWED
    assert np.abs(codes[..., 1] - wanted).max() < 1.0
    np.testing.assert_array_equal(codes[..., 0], codes[..., 2])  # gray stays gray


@pytest.mark.parametrize("level", np.linspace(0.0, 1.0, 41))
def test_every_fraction_of_a_code_has_its_mean_everywhere(level):
    light = np.full((64, 64, 3), decode_srgb((100 + level) / 255.0), np.float32)
    for frame in (0, 1, 9):
        codes = Encoding("none", dither="blue").to_codes(light, 8, frame=frame)[..., 0].astype(np.float64)
        sums = np.cumsum(np.cumsum(np.pad(np.tile(codes, (2, 2)), ((1, 0), (1, 0))), 0), 1)
        means = (sums[16:80, 16:80] - sums[:64, 16:80] - sums[16:80, :64] + sums[:64, :64]) / BLOCK**2
        assert np.abs(means - 100 - level).max() <= ALLOWED


def test_without_it_there_are_bands_and_with_it_there_are_none(tmp_path, ramp):
    light = ramp[0].astype(np.float32)
    longest = {}
    for dither in ("none", "blue"):
        hal.write(tmp_path / "a.png", light, view="none", dither=dither)
        codes = load(tmp_path / "a.png")[..., 0]
        plain = (codes == codes[:1]).all(axis=0)  # columns of one code
        edges = np.flatnonzero(
            np.diff(np.where(plain, codes[0], -2 - np.arange(codes.shape[1])), prepend=-1, append=-1)
        )
        longest[dither] = np.diff(edges).max()
    assert longest["none"] >= 34 and longest["blue"] <= 8


def test_the_grain_is_blue():
    light = np.full((64, 64, 3), decode_srgb(100.5 / 255.0), np.float32)
    grain = BLUE.to_codes(light, 8)[..., 0].astype(float)
    power = np.abs(np.fft.fft2(grain - grain.mean())) ** 2
    distance = np.hypot(*np.meshgrid(np.fft.fftfreq(64), np.fft.fftfreq(64)))
    assert power[(distance > 0) & (distance < 0.1)].mean() < 0.05 * power[distance > 0.3].mean()


def test_exact_codes_stay(tmp_path):
    codes = np.random.default_rng(1).integers(0, 256, (128, 256, 3), np.uint8)
    light = decode_srgb(codes / 255.0)
    for pixels in (light.astype(np.float32), light.astype(np.float16).astype(np.float32)):
        for frame in range(1, 20):
            np.testing.assert_array_equal(BLUE.to_codes(pixels, 8, frame=frame), codes)


def test_alpha_and_data_are_not_dithered(tmp_path):
    numbers = np.random.default_rng(2).random((64, 64, 1), np.float32)
    plain = np.floor(numbers * 255 + 0.5)
    write_picture(tmp_path / "m.png", {"m": numbers}, kinds={"m": Kind.FIELD}, encoding=BLUE, sandbox=UNRESTRICTED)
    np.testing.assert_array_equal(load(tmp_path / "m.png")[..., :1], plain)
    glass = np.concatenate([numbers.repeat(3, 2) * 0.3, numbers], axis=2)
    np.testing.assert_array_equal(BLUE.to_codes(glass, 8)[..., 3:], plain)
    raw = Encoding(space="Raw", dither="blue").to_codes(numbers.repeat(3, 2), 8)
    np.testing.assert_array_equal(raw, plain.repeat(3, 2))
    np.testing.assert_array_equal(BLUE.to_codes(glass, 16), Encoding("none").to_codes(glass, 16))


def test_frames_differ_and_are_the_same_again():
    patterns = [make_dither(100, 70, frame) for frame in (1, 2, 3, 1)]
    np.testing.assert_array_equal(patterns[0], patterns[3])
    assert all((one != other).mean() > 0.9 for one, other in pairwise(patterns[:3]))
    assert all(np.abs(pattern).max() < 0.45 for pattern in patterns)


@pytest.mark.parametrize(
    ("name", "codec", "bits"), [("a.mp4", "h264", 8), ("a.mov", "prores", 10), ("a.mkv", "ffv1", 8)]
)
def test_videos_are_dithered(tmp_path, ramp, monkeypatch, name, codec, bits):
    """What the encoder gets: lossy codecs smooth it afterwards."""
    light, exact = ramp
    planes = []
    update = VideoWriter._encode_frame

    def keep(self, frame):
        if frame is not None:
            numbers = np.frombuffer(frame.planes[0], np.uint16 if bits == 10 else np.uint8).reshape(256, -1)
            planes.append((numbers[:, :4480:4] if codec == "ffv1" else numbers[:, :1120]).astype(np.float64))
        update(self, frame)

    monkeypatch.setattr(VideoWriter, "_encode_frame", keep)
    encoding = Encoding("none", dither="blue")
    video = VideoWriter(tmp_path / name, (1120, 256), 24, codec=codec, encoding=encoding, sandbox=UNRESTRICTED)
    for frame in (1, 2):
        video.add({"": light.astype(np.float32)}, IMAGE, frame)
    video.close()
    step = 1 << (bits - 8)
    wanted = encode_srgb(exact) * (255 if codec == "ffv1" else 219 * step) + (0 if codec == "ffv1" else 16 * step)
    first, second = planes
    for codes in (first, second):
        assert np.abs(average_blocks(codes) - average_blocks(wanted)).max() <= ALLOWED
    assert (first != second).any()
