"""Color under alpha: light without cover survives, in every space of the built-in config, in and out."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.color.encoding import Encoding
from halation.color.management import OcioColorSpace, get_color_manager, get_default_color_manager
from halation.color.transforms import from_working
from halation.media import read_layer, write_picture
from halation.nodes import ColorSettings, Kind
from halation.resources.sandbox import UNRESTRICTED
from house_config import OCIO, studio
from oiio_pictures import write_with_attributes

Array = np.ndarray
COLORS = np.array([(0.5, 0.4, 0.3), (0.02, 0.18, 0.7), (0.0, 0.0, 0.0), (0.9, 0.05, 0.35)])
ALPHAS = (0.0, 1e-6, 1e-3, 0.25, 1.0, 1.5, 40.0, -0.5)
SPACES = [space.getName() for space in studio().getColorSpaces() if not space.isData()]
LINEAR = [name for name in SPACES if studio().isColorSpaceLinear(name, OCIO.REFERENCE_SPACE_SCENE)]
WORKING = "Linear Rec.709 (sRGB)"


def cards() -> Array:
    """Every color under every alpha, premultiplied where there is cover: [alphas, colors, 4], float32."""
    rows = [[(*(color * alpha if alpha > 0.0 else color), alpha) for color in COLORS] for alpha in ALPHAS]
    return np.array(rows, np.float32)


def reference(rgba: Array, source: str, target: str) -> Array:
    """The same in float64 but for the curve, which is OpenColorIO's: straight where there is cover, else as it is."""
    exact = rgba.astype(np.float64)
    color, alpha = exact[..., :3], exact[..., 3:]
    covered = alpha > 0.0
    straight = np.where(covered, color / np.where(covered, alpha, 1.0), color)
    processor = studio().getProcessor(source, target).getOptimizedCPUProcessor(OCIO.OPTIMIZATION_LOSSLESS)
    light = np.ascontiguousarray(straight, np.float32)
    processor.applyRGB(light)
    return np.where(covered, light.astype(np.float64) * alpha, light)


def read(path: Path, **options: object) -> Array:
    return read_layer(path, "", Kind.IMAGE, **options, sandbox=UNRESTRICTED).array


@pytest.mark.parametrize("space", SPACES)
def test_every_space_in_and_out(tmp_path, space):
    rgba = cards()
    path = write_with_attributes(tmp_path / "a.exr", rgba, format="float", colorInteropID=space)
    expected = reference(rgba, space, WORKING)
    is_empty = (rgba == 0.0).all(axis=2)
    expected[is_empty] = 0.0  # no light and no cover is nothing, whatever the curve makes of 0
    pixels = read(path)
    np.testing.assert_array_equal(pixels[..., 3], rgba[..., 3])
    scale = np.abs(expected).max(axis=2, keepdims=True)
    np.testing.assert_allclose(pixels[..., :3] / (scale + 1e-9), expected / (scale + 1e-9), atol=2e-4)
    is_light = (rgba[..., :3] > 0.0).any(axis=2) & (np.abs(expected) > 1e-5).any(axis=2)
    assert np.abs(pixels[is_light][:, :3]).max(axis=1).min() > 0.0
    if space == WORKING:
        return
    write_picture(
        tmp_path / "b.exr",
        {"": rgba},
        kinds={"": Kind.IMAGE},
        precision="float",
        encoding=Encoding(space=space),
        sandbox=UNRESTRICTED,
    )
    stored = oiio.ImageBuf(str(tmp_path / "b.exr")).get_pixels(oiio.FLOAT)
    np.testing.assert_allclose(stored[..., :3], reference(rgba, WORKING, space), rtol=1e-3, atol=1e-5)


@pytest.mark.parametrize("space", LINEAR)
def test_linear_spaces_are_a_matrix_whatever_alpha_is(tmp_path, space):
    rgba = np.random.default_rng(2).normal(0.0, 4.0, (16, 16, 4)).astype(np.float32)
    rgba[0, :, 3], rgba[1, :, 3], rgba[2, :, 3] = 0.0, 1e-30, -1.0
    matrix = np.eye(3, dtype=np.float32)
    studio().getProcessor(space, WORKING).getDefaultCPUProcessor().applyRGB(matrix)
    path = write_with_attributes(tmp_path / "a.exr", rgba, format="float", colorInteropID=space)
    expected = rgba[..., :3].astype(np.float64) @ matrix.astype(np.float64)
    np.testing.assert_allclose(read(path)[..., :3], expected, rtol=2e-5, atol=2e-5)


