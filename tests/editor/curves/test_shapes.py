"""Curves on the screen are what `Keys.at` says."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from halation.editor.curves.shapes import (
    ExpressionSamples,
    cut_dashes,
    find_value_range,
    flatten_curves,
    make_outside_pieces,
    make_pieces,
)
from halation.editor.toolkit.plane import Plane, View, step, ticks
from halation.graph import Expression, Graph, Key, Keys, Port, Settings
from toy_nodes import Gain

HOW = ("constant", "linear", "smooth", "bezier")
PLANE = Plane(View(-20.0, 60.0, -2.0, 3.0), (0.0, 0.0, 1600.0, 800.0))


def some_keys(outside="hold", channels: int = 1) -> Keys:
    rng = np.random.default_rng(3)
    found = []
    for place, how in enumerate([*HOW, *HOW]):
        value = tuple(map(float, rng.uniform(-1.0, 2.0, channels)))
        handles = {}
        if place % 3 == 0:
            handles = {"left": (-1.5, *rng.normal(size=channels)), "right": (6.0, *rng.normal(size=channels))}
        found.append(Key(place * 4.0 + place % 2, value if channels > 1 else value[0], how, **handles))
    return Keys(tuple(found), outside)


def curve(keys: Keys, channel: int) -> np.ndarray:
    """All that is drawn of a channel, in frames and values."""
    inner = make_pieces(keys, channel)
    before, after = make_outside_pieces(keys, channel, inner, PLANE.view.first, PLANE.view.last)
    lines = [line for line in flatten_curves([before, inner, after], PLANE) if len(line)]
    found = np.concatenate(lines)
    return np.stack(
        [PLANE.view.first + found[:, 0] / PLANE.across, PLANE.view.low + (PLANE.rect[3] - found[:, 1]) / PLANE.up],
        axis=1,
    )


@pytest.mark.parametrize(("ends", "channels"), [*itertools.product(("hold", "linear", "loop", "mirror"), (1, 3))])
def test_a_drawn_curve_is_where_the_keys_say(ends: str, channels: int) -> None:
    keys = some_keys(ends, channels)
    for channel in range(channels):
        line = curve(keys, channel)
        assert np.all(np.diff(line[:, 0]) >= -1e-9)
        for frame in np.random.default_rng(1).uniform(-20.0, 60.0, 300):
            value = keys.evaluate(frame)
            there = value[channel] if isinstance(value, tuple) else value
            place = int(np.clip(np.searchsorted(line[:, 0], frame), 1, len(line) - 1))
            near = line[max(place - 2, 0) : place + 2]
            starts, ends_at = near[:-1], near[1:]
            scale = np.array((PLANE.across, PLANE.up))
            along, to = (ends_at - starts) * scale, (np.array((frame, there)) - starts) * scale
            part = np.clip((along * to).sum(1) / np.maximum((along * along).sum(1), 1e-12), 0.0, 1.0)
            assert np.hypot(*(to - along * part[:, None]).T).min() < 0.5, (frame, there)


def test_what_is_not_seen_is_not_made() -> None:
    keys = some_keys()
    inner = make_pieces(keys, 0)
    (none,) = flatten_curves([inner], Plane(View(100.0, 200.0, 0.0, 1.0), PLANE.rect))
    assert len(none) == 0
    (part,) = flatten_curves([inner], Plane(View(10.0, 12.0, 0.0, 1.0), PLANE.rect))
    (whole,) = flatten_curves([inner], Plane(View(-100.0, 200.0, 0.0, 1.0), PLANE.rect))
    assert 2 <= len(part) < 400 and 2 <= len(whole) < 200


def test_switches_and_whole_numbers_are_curves_too() -> None:
    keys = Keys((Key(1, False), Key(5, True), Key(9, False)))
    assert make_pieces(keys, 0)[:, 3, 1].tolist() == [0.0, 1.0, 1.0, 0.0]
    assert find_value_range(keys, 0) == (0.0, 1.0)
    assert find_value_range(keys, 0, lambda key: key.frame == 5) == (1.0, 1.0)
    assert find_value_range(keys, 0, lambda key: False) is None


def test_an_expression_is_sampled_once_and_has_gaps() -> None:
    graph = Graph().add("gain", Gain()).animate(Port("gain", "gain"), Expression("1 / (frame - 5)"))
    samples = ExpressionSamples()
    first, second = samples.sample_lines(graph, Settings(), Port("gain", "gain"), 0, 2.5, 9.0)
    assert first[:, 0].tolist() == [2.0, 3.0, 4.0] and second[:, 0].tolist()[0] == 6.0
    assert second[0, 1] == pytest.approx(1.0)
    many = samples.sample_lines(graph, Settings(), Port("gain", "gain"), 0, 0.0, 1e5)
    assert sum(map(len, many)) < 300


def test_dashes_cover_a_line_in_turn() -> None:
    line = np.array([(0.0, 0.0), (50.0, 0.0), (50.0, 50.0)])
    found = cut_dashes(line, 6.0, 4.0)
    assert len(found) == 10
    assert found[0].tolist() == [[0.0, 0.0], [6.0, 0.0]]
    assert found[5][0].tolist() == [50.0, 0.0]
    assert cut_dashes(line[:1], 6.0, 4.0) == []


def test_ticks_are_round_and_far_enough_apart() -> None:
    for scale in np.geomspace(1e-5, 1e5, 60):
        labelled = [tick for tick in ticks(-3.0 / scale, 1000.0 / scale, scale, 50.0) if tick.label]
        assert 2 <= len(labelled) <= 21
        gaps = np.diff([tick.at for tick in labelled]) * scale
        assert gaps.min() > 49.0 and len({tick.label for tick in labelled}) == len(labelled)
    whole = ticks(0.0, 5.0, 300.0, 60.0, whole=True)
    assert [tick.label for tick in whole] == ["0", "1", "2", "3", "4", "5"]
    assert ticks(-0.2, 0.2, 500.0, 45.0)[0].label == "-0.2"


def test_zooming_keeps_the_place_under_the_pointer() -> None:
    view = View(0.0, 100.0, -1.0, 1.0)
    plane = Plane(view, (100.0, 50.0, 900.0, 450.0))
    assert (plane.frame(plane.x(33.0)), plane.value(plane.y(0.25))) == (pytest.approx(33.0), pytest.approx(0.25))
    closer = Plane(view.zoom(33.0, 0.25, 1.7, 0.6), plane.rect)
    assert (closer.x(33.0), closer.y(0.25)) == (pytest.approx(plane.x(33.0)), pytest.approx(plane.y(0.25)))
    assert closer.across == pytest.approx(plane.across * 1.7)
    for factor in (1e-30, 1e30):
        far = view.zoom(10.0, 0.0, factor, factor)
        assert far.last > far.first and far.high > far.low
    assert view.fit((5.0, 5.0), (2.0, 2.0)) == View(4.0, 6.0, 1.0, 3.0)
    assert view.fit(None, None) == view


@pytest.mark.parametrize(
    ("scale", "apart", "whole", "expected"),
    [(1.0, 50.0, False, 50.0), (1.0, 51.0, False, 100.0), (1.0, 20.0, False, 20.0), (10.0, 50.0, False, 5.0),
     (300.0, 60.0, False, 0.2), (300.0, 60.0, True, 1.0), (1000.0, 50.0, False, 0.05), (0.5, 60.0, True, 200.0)],
)  # fmt: skip
def test_steps_are_the_least_round_ones_with_room(scale: float, apart: float, whole: bool, expected: float) -> None:
    assert step(scale, apart, whole) == pytest.approx(expected)


@pytest.mark.parametrize(("scale", "between"), [(1.0, 10.0), (2.0, 10.0), (10.0, 1.0), (100.0, 0.1), (0.5, 20.0)])
def test_small_ticks_divide_a_step_by_two_or_five(scale: float, between: float) -> None:
    """Steps of 50 pixels or more are 50, 50, 5, 0.5 and 100: twos are halved, others have five parts."""
    marks = [tick.at for tick in ticks(0.0, 400.0 / scale, scale, 50.0)]
    assert {round(b - a, 9) for a, b in itertools.pairwise(marks)} == {between}
