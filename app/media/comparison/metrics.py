"""Measures of the difference of two pictures, and a picture of the difference."""

from __future__ import annotations

from math import inf, log10, nan

import numpy as np
import OpenImageIO as oiio
from msgspec import Struct

from ...color.transforms import Array, decode_srgb, encode_srgb, to_float, to_three_channels
from ...errors import UsageError

EIGHT_BIT_STEP = 1.0 / 255.0
"""One step of an 8-bit picture."""

_TAPS = 11
_SIGMA = 1.5
_K1, _K2 = 0.01, 0.03
"""Size and sigma of the window, and the constants of SSIM (Wang, Bovik, Sheikh and Simoncelli 2004)."""
_BROKEN_COLOR = (1.0, 0.0, 1.0)
"""Magenta for NaN and infinity, which no heat map has."""


class PictureDifference(Struct, frozen=True):
    """The difference of a picture from the expected one.

    `max_abs` and `rms` are in the units of the pixels, over all channels. `max_rel` is the largest difference relative
    to the expected number if that is above 1, like the precision of floats. `psnr` is in dB, infinite for equal
    pictures; its peak is the largest number of both, at least 1. `ssim` is 1 for equal pictures, `flip` 0; both are NaN
    if they were not asked for. `failing` is the fraction of pixels with a channel beyond the threshold.

    A number that is not finite equals only the same on the other side; any other pair fails, with `max_abs` and
    `rms` infinite; `broken` counts pixels with such pairs. Where pictures cannot be compared `fault` says why in a
    few words, and all measures are at their worst.
    """

    max_abs: float = inf
    rms: float = inf
    psnr: float = -inf
    ssim: float = 0.0
    flip: float = 1.0
    failing: float = 1.0
    worst: tuple[int, int] | None = None
    actual: tuple[float, ...] = ()
    expected: tuple[float, ...] = ()
    broken: int = 0
    fault: str = ""
    max_rel: float = inf

    @property
    def equal(self) -> bool:
        """True if every number is the same."""
        return self.max_abs == 0.0


def compare_pictures(
    actual: Array,
    expected: Array,
    *,
    threshold: float = EIGHT_BIT_STEP,
    relative: bool = False,
    linear: bool = True,
    perceptual: bool = True,
) -> PictureDifference:
    """Measure two pictures [h, w] or [h, w, c] of floats; integers fill 0..1.

    With `relative` the threshold and the worst pixel are relative to the expected number if that is above 1. `linear`
    light is converted to display values before SSIM; other numbers are used unchanged. `perceptual=False` leaves out
    SSIM and FLIP, which take most of the time.

    Raises:
        UsageError: an array that is no picture.
    """
    actual_picture, expected_picture = _check_picture(actual, "actual"), _check_picture(expected, "expected")
    if fault := _describe_mismatch(actual_picture, expected_picture):
        return PictureDifference(fault=fault)
    actual_numbers, expected_numbers = actual_picture.astype(np.float64), expected_picture.astype(np.float64)
    broken = _find_broken(actual_numbers, expected_numbers)
    finite = np.isfinite(actual_numbers) & np.isfinite(expected_numbers)
    difference = np.where(
        finite, np.abs(np.where(finite, actual_numbers, 0.0) - np.where(finite, expected_numbers, 0.0)), 0.0
    )
    difference[broken] = inf
    relative_difference = difference / np.maximum(1.0, np.where(finite, np.abs(expected_numbers), 1.0))
    per_pixel = (relative_difference if relative else difference).max(axis=2)
    max_abs, rms = float(difference.max()), float(np.sqrt(np.mean(difference**2)))
    y, x = (int(place) for place in np.unravel_index(per_pixel.argmax(), per_pixel.shape))
    return PictureDifference(
        max_abs,
        rms,
        _psnr(rms, actual_numbers[finite], expected_numbers[finite]),
        measure_ssim(actual_picture, expected_picture, linear=linear) if perceptual else nan,
        measure_flip(actual_picture, expected_picture, linear=linear) if perceptual else nan,
        float(np.mean(per_pixel > threshold)),
        (x, y) if max_abs else None,
        tuple(map(float, actual_picture[y, x])) if max_abs else (),
        tuple(map(float, expected_picture[y, x])) if max_abs else (),
        int(broken.any(axis=2).sum()),
        max_rel=float(relative_difference.max()),
    )


