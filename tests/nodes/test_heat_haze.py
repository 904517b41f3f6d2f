"""Heat haze: what it promises, read off a picture that holds its own positions."""

from __future__ import annotations

import numpy as np
import pytest
from halation.app.graph import Graph, Input, Output, Port
from halation.app.renderer import Wanted
from halation.nodes import Kind
from halation.nodes.distort.heat_haze import HeatHaze
from warps import waves


def ramp(width: int, height: int) -> np.ndarray:
    """Every pixel holds its own position."""
    y, x = np.mgrid[:height, :width] + 0.5
    return np.stack([x, y, 0 * x, 0 * x + 1], -1).astype(np.float32)


def at_frame(renderer, node: HeatHaze, picture: np.ndarray, frame: int) -> np.ndarray:
    graph = Graph().add("node", node).add_input("image", Input(Kind.IMAGE, 4)).add_output("out", Output(Kind.IMAGE, 4))
    graph = graph.connect(Port("inputs", "image"), Port("node", "image"))
    graph = graph.connect(Port("node", "out"), Port("outputs", "out"))
    wanted = Wanted({"image": picture}, {"out": Port("outputs", "out")}, precision="float", frame=frame)
    return renderer.render(graph, wanted)["out"]


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
