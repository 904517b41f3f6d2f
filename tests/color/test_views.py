"""Color in and out agrees with the formulas and with OpenImageIO's own use of OpenColorIO."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import PyOpenColorIO as ocio
import pytest
from halation.color.display import find_view, list_displays, list_views, to_display
from halation.color.gpu_programs import write_view_program
from halation.errors import InputError, UsageError
from halation.media import read_layer
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED

Make = Callable[..., Path]
Random = np.random.Generator
ACES = "ACES 2.0 - SDR 100 nits (Rec.709)"


def decoded(encoded: np.ndarray) -> np.ndarray:
    """IEC 61966-2-1, in doubles."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def encoded(linear: np.ndarray) -> np.ndarray:
    return np.where(linear <= 0.0031308, linear * 12.92, 1.055 * np.abs(linear) ** (1 / 2.4) - 0.055)


@pytest.mark.parametrize("name", ["a.png", "a.tif", "a.bmp", "a.tga"])
def test_every_8_bit_level(make: Make, name: str) -> None:
    levels = np.arange(256, dtype=np.uint8).reshape(16, 16, 1).repeat(3, axis=2)
    array = read_layer(make(name, levels, format="uint8"), "", Kind.IMAGE, sandbox=UNRESTRICTED).array
    assert array.dtype == np.float32 and (array[..., 3] == 1.0).all()
    np.testing.assert_allclose(array[..., :3], decoded(levels / 255), atol=1e-7)


@pytest.mark.parametrize("name", ["a.png", "a.tif"])
def test_every_16_bit_level(make: Make, name: str) -> None:
    levels = np.arange(65536, dtype=np.uint16).reshape(256, 256, 1).repeat(3, axis=2)
    array = read_layer(make(name, levels, format="uint16"), "", Kind.IMAGE, sandbox=UNRESTRICTED).array
    np.testing.assert_allclose(array[..., :3], decoded(levels / 65535), atol=1e-7)


@pytest.mark.parametrize("name", ["a.jpg", "a.webp"])
def test_lossy_formats(make: Make, name: str) -> None:
    smooth = np.linspace(20, 230, 64 * 64 * 3).astype(np.uint8).reshape(64, 64, 3)
    path = make(name, smooth, format="uint8")
    stored = oiio.ImageInput.open(str(path)).read_image(0, 0, 0, 3, "uint8")
    np.testing.assert_allclose(
        read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED).array[..., :3], decoded(stored / 255), atol=1e-7
    )


def test_radiance_is_linear(make: Make, rng: Random) -> None:
    path = make("a.hdr", rng.random((9, 16, 3), np.float32) * 50)
    stored = oiio.ImageInput.open(str(path)).read_image(0, 0, 0, 3, "float")
    np.testing.assert_array_equal(read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED).array[..., :3], stored)


def test_gray_and_palette(make: Make, tmp_path: Path) -> None:
    gray = np.arange(256, dtype=np.uint8).reshape(16, 16, 1)
    array = read_layer(make("g.png", gray, format="uint8", names=("Y",)), "", Kind.IMAGE, sandbox=UNRESTRICTED).array
    np.testing.assert_allclose(array[..., :3], decoded(gray / 255).repeat(3, axis=2), atol=1e-7)
    colors = np.array([[[255, 0, 0], [0, 128, 255]], [[7, 7, 7], [255, 0, 0]]], np.uint8)
    array = read_layer(make("p.gif", colors, format="uint8"), "", Kind.IMAGE, sandbox=UNRESTRICTED).array
    np.testing.assert_allclose(array[..., :3], decoded(colors / 255), atol=1e-7)


@pytest.mark.parametrize(
    ("name", "channels"), [("a.png", "RGBA"), ("a.webp", "RGBA"), ("a.tif", "RGBA"), ("g.png", "YA")]
)
def test_straight_alpha_is_applied_to_linear_color(make: Make, rng: Random, name: str, channels: str) -> None:
    stored = rng.integers(0, 256, (16, 16, len(channels)), dtype=np.uint8)
    path = make(
        name, stored, format="uint8", names=tuple(channels), attributes={"oiio:UnassociatedAlpha": 1, "webp:method": 6}
    )
    wish = oiio.ImageSpec()
    wish.attribute("oiio:UnassociatedAlpha", 1)
    file = oiio.ImageInput.open(str(path), wish).read_image(0, 0, 0, len(channels), "uint8") / 255
    array = read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED).array
    np.testing.assert_allclose(array[..., 3:], file[..., -1:], atol=1e-7)
    np.testing.assert_allclose(array[..., :3], decoded(file[..., :-1]) * file[..., -1:] * np.ones(3), atol=1e-6)


