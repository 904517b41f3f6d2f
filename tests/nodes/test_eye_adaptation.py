"""Eye adaptation against the closed form of its exponential, the paper's numbers, and halved time steps."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from halation.graph import Input, Port
from halation.nodes import Kind
from halation.nodes.time.eye_adaptation import EyeAdaptation
from sequences import make_flat_frames, render_frames, shot_graph

DARK, BRIGHT = 0.02, 5.0


def door(opens: int = 2):
    """A dark room until the door opens."""
    return {"image": make_flat_frames(lambda frame: BRIGHT if frame >= opens else DARK)}


def adapted(renderer, node, shot, frames, output="adapted", **settings):
    found = render_frames(renderer, shot_graph(node, shot, (1, max(frames)), **settings), shot, frames, output)
    return np.array([float(made[0, 0, 0]) for made in found])


def log_average(value: float) -> float:
    return value + 1e-5


@pytest.mark.parametrize(("start", "end", "time"), [(DARK, BRIGHT, 0.4), (BRIGHT, DARK, 1.2)])
@pytest.mark.parametrize("scale", ["stops", "light"])
def test_a_step_is_followed_by_an_exponential(renderer, start, end, time, scale):
    shot = {"image": make_flat_frames(lambda frame: start if frame < 2 else end)}
    found = adapted(renderer, EyeAdaptation(scale=scale), shot, range(1, 25))
    kept = np.exp(-np.arange(24) / 24 / time)
    if scale == "stops":
        expected = np.exp(kept * math.log(log_average(start)) + (1 - kept) * math.log(log_average(end)))
    else:
        expected = kept * log_average(start) + (1 - kept) * log_average(end)
    np.testing.assert_allclose(found, expected, rtol=5e-6)


def test_the_natural_eye_is_krawczyk_s(renderer):
    """Time constants by what is seen, and the key of the adapted luminance: 0.030 at 1e-3 cd/m2, 0.531 at 100."""
    node = EyeAdaptation(model="natural", scale="light", nits=1.0)
    for end in (0.01, 0.5, 50.0):
        shot = {"image": make_flat_frames(lambda frame, end=end: 1.0 if frame < 2 else end)}
        found = adapted(renderer, node, shot, range(1, 9))
        rods = 0.04 / (0.04 + log_average(end))
        kept = np.exp(-np.arange(8) / 24 / (rods * 0.4 + (1 - rods) * 0.1))
        np.testing.assert_allclose(found, kept * log_average(1.0) + (1 - kept) * log_average(end), rtol=5e-6)
    for nits, key in ((1e-3, 0.030), (1.0, 0.161), (100.0, 0.531)):
        shot = {"image": make_flat_frames(lambda _, nits=nits: nits)}
        stops = adapted(renderer, replace(node, maximum=20.0), shot, [1], "exposure")[0]
        assert abs(2**stops * log_average(nits) - key) < 1e-3


@pytest.mark.parametrize("values", [{}, {"scale": "light"}, {"model": "natural"}])
def test_halved_time_steps_lead_to_the_same(renderer, values):
    node, slow = EyeAdaptation(**values), door()
    fast = {"image": lambda frame: slow["image"]((frame - 1) // 2 + 1)}
    one = adapted(renderer, node, slow, range(1, 13))
    two = adapted(renderer, node, fast, range(2, 25, 2), rate=48.0)
    np.testing.assert_allclose(np.log2(two), np.log2(one), atol=1e-6 * math.log2(BRIGHT / DARK))


def test_what_does_not_change_is_exposed_as_the_key_says(renderer, hdr):
    picture = hdr(9, 7, opaque=True)
    shot = {"image": lambda _: picture}
    luminance = picture[..., :3].astype(float) @ (0.2126, 0.7152, 0.0722)
    average = np.exp(np.log(luminance + 1e-5).mean())
    graph = shot_graph(EyeAdaptation(), shot)
    for made in render_frames(renderer, graph, shot, (1, 8)):
        np.testing.assert_allclose(made[..., :3], picture[..., :3] * 0.18 / average, rtol=2e-5)
        assert np.array_equal(made[..., 3], picture[..., 3])


def test_empty_pixels_and_broken_ones_do_not_count(renderer, hdr):
    picture = hdr(8, 8, opaque=True)
    spoiled = picture.copy()
    spoiled[:4] = 0.0
    spoiled[4, 4] = np.nan
    node = EyeAdaptation()
    found = adapted(renderer, node, {"image": lambda _: spoiled}, [1])[0]
    light = np.delete(spoiled[4:].reshape(-1, 4), 4, 0)[:, :3].astype(float) @ (0.2126, 0.7152, 0.0722)
    np.testing.assert_allclose(found, np.exp(np.log(light + 1e-5).mean()), rtol=2e-5)


def test_another_meter_may_lead_it(renderer):
    shot = door()
    graph = shot_graph(EyeAdaptation(), shot, (1, 4))
    graph = graph.add_input("met", Input(Kind.NUMBER, default=2.0))
    graph = graph.connect(Port("inputs", "met"), Port("node", "luminance"))
    found = render_frames(renderer, graph, shot, (1, 4), "adapted")
    assert [float(made[0, 0, 0]) for made in found] == [2.0, 2.0]


def test_exposure_stays_in_its_range(renderer):
    shot = door()
    node = EyeAdaptation(minimum=-1.0, maximum=1.0, compensation=0.5)
    found = adapted(renderer, node, shot, [1, 200], "exposure")
    np.testing.assert_allclose(found, [1.5, -0.5])
