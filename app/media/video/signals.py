"""Converts between the planes of a video and red, green and blue: ITU-R BT.601, BT.709, BT.2020 and H.273.

Everything here is numpy in 32-bit floats. R'G'B' are display values; 0 is black and 1 white, and numbers of a limited
range beyond these are kept.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from ...color.primaries import REC709_LUMINANCE
from ...color.transforms import decode_srgb
from ...errors import InputError

Array = np.ndarray

LUMA: Mapping[int, tuple[float, float]] = MappingProxyType(
    {
        1: (REC709_LUMINANCE[0], REC709_LUMINANCE[2]),
        4: (0.30, 0.11),
        5: (0.299, 0.114),
        6: (0.299, 0.114),
        7: (0.212, 0.087),
        9: (0.2627, 0.0593),
    }
)
"""The weights of red and blue in luma by the number of the matrix: BT.709, FCC, BT.601 twice, SMPTE 240M, BT.2020."""

RGB, UNKNOWN = 0, 2
_YCGCO = 8
_UNSPECIFIED = (UNKNOWN, 3)
"""Numbers of the matrix in H.273, table 4: no matrix, not specified, YCgCo, and reserved."""

_SMALL = (1024, 576)
"""The largest size of video in standard definition: 576 lines of PAL, with square pixels in 16:9."""

_BT1886_GAMMA = 2.4
"""The exponent of the reference display (ITU-R BT.1886, annex 1)."""

_PQ_WHITE = 203.0
_HLG_WHITE = 0.75
"""Reference white in PQ (cd/m2) and as a signal of HLG (ITU-R BT.2408)."""

GAMUTS = MappingProxyType({9: "lin_rec2020_scene", 12: "lin_p3d65_scene"})
"""Primaries that differ much from Rec.709, as linear spaces of OpenColorIO."""

VIDEO_TRANSFERS = frozenset({1, 6, 14, 15})
"""Transfer characteristics (H.273) of video for a BT.1886 display: BT.709, BT.601, BT.2020 with 10 and with 12 bits."""

SCENE_TRANSFERS = frozenset({8, 9, 10, 16, 18})
"""Transfer characteristics (H.273) of light of a scene, or of more light than a screen of standard range shows: linear,
two logarithmic curves, PQ and HLG."""


def choose_matrix(number: int, size: tuple[int, int]) -> int:
    """The matrix of a video; without a tag BT.601 up to 1024x576, else BT.709."""
    if number not in _UNSPECIFIED and number != RGB:
        return number
    return 6 if size[0] <= _SMALL[0] and size[1] <= _SMALL[1] else 1


def code_ranges(bits: int, limited: bool) -> tuple[float, float, float, float]:
    """Black and the span to white for luma, and the same for color differences: their center and span (BT.709)."""
    step = float(1 << (bits - 8)) if bits > 8 else 1.0
    if limited:
        return 16.0 * step, 219.0 * step, 128.0 * step, 224.0 * step
    return 0.0, float((1 << bits) - 1), float(1 << (bits - 1)), float((1 << bits) - 1)


def chroma_to_rgb(luma: Array, blue: Array, red: Array, matrix: int) -> Array:
    """R'G'B' [h, w, 3] of Y' (0..1) and color differences (-0.5..0.5). Raises InputError for an unknown matrix."""
    rgb = np.empty((*luma.shape, 3), np.float32)
    if matrix == _YCGCO:  # blue is Cg, red is Co
        middle = luma - blue
        rgb[..., 0], rgb[..., 1], rgb[..., 2] = middle + red, luma + blue, middle - red
        return rgb
    if matrix not in LUMA:
        raise InputError(f"its color matrix (number {matrix} of H.273) is unknown here: convert it to BT.709")
    kr, kb = LUMA[matrix]
    kg = 1.0 - kr - kb
    np.add(luma, np.float32(2.0 * (1.0 - kr)) * red, out=rgb[..., 0])
    np.add(luma, np.float32(2.0 * (1.0 - kb)) * blue, out=rgb[..., 2])
    green_share = np.float32(2.0 * kb * (1.0 - kb) / kg) * blue + np.float32(2.0 * kr * (1.0 - kr) / kg) * red
    np.subtract(luma, green_share, out=rgb[..., 1])
    return rgb


def rgb_to_chroma(rgb: Array, matrix: int) -> tuple[Array, Array, Array]:
    """Y' and the color differences to blue and red of R'G'B' [h, w, 3]."""
    kr, kb = LUMA[matrix]
    luma = rgb @ np.array([kr, 1.0 - kr - kb, kb], np.float32)
    blue, red = np.float32(2.0 * (1.0 - kb)), np.float32(2.0 * (1.0 - kr))
    return luma, (rgb[..., 2] - luma) / blue, (rgb[..., 0] - luma) / red


def enlarge_plane(plane: Array, axis: int, length: int, factor: int, offset: float) -> Array:
    """A plane of chroma enlarged to the size of luma along one axis, linear between samples.

    Sample 0 lies at luma position `offset`, the others `factor` apart; beyond the border its samples go on.
    """
    if factor == 1 and plane.shape[axis] == length:
        return plane
    at = (np.arange(length) - offset) / factor
    low = np.floor(at)
    shape = [1, 1]
    shape[axis] = length
    part = (at - low).astype(np.float32).reshape(shape)
    last = plane.shape[axis] - 1
    here, there = (plane.take(np.clip(low + step, 0, last).astype(np.intp), axis) for step in (0, 1))
    return here + part * (there - here)


def decode_transfer(encoded: Array, transfer: int) -> Array:
    """Linear light of R'G'B' by the number of the transfer characteristics in H.273, without change of primaries.

    Video (BT.709, BT.601, BT.2020) is decoded as its display does (BT.1886 with a black of 0), not by the inverse of
    the camera's curve: a grade is judged on that display, and the camera's curve leaves the contrast out that the
    display adds. PQ and HLG are scaled so that reference white (BT.2408: 203 cd/m2, 75 %) is 1. An unspecified curve is
    taken as sRGB, as for 8-bit pictures.
    """
    if transfer in VIDEO_TRANSFERS:
        return _mirror_curve(encoded, lambda size: size**_BT1886_GAMMA)
    if transfer in (0, 2, 13):
        return decode_srgb(encoded).astype(np.float32)
    if transfer == 8:
        return encoded
    if transfer in (4, 5):
        return _mirror_curve(encoded, lambda size: size ** (2.2 if transfer == 4 else 2.8))
    if transfer == 16:
        return _mirror_curve(encoded, _decode_pq) / np.float32(_PQ_WHITE)
    if transfer == 18:
        return _mirror_curve(encoded, _decode_hlg) / np.float32(_decode_hlg(np.array(_HLG_WHITE)))
    raise InputError(f"its transfer curve (number {transfer} of H.273) is unknown here: convert it to sRGB or BT.709")


def _decode_pq(signal: Array) -> Array:
    """cd/m2 (SMPTE ST 2084, whose constants these are)."""
    m1, m2, c1, c2, c3 = 2610 / 16384, 2523 / 32, 3424 / 4096, 2413 / 128, 2392 / 128
    root = np.clip(signal, 0.0, 1.0).astype(np.float64) ** (1.0 / m2)
    return 10000.0 * (np.maximum(root - c1, 0.0) / (c2 - c3 * root)) ** (1.0 / m1)


def _decode_hlg(signal: Array) -> Array:
    """Scene light, 0..1 (BT.2100, table 5, whose constants these are)."""
    a, b, c = 0.17883277, 0.28466892, 0.55991073
    return np.where(signal <= 0.5, signal**2 / 3.0, (np.exp((signal - c) / a) + b) / 12.0)


def _mirror_curve(encoded: Array, curve: Callable[[Array], Array]) -> Array:
    """A curve for numbers from 0 up, mirrored for negative numbers."""
    return np.copysign(curve(np.abs(encoded)), encoded).astype(np.float32)