def test_associated_alpha_is_taken_out_of_the_encoding(make: Make) -> None:
    stored = np.array([[[100, 50, 25, 200], [0, 0, 0, 0], [255, 255, 255, 255]]], np.uint8)
    array = read_layer(make("a.tif", stored, format="uint8"), "", Kind.IMAGE, sandbox=UNRESTRICTED).array
    alpha = stored[..., 3:] / 255
    color = np.divide(stored[..., :3] / 255, alpha, out=np.zeros((1, 3, 3)), where=alpha > 0)
    np.testing.assert_allclose(array[..., :3], decoded(color) * alpha, atol=1e-6)


def test_a_mask_is_read_as_numbers(make: Make) -> None:
    levels = np.arange(256, dtype=np.uint8).reshape(16, 16, 1)
    mask = read_layer(make("m.png", levels, format="uint8", names=("Y",)), "", Kind.FIELD, sandbox=UNRESTRICTED).array
    np.testing.assert_allclose(mask, levels / 255, atol=1e-7)


@pytest.mark.parametrize(
    "attributes",
    [
        {"oiio:ColorSpace": "lin_ap1_scene"},
        {"chromaticities": ("float[8]", (0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767))},
    ],
)
def test_wide_gamut_becomes_rec709(make: Make, rng: Random, attributes: dict[str, object]) -> None:
    colors = rng.random((8, 8, 3), np.float32)
    array = read_layer(make("a.exr", colors, attributes=attributes), "", Kind.IMAGE, sandbox=UNRESTRICTED).array[
        ..., :3
    ]
    # AP1 to Rec.709 with the Bradford adaptation of D60 to D65 (ACES, TB-2018-001)
    matrix = np.array(
        [
            [1.70505, -0.62179, -0.08326],
            [-0.13026, 1.14080, -0.01055],
            [-0.02400, -0.12897, 1.15297],
        ]
    )
    np.testing.assert_allclose(array, colors @ matrix.T, atol=2e-5)


def test_an_unknown_space_is_an_error(make: Make, rng: Random) -> None:
    path = make("a.exr", rng.random((4, 4, 3), np.float32), attributes={"colorInteropID": "my_own_space"})
    with pytest.raises(InputError, match=r"a\.exr: its color space 'my_own_space' is unknown"):
        read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED)


def shown_by_oiio(colors: np.ndarray, view: str) -> np.ndarray:
    """What OpenImageIO's command for the same view makes of premultiplied RGBA, straight."""
    config = "ocio://default"
    source = oiio.ImageBuf(colors)
    shown = oiio.ImageBufAlgo.ociodisplay(
        source, "sRGB - Display", view, fromspace="lin_rec709_scene", unpremult=True, colorconfig=config
    )
    assert not shown.has_error, shown.geterror()
    return oiio.ImageBufAlgo.unpremult(shown).get_pixels(oiio.FLOAT)


@pytest.mark.parametrize("view", ["", ACES, "Un-tone-mapped", "Video (colorimetric)"])
def test_views_agree_with_openimageio(rng: Random, view: str) -> None:
    colors = np.exp2(rng.uniform(-10, 6, (64, 64, 4))).astype(np.float32)
    colors[..., 3] = rng.uniform(0.05, 1.0, (64, 64))
    expected = shown_by_oiio(colors, view or ACES).clip(0, 1)
    bytes8 = to_display(colors, view)
    assert bytes8.dtype == np.uint8 and np.abs(bytes8 / 255 - expected).max() <= 1 / 255
    assert np.abs(to_display(colors, view, bits=16) / 65535 - expected).max() <= 1e-4
    assert np.abs(to_display(colors, view, bits=32).clip(0, 1) - expected).max() <= 1e-4


