"""What the mouse is at."""

from __future__ import annotations

import numpy as np
from halation.editor.curves.bundle import BundleBuilder
from halation.editor.curves.hits import (
    EntryCache,
    find_line,
    find_nearest,
    find_sheet_marks,
    find_spots_in_box,
    find_tips,
)
from halation.editor.curves.rows import make_rows
from halation.editor.toolkit.plane import Plane, View
from halation.graph import Graph, Key, Keys, Port
from toy_nodes import Gain

GAIN, TINT = Port("gain", "gain"), Port("gain", "tint")
PLANE = Plane(View(0.0, 100.0, 0.0, 4.0), (0.0, 0.0, 1000.0, 400.0))


def graph() -> Graph:
    made = Graph().add("gain", Gain())
    made = made.animate(GAIN, Keys((Key(10, 1.0, "bezier"), Key(40, 2.0, "bezier"), Key(300, 2.0))))
    return made.animate(TINT, Keys((Key(10, (1.0, 2.0, 3.0, 4.0)), Key(60, (1.0, 1.0, 1.0, 1.0)))))


def test_keys_of_the_sheet() -> None:
    found, entries = graph(), EntryCache()
    shown = make_rows(found)
    summary, gain, tint = find_sheet_marks(shown, found.animation, entries, PLANE, 50.0, 20.0)
    assert [(mark.x, mark.y) for mark in gain] == [(100.0, 80.0), (400.0, 80.0)]
    assert [mark.x for mark in summary] == [100.0, 400.0, 600.0] and len(summary[0].spots) == 5
    assert [mark.x for mark in tint] == [100.0, 600.0]
    every = [*summary, *gain, *tint]
    assert find_nearest(every, 103.0, 82.0, 7.0) is gain[0]
    assert find_nearest(every, 103.0, 90.0, 5.0) is None
    assert find_spots_in_box(every, (500.0, 110.0, 90.0, 70.0)) == gain[0].spots | gain[1].spots | tint[0].spots
    again = find_sheet_marks(shown, found.animation, entries, PLANE, 50.0, 20.0)
    assert again[0][0].spots is summary[0].spots
    assert find_sheet_marks(shown, found.animation, entries, PLANE, -500.0, 20.0) == [[], [], []]
    moved = found.animate(GAIN, Keys((Key(11, 1.0),)))
    assert [mark.x for mark in find_sheet_marks(make_rows(moved), moved.animation, entries, PLANE, 50.0, 20.0)[0]] == [
        100.0,
        110.0,
        600.0,
    ]


def test_keys_and_handles_of_curves() -> None:
    found = graph()
    made = BundleBuilder()
    bundle = made.make(make_rows(found), {(TINT, 3)})
    assert bundle.lanes == ((GAIN, 0), (TINT, 0), (TINT, 1), (TINT, 2))
    assert made.make(make_rows(found), ()).shapes[1] is bundle.shapes[1]
    seen = bundle.project(PLANE)
    assert len(seen.list_marks()) == 2 + 3 * 2
    for chosen in ((GAIN, 10.0, 0), (TINT, 10.0, 0)):
        assert seen.find_mark(99.0, 301.0, 6.0, {chosen}).spots == {chosen}
    assert seen.find_mark(99.0, 320.0, 6.0, ()) is None
    middle = found.animation[GAIN].evaluate(30)
    assert seen.find_lane(PLANE.x(30.0), PLANE.y(middle) + 3.0, 5.0) == (GAIN, 0)
    of, _, bent, cuts = bundle.project_outside(PLANE)
    assert of == [0, 1, 2, 3, 1, 2, 3] and cuts == list(range(8)) and not bent.any()
    assert BundleBuilder().make((), ()).project(PLANE).list_marks() == []
    ends = find_tips(found.animation, [(GAIN, 40.0, 0), (TINT, 10.0, 0), (GAIN, 77.0, 0)], (), PLANE)
    assert [tip.side for tip in ends] == ["left", "right"]
    left, right = found.animation[GAIN].handles(40.0)
    assert (ends[0].x, ends[1].x) == (PLANE.x(40.0 + left[0]), PLANE.x(40.0 + right[0]))
    assert find_tips(found.animation, [(GAIN, 40.0, 0)], {(GAIN, 0)}, PLANE) == []
    assert [tip.side for tip in find_tips(found.animation, [(GAIN, 10.0, 0)], (), PLANE)] == ["right"]


def test_the_curve_under_the_mouse() -> None:
    steep = np.array([(0.0, 0.0), (10.0, 0.0), (10.0, 300.0), (20.0, 300.0)])
    flat = np.array([(0.0, 150.0), (100.0, 150.0)])
    lines = (("steep", steep), ("flat", flat))
    assert find_line(lines, 12.0, 80.0, 5.0) == "steep"
    assert find_line(lines, 60.0, 153.0, 5.0) == "flat"
    assert find_line(lines, 12.0, 151.0, 5.0) == "flat"
    assert find_line(lines, 60.0, 190.0, 5.0) is None
