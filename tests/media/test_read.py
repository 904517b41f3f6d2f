"""Pixels are those that OpenImageIO reads, placed, completed and repaired as the sockets want."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.errors import InputError
from halation.media import LayerRequest, read_info, read_layer, read_layers
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED

ROOT = Path(__file__).parents[2]
NEON = ROOT / "presets/samples/neon.exr"
SINGLE = ROOT / "tests/data/blender45_multilayer.exr"
Make = Callable[..., Path]
Random = np.random.Generator


def direct(path: Path, part: int, first: int, last: int) -> np.ndarray:
    return oiio.ImageInput.open(str(path)).read_image(part, 0, first, last, "float")


def test_half_color_stays_half() -> None:
    pixels = read_layer(NEON, "", Kind.IMAGE, sandbox=UNRESTRICTED)
    assert pixels.half and pixels.repaired == 0
    assert pixels.array.dtype == np.float16 and pixels.array.flags.c_contiguous and pixels.array.shape == (270, 480, 4)
    np.testing.assert_array_equal(pixels.array, direct(NEON, 0, 0, 4))


@pytest.mark.parametrize(
    ("layer", "kind", "width", "part", "channels"),
    [
        ("Depth", Kind.FIELD, 1, 1, (0, 1)),
        ("Position", Kind.VECTOR, 3, 2, (0, 3)),
        ("Normal", Kind.VECTOR, 2, 3, (0, 2)),
        ("Vector", Kind.VECTOR, 4, 4, (0, 4)),
        ("Position.Y", Kind.FIELD, 1, 2, (1, 2)),
        ("Object Index", Kind.FIELD, 1, 5, (0, 1)),
        ("CryptoObject00", Kind.VECTOR, 4, 8, (0, 4)),
    ],
)
def test_data_is_exact(layer: str, kind: Kind, width: int, part: int, channels: tuple[int, int]) -> None:
    pixels = read_layer(NEON, layer, kind, width, sandbox=UNRESTRICTED)
    assert pixels.array.dtype == np.float32 and pixels.array.shape == (270, 480, width) and not pixels.half
    np.testing.assert_array_equal(pixels.array.view(np.uint32), direct(NEON, part, *channels).view(np.uint32))


def test_every_layer_of_a_single_part_in_one_go() -> None:
    wants = [
        LayerRequest("Vector", Kind.VECTOR),
        LayerRequest(""),
        LayerRequest("Depth", Kind.FIELD),
        LayerRequest("DiffCol", Kind.IMAGE),
    ]
    together = read_layers(SINGLE, wants, sandbox=UNRESTRICTED)
    for want, pixels, (first, last) in zip(wants, together, [(34, 38), (0, 4), (16, 17), (17, 20)], strict=True):
        expected = direct(SINGLE, 0, first, last)
        np.testing.assert_array_equal(pixels.array[..., : last - first], expected)
        np.testing.assert_array_equal(
            pixels.array, read_layer(SINGLE, want.layer, want.kind, want.width, sandbox=UNRESTRICTED).array
        )
    assert (together[3].array[..., 3] == 1.0).all()


def test_missing_channels(make: Make, rng: Random) -> None:
    path = make("uv.exr", rng.random((5, 7, 2), np.float32), names=("u", "v"))
    stored = direct(path, 0, 0, 2)
    as_vector = read_layer(path, "uv", Kind.VECTOR, 4, sandbox=UNRESTRICTED).array
    np.testing.assert_array_equal(as_vector[..., :2], stored)
    assert not as_vector[..., 2:].any()
    as_image = read_layer(path, "uv", Kind.IMAGE, sandbox=UNRESTRICTED).array
    np.testing.assert_array_equal(as_image[..., :2], stored)
    assert not as_image[..., 2].any() and (as_image[..., 3] == 1.0).all()


def test_field_as_picture_is_gray() -> None:
    array = read_layer(NEON, "Depth", Kind.IMAGE, sandbox=UNRESTRICTED).array
    np.testing.assert_array_equal(array[..., :3], direct(NEON, 1, 0, 1).repeat(3, axis=2))
    assert (array[..., 3] == 1.0).all()


@pytest.mark.parametrize("origin", [(0, 0), (-3, 11)])
@pytest.mark.parametrize(("at", "size"), [((2, 1), (4, 3)), ((-2, -3), (14, 12)), ((6, 5), (6, 6)), ((20, 20), (3, 3))])
def test_data_window(
    make: Make, rng: Random, at: tuple[int, int], size: tuple[int, int], origin: tuple[int, int]
) -> None:
    data = rng.random((size[1], size[0], 4), np.float32)
    left, top = at[0] + origin[0], at[1] + origin[1]
    path = make("w.exr", data, at=(left, top), display=(*origin, 10, 8))
    expected = np.zeros((8, 10, 4), np.float32)
    for y in range(8):
        for x in range(10):
            if 0 <= y - at[1] < size[1] and 0 <= x - at[0] < size[0]:
                expected[y, x] = data[y - at[1], x - at[0]]
    assert read_info(path, sandbox=UNRESTRICTED).size == (10, 8)
    np.testing.assert_array_equal(read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED).array, expected)


def test_opaque_color_is_transparent_outside_its_data(make: Make, rng: Random) -> None:
    path = make("w.exr", rng.random((2, 2, 3), np.float32), at=(1, 1), display=(0, 0, 4, 4))
    alpha = read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED).array[..., 3]
    assert alpha.sum() == 4.0 and alpha[1:3, 1:3].all()


@pytest.mark.parametrize("format", ["float", "half"])
def test_repair_is_that_of_openimageio(make: Make, rng: Random, format: str) -> None:
    broken = rng.random((16, 20, 4), np.float32)
    broken[3, 4, 1] = np.nan
    broken[0, 0] = np.inf
    broken[8:12, 8:12, 2] = -np.inf
    broken[15, 19, 3] = np.nan
    path = make("n.exr", broken, format=format)
    source = oiio.ImageBuf(str(path))
    expected = oiio.ImageBufAlgo.fixNonFinite(source, oiio.NONFINITE_BOX3, nthreads=1).get_pixels(oiio.FLOAT)
    pixels = read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED)
    assert pixels.repaired == 1 + 1 + 16 + 1 and pixels.half == (format == "half")
    assert np.isfinite(pixels.array).all()
    np.testing.assert_array_equal(pixels.array.astype(np.float32), expected)


def test_data_keeps_its_infinite_background(make: Make) -> None:
    stored = np.array([[[1.0], [np.inf], [np.nan], [-np.inf]]], np.float32)
    pixels = read_layer(make("d.exr", stored, names=("Z",)), "Z", Kind.FIELD, sandbox=UNRESTRICTED)
    np.testing.assert_array_equal(pixels.array, np.array([[[1.0], [np.inf], [0.0], [-np.inf]]], np.float32))
    assert pixels.repaired == 1


def test_integer_ids_are_counts(make: Make) -> None:
    ids = np.array([[[0], [7], [65536], [1 << 24]]], np.uint32)
    np.testing.assert_array_equal(
        read_layer(make("id.exr", ids, format="uint", names=("ID",)), "ID", Kind.FIELD, sandbox=UNRESTRICTED).array, ids
    )


@pytest.mark.parametrize("orientation", range(1, 9))
def test_pictures_stand_upright(make: Make, rng: Random, orientation: int) -> None:
    path = make("o.tif", rng.random((4, 6, 3), np.float32), attributes={"Orientation": orientation})
    upright = oiio.ImageBufAlgo.reorient(oiio.ImageBuf(str(path))).get_pixels(oiio.FLOAT)
    pixels = read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED).array
    assert read_info(path, sandbox=UNRESTRICTED).size == (pixels.shape[1], pixels.shape[0])
    np.testing.assert_array_equal(pixels[..., :3], upright)


def test_any_alphabet(make: Make, rng: Random) -> None:
    data = rng.random((3, 3, 4), np.float32)
    np.testing.assert_array_equal(
        read_layer(make("Bild_ä_画像 👁.exr", data), "", Kind.IMAGE, sandbox=UNRESTRICTED).array, data
    )


@pytest.mark.parametrize("compression", ["zip", "dwab", "none"])
@pytest.mark.parametrize(("format", "kind"), [("half", Kind.IMAGE), ("float", Kind.VECTOR), ("uint", Kind.FIELD)])
def test_bands_of_a_tall_picture_are_the_whole(tmp_path: Path, compression: str, format: str, kind: Kind) -> None:
    height, top = 256 * max(1, oiio.get_int_attribute("threads") // 2) * 2 + 37, 11
    random = np.random.default_rng(7)
    numbers = random.integers(0, 1000, (height, 33, 4))
    spec = oiio.ImageSpec(33, height, 4, format)
    spec.attribute("compression", compression)
    spec.y = spec.full_y = -top
    path = tmp_path / "tall.exr"
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), spec)
    assert output.write_image(numbers.astype({"half": np.float16, "float": np.float32, "uint": np.uint32}[format]))
    output.close()
    pixels = read_layer(path, "", kind, sandbox=UNRESTRICTED)
    whole = oiio.ImageInput.open(str(path)).read_image(0, 0, 0, pixels.array.shape[2], format)
    np.testing.assert_array_equal(pixels.array, whole)


def test_a_tall_picture_that_is_cut_short_is_an_error(tmp_path: Path) -> None:
    height = 256 * max(1, oiio.get_int_attribute("threads") // 2) * 2
    path = tmp_path / "tall.exr"
    oiio.ImageBuf(np.random.default_rng(7).random((height, 33, 4), np.float32)).write(str(path), "half")
    path.write_bytes(path.read_bytes()[: path.stat().st_size * 3 // 4])
    with pytest.raises(InputError, match="is cut short or damaged"):
        read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED)
