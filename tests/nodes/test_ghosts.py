"""Lens ghosts against the geometry of a magnified picture, and against scipy in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.glow.ghosts import Ghosts
from scipy.ndimage import gaussian_filter, map_coordinates

ALL_LIGHT = {"threshold": 0.0, "knee": 0.0, "limit": 65504.0}
BARE = {"ghosts": 0.0, "halo": 0.0, "veil": 0.0, "dirt_amount": 0.0, "chromatic": 0.0, "colors": 0.0}
FACTORS = (-0.45, -1.0, 0.3, -1.8, -0.25, 0.55, -0.7, 1.4, -2.6, -0.35, 0.8, -1.3)


def spot(width: int, height: int, x: float, y: float, sigma: float = 2.5) -> np.ndarray:
    """A round light, in pixels from the top left corner; centers lie at .5."""
    down, across = np.mgrid[:height, :width] + 0.5
    light = np.exp(-0.5 * ((across - x) ** 2 + (down - y) ** 2) / sigma**2)
    return np.repeat(light[..., None], 4, axis=-1).astype(np.float32)


def moments(light: np.ndarray) -> tuple[float, float, float, float]:
    """Sum, place and standard deviation along an axis."""
    light = light.astype(np.float64)
    down, across = np.mgrid[: light.shape[0], : light.shape[1]] + 0.5
    total = light.sum()
    x, y = (light * across).sum() / total, (light * down).sum() / total
    return total, x, y, float(np.sqrt((light * ((across - x) ** 2 + (down - y) ** 2)).sum() / total / 2.0))


@pytest.mark.parametrize("factor", [-0.5, -0.7, -1.0])
@pytest.mark.parametrize("center", [(0.5, 0.5), (0.42, 0.6)])
def test_a_ghost_lies_on_the_line_through_the_axis(run, factor, center):
    """Its place, its size and its share of the light: m times as far out, m times as wide, the same sum."""
    width, height, x, y, sigma = 200, 160, 130.0, 60.0, 3.0
    node = Ghosts(**BARE | ALL_LIGHT | {"ghosts": 0.25}, count=1, spread=factor / FACTORS[0], center=center)
    picture = spot(width, height, x, y, sigma)
    total, ghost_x, ghost_y, wide = moments(run(node, {"image": picture}, output="glow")[..., 1])
    axis = center[0] * width, center[1] * height
    assert total == pytest.approx(0.25 * picture[..., 1].sum(dtype=np.float64), rel=2e-3)
    assert ghost_x == pytest.approx(axis[0] + factor * (x - axis[0]), abs=0.05)
    assert ghost_y == pytest.approx(axis[1] + factor * (y - axis[1]), abs=0.05)
    # Variances: blurred by 4 pixels and a tent of 2 pixels (4 / 6) before it is magnified, by one more tent after.
    expected = factor**2 * (sigma**2 + 4.0**2 + 4.0 / 6.0) + 4.0 / 6.0
    assert wide == pytest.approx(np.sqrt(expected), rel=0.02)


def reference(picture: np.ndarray, node: Ghosts) -> np.ndarray:
    """The flare of all light without dirt and coatings, for even sizes: scipy's Gaussian and bilinear samples."""
    height, width = picture.shape[0] // 2, picture.shape[1] // 2
    light = picture[..., :3].reshape(height, 2, width, 2, 3).mean((1, 3), dtype=np.float64)
    sigma = max(node.softness * picture.shape[0], 4.0) / 2.0
    sharp = gaussian_filter(light, (sigma, sigma, 0.0), mode="constant")
    veil = gaussian_filter(light, (0.15 * height, 0.15 * height, 0.0), mode="constant")
    axis = np.array([node.center[0] * width, node.center[1] * height])
    down, across = np.mgrid[:height, :width] + 0.5
    away = np.stack([across, down], axis=-1) - axis
    outward = away / np.linalg.norm(away, axis=-1, keepdims=True)

    def seen(at: np.ndarray, channel: int) -> np.ndarray:
        border = np.minimum(at, np.array([width, height]) - at).min(-1) / (0.1 * height)
        fade = np.clip(border, 0.0, 1.0)
        place = [at[..., 1] - 0.5, at[..., 0] - 0.5]
        return map_coordinates(sharp[..., channel], place, order=1, mode="grid-constant") * fade**2 * (3.0 - 2.0 * fade)

    flare = node.veil * veil
    for channel in range(3):
        larger = 1.0 + node.chromatic * (1 - channel)
        for factor in FACTORS[: node.count]:
            magnified = factor * node.spread * larger
            flare[..., channel] += node.ghosts / magnified**2 * seen(axis + away / magnified, channel)
        ring = axis + away - node.radius * height * larger * outward
        flare[..., channel] += node.halo * seen(ring, channel)
    y, x = (np.mgrid[: picture.shape[0], : picture.shape[1]] + 0.5) / 2.0 - 0.5
    parts = [map_coordinates(part, [y, x], order=1, mode="nearest") for part in np.moveaxis(flare, -1, 0)]
    return np.stack(parts, axis=-1)