def measure_ssim(actual: Array, expected: Array, *, linear: bool = True) -> float:
    """Structural similarity, the mean over pixels and channels, 1 for equal pictures (Wang et al. 2004).

    An 11x11 Gaussian of sigma 1.5, K1 0.01, K2 0.03, where the window fits in; a side shorter than that is continued
    by its mirror image. `linear` light is first encoded with the curve of sRGB, continued beyond 1 and mirrored below
    0. The dynamic range is the largest number of both, at least 1. Pixels near a number that is not finite on one side
    only count as 0.

    Raises:
        UsageError: the sizes differ.
    """
    actual_numbers, expected_numbers = _check_pair(actual, expected)
    broken = _find_broken(actual_numbers, expected_numbers)
    first, second = (
        encode_srgb(_zero_non_finite(item)) if linear else _zero_non_finite(item)
        for item in (actual_numbers, expected_numbers)
    )
    first, second = np.where(broken, 0.0, first), np.where(broken, 0.0, second)
    span = max(1.0, float(np.abs(first).max()), float(np.abs(second).max()))
    low, high = (_K1 * span) ** 2, (_K2 * span) ** 2
    total, count = 0.0, 0
    for channel in range(first.shape[2]):
        a, b = first[..., channel], second[..., channel]
        mean_a, mean_b = _gaussian_mean(a), _gaussian_mean(b)
        squared_means = mean_a**2 + mean_b**2
        covariance = _gaussian_mean(a * b) - mean_a * mean_b
        variances = _gaussian_mean(a**2 + b**2) - squared_means
        similarity = (
            (2.0 * mean_a * mean_b + low) * (2.0 * covariance + high) / ((squared_means + low) * (variances + high))
        )
        if broken[..., channel].any():
            similarity[_gaussian_mean(broken[..., channel].astype(np.float64)) > 0.0] = 0.0
        total, count = total + float(similarity.sum()), count + similarity.size
    return total / count


def measure_flip(actual: Array, expected: Array, *, linear: bool = True) -> float:
    """The mean of FLIP's map, 0 for equal pictures and at most 1, as OpenImageIO computes it.

    Scene-linear Rec.709 goes through HDR-FLIP (Andersson et al. 2021) at its fixed range of exposures, so that numbers
    of different pictures can be compared; sRGB-encoded pictures (`linear=False`) through LDR-FLIP (2020). Both for a
    4K screen of 0.7 m at 0.7 m. A single channel is gray, two are red and green, of more than three the color is
    looked at, over black. A pixel that is not finite on one side only counts as 1.

    Raises:
        UsageError: the sizes differ, or this OpenImageIO is older than FLIP in it.
    """
    actual_numbers, expected_numbers = _check_pair(actual, expected)
    if not hasattr(oiio.ImageBufAlgo, "FLIP_diff"):
        raise UsageError(f"OpenImageIO {oiio.__version__} has no FLIP: use 3.2, or measure with another metric")
    broken = np.any(_find_broken(actual_numbers, expected_numbers), axis=2)
    pair = [
        to_three_channels(np.where(broken[..., None], 0.0, _zero_non_finite(item))).astype(np.float32)
        for item in (expected_numbers, actual_numbers)
    ]
    pair = pair if linear else [decode_srgb(np.clip(item, 0.0, 1.0)).astype(np.float32) for item in pair]
    buffers = [oiio.ImageBuf(np.ascontiguousarray(item)) for item in pair]
    flip_map = oiio.ImageBufAlgo.FLIP_diff(*buffers, hdr=int(linear))
    if flip_map.has_error:
        raise UsageError(f"FLIP cannot be computed ({flip_map.geterror()}); measure with another metric")
    errors = np.asarray(flip_map.get_pixels(oiio.FLOAT), np.float64)[..., 0]
    return float(np.where(broken, 1.0, errors).mean())


