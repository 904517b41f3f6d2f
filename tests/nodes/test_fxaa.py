"""FXAA against its authors' procedure in 64 bits, and against the true coverage of edges."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.aa.fxaa import Fxaa
from scipy.ndimage import map_coordinates

STRIDES = {
    "low": [1, 1.5, 2, 4, 12],
    "medium": [1, 1.5, 2, 2, 2, 2, 2, 2, 2, 2, 4, 8],
    "high": [1, 1, 1, 1, 1, 1.5, 2, 2, 2, 2, 4, 8],
}


def tone_of(picture: np.ndarray) -> np.ndarray:
    light = picture[..., :3].astype(np.float64) @ [0.2126, 0.7152, 0.0722]
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def fxaa(picture, quality, subpix, threshold, dark) -> np.ndarray:
    """Pixel by pixel, named as in FXAA 3.11. Both directions often weigh the same: there rows win, not rounding."""
    luma, found = tone_of(picture), picture.astype(np.float64)

    def at(y, x):
        (top, dy), (left, dx) = divmod(y, 1), divmod(x, 1)
        rows, columns = (
            [min(max(int(i), 0), n - 1) for i in (first, first + 1)]
            for first, n in zip((top, left), luma.shape, strict=True)
        )
        above, below = (luma[row, columns[0]] * (1 - dx) + luma[row, columns[1]] * dx for row in rows)
        return above * (1 - dy) + below * dy

    for y, x in np.ndindex(luma.shape):
        m = luma[y, x]
        n, s, w, e = at(y - 1, x), at(y + 1, x), at(y, x - 1), at(y, x + 1)
        nw, ne, sw, se = at(y - 1, x - 1), at(y - 1, x + 1), at(y + 1, x - 1), at(y + 1, x + 1)
        range_ = max(n, s, w, e, m) - min(n, s, w, e, m)
        if range_ < max(dark, max(n, s, w, e, m) * threshold, 1e-12):
            continue
        c = np.clip(abs((2 * (n + s + w + e) + nw + ne + sw + se) / 12 - m) / range_, 0, 1)
        subpix_h = ((3 - 2 * c) * c * c) ** 2 * subpix
        horizontal = abs(nw - 2 * w + sw) + 2 * abs(n - 2 * m + s) + abs(ne - 2 * e + se)
        vertical = abs(nw - 2 * n + ne) + 2 * abs(w - 2 * m + e) + abs(sw - 2 * s + se)
        horz_span = horizontal > vertical - 1e-5 * max(n, s, w, e, m)
        luma_n, luma_s = (n, s) if horz_span else (w, e)
        pair_n = abs(luma_n - m) >= abs(luma_s - m)
        sign = -1 if pair_n else 1
        gradient = max(abs(luma_n - m), abs(luma_s - m)) / 4
        luma_nn = ((luma_n if pair_n else luma_s) + m) / 2
        py, px = (y + sign / 2, x) if horz_span else (y, x + sign / 2)
        ends = []
        for way in (-1, 1):
            distance = STRIDES[quality][0]
            for stride in STRIDES[quality][1:]:
                end = at(py + (0 if horz_span else way * distance), px + (way * distance if horz_span else 0)) - luma_nn
                if abs(end) >= gradient:
                    break
                distance += stride
            ends.append((distance, end))
        (dst_n, end_n), (dst_p, end_p) = ends
        dst, end = (dst_n, end_n) if dst_n < dst_p else (dst_p, end_p)
        offset = 0.5 - dst / (dst_n + dst_p) if (end < 0) != (m - luma_nn < 0) else 0.0
        offset = max(offset, subpix_h) * sign
        where = [[y + offset], [x]] if horz_span else [[y], [x + offset]]
        for channel in range(4):
            plane = picture[..., channel].astype(np.float64)
            found[y, x, channel] = map_coordinates(plane, where, order=1, mode="nearest")[0]
    return found


def half_plane(angle: float, samples: int, offset: float = 0.0) -> np.ndarray:
    """Black and white on either side of a line, each pixel the mean of `samples` by `samples`."""
    y, x = np.mgrid[:56, :56]
    normal = np.sin(np.radians(angle)), np.cos(np.radians(angle))
    finer = (np.arange(samples) + 0.5) / samples - 0.5
    white = np.mean(
        [(x + dx - 27.8) * normal[0] + (y + dy - 27.7) * normal[1] > offset for dx in finer for dy in finer], axis=0
    )
    picture = np.ones((56, 56, 4), np.float32)
    picture[..., :3] = white[..., None]
    return picture


@pytest.mark.parametrize("quality", STRIDES)
@pytest.mark.parametrize(("subpix", "threshold", "dark"), [(0.75, 0.166, 0.0833), (0.0, 0.063, 0.0)])
def test_it_equals_the_original(run, hdr, quality, subpix, threshold, dark):
    """Levels, slopes whose ends lie within and beyond the search, one where both directions weigh the same, noise."""
    node = Fxaa(quality=quality, subpixel=subpix, threshold=threshold, threshold_dark=dark)
    slopes = [half_plane(angle, 1)[14:42, 5:50] for angle in (1.2, 12.0, 45.0, 71.0)]
    for picture in (np.minimum(hdr(21, 14, opaque=True), 2.0), *slopes):
        found = run(node, {"image": picture.copy()})
        one = fxaa(picture, quality, subpix, threshold, dark)
        wrong = (np.abs(found - one) / (1.0 + one)).max(-1)
        assert wrong.max() <= 4e-6


def left_over(run, angle: float) -> float:
    """The part of the error against the true edge that remains."""
    middle, squares = np.s_[10:46, 10:46, 0], np.zeros(2)
    for offset in (0.0, 0.3):
        jagged, true = half_plane(angle, 1, offset), half_plane(angle, 16, offset)
        found = run(Fxaa(quality="high"), {"image": jagged})
        squares += [((picture - true)[middle] ** 2).mean() for picture in (jagged, found)]
    return float(np.sqrt(squares[1] / squares[0]))


@pytest.mark.parametrize("angle", [1, 2, 5, 9, 14, 18, 22, 68, 72, 76, 81, 85, 88, 89])
def test_jagged_edges_come_closer_to_the_truth(run, angle):
    assert left_over(run, angle) <= 0.4


@pytest.mark.parametrize(("angle", "most"), [(26, 0.51), (31, 0.5), (36, 0.54), (40, 0.6), (43, 0.67), (45, 0.73)])
def test_near_diagonals_it_does_less(run, angle, most):
    """The search knows only rows and columns, where stairs of one or two pixels have no ends to find."""
    assert left_over(run, angle) <= most
    assert left_over(run, 90 - angle) <= most + 0.02


@pytest.mark.parametrize("turns", [0, 1, 2, 3])
def test_straight_edges_and_flat_stay(run, turns):
    step = np.ones((20, 24, 4), np.float32)
    step[:, :11, :3] = 0.1
    step = np.rot90(step, turns).copy()
    np.testing.assert_allclose(run(Fxaa(subpixel=0.0), {"image": step}), step, atol=1e-6)
    flat = np.full((9, 9, 4), 0.3, np.float32)
    np.testing.assert_array_equal(run(Fxaa(threshold_dark=0.0), {"image": flat}), flat)


def test_faint_contrast_is_left_alone(run, hdr):
    faint = 0.5 + 0.02 * np.random.default_rng(4).random((12, 15, 4)).astype(np.float32)
    np.testing.assert_array_equal(run(Fxaa(), {"image": faint}), faint)
