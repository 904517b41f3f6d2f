"""How far pictures are apart, against scipy, OpenCV and OpenImageIO."""

from __future__ import annotations

import math

import cv2
import numpy as np
import OpenImageIO as oiio
import pytest
from halation.errors import UsageError
from halation.media.comparison import side_by_side
from halation.media.comparison.metrics import (
    EIGHT_BIT_STEP,
    amplify_difference,
    compare_pictures,
    measure_flip,
    measure_ssim,
)
from halation.media.comparison.side_by_side import PicturePair, write_side_by_side
from halation.media.pictures.stored import StoredPart, encode_for_viewing
from halation.resources.sandbox import UNRESTRICTED
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.ndimage import gaussian_filter, zoom

Array = np.ndarray


def scene(rng: np.random.Generator, height: int = 40, width: int = 56, channels: int = 3, top: float = 1.0) -> Array:
    """Smooth light with detail, from 0 to `top`."""
    coarse = zoom(rng.random((5, 7, channels)), (height / 5, width / 7, 1), order=1)
    return (top * np.clip(0.8 * coarse + 0.2 * rng.random((height, width, channels)), 0.0, 1.0)).astype(np.float32)


def nudged(rng: np.random.Generator, picture: Array, by: float = 0.05) -> Array:
    return (picture + by * rng.standard_normal(picture.shape)).astype(np.float32)


def buffer(array: Array) -> oiio.ImageBuf:
    return oiio.ImageBuf(np.ascontiguousarray(array))


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
@pytest.mark.parametrize("top", [0.5, 1.0, 40.0])
def test_plain_measures_are_those_of_openimageio(rng: np.random.Generator, channels: int, top: float) -> None:
    expected = scene(rng, channels=channels, top=top)
    actual = nudged(rng, expected)
    found = compare_pictures(actual, expected, threshold=0.06, perceptual=False)
    reference = oiio.ImageBufAlgo.compare(buffer(actual), buffer(expected), 0.06, 0.06)
    assert found.max_abs == pytest.approx(reference.maxerror, rel=1e-5)
    assert found.rms == pytest.approx(reference.rms_error, rel=1e-5)
    assert found.psnr == pytest.approx(reference.PSNR, abs=1e-3)
    assert found.worst == (reference.maxx, reference.maxy)
    assert round(found.failing * 40 * 56) == reference.nfail
    assert math.isnan(found.ssim) and math.isnan(found.flip)


def test_relative_differences_are_parts_of_the_expected_where_numbers_are_large(rng: np.random.Generator) -> None:
    expected = scene(rng, top=50.0) + np.float32(3.0)
    actual = nudged(rng, expected, 1.0)
    found = compare_pictures(actual, expected, threshold=0.1, relative=True, perceptual=False)
    reference = np.abs(actual.astype(float) - expected) / expected
    assert found.max_rel == pytest.approx(reference.max(), rel=1e-6)
    assert found.failing == pytest.approx(np.mean(reference.max(axis=2) > 0.1))
    y, x = np.unravel_index(reference.max(axis=2).argmax(), reference.shape[:2])
    assert found.worst == (x, y)


@pytest.mark.parametrize("top", [0.25, 1.0])
def test_relative_differences_are_absolute_up_to_one(rng: np.random.Generator, top: float) -> None:
    expected = scene(rng, top=top)
    actual = nudged(rng, expected)
    plain, relative = (compare_pictures(actual, expected, relative=flag, perceptual=False) for flag in (False, True))
    assert plain == relative and plain.max_rel == plain.max_abs


def test_the_peak_of_psnr_is_that_of_opencv_where_pictures_end_at_one(rng: np.random.Generator) -> None:
    expected = scene(rng)
    actual = np.clip(nudged(rng, expected), 0.0, 1.0)
    assert compare_pictures(actual, expected).psnr == pytest.approx(cv2.PSNR(actual, expected, 1.0), abs=1e-3)


def wang(x: Array, y: Array, span: float) -> float:
    """SSIM of one channel by scipy's filter, as scikit-image documents it for the numbers of Wang et al."""

    def blur(item: Array) -> Array:
        return gaussian_filter(item.astype(np.float64), 1.5, truncate=3.5)

    mx, my = blur(x), blur(y)
    vx, vy, vxy = blur(x * x) - mx * mx, blur(y * y) - my * my, blur(x * y) - mx * my
    one, two = (0.01 * span) ** 2, (0.03 * span) ** 2
    found = (2 * mx * my + one) * (2 * vxy + two) / ((mx**2 + my**2 + one) * (vx + vy + two))
    return float(found[5:-5, 5:-5].mean())


