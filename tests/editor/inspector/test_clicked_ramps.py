"""Colors of a ramp in its field: a click adds one, dragging moves it, the right button removes it.

From black to white, the color at a place is the place: which color a click has added says where it was.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from halation.authoring.commands import ReplaceGraph
from halation.graph import Graph, Port
from still_editor import StillEditor, open_still_editor
from still_hand import Hand
from toy_nodes import Tint

FIELD = "field tint.ramp"


@pytest.fixture(params=[1.0, 2.0], ids=["small", "large"])
def still(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[StillEditor]:
    scale = request.param
    with open_still_editor(tmp_path, size=(340.0 * scale, 900.0 * scale), scale=scale, screen=(3e3, 3e3)) as still:
        still.editor.session.apply(ReplaceGraph("Start", Graph().add("tint", Tint())))
        still.select("tint")
        still.show("Inspector")
        yield still


def read_stops(still: StillEditor) -> list[tuple[float, ...]]:
    """The place and the color of each."""
    ramp = still.editor.session.graph.value(Port("tint", "ramp"))
    assert isinstance(ramp, tuple)
    numbers = [float(number) for number in ramp]
    return [tuple(numbers[at : at + 5]) for at in range(0, len(numbers), 5)]


def find_band(still: StillEditor) -> tuple[float, float, float, float]:
    """The colors that are drawn, from the first place to the last."""
    left, top, right, bottom = still.places[FIELD]
    shapes = [shape.points for shape in still.show("Inspector", 1) if shape.kind == "shaded rect"]
    inside = [(low, high) for low, high in shapes if left <= low[0] and high[0] <= right and top <= low[1] < bottom]
    return (
        min(low[0] for low, _ in inside), inside[0][0][1], max(high[0] for _, high in inside), inside[0][1][1],
    )  # fmt: skip


def place(still: StillEditor, part: float) -> tuple[float, float]:
    left, top, right, bottom = find_band(still)
    return left + part * (right - left), (top + bottom) / 2.0


def test_a_click_adds_the_color_that_is_there(still: StillEditor) -> None:
    steps = len(still.editor.session.history.steps)
    for count, part in ((3, 0.5), (4, 0.25)):
        Hand(still).drag(place(still, part))
        still.calm("Inspector")
        stops = read_stops(still)
        assert len(stops) == count
        (added,) = [stop for stop in stops if stop[0] == pytest.approx(part, abs=0.01)]
        assert added[1:4] == pytest.approx([added[0]] * 3, abs=1e-6) and added[4] == 1.0
        steps += 1
        assert len(still.editor.session.history.steps) == steps


def test_a_color_is_dragged_and_keeps_what_it_is(still: StillEditor) -> None:
    Hand(still).drag(place(still, 0.5))
    still.calm("Inspector")
    color = read_stops(still)[1][1:]
    Hand(still).drag(place(still, 0.5), place(still, 0.6), place(still, 0.8))
    still.calm("Inspector")
    stops = read_stops(still)
    assert len(stops) == 3 and stops[1][0] == pytest.approx(0.8, abs=0.01) and stops[1][1:] == color
    assert (stops[0], stops[2]) == ((0.0, 0.0, 0.0, 0.0, 1.0), (1.0, 1.0, 1.0, 1.0, 1.0))


def test_the_right_button_removes_a_color_but_two_remain(still: StillEditor) -> None:
    Hand(still).drag(place(still, 0.5))
    still.calm("Inspector")
    for part, count in ((0.3, 3), (0.5, 2), (0.0, 2)):
        hand = Hand(still)
        hand.move(place(still, part))
        hand.press(1)
        hand.let_go(1)
        still.calm("Inspector")
        assert len(read_stops(still)) == count