@pytest.mark.parametrize("format", ["half", "float"])
@pytest.mark.parametrize("space", ["ACEScg", "ACES2065-1", "ARRI LogC4", "srgb_rec709_scene"])
def test_a_glow_without_cover_survives(tmp_path, format, space):
    rgba = np.zeros((4, 6, 4), np.float32)
    rgba[..., :3] = (0.5, 0.4, 0.3)
    path = write_with_attributes(tmp_path / "a.exr", rgba, format=format, colorInteropID=space)
    for color in (ColorSettings(), ColorSettings("", "ACEScg"), ColorSettings("ocio://default", "ACES2065-1")):
        pixels = read(path, manager=get_color_manager(color, UNRESTRICTED))
        assert (pixels[..., :3] > 0.02).all() and not pixels[..., 3].any()


def test_a_tiny_alpha_never_makes_light_infinite(tmp_path):
    """A log curve gives infinite light for 0.5 / 1e-6: such a pixel is converted as it stands."""
    rgba = np.full((3, 3, 4), 0.5, np.float32)
    rgba[..., 3] = np.array([1e-6, 1e-20, 1e-41], np.float32)
    path = write_with_attributes(tmp_path / "a.exr", rgba, format="float", colorInteropID="arri_logc4")
    pixels = read_layer(path, "", Kind.IMAGE, sandbox=UNRESTRICTED)
    assert np.isfinite(pixels.array).all() and pixels.repaired == 0
    np.testing.assert_allclose(pixels.array[..., :3], reference(rgba * (1, 1, 1, 0), "ARRI LogC4", WORKING), rtol=1e-4)


def test_light_above_half_is_kept_on_the_way_out(tmp_path):
    rgba = np.array([[(0.5, 0.5, 0.5, 1e-6), (9e4, 1.0, 1.0, 1.0)]], np.float32)
    write_picture(
        tmp_path / "a.exr",
        {"": rgba},
        kinds={"": Kind.IMAGE},
        precision="float",
        encoding=Encoding(space="g22_rec709_scene"),
        sandbox=UNRESTRICTED,
    )
    np.testing.assert_allclose(read(tmp_path / "a.exr"), rgba, rtol=1e-3)


def test_straight_files_and_views_under_no_cover(tmp_path):
    """A straight file has no color where alpha is 0; a view shows a glow as bright as it is."""
    codes = np.full((2, 2, 4), 128, np.uint8)
    codes[..., 3] = 0
    assert not read(write_with_attributes(tmp_path / "a.png", codes, format="uint8")).any()
    glow = np.array([[(0.5, 0.4, 0.3, 0.0)]], np.float32)
    shown = Encoding("none").to_codes(glow, 16)
    opaque = Encoding("none").to_codes(np.array([[(0.5, 0.4, 0.3, 1.0)]], np.float32), 16)
    np.testing.assert_array_equal(shown[..., :3], opaque[..., :3])


def test_a_bitmap_without_any_cover_has_a_fourth_byte_that_nobody_wrote(tmp_path):
    codes = np.full((2, 2, 4), 128, np.uint8)
    codes[..., 3] = 0
    path = write_with_attributes(tmp_path / "a.bmp", codes, format="uint8")
    np.testing.assert_allclose(read(path), [[(0.2158605,) * 3 + (1.0,)] * 2] * 2, rtol=1e-5)
    codes[0, 0, 3] = 255
    assert (read(write_with_attributes(tmp_path / "b.bmp", codes, format="uint8"))[1] == 0.0).all()


def test_data_spaces_stay_as_they_are():
    manager = get_default_color_manager()
    light = np.array([[0.1, 0.2, 0.3]], np.float32)
    np.testing.assert_array_equal(from_working(light, OcioColorSpace("Raw", True, True), manager), light)