def test_no_view_is_the_srgb_formula(rng: Random) -> None:
    colors = rng.uniform(-0.2, 1.5, (32, 32, 3)).astype(np.float32)
    expected = encoded(colors.clip(0, 1))
    np.testing.assert_allclose(to_display(colors, "none", bits=32).clip(0, 1), expected, atol=2e-5)
    assert np.abs(to_display(colors, "none") - expected * 255).max() <= 0.51


def test_glow_without_alpha_stays_bright() -> None:
    glow = np.array([[[0.5, 0.2, 0.1, 0.0]]], np.float32)
    shown = to_display(glow, "none", bits=32)[0, 0]
    np.testing.assert_allclose(shown[:3], encoded(glow[0, 0, :3]), atol=2e-5)
    assert shown[3] == 0.0


def test_broken_numbers_do_not_leak() -> None:
    clean = np.full((4, 5, 4), 0.5, np.float32)
    broken = clean.copy()
    broken[1, 1] = np.nan
    broken[2, 2, :3] = np.inf
    broken[3, 3, :3] = -np.inf
    shown, expected = to_display(broken), to_display(clean)
    touched = np.zeros((4, 5), bool)
    touched[[1, 2, 3], [1, 2, 3]] = True
    np.testing.assert_array_equal(shown[~touched], expected[~touched])
    assert shown[1, 1].tolist() == [0, 0, 0, 0] and shown[2, 2, :3].min() > 250 and shown[3, 3, :3].max() == 0


def test_names_of_views() -> None:
    known = ocio.Config.CreateFromBuiltinConfig("ocio://default").getViews("sRGB - Display")
    assert list_views() == (*known, "none") and find_view("") == list_views()[0] == ACES
    assert find_view("aces") == ACES and find_view("UN-TONE") == "Un-tone-mapped" and find_view("raw") == "Raw"
    with pytest.raises(UsageError, match=r"no view 'Untonemapped': did you mean 'Un-tone-mapped'\? Choose from ACES"):
        find_view("Untonemapped")
    with pytest.raises(UsageError, match="no view 'qqqq': choose from ACES"):
        find_view("qqqq")


def test_opencolorio_is_loaded_when_needed() -> None:
    code = "import sys, halation.media; print('PyOpenColorIO' in sys.modules)"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout.strip() == "False"


def test_displays_have_views_of_their_own() -> None:
    known = tuple(ocio.Config.CreateFromBuiltinConfig("ocio://default").getDisplays())
    assert list_displays() == known and list_displays()[0] == "sRGB - Display"
    assert list_views(list_displays()[0]) == list_views()
    assert list_views("Display P3 - Display")[0] == "ACES 2.0 - SDR 100 nits (P3 D65)"
    with pytest.raises(UsageError, match="there is no display 'CRT': choose from sRGB - Display"):
        list_views("CRT")
    with pytest.raises(UsageError, match=r"there is no view 'ACES 2.0 - SDR 100 nits \(P3 D65\)'"):
        to_display(np.zeros((1, 1, 3)), "ACES 2.0 - SDR 100 nits (P3 D65)")


def test_another_display_shows_other_numbers(rng: Random) -> None:
    colors = rng.random((4, 4, 3), np.float32)
    processor = ocio.Config.CreateFromBuiltinConfig("ocio://default").getProcessor(
        "lin_rec709_scene", "Display P3 - Display", "Un-tone-mapped", ocio.TRANSFORM_DIR_FORWARD
    )
    expected = colors.copy()
    processor.getDefaultCPUProcessor().applyRGB(expected)
    np.testing.assert_array_equal(to_display(colors, "Un-tone", bits=32, display="Display P3 - Display"), expected)
    plain = to_display(colors, "none", bits=32)
    np.testing.assert_array_equal(to_display(colors, "none", bits=32, display="Display P3 - Display"), plain)


@pytest.mark.parametrize("display", list_displays())
def test_a_view_for_shaders_declares_all_that_it_reads(display: str) -> None:
    for view in list_views(display):
        found = write_view_program(view, display)
        assert f"vec4 {found.function}(vec4" in found.text.body and "sampler1D" not in found.text.body
        assert found.text.body.count("uniform sampler") == len(found.tables)
        for table in found.tables:
            values = np.asarray(table.values)
            assert table.sampler in found.text.body and values.dtype == np.float32 and np.isfinite(values).all()