def amplify_difference(actual: Array, expected: Array, gain: float | None = None) -> Array:
    """The absolute difference times `gain`, as [h, w, 3] of float32 within 0..1, to be shown unchanged.

    Without a gain the largest difference is made 1. A difference of alpha is added as gray. Magenta is where one
    picture is larger than the other, or not finite where the other is.
    """
    actual_numbers = _check_picture(actual, "actual").astype(np.float64)
    expected_numbers = _check_picture(expected, "expected").astype(np.float64)
    height, width = (max(sides) for sides in zip(actual_numbers.shape[:2], expected_numbers.shape[:2], strict=True))
    first, second = (_pad_to(item, height, width) for item in (actual_numbers, expected_numbers))
    broken = np.any(_find_broken(first, second), axis=2)
    difference = np.where(broken[..., None], 0.0, np.abs(_zero_non_finite(first) - _zero_non_finite(second)))
    light = to_three_channels(difference)
    if difference.shape[2] == 4:
        light = light + difference[..., 3:]
    largest = float(light.max(initial=0.0))
    factor = (1.0 / largest if largest else 1.0) if gain is None else gain
    light = np.clip(light * factor, 0.0, 1.0)
    light[broken] = _BROKEN_COLOR
    return light.astype(np.float32)


def _check_picture(array: Array, name: str) -> Array:
    picture = to_float(np.asarray(array))
    if picture.ndim not in (2, 3) or not picture.size or picture.dtype.kind != "f":
        raise UsageError(
            f"the {name} picture is {picture.dtype} {list(picture.shape)}; give numbers as [height, width, channels]"
        )
    return picture if picture.ndim == 3 else picture[..., None]


def _check_pair(actual: Array, expected: Array) -> tuple[Array, Array]:
    actual_picture, expected_picture = _check_picture(actual, "actual"), _check_picture(expected, "expected")
    if fault := _describe_mismatch(actual_picture, expected_picture):
        raise UsageError(f"these pictures cannot be compared: {fault}")
    return actual_picture.astype(np.float64), expected_picture.astype(np.float64)


def _describe_mismatch(actual: Array, expected: Array) -> str:
    (height, width, channels), (expected_height, expected_width, expected_channels) = actual.shape, expected.shape
    if (height, width) != (expected_height, expected_width):
        return f"the size is {width}x{height}, and {expected_width}x{expected_height} is expected"
    plural = "" if channels == 1 else "s"
    return (
        ""
        if channels == expected_channels
        else f"it has {channels} channel{plural}, and {expected_channels} are expected"
    )


def _find_broken(actual: Array, expected: Array) -> Array:
    """Where a number is not finite and the other one is not the same."""
    same = (actual == expected) | (np.isnan(actual) & np.isnan(expected))
    return ~same & ~(np.isfinite(actual) & np.isfinite(expected))


def _zero_non_finite(array: Array) -> Array:
    return np.where(np.isfinite(array), array, 0.0)


def _psnr(rms: float, *numbers: Array) -> float:
    if rms == 0.0:
        return inf
    peak = max(1.0, *(float(item.max(initial=0.0)) for item in numbers))
    return -inf if rms == inf else 20.0 * log10(peak / rms)


def _gaussian_mean(channel: Array) -> Array:
    """The Gaussian mean around every pixel whose window lies inside the picture."""
    place = np.arange(_TAPS) - _TAPS // 2
    weights = np.exp(-(place**2) / (2.0 * _SIGMA**2))
    weights /= weights.sum()
    for axis in (0, 1):
        if channel.shape[axis] < _TAPS:
            around = [(_TAPS // 2, _TAPS // 2) if side == axis else (0, 0) for side in (0, 1)]
            channel = np.pad(channel, around, mode="symmetric")
        count = channel.shape[axis] - _TAPS + 1
        parts = (weight * channel.take(range(at, at + count), axis) for at, weight in enumerate(weights))
        channel = sum(parts, start=np.zeros(()))
    return channel


def _pad_to(array: Array, height: int, width: int) -> Array:
    """The array on a larger canvas, with NaN where it has no pixels."""
    around = ((0, height - array.shape[0]), (0, width - array.shape[1]), (0, 0))
    return np.pad(array, around, constant_values=nan)