@pytest.mark.parametrize("top", [1.0, 40.0])
def test_ssim_is_that_of_the_paper(rng: np.random.Generator, top: float) -> None:
    expected = scene(rng, top=top).astype(np.float64)
    actual = nudged(rng, expected, 0.05 * top).astype(np.float64)
    span = max(1.0, expected.max(), actual.max())
    reference = np.mean([wang(actual[..., c], expected[..., c], span) for c in range(3)])
    assert 0.2 < reference < 0.99
    assert measure_ssim(actual, expected, linear=False) == pytest.approx(reference, abs=1e-9)


def test_ssim_of_linear_light_is_that_of_its_encoding(rng: np.random.Generator) -> None:
    expected, actual = scene(rng), scene(rng)
    processor = [
        oiio.ImageBufAlgo.colorconvert(buffer(item), "lin_rec709_scene", "srgb_rec709_scene")
        for item in (actual, expected)
    ]
    encoded = [item.get_pixels(oiio.FLOAT) for item in processor]
    assert measure_ssim(actual, expected) == pytest.approx(measure_ssim(*encoded, linear=False), abs=1e-5)


@pytest.mark.parametrize(("mean", "contrast"), [(0.5, 1.2), (0.1, 1.0), (0.9, 0.5)])
def test_ssim_of_flat_pictures_has_a_closed_form(mean: float, contrast: float) -> None:
    first, second = np.full((16, 16), mean), np.full((16, 16), mean * contrast)
    span = max(1.0, mean, mean * contrast)
    one = (0.01 * span) ** 2
    expected = (2 * mean**2 * contrast + one) / (mean**2 * (1 + contrast**2) + one)
    assert measure_ssim(second, first, linear=False) == pytest.approx(expected, abs=1e-9)


def test_flip_is_openimageios(rng: np.random.Generator) -> None:
    expected = scene(rng, top=3.0)
    actual = nudged(rng, expected)
    for linear, hdr in ((True, 1), (False, 0)):
        pair = (
            (expected, actual)
            if linear
            else [
                oiio.ImageBufAlgo.colorconvert(
                    buffer(np.clip(item, 0, 1)), "srgb_rec709_scene", "lin_rec709_scene"
                ).get_pixels(oiio.FLOAT)
                for item in (expected, actual)
            ]
        )
        reference = oiio.ImageBufAlgo.FLIP_diff(*map(buffer, pair), hdr=hdr)
        mean = reference.spec().getattribute("FLIP:meanerror")
        assert measure_flip(actual, expected, linear=linear) == pytest.approx(mean, abs=2e-5)


def test_flip_of_green_and_blue_is_its_largest() -> None:
    """The largest color difference there is, by which the paper scales all others."""
    green, blue = np.zeros((24, 24, 3)), np.zeros((24, 24, 3))
    green[..., 1] = blue[..., 2] = 1.0
    assert measure_flip(blue, green, linear=False) == pytest.approx(1.0, abs=1e-4)


@pytest.mark.parametrize("channels", [0, 1, 2, 3, 4, 6])
def test_equal_pictures(rng: np.random.Generator, channels: int) -> None:
    picture = scene(rng, channels=max(1, channels), top=9.0)
    picture = picture if channels else picture[..., 0]
    found = compare_pictures(picture.copy(), picture)
    assert found.equal and (found.max_abs, found.rms, found.psnr, found.failing) == (0.0, 0.0, math.inf, 0.0)
    assert found.ssim == pytest.approx(1.0, abs=1e-9) and found.flip == pytest.approx(0.0, abs=1e-6)
    assert (found.worst, found.actual, found.expected) == (None, (), ())
    assert not amplify_difference(picture, picture).any()


