"""Noise warp against scipy at positions computed in 64 bits."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import graph_of
from halation.graph import Port
from halation.nodes.distort.noise_warp import NoiseWarp
from halation.renderer import RenderRequest
from noises import places, simplex_noise, stream
from warps import sample_bilinear, waves

STEEPEST = 3.44793


def ways(node: NoiseWarp, width: int, height: int, frame: int = 1) -> np.ndarray:
    """Which way every pixel goes, at most 1 far along each axis: [h, w, 2]."""
    strengths, total = node.gain ** np.arange(node.octaves), 0.0
    for octave, strength in enumerate(strengths):
        p = places(width, height, node.size * height, node.evolution + node.speed * frame)
        p[..., :2] *= 2**octave
        number, step = stream(node.seed, octave), 1e-5
        if node.kind == "push":
            layer = simplex_noise(p, number)[..., :2]
        else:
            across, down = (
                (simplex_noise(p + way, number) - simplex_noise(p - way, number))[..., 0] / (2 * step * STEEPEST)
                for way in (np.array([step, 0, 0]), np.array([0, step, 0]))
            )
            layer = np.stack([down, -across], -1)
        total += strength * layer
    return total / strengths.sum()


def warped(node: NoiseWarp, picture: np.ndarray, mask: np.ndarray | float, mode: str) -> tuple[np.ndarray, np.ndarray]:
    """The warped picture, and where it is certain how finely each pixel was sampled."""
    height, width = picture.shape[:2]
    way = ways(node, width, height)
    far = node.amount * height * mask * np.ones((height, width))
    y, x = np.mgrid[:height, :width] + 0.5
    ringed = np.pad(way, ((1, 1), (1, 1), (0, 0)), "edge")
    across = np.array([1.0, 0.0]) + 0.5 * far[..., None] * (ringed[1:-1, 2:] - ringed[1:-1, :-2])
    down = np.array([0.0, 1.0]) + 0.5 * far[..., None] * (ringed[2:, 1:-1] - ringed[:-2, 1:-1])
    span = (np.maximum(np.linalg.norm(across, axis=-1), np.linalg.norm(down, axis=-1)) - 0.01).clip(1, 8)
    count, out = np.ceil(span).astype(int), np.zeros(picture.shape)
    for n in np.unique(count):
        offsets = (np.arange(n) + 0.5) / n - 0.5
        spots = [np.stack([x, y], -1) + far[..., None] * way + i * across + j * down for j in offsets for i in offsets]
        found = np.mean([sample_bilinear(picture, spot[..., 0], spot[..., 1], mode) for spot in spots], 0)
        out = np.where((count == n)[..., None], found, out)
    return out, (np.abs(span - np.round(span)) > 1e-3) | (span == 1) | (span == 8)


@pytest.mark.parametrize("kind", ["push", "flow"])
@pytest.mark.parametrize(("size", "amount", "wave"), [((33, 26), 0.1, 0.5), ((30, 21), 0.4, 0.2), ((3, 2), 1.0, 0.5)])
def test_it_is_scipys_at_these_positions(run, hdr, edge, kind, size, amount, wave):
    picture, mask = hdr(*size), np.random.default_rng(3).uniform(-1, 1, size[::-1]).astype(np.float32)
    node = NoiseWarp(kind=kind, amount=amount, size=wave, octaves=2, evolution=0.7, seed=4, edge=edge.name)
    expected, sure = warped(node, picture, mask.astype(np.float64), edge.scipy_map)
    error = np.abs(run(node, {"image": picture, "mask": mask}) - expected).max(-1)
    assert sure.mean() > 0.9 and error[sure].max() < 4e-5 * picture.max()


def test_flow_keeps_areas_and_push_does_not(run):
    """The determinant of the warp, read off a picture of positions: 1 for small steps of a flow."""

    def stretch(kind: str) -> np.ndarray:
        y, x = np.mgrid[:96, :96] + 0.5
        picture = np.stack([x, y, 0 * x, 0 * x + 1], -1).astype(np.float32)
        node = NoiseWarp(kind=kind, amount=0.02, size=0.5, octaves=1)
        out = run(node, {"image": picture})[4:-4, 4:-4, :2].astype(np.float64)
        (xx, yx), (xy, yy) = (np.moveaxis(np.gradient(out, axis=axis), -1, 0) for axis in (1, 0))
        return np.abs(xx * yy - xy * yx - 1.0)

    assert stretch("flow").max() < 0.01 and stretch("push").max() > 0.05


def test_nothing_moves_farther_than_the_amount(run):
    y, x = np.mgrid[:64, :80] + 0.5
    picture = np.stack([x, y, 0 * x, 0 * x + 1], -1).astype(np.float32)
    for kind in ("push", "flow"):
        moved = (run(NoiseWarp(kind=kind, amount=0.1), {"image": picture}) - picture)[8:-8, 8:-8, :2]
        assert 1.0 < np.abs(moved).max() <= 6.4


def test_frames_follow_the_speed(renderer):
    """Ten frames of a tenth are one of evolution."""
    picture = waves(40, 30)

    def at(frame: int, **values: float) -> np.ndarray:
        node = NoiseWarp(**values)
        wanted = RenderRequest({"image": picture}, {"out": Port("outputs", "out")}, precision="float", frame=frame)
        return renderer.render(graph_of(node, {"image": picture}), wanted)["out"]

    still = {"speed": 0.0}
    assert np.array_equal(at(3, **still), at(8, **still)) and np.array_equal(at(7), at(7))
    assert np.abs(at(3) - at(8)).max() > 1e-3
    assert np.abs(at(10, speed=0.125) - at(1, speed=0.0, evolution=1.25)).max() < 1e-5


def test_the_proxy_shows_the_same(run):
    picture = waves(128, 96)
    full, half = (run(NoiseWarp(), {"image": picture}, scale=scale) for scale in (1.0, 0.5))
    assert np.abs(full.reshape(48, 2, 64, 2, 4).mean((1, 3)) - half).max() < 0.02


@pytest.mark.parametrize("wild", [np.nan, np.inf, -np.inf, 1e30])
def test_wild_masks_stay_harmless(run, hdr, edge, wild):
    mask = np.ones((10, 11), np.float32)
    mask[4, 5] = wild
    assert np.isfinite(run(NoiseWarp(edge=edge.name), {"image": hdr(11, 10), "mask": mask})).all()


def test_without_amount_it_vanishes(run, hdr):
    assert NoiseWarp(amount=0.0).identity() == "image"
    picture = hdr(14, 9)
    np.testing.assert_array_equal(run(NoiseWarp(), {"image": picture, "mask": np.zeros((9, 14))}), picture)
