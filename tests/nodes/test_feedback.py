"""Feedback against scipy's cubic resampling and closed forms; bounded, sharp, and free of what is no number."""

from __future__ import annotations

import math

import numpy as np
import pytest
from halation.nodes.time.feedback import Feedback
from sequences import make_flat_frames, render_frames, shot_graph

STILL = {"rotation": 0.0, "scale": 1.0, "hue": 0.0}


def first_only(picture: np.ndarray):
    """A picture, and black from the second frame on."""
    return {"image": lambda frame: picture if frame == 1 else np.zeros_like(picture)}


def second(renderer, node, picture, frame=2, **options):
    """What has become of it: its past was itself, so the screen shows that at the first frame too."""
    shot = first_only(picture)
    return render_frames(renderer, shot_graph(node, shot, (1, frame)), shot, [frame], **options)[0].astype(float)


def cubic(x: np.ndarray) -> np.ndarray:
    """Catmull-Rom, Keys 1981 with a = -1/2."""
    x = np.abs(x)
    near, far = 1.5 * x**3 - 2.5 * x**2 + 1, -0.5 * x**3 + 2.5 * x**2 - 4 * x + 2
    return np.where(x < 1, near, np.where(x < 2, far, 0.0))


def sampled(picture: np.ndarray, x: float, y: float) -> np.ndarray:
    """Catmull-Rom on black ground, within the four pixels around."""
    height, width = picture.shape[:2]
    columns, rows = np.arange(-9, width + 9), np.arange(-9, height + 9)
    padded = np.pad(picture, ((9, 9), (9, 9), (0, 0)))
    weights = cubic(rows + 0.5 - y)[:, None] * cubic(columns + 0.5 - x)[None]
    value = (weights[..., None] * padded).sum((0, 1)) / weights.sum()
    i, j = math.floor(y - 0.5) + 9, math.floor(x - 0.5) + 9
    around = padded[i : i + 2, j : j + 2].reshape(4, -1)
    return np.clip(value, around.min(0), around.max(0))


@pytest.mark.parametrize(
    "values",
    [
        {"position": (1.3, -0.6)},
        {"rotation": 7.0},
        {"scale": 1.15},
        {"pivot": (0.2, 0.7), "rotation": -4.0},
        {"position": (0.4, 0.9), "rotation": 3.0, "scale": 1.05, "pivot": (0.4, 0.4)},
    ],
)
def test_the_past_is_moved_as_the_values_say(renderer, values):
    picture = np.random.default_rng(1).uniform(0.0, 1.0, (11, 14, 4)).astype(np.float32)
    node = Feedback(**{**STILL, "decay": 1.0, "mode": "add", **values})
    size, angle = np.array([14.0, 11.0]), math.radians(node.rotation)
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]) * node.scale
    pivot = np.array(node.pivot) * size
    # The first frame is the picture on itself as it was moved; its past is the picture.
    once = np.zeros_like(picture, float)
    for i in range(11):
        for j in range(14):
            x, y = np.linalg.inv(turn) @ (np.array([j + 0.5, i + 0.5]) - pivot - node.position) + pivot
            once[i, j] = sampled(picture, x, y)
    shot = first_only(picture)
    found = render_frames(renderer, shot_graph(node, shot, (1, 1)), shot, [1])[0].astype(float)
    expected = picture + once
    assert np.abs(found[..., :3] - expected[..., :3]).max() < 2e-5
    assert np.abs(found[..., 3] - np.minimum(expected[..., 3], 1)).max() < 2e-5


@pytest.mark.parametrize(
    ("mode", "level"),
    [
        ("brightest", lambda d, n: 1.0),
        ("add", lambda d, n: (1 - d ** (n + 1)) / (1 - d)),
        ("mix", lambda d, n: 1.0),
    ],
)
def test_still_light_adds_up_to_the_closed_form(renderer, mode, level):
    shot = {"image": make_flat_frames(lambda _: 1.0)}
    node = Feedback(**STILL, decay=0.8, mode=mode)
    found = render_frames(renderer, shot_graph(node, shot, (1, 9)), shot, range(1, 10))
    for frame, made in enumerate(found, 1):
        np.testing.assert_allclose(made[..., :3], level(0.8, frame), rtol=2e-6)


