"""Integers of every depth are the same light: 1 to 32 bits, with and without a sign, in color and as numbers."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest
from halation.media import LayerRequest, read_info, read_layer
from halation.media.color_spaces import describe_color_spaces
from halation.media.pictures.row_reader import read_rows
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED
from oiio_pictures import write_with_attributes

Array = np.ndarray


def write_tiff(path: Path, codes: Array, bits: int, channels: int, *, signed: bool = False, big: bool = False) -> Path:
    """A TIFF 6.0 of one strip, packed to the bit."""
    order = ">" if big else "<"
    height = codes.shape[0]
    rows = codes.reshape(height, -1).astype(np.int64) & ((1 << bits) - 1)
    if bits % 8 == 0:
        parts = [row.astype(f"{order}u8").view(np.uint8).reshape(-1, 8) for row in rows]
        take = slice(8 - bits // 8, 8) if big else slice(0, bits // 8)
        strip = b"".join(part[:, take].tobytes() for part in parts)
    else:
        shifts = np.arange(bits - 1, -1, -1)
        strip = b"".join(np.packbits(((row[:, None] >> shifts) & 1).astype(np.uint8).ravel()).tobytes() for row in rows)
    entries = [
        (256, 4, 1, codes.shape[1]),
        (257, 4, 1, height),
        (258, 3, 1, bits),
        (259, 3, 1, 1),
        (262, 3, 1, 2 if channels == 3 else 1),
        (273, 4, 1, 8),
        (277, 3, 1, channels),
        (278, 4, 1, height),
        (279, 4, 1, len(strip)),
        (339, 3, 1, 2 if signed else 1),
    ]
    strip += bytes(len(strip) % 2)
    after = 8 + len(strip)
    if channels == 3:  # one number of bits for each
        entries[2] = (258, 3, 3, after + 2 + 12 * len(entries) + 4)
        entries[9] = (339, 3, 3, after + 2 + 12 * len(entries) + 10)
    table = struct.pack(f"{order}H", len(entries))
    for tag, kind, count, number in entries:
        short = kind == 3 and count == 1
        table += struct.pack(f"{order}HHI", tag, kind, count)
        table += struct.pack(f"{order}HH" if short else f"{order}I", *((number, 0) if short else (number,)))
    table += struct.pack(f"{order}I", 0)
    if channels == 3:
        table += struct.pack(f"{order}6H", bits, bits, bits, *[2 if signed else 1] * 3)
    head = (b"MM\0*" if big else b"II*\0") + struct.pack(f"{order}I", after)
    path.write_bytes(head + strip + table)
    return path


def ramp(bits: int, channels: int, *, signed: bool = False) -> Array:
    top = (1 << (bits - signed)) - 1
    return np.round(np.linspace(0.0, 1.0, 8 * 12 * channels) * top).astype(np.int64).reshape(8, 12, channels)


def srgb(encoded: Array) -> Array:
    return np.where(encoded <= 0.04045, encoded / 12.92, ((np.abs(encoded) + 0.055) / 1.055) ** 2.4)


@pytest.mark.parametrize("big", [False, True], ids=["little", "big"])
@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize("bits", [1, 2, 4, 6, 8, 10, 12, 14, 16, 24, 32])
def test_unsigned(tmp_path, bits, channels, big):
    codes = ramp(bits, channels)
    path = write_tiff(tmp_path / "a.tif", codes, bits, channels, big=big)
    share = codes / ((1 << bits) - 1)
    pixels = read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED).array
    near = 1.0 / 255.0 if bits == 6 else 2e-5  # OpenImageIO has 6 bits in 8
    np.testing.assert_allclose(pixels[..., :channels], srgb(share), rtol=1e-4, atol=5.0 * near)
    np.testing.assert_allclose(
        read_layer(path, "", Kind.FIELD, sandbox=UNRESTRICTED).array[..., 0], share[..., 0], atol=near
    )
    np.testing.assert_allclose(
        read_layer(path, "", Kind.VECTOR, channels, sandbox=UNRESTRICTED).array, share, atol=near
    )
    assert describe_color_spaces(path, sandbox=UNRESTRICTED)[0][0] == "srgb_rec709_scene"
    if read_info(path, sandbox=UNRESTRICTED).by_rows:
        rows = read_rows(str(path), LayerRequest("", Kind.IMAGE), 2, 5, sandbox=UNRESTRICTED)
        np.testing.assert_array_equal(rows.array, pixels[2:5])


@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize("bits", [8, 16, 32])
def test_signed(tmp_path, bits, channels):
    codes = ramp(bits, channels, signed=True)
    codes[0, 0] = -(1 << (bits - 1)) + 1
    path = write_tiff(tmp_path / "a.tif", codes, bits, channels, signed=True)
    share = codes / ((1 << (bits - 1)) - 1)
    np.testing.assert_allclose(
        read_layer(path, "", Kind.FIELD, sandbox=UNRESTRICTED).array[..., 0], share[..., 0], atol=2e-5
    )
    pixels = read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED).array
    np.testing.assert_allclose(pixels[1:, :, :channels], srgb(share[1:]), rtol=1e-4, atol=2e-5)
    np.testing.assert_allclose(pixels[0, 0, 0], -1.0, atol=1e-4)


def test_colors_of_32_bits_in_exr_are_linear_and_ids_are_counts(tmp_path):
    codes = np.array([[0, 2**31, 2**32 - 1]], np.uint32)[..., None].repeat(3, axis=2)
    path = write_with_attributes(tmp_path / "a.exr", codes, format="uint")
    np.testing.assert_allclose(
        read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED).array[0, :, 0], [0.0, 0.5, 1.0], atol=1e-6
    )
    np.testing.assert_array_equal(
        read_layer(path, "", Kind.FIELD, sandbox=UNRESTRICTED).array[0, :, 0], codes[0, :, 0].astype(np.float32)
    )
    assert describe_color_spaces(path, sandbox=UNRESTRICTED) == [
        ("lin_rec709_scene", "the working space, for nothing says otherwise")
    ]


@pytest.mark.parametrize("number", [0, 9, -1, 2**31 - 1, "sideways"])
def test_an_orientation_that_means_nothing_is_upright(tmp_path, number):
    path = write_with_attributes(tmp_path / "a.exr", np.ones((4, 6, 3), np.float32), Orientation=number)
    assert read_info(path, sandbox=UNRESTRICTED).size == (6, 4)
    assert read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED).array.shape == (4, 6, 4)