@pytest.mark.parametrize("number", [np.nan, np.inf, -np.inf])
def test_what_is_not_finite_equals_the_same_only(rng: np.random.Generator, number: float) -> None:
    expected = scene(rng)
    expected[20, 30, 1] = number
    assert compare_pictures(expected.copy(), expected).equal
    for actual in (np.nan_to_num(expected, nan=0.0, posinf=0.0, neginf=0.0), np.where(expected == 0, 0, -expected)):
        found = compare_pictures(actual, expected)
        if math.isnan(number) and np.isnan(actual).any():
            continue
        assert (found.max_abs, found.rms, found.psnr, found.broken) == (math.inf, math.inf, -math.inf, 1)
        assert found.worst == (30, 20)
    clean = np.nan_to_num(expected, nan=0.5, posinf=0.5, neginf=0.5)
    found, pixels = compare_pictures(clean, expected), 40 * 56
    assert found.failing == pytest.approx(1 / pixels) and found.flip >= 1 / pixels
    assert found.ssim == pytest.approx(1.0 - 121 / (3 * 30 * 46), abs=1e-9)
    light = amplify_difference(clean, expected)
    assert tuple(light[20, 30]) == (1.0, 0.0, 1.0) and light.sum() == 2.0


def test_sizes_and_channels_that_differ_are_told() -> None:
    small, large = np.zeros((4, 6, 3)), np.zeros((5, 6, 3))
    found = compare_pictures(small, large)
    assert found.fault == "the size is 6x4, and 6x5 is expected"
    assert (found.max_abs, found.ssim, found.flip, found.failing) == (math.inf, 0.0, 1.0, 1.0)
    assert "it has 1 channel, and 3 are expected" in compare_pictures(small[..., 0], small).fault
    with pytest.raises(UsageError, match="6x4"):
        measure_ssim(small, large)
    light = amplify_difference(small, large)
    assert light.shape == (5, 6, 3) and (light[4] == (1, 0, 1)).all() and not light[:4].any()


@pytest.mark.parametrize("array", [np.zeros((2, 2, 2, 2)), np.zeros(3), np.zeros((0, 4)), np.array([["a"]])])
def test_what_is_no_picture_is_refused(array: Array) -> None:
    with pytest.raises(UsageError, match=r"the actual picture is .*\[height, width, channels\]"):
        compare_pictures(array, np.zeros((2, 2)))


def test_integers_fill_zero_to_one() -> None:
    expected = np.full((3, 3, 3), 100, np.uint8)
    found = compare_pictures(expected + np.uint8(2), expected, threshold=1.5 * EIGHT_BIT_STEP)
    assert found.max_abs == pytest.approx(2 / 255, rel=1e-5) and found.failing == 1.0


def test_the_picture_of_differences(rng: np.random.Generator) -> None:
    expected = scene(rng, channels=4)
    actual = expected.copy()
    actual[3, 5] += (0.25, 0.0, 0.0, 0.0)
    actual[9, 9, 3] -= np.float32(0.125)
    assert amplify_difference(actual, expected)[3, 5] == pytest.approx((1.0, 0.0, 0.0), abs=1e-5)
    light = amplify_difference(actual, expected, 2.0)
    assert light[3, 5] == pytest.approx((0.5, 0.0, 0.0), abs=1e-5)
    assert light[9, 9] == pytest.approx((0.25, 0.25, 0.25), abs=1e-5)
    assert np.count_nonzero(light.any(axis=2)) == 2
    assert amplify_difference(actual, expected, 1000.0).max() == 1.0


NUMBERS = st.floats(-1e6, 1e6, width=32) | st.sampled_from([np.nan, np.inf, -np.inf])
PICTURES = st.tuples(st.integers(1, 14), st.integers(1, 14), st.integers(1, 5)).flatmap(
    lambda shape: st.tuples(*[arrays(np.float32, shape, elements=NUMBERS)] * 2)
)


@settings(max_examples=60)
@given(PICTURES)
def test_measures_stay_within_their_bounds(pair: tuple[Array, Array]) -> None:
    """Nothing warns (the tests make that an error), whatever the numbers; both ways round are the same."""
    found, back = compare_pictures(*pair), compare_pictures(*pair[::-1])
    assert 0.0 <= found.failing <= 1.0 and 0.0 <= found.flip <= 1.0 + 1e-6 and -1.0 - 1e-6 <= found.ssim <= 1.0 + 1e-6
    assert (found.max_abs, found.rms, found.psnr, found.failing) == (back.max_abs, back.rms, back.psnr, back.failing)
    assert found.rms <= found.max_abs
    light = amplify_difference(*pair)
    assert light.shape == (*pair[0].shape[:2], 3) and light.min() >= 0.0 and light.max() <= 1.0
    assert compare_pictures(pair[0], pair[0].copy()).equal


