"""FXAA against its white paper in 64 bits, and against the true coverage of edges."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.aa.fxaa import Fxaa
from scipy.ndimage import map_coordinates

STRIDES = {
    "low": [1, 1.5, 2, 4, 12], "medium": [1, 1.5, 2, 2, 2, 2, 2, 2, 2, 2, 4, 8],
    "high": [1, 1, 1, 1, 1, 1.5, 2, 2, 2, 2, 4, 8],
}


def tone_of(picture: np.ndarray) -> np.ndarray:
    light = picture[..., :3].astype(np.float64) @ [0.2126, 0.7152, 0.0722]
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def fxaa(picture, quality, subpix, threshold, dark) -> np.ndarray:
    """Pixel by pixel, named as in the paper; NaN where an edge runs either way, as both directions weigh the same."""
    luma, found = tone_of(picture), picture.astype(np.float64)

    def at(y, x):
        return map_coordinates(luma, [[y], [x]], order=1, mode="nearest")[0]

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
        if abs(horizontal - vertical) < 1e-5:
            found[y, x] = np.nan
            continue
        horz_span = horizontal > vertical
        luma_n, luma_s = (n, s) if horz_span else (w, e)
        pair_n = abs(luma_n - m) >= abs(luma_s - m)
        sign = -1 if pair_n else 1
        gradient = max(abs(luma_n - m), abs(luma_s - m)) / 4
        luma_nn = ((luma_n if pair_n else luma_s) + m) / 2
        py, px = (y + sign / 2, x) if horz_span else (y, x + sign / 2)
        ends = []
        for way in (-1, 1):
            distance = 0.0
            for stride in STRIDES[quality]:
                distance += stride
                end = at(py + (0 if horz_span else way * distance), px + (way * distance if horz_span else 0)) - luma_nn
                if abs(end) >= gradient:
                    break
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


def half_plane(angle: float, samples: int) -> np.ndarray:
    """Black and white on either side of a line, each pixel the mean of `samples` by `samples`."""
    y, x = np.mgrid[:40, :40]
    normal = np.sin(np.radians(angle)), np.cos(np.radians(angle))
    finer = (np.arange(samples) + 0.5) / samples - 0.5
    white = np.mean([
        (x + dx - 19.7) * normal[0] + (y + dy - 20.2) * normal[1] > 0.0 for dx in finer for dy in finer
    ], axis=0)
    picture = np.ones((40, 40, 4), np.float32)
    picture[..., :3] = white[..., None]
    return picture


@pytest.mark.parametrize("quality", STRIDES)
@pytest.mark.parametrize(("subpix", "threshold", "dark"), [(0.75, 0.166, 0.0833), (0.0, 0.063, 0.0)])
def test_it_equals_the_white_paper(run, hdr, quality, subpix, threshold, dark):
    node = Fxaa(quality=quality, subpixel=subpix, threshold=threshold, threshold_dark=dark)
    for picture in (np.minimum(hdr(21, 14, opaque=True), 2.0), half_plane(12.0, 1)[8:30, 4:36]):
        found, expected = run(node, {"image": picture.copy()}), fxaa(picture, quality, subpix, threshold, dark)
        sure = np.isfinite(expected)
        assert sure.mean() > 0.9
        np.testing.assert_allclose(found[sure], expected[sure], rtol=1e-4, atol=2e-5)


@pytest.mark.parametrize("angle", [4.0, 9.0, 18.0, 72.0, 81.0, 86.0])
def test_jagged_edges_come_closer_to_the_truth(run, angle):
    jagged, true = half_plane(angle, 1), half_plane(angle, 16)
    found = run(Fxaa(quality="high"), {"image": jagged})
    middle = np.s_[8:32, 8:32, 0]
    before, after = (np.sqrt(((picture - true)[middle] ** 2).mean()) for picture in (jagged, found))
    assert after <= 0.5 * before


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
