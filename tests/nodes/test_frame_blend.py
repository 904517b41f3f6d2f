"""Frame blend against its closed form; halved time steps; and where a history of half floats would stall."""

from __future__ import annotations

import math

import numpy as np
import pytest
from halation.nodes.time.frame_blend import FrameBlend
from sequences import make_flat_frames, render_frames, shot_graph

WHOLE = range(1, 9)


def picture(frame: int) -> np.ndarray:
    """Noise with a few suns."""
    random = np.random.default_rng(frame)
    return np.exp(random.normal(0.0, 2.0, (5, 7, 4))).astype(np.float32)


def closed_form(keep: float, frame: int, first: int = 1) -> np.ndarray:
    """y_n = sum of (1 - a) a^k x_(n - k), with the first frame standing for all before it."""
    found = keep ** (frame - first) * picture(first).astype(float)
    return found + sum((1 - keep) * keep**back * picture(frame - back).astype(float) for back in range(frame - first))


@pytest.mark.parametrize(
    ("node", "keep"),
    [
        (FrameBlend(mode="persistence", persistence=0.7), 0.7),
        (FrameBlend(mode="persistence", persistence=0.0), 0.0),
        (FrameBlend(time=0.2), math.exp(-1 / (24 * 0.2))),
        (FrameBlend(time=0.0), 0.0),
    ],
)
def test_it_is_the_closed_form(renderer, node, keep):
    shot = {"image": picture}
    found = render_frames(renderer, shot_graph(node, shot), shot, WHOLE)
    for frame, made in zip(WHOLE, found, strict=True):
        np.testing.assert_allclose(made, closed_form(keep, frame), rtol=2e-6)


def test_a_step_is_answered_by_an_exponential(renderer):
    shot = {"image": make_flat_frames(lambda frame: float(frame > 1))}
    found = render_frames(renderer, shot_graph(FrameBlend(time=0.125), shot, (1, 25)), shot, range(1, 26))
    level = [float(made[0, 0, 0]) for made in found]
    np.testing.assert_allclose(level, [1 - math.exp(-(frame - 1) / 24 / 0.125) for frame in range(1, 26)], atol=1e-6)


@pytest.mark.parametrize("steps", [2, 5])
def test_more_frames_a_second_make_the_same_picture(renderer, steps):
    """The same light, seen for the same time, in more frames: what it has become when it changes."""
    slow = {"image": picture}
    fast = {"image": lambda frame: picture((frame - 1) // steps + 1)}
    node = FrameBlend(time=0.1)
    one = render_frames(renderer, shot_graph(node, slow, (1, 6)), slow, range(1, 7))
    two = render_frames(
        renderer, shot_graph(node, fast, (1, 6 * steps), rate=24.0 * steps), fast, range(1, 6 * steps + 1)
    )
    for frame in range(6):
        np.testing.assert_allclose(two[steps * frame + steps - 1], one[frame], rtol=3e-6)


def test_history_has_32_bits_where_16_would_stall(renderer):
    """A half float near 1 stays where it is once (1 - a) |x - y| is less than half its step of 2^-11."""
    keep, frames = 0.95, 200
    half = np.float16(1.0)
    for _ in range(frames):
        half = np.float16(keep * float(half) + (1 - keep) * 0.99)
    assert half > 0.99 + 2.0**-11 / 2 / (1 - keep) * 0.5, "so the test has something to prove"
    shot = {"image": make_flat_frames(lambda frame: 1.0 if frame == 1 else 0.99)}
    node = FrameBlend(mode="persistence", persistence=keep)
    for precision in ("half", "float"):
        graph = shot_graph(node, shot, (1, frames))
        last = render_frames(renderer, graph, shot, [frames], precision=precision)[0][0, 0, 0]
        assert abs(float(last) - (0.99 + 0.01 * keep ** (frames - 1))) < 2e-6, precision


def test_light_that_is_gone_fades_out(renderer):
    shot = {"image": make_flat_frames(lambda frame: 100.0 if frame == 1 else 0.0)}
    node = FrameBlend(mode="persistence", persistence=0.9)
    last = render_frames(renderer, shot_graph(node, shot, (1, 150)), shot, [150])[0]
    np.testing.assert_allclose(last[0, 0, 0], 100 * 0.9**149, rtol=1e-4)
