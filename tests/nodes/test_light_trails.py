"""Light trails against numpy's running maximum, and the same trail at any frame rate."""

from __future__ import annotations

import math

import numpy as np
import pytest
from halation.nodes.time.light_trails import LightTrails
from sequences import render_frames, shot_graph

WHOLE = range(1, 11)


def lamp(frame: int) -> np.ndarray:
    """A lamp that moves a pixel each frame over a dim wall."""
    picture = np.full((3, 12, 4), 0.1, np.float32)
    picture[..., 3] = 1.0
    picture[1, frame, :3] = (9.0, 5.0, 2.0)
    return picture


def test_lamps_draw_lines_for_ever(renderer):
    shot = {"image": lamp}
    graph = shot_graph(LightTrails(fade="never"), shot, (1, 10))
    last = render_frames(renderer, graph, shot, [10])[0].astype(float)
    light = last[1, 1:11, :3]
    assert np.abs(light - light[0]).max() < 1e-6, "all as bright as the lamp now"
    assert np.abs(np.delete(last, 1, 0)[..., :3] - 0.1).max() < 1e-6 and (last[..., 3] == 1.0).all()


@pytest.mark.parametrize("time", [0.05, 0.5])
def test_trails_fade_by_the_closed_form(renderer, time):
    shot = {"image": lamp}
    found = render_frames(
        renderer, shot_graph(LightTrails(time=time, threshold=0.0), shot, (1, 10)), shot, WHOLE, "trail"
    )
    for frame, made in zip(WHOLE, found, strict=True):
        kept = [
            lamp(past)[..., :3].astype(float) * math.exp(-(frame - past) / 24 / time) for past in range(1, frame + 1)
        ]
        np.testing.assert_allclose(made[..., :3], np.max(kept, axis=0), rtol=2e-6)


def test_the_same_trail_at_any_frame_rate(renderer):
    slow, fast = {"image": lamp}, {"image": lambda frame: lamp((frame - 1) // 2 + 1)}
    one = render_frames(renderer, shot_graph(LightTrails(), slow, (1, 10)), slow, [10], "trail")[0]
    two = render_frames(renderer, shot_graph(LightTrails(), fast, (1, 20), rate=48.0), fast, [19], "trail")[0]
    # Half of each frame's time more has passed since the lamp left.
    now = one[1, 10, 0]
    age = np.arange(1, 10)
    np.testing.assert_allclose(two[1, 10 - age, 0] / now, np.exp(-(2 * age - 1) / 48 / 0.5), rtol=2e-6)
    np.testing.assert_allclose(one[1, 10 - age, 0] / now, np.exp(-age / 24 / 0.5), rtol=2e-6)


def test_what_is_dim_leaves_none(renderer):
    shot = {"image": lambda frame: lamp(frame) * (0.05, 0.05, 0.05, 1.0)}
    found = render_frames(renderer, shot_graph(LightTrails(), shot, (1, 10)), shot, [10], "trail")[0]
    assert not found.any()


def test_a_bad_pixel_is_forgotten(renderer):
    def spoiled(frame: int) -> np.ndarray:
        picture = lamp(frame)
        if frame == 2:
            picture[0, 0], picture[0, 1] = np.nan, np.inf
        return picture

    shot = {"image": spoiled}
    last = render_frames(renderer, shot_graph(LightTrails(time=0.05), shot, (1, 40)), shot, [10], "trail")[0]
    assert np.isfinite(last).all() and not last[0, 0].any()