def test_over_and_screen(renderer):
    half = np.full((3, 3, 4), 0.25, np.float32)
    half[..., 3] = 0.5
    shot = {"image": lambda _: half}
    over = render_frames(renderer, shot_graph(Feedback(**STILL, decay=0.8, mode="over"), shot, (1, 1)), shot, [1])[0]
    np.testing.assert_allclose(over[0, 0], [0.35, 0.35, 0.35, 0.7], rtol=1e-6)
    screen = render_frames(renderer, shot_graph(Feedback(**STILL, decay=0.8, mode="screen"), shot, (1, 1)), shot, [1])[
        0
    ]
    np.testing.assert_allclose(screen[0, 0], [0.4, 0.4, 0.4, 0.7], rtol=1e-6)


def test_hue_goes_around_the_wheel_and_light_stays(renderer):
    picture = np.tile(np.float32([0.9, 0.2, 0.1, 1.0]), (3, 3, 1))
    found = second(renderer, Feedback(**{**STILL, "hue": 120.0}, decay=1.0, mode="brightest"), picture, 2)
    # Red, then green on it, then both gone around: all primaries have been there.
    np.testing.assert_allclose(found[1, 1, :3], [0.2, 0.9, 0.9], atol=1e-5)


def test_it_stays_sharp(renderer):
    """Ten steps of half a pixel: waves of six pixels keep most of what bilinear reading takes."""
    x = np.arange(66)
    wave = 0.5 + 0.5 * np.sin(2 * np.pi * (x + 0.5) / 6)
    picture = np.broadcast_to(wave[None, :, None], (5, 66, 4)).astype(np.float32).copy()
    node = Feedback(**STILL, position=(0.5, 0.0), decay=1.0, mode="add", edge="wrap")

    def shot(frame: int) -> np.ndarray:
        return picture if frame == 1 else np.zeros_like(picture)

    # Without the past of the first frame, which is itself: what ten steps make of one.
    found = render_frames(renderer, shot_graph(node, {"image": shot}, (1, 11)), {"image": shot}, (1, 11))
    span = [np.ptp(made[2, :, 0]) for made in found]
    bilinear = np.cos(np.pi / 6) ** 10
    print(span[1] / span[0], bilinear)
    assert span[1] / span[0] > 2.0 * bilinear


@pytest.mark.parametrize("mode", ["brightest", "add", "screen", "over", "mix"])
@pytest.mark.parametrize("values", [{}, {"scale": 0.9, "rotation": 33.0}, {"scale": 1.3, "edge": "mirror"}])
def test_it_never_explodes(renderer, hdr, mode, values):
    shot = {"image": lambda frame: np.roll(hdr(16, 12), frame, 1)}
    node = Feedback(mode=mode, decay=1.0, hue=25.0, ceiling=20.0, **values)
    brightest = max(float(hdr(16, 12).max()), 1.0)
    last = render_frames(renderer, shot_graph(node, shot, (1, 60)), shot, [60])[0]
    assert np.isfinite(last).all() and last.max() <= brightest + 20.0


def test_a_bad_pixel_does_not_come_back(renderer):
    def spoiled(frame: int) -> np.ndarray:
        picture = np.full((6, 6, 4), 0.5, np.float32)
        if frame == 2:
            picture[1, 1], picture[2, 4], picture[4, 4] = np.nan, np.inf, -np.inf
        return picture

    shot = {"image": spoiled}
    found = render_frames(renderer, shot_graph(Feedback(mode="mix", hue=0.0), shot, (1, 90)), shot, (2, 3, 90))
    assert all(np.isfinite(made).all() for made in found)
    assert np.abs(found[2] - 0.5).max() < 0.5
