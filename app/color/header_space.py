"""Color spaces that a header describes by numbers: chromaticities, a gamma, or the curve of film scans."""

from __future__ import annotations

from functools import cached_property, lru_cache

import numpy as np
from msgspec import Struct

Array = np.ndarray
Gamut = tuple[float, ...]
"""x and y of red, green, blue and white."""

REC709: Gamut = (0.640, 0.330, 0.300, 0.600, 0.150, 0.060, 0.3127, 0.3290)
"""ITU-R BT.709, with the white D65."""

_EQUAL_ENERGY: Gamut = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0 / 3.0, 1.0 / 3.0)
"""The primaries of CIE XYZ itself."""

_SAME_PRIMARIES = 1e-3
_SAME_WHITE = 1e-6
"""How far chromaticities may be from known ones: files have three decimals at least. White that is nearer to D65 than
floats tell needs no adaptation."""

_LEAST_GAMMA, _LARGEST_GAMMA = 0.1, 10.0
"""Exponents that are taken seriously: displays have 1.8 to 2.8, others are damaged headers. Chosen by judgement."""

_BRADFORD = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])
"""From CIE XYZ to cone responses, in which white points are adapted: Lam 1985, as in OpenColorIO's ACES matrices."""

_LEAST_AREA = 1e-4
"""Twice the smallest area of a triangle of primaries. That of Rec.709 is 0.22; a triangle of less than a thousandth of
that is a damaged header."""

_FILM_BLACK, _FILM_WHITE, _FILM_STEP = 95.0, 685.0, 0.002 / 0.6
"""Codes of 10 bits for black and for 90 % white, and log exposure for each code: 0.002 of printing density, at the
gamma of negative film (Kodak, Conversion of 10-bit Log Film Data To 8-bit Linear or Video Data, 1995)."""


class HeaderSpace(Struct, frozen=True, dict=True):
    """Linear light of these primaries, or its power 1 / `gamma`, or on Kodak's logarithmic curve for film scans."""

    gamut: Gamut = REC709
    gamma: float = 1.0
    is_film: bool = False

    @property
    def is_linear(self) -> bool:
        """True if it has no curve."""
        return self.gamma == 1.0 and not self.is_film

    @property
    def name(self) -> str:
        """Its numbers, for messages."""
        if self.is_film:
            return "Kodak log film"
        pairs = [f"({x:.4g}, {y:.4g})" for x, y in zip(self.gamut[::2], self.gamut[1::2], strict=True)]
        primaries = "Rec.709" if self.gamut == REC709 else f"primaries {' '.join(pairs[:3])} white {pairs[3]}"
        return f"gamma {self.gamma:.4g}, {primaries}" if self.gamma != 1.0 else primaries

    @cached_property
    def is_valid(self) -> bool:
        """False for impossible chromaticities: primaries on one line, a white that cannot be mixed from them."""
        return _LEAST_GAMMA <= self.gamma <= _LARGEST_GAMMA and make_gamut_matrix(self.gamut) is not None

    def to_rec709(self, rgb: Array) -> Array:
        """Colors [..., 3] as linear Rec.709, in new float32."""
        light = np.array(rgb, np.float32)
        if self.is_film:
            black = 10.0 ** ((_FILM_BLACK - _FILM_WHITE) * _FILM_STEP)
            light = (10.0 ** ((1023.0 * light - _FILM_WHITE) * _FILM_STEP) - black) / (1.0 - black)
        elif self.gamma != 1.0:
            light = np.copysign(np.abs(light) ** np.float32(self.gamma), light)
        matrix = make_gamut_matrix(self.gamut)
        if matrix is not None and self.gamut != REC709:
            light = light @ matrix.T
        return np.ascontiguousarray(light, np.float32)


def primaries_to_xyz(gamut: Gamut) -> Array:
    """The matrix from primaries, given by their chromaticities, to CIE XYZ, with white at (1, 1, 1) (SMPTE RP 177).

    Primaries of CIE XYZ itself have a y of 0.
    """
    pairs = zip(gamut[::2], gamut[1::2], strict=True)
    points = np.array([(x / (y or 1.0), y / (y or 1.0), (1.0 - x - y) / (y or 1.0)) for x, y in pairs]).T
    return points[:, :3] * np.linalg.solve(points[:, :3], points[:, 3])


@lru_cache(maxsize=64)
def make_gamut_matrix(gamut: Gamut) -> Array | None:
    """The matrix from linear colors of these primaries to linear Rec.709, float32; None for impossible chromaticities.

    A white point other than D65 is adapted to it by Bradford's method, as OpenColorIO's configs do. CIE XYZ with its
    equal-energy white is not a display whose white could be adapted: its numbers are tristimulus values of the light
    itself, so only the primaries change.
    """
    if len(gamut) != 8 or not np.isfinite(gamut).all() or gamut[7] <= 0.0:
        return None
    (rx, ry, gx, gy, bx, by), white = gamut[:6], gamut[6:]
    area = (gx - rx) * (by - ry) - (bx - rx) * (gy - ry)
    if abs(area) < _LEAST_AREA:
        return None
    to_xyz = primaries_to_xyz(gamut)
    if not np.isfinite(to_xyz).all() or (to_xyz.sum(axis=0) <= 0.0).any():
        return None
    if not is_tristimulus(gamut):
        to_xyz = _adapt_white(white) @ to_xyz
    return np.linalg.solve(primaries_to_xyz(REC709), to_xyz).astype(np.float32)


def is_tristimulus(gamut: Gamut) -> bool:
    """True for CIE XYZ with the white of equal energy."""
    return np.allclose(gamut, _EQUAL_ENERGY, atol=_SAME_PRIMARIES)


def _adapt_white(white: tuple[float, ...]) -> Array:
    """The matrix from CIE XYZ under this white to CIE XYZ under D65."""
    if np.allclose(white, REC709[6:], atol=_SAME_WHITE):
        return np.eye(3)
    here, there = (_BRADFORD @ np.array((x / y, 1.0, (1.0 - x - y) / y)) for x, y in (white, REC709[6:]))
    return np.linalg.solve(_BRADFORD, (there / here)[:, None] * _BRADFORD)
