"""Heat haze against scipy at positions computed in 64 bits, and what it promises."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import graph_of
from halation.graph import Port
from halation.nodes.distort.heat_haze import HeatHaze
from halation.renderer import RenderRequest
from noises import gradient_noise, places
from warps import sample_bilinear, waves


def ramp(width: int, height: int) -> np.ndarray:
    """Every pixel holds its own position."""
    y, x = np.mgrid[:height, :width] + 0.5
    return np.stack([x, y, 0 * x, 0 * x + 1], -1).astype(np.float32)


def at_frame(renderer, node: HeatHaze, picture: np.ndarray, frame: int, heat: np.ndarray | None = None) -> np.ndarray:
    arrays = {"image": picture} if heat is None else {"image": picture, "heat": heat}
    wanted = RenderRequest(arrays, {"out": Port("outputs", "out")}, precision="float", frame=frame)
    return renderer.render(graph_of(node, arrays), wanted)["out"]


def haze(node: HeatHaze, width: int, height: int, frame: int) -> np.ndarray:
    """How far every pixel looks away where it is hot, in pixels: [h, w, 2]."""
    risen = np.array([0.0, height * node.rise / node.rate * frame, 0.0])
    p = places(width, height, 1.0, node.change / node.rate * frame) + risen
    p = p / [node.size * height, node.size * node.stretch * height, 1.0]
    coarse, fine = (gradient_noise(p * [2**i, 2**i, 1], np.array([node.seed, i, 0], np.uint32)) for i in (0, 1))
    return node.amount * height * (2 * coarse + fine)[..., :2] / 3


@pytest.mark.parametrize("size", [(33, 26), (3, 2), (1, 1)])
@pytest.mark.parametrize(
    ("frame", "values"),
    [
        (1, {}),
        (17, {"amount": 0.05, "size": 0.2, "stretch": 0.6, "rise": -1.0, "rate": 30.0, "seed": 8}),
    ],
)
def test_it_is_scipys_at_these_positions(renderer, hdr, edge, size, frame, values):
    node, picture = HeatHaze(edge=edge.name, **values), hdr(*size)
    heat = np.random.default_rng(1).uniform(-1, 1, size[::-1]).astype(np.float32)
    y, x = np.mgrid[: size[1], : size[0]] + 0.5
    away = heat[..., None].astype(np.float64) * haze(node, *size, frame)
    expected = sample_bilinear(picture, x + away[..., 0], y + away[..., 1], edge.scipy_map)
    found = at_frame(renderer, node, picture, frame, heat)
    assert np.abs(found - expected).max() < 2e-5 * picture.max()


def test_nothing_moves_farther_than_the_amount_and_half_of_it_half_as_far(run):
    picture = ramp(96, 80)
    pushes = [run(HeatHaze(amount=amount), {"image": picture}) - picture for amount in (0.02, 0.04)]
    inside = np.s_[6:-6, 6:-6, :2]
    assert 0.3 < np.abs(pushes[0][inside]).max() <= 0.02 * 80
    assert np.abs(2 * pushes[0] - pushes[1])[inside].max() < 1e-3
    assert np.abs(pushes[0][inside].mean((0, 1))).max() < 0.25


def test_heat_says_where(run, hdr):
    picture, heat = hdr(33, 26), np.zeros((26, 33), np.float32)
    heat[:, 16:] = 1.0
    out = run(HeatHaze(amount=0.05), {"image": picture, "heat": heat})
    np.testing.assert_array_equal(out[:, :16], picture[:, :16])
    np.testing.assert_array_equal(out[:, 16:], run(HeatHaze(amount=0.05), {"image": picture})[:, 16:])


def test_swirls_rise(renderer):
    """With nothing else changing, a later frame's haze is an earlier one's, higher up."""
    picture, node = ramp(64, 64), HeatHaze(change=0.0, rise=3.0, rate=24.0, amount=0.02)
    early, late = (at_frame(renderer, node, picture, frame) - picture for frame in (2, 4))
    rows = 16  # 3 / 24 of 64 rows in a frame
    assert np.abs(late[4 : 60 - rows, 4:-4, :2] - early[4 + rows : 60, 4:-4, :2]).max() < 1e-3


def test_frames_differ_and_repeat(renderer):
    picture, node = waves(48, 40), HeatHaze()
    one, again, next_ = (at_frame(renderer, node, picture, frame) for frame in (7, 7, 8))
    assert np.array_equal(one, again) and np.abs(one - next_).max() > 1e-3


@pytest.mark.parametrize("wild", [np.nan, np.inf, 1e30])
def test_wild_masks_stay_harmless(run, hdr, wild):
    heat = np.full((10, 11), 1.0, np.float32)
    heat[4, 5] = wild
    out = run(HeatHaze(), {"image": hdr(11, 10), "heat": heat})
    assert np.isfinite(out).all() and HeatHaze(amount=0.0).identity() == "image"