@pytest.mark.parametrize(
    "values",
    [
        {"ghosts": 0.1, "count": 12},
        {"ghosts": 0.1, "count": 5, "spread": 1.7, "chromatic": 0.1, "center": (0.3, 0.61)},
        {"halo": 0.2, "chromatic": 0.05},
        {"veil": 0.3},
        {"ghosts": 0.1, "halo": 0.1, "veil": 0.1, "softness": 0.15},
    ],
)
def test_the_whole_flare(run, hdr, values):
    picture = hdr(64, 42)
    node = Ghosts(**BARE | ALL_LIGHT | values)
    found = run(node, {"image": picture}, output="glow")
    expected = reference(picture, node)
    # Where ghosts shrink the picture, a position in 32 bits is known to 1e-5 pixels of steep light.
    assert np.abs(found[..., :3] - expected).max() <= 5e-5 * expected.max()
    np.testing.assert_array_equal(found[..., 3], picture[..., 3])


def test_a_light_on_the_axis_has_a_round_halo(run):
    side = 120
    picture = spot(side, side, side / 2, side / 2)
    node = Ghosts(**BARE | ALL_LIGHT | {"halo": 1.0}, radius=0.3)
    glow = run(node, {"image": picture}, output="glow")[..., 1]
    y, x = np.mgrid[:side, :side] + 0.5 - side / 2
    assert np.hypot(x, y)[glow > 0.9 * glow.max()].mean() == pytest.approx(0.3 * side, abs=0.5)
    for turned in (glow[::-1], glow[:, ::-1], glow.T):
        np.testing.assert_allclose(turned, glow, atol=1e-5 * float(glow.max()))


def test_coatings_color_each_ghost_and_the_tint_all(run):
    picture = spot(96, 80, 60.0, 30.0)
    node = Ghosts(**ALL_LIGHT | BARE | {"ghosts": 0.1, "colors": 1.0}, count=1)
    colors = run(node, {"image": picture}, output="glow")
    red, green, blue = colors[..., :3].sum((0, 1))
    assert max(red, green, blue) > 2.0 * min(red, green, blue)
    plain = run(Ghosts(), {"image": 40.0 * picture}, output="glow")
    tinted = run(Ghosts(tint=(0.9, 0.3, 0.1, 1.0)), {"image": 40.0 * picture}, output="glow")
    np.testing.assert_allclose(tinted[..., :3], plain[..., :3] * np.float32([0.9, 0.3, 0.1]), rtol=1e-5)


def test_dirt_multiplies_the_flare(run, hdr):
    picture, dirt = hdr(40, 30), hdr(40, 30)
    clean = run(Ghosts(dirt_amount=0.0), {"image": picture, "dirt": dirt}, output="glow")
    dirty = run(Ghosts(dirt_amount=0.7), {"image": picture, "dirt": dirt}, output="glow")
    expected = clean[..., :3] * (0.3 + 0.7 * dirt[..., :3])
    np.testing.assert_allclose(dirty[..., :3], expected, rtol=1e-5, atol=1e-7)


def test_smudges_only_take_light_away_and_are_alike_at_any_size(run):
    means = []
    for height in (90, 180):
        flat = np.full((height, 2 * height, 4), 10.0, np.float32)
        clean, dirty = (
            run(Ghosts(dirt_amount=amount, count=0, halo=0.0), {"image": flat}, output="glow") for amount in (0.0, 1.0)
        )
        share = dirty[..., 1] / clean[..., 1]
        assert share.min() >= 0.0
        assert share.max() <= 1.0
        blocks = share.reshape(15, height // 15, 30, height // 15).mean((1, 3))
        assert blocks.std() > 0.02
        means.append(blocks)
    assert np.abs(means[0] - means[1]).max() <= 0.05


def test_the_flare_joins_the_picture(run, hdr):
    picture = hdr(24, 20)
    glow = run(Ghosts(), {"image": picture}, output="glow")
    expected = picture + glow * np.float32([1.0, 1.0, 1.0, 0.0])
    np.testing.assert_allclose(run(Ghosts(), {"image": picture}), expected, rtol=1e-6)
    found = run(Ghosts(ghosts=0.0, halo=0.0, veil=0.0), {"image": picture})
    np.testing.assert_array_equal(found, picture)