def test_pairs_stand_side_by_side(tmp_path, monkeypatch):
    """Data of a pair has one range, black to white (IEC 61966-2-1 by hand); what one side lacks is black and named."""
    cells = {}
    make_sheet = side_by_side.make_sheet
    monkeypatch.setattr(
        side_by_side, "make_sheet", lambda given, columns: cells.update(given) or make_sheet(given, columns)
    )
    ramp = np.linspace(0.0, 1.0, 40, dtype=np.float32).reshape(1, 40, 1).repeat(20, 0)
    pairs = {
        "depth": PicturePair(ramp, 4.0 * ramp - 1.0, False),
        "new": PicturePair(None, ramp, False),
        "old": PicturePair(ramp, None, False),
        "flat": PicturePair(0.5 * np.ones_like(ramp), 0.5 * np.ones_like(ramp), False),
        "light": PicturePair(np.dstack([ramp] * 3), np.dstack([ramp] * 3), True, "Un-tone-mapped"),
    }
    path = tmp_path / "pairs.png"
    write_side_by_side(path, pairs, ("a", "b"), UNRESTRICTED)
    assert list(cells) == [
        *("depth: a", "depth: b", "depth: difference"),
        *("new: not in a", "new: b", "new: difference"),
        *("old: a", "old: not in b", "old: difference"),
        *("flat: a", "flat: b", "flat: difference"),
        *("light: a", "light: b", "light: difference"),
    ]

    def shown(codes):
        return np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4).repeat(3, 2)

    np.testing.assert_allclose(cells["depth: a"], shown((ramp + 1.0) / 4.0), atol=1e-6)
    np.testing.assert_allclose(cells["depth: b"], shown(ramp), atol=1e-6)
    np.testing.assert_allclose(cells["depth: difference"], (np.abs(3.0 * ramp - 1.0) / 2.0).repeat(3, 2), atol=1e-6)
    for name in ("new: b", "old: a"):
        np.testing.assert_allclose(cells[name], shown(ramp), atol=1e-6)
    for name in ("new: not in a", "old: not in b", "flat: a", "flat: difference", "light: difference"):
        assert cells[name].shape == (20, 40, 3) and not cells[name].any()
    for name in ("new: difference", "old: difference"):
        np.testing.assert_allclose(cells[name], ramp.repeat(3, 2), atol=1e-6)
    np.testing.assert_allclose(cells["light: a"], np.dstack([ramp] * 3), atol=4e-3)  # sRGB there and back
    spec = oiio.ImageInput.open(str(path)).spec()
    assert spec.width > 3 * 40 and spec.height > 5 * 20


def test_parts_of_files_as_they_are_shown():
    """Data from black to white over its span, integers as they are stored, light through the view, without alpha."""
    numbers = np.array([[-np.inf, 2.0, 3.0, 4.0, 6.0, 9.0, np.inf, np.nan]], np.float32)[..., None]
    depth = encode_for_viewing(StoredPart(numbers, ("Z",), False), span=(2.0, 6.0))
    assert depth[0, :, 0].tolist() == [0, 0, 64, 128, 255, 255, 255, 0] and depth.shape == (1, 8, 3)
    flat = encode_for_viewing(StoredPart(numbers[:, 1:6], ("Z",), False), span=(2.0, 2.0))
    assert flat[0, :, 0].tolist() == [0, 255, 255, 255, 255]
    half = encode_for_viewing(StoredPart(np.full((1, 1, 1), 2.5, np.float32), ("Z",), False), span=(2.0, 2.0))
    assert half[0, 0].tolist() == [128] * 3
    codes = np.array([[[0.0, 0.5, 1.0, 0.25]]], np.float32)
    assert encode_for_viewing(StoredPart(codes, tuple("RGBA"), True), "none")[0, 0].tolist() == [0, 128, 255]
    light = np.array([[[0.18, 1.0, 0.0, 0.5], [0.5, 0.5, 0.5, 1.0]]], np.float32)
    shown = encode_for_viewing(StoredPart(light, tuple("RGBA"), False), "Un-tone-mapped")
    curve = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)[..., :3]
    assert shown.shape == (1, 2, 3) and np.abs(shown - 255.0 * curve).max() <= 1.0
    assert np.abs(encode_for_viewing(StoredPart(light, tuple("RGBA"), False)) - 255.0 * curve).max() > 5.0
