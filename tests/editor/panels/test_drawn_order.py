"""What panels draw keeps the order that any reader expects, whatever it shows: texts lie apart, inside of their panel
and in the middle of their boxes, so do marks, and the pointer changes nothing but what it is over.

Nothing here knows how a panel looks. A margin that has lost its sign, a text that is half a line too low or a mark out
of its button breaks one of these.
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from drawn_shapes import Shape
from gui_screens import write_many_things
from still_editor import open_still_editor
from still_pictures import show_files, show_handles, show_lessons, show_opened_fields, show_passes, show_viewer
from still_screens import (
    show_animation,
    show_dialogs,
    show_more_dialogs,
    show_panels,
    show_renders,
    show_typical_nodes,
    show_values,
)
from still_window import Rect, overlap

CUT = "table", "compare", "notes", "sheet", "curves", "image list"
"""How screens begin in which texts are cut where a column or a ruler ends, or a menu or a tip lies over the panel."""

FLAT = 2.2
"""A box that is at most so many texts high holds one line, which is in its middle."""

MARKS = "line", "disk", "circle", "polygon", "polyline", "ngon", "outlined ngon", "outlined triangle"
"""Shapes that marks in buttons are made of."""

SQUARE, CHECK = 34.0, 16.0
"""The largest button with a mark alone in it, and the largest box with a check mark."""

SURFACES = "##picture", "##canvas", "##keys", "##names", "##ruler", "##name ", "##lamp_", "##curve_", "##node.colors",\
    "##curves.ramp"  # fmt: skip
"""Invisible buttons on which the pointer draws, or that it cannot change: plots, lists, names, what is chosen."""

PLAIN = show_typical_nodes, show_values, show_panels, show_animation, show_renders, show_files, show_passes
SCREENS = *PLAIN, show_viewer, show_handles


def has_area(box: Rect, least: float = 1.0) -> bool:
    return box[2] - box[0] > least and box[3] - box[1] > least


def holds(outer: Rect, inner: Rect, slack: float = 0.5) -> bool:
    return all(a <= b + slack for a, b in zip((*outer[:2], *inner[2:]), (*inner[:2], *outer[2:]), strict=True))


def find_bounds(shape: Shape) -> Rect:
    """The box around a mark."""
    radius = shape.lengths[0] if shape.kind in ("disk", "circle", "ngon", "outlined ngon") else 0.0
    across, down = ([point[axis] for point in shape.points] for axis in (0, 1))
    return min(across) - radius, min(down) - radius, max(across) + radius, max(down) + radius


@pytest.mark.parametrize("screens", [*SCREENS, show_dialogs, show_more_dialogs, show_lessons])
def test_texts_lie_apart_and_inside_of_their_panel(draw, screens) -> None:
    faults, count = list[str](), 0
    for name, drawing in draw(screens).items():
        texts = [text for text in drawing.texts if has_area(text.sight) and not name.startswith(CUT)]
        count += len(texts)
        faults += [
            f"{name}: {text}" for text in texts if text.box[0] < text.clip[0] - 1.0 or text.box[2] > text.clip[2] + 1.0
        ]
        faults += [
            f"{name}: {text} and {other}"
            for index, text in enumerate(texts)
            for other in texts[index + 1 :]
            if has_area(overlap(text.sight, other.sight), 1.5)
        ]
    assert not faults and count > 0, faults[:5]


@pytest.mark.parametrize("screens", [*SCREENS, show_opened_fields])
def test_a_line_of_text_is_in_the_middle_of_its_box(draw, screens) -> None:
    faults, count = list[str](), 0
    for name, drawing in draw(screens).items():
        boxes = drawing.list_boxes("filled rect", "rect", "invisible_button", "button", "selectable", "dummy")
        if "operator 0" in name:  # an open list lies over the fields
            continue
        for text in drawing.drawn_texts:
            sight = text.sight
            if not has_area(sight):
                continue
            x, y = (sight[0] + sight[2]) / 2, (sight[1] + sight[3]) / 2
            around = [box for box in boxes if holds(box, (x, y, x, y), 0.0) and has_area(box)]
            around = [box for box in around if box[3] - box[1] <= FLAT * (sight[3] - sight[1])]
            if not around:
                continue
            count += 1
            box = min(around, key=lambda box: (box[2] - box[0]) * (box[3] - box[1]))
            if abs((box[1] + box[3]) / 2 - y) > 1.0 or not holds((box[0], -1e9, box[2], 1e9), sight):
                faults.append(f"{name}: {text} in {box}")
    assert not faults, faults[:5]
    assert count > 0 or screens in (show_passes, show_renders)


@pytest.mark.parametrize("screens", [*PLAIN, show_viewer, show_opened_fields])
def test_a_mark_is_in_the_middle_of_its_button(draw, screens) -> None:
    """Of a switch, which is wider, the knob is as far from the one end as from the other when it is off."""
    faults, sides = list[str](), set[float]()
    for name, drawing in draw(screens).items():
        marks = [find_bounds(shape) for shape in drawing.shapes if shape.kind in MARKS]
        boxes = [(box, SQUARE) for box in drawing.list_boxes("invisible_button", "button")]
        boxes += [(box, CHECK) for box in drawing.list_boxes("filled rect", "rect") if not name.startswith("Graph")]
        for box, most in boxes:
            wide, high = box[2] - box[0], box[3] - box[1]
            inside = [mark for mark in marks if holds(box, mark)] if min(wide, high) > 4.0 else []
            if not inside or max(wide, high) > most:
                continue
            lows, highs = (
                [edge(mark[at] for mark in inside) for at in ats] for edge, ats in ((min, (0, 1)), (max, (2, 3)))
            )
            across, down = ((lows[at] + highs[at] - box[at] - box[at + 2]) / 2 for at in (0, 1))
            if wide > 1.4 * high:
                sides.add(round(across, 2))
            elif abs(across) > 1.05:
                faults.append(f"{name}: {inside} are {across} aside in {box}")
            if abs(down) > 0.6:
                faults.append(f"{name}: {inside} are {down} too low in {box}")
    assert not faults, faults[:5]
    assert len({abs(side) for side in sides}) <= 1


@pytest.mark.parametrize("screens", [*SCREENS, show_opened_fields, show_dialogs, show_more_dialogs, show_lessons])
def test_rectangles_have_an_area_and_lines_a_width(draw, screens) -> None:
    faults = list[str]()
    for name, drawing in draw(screens).items():
        for shape in drawing.shapes:
            (x0, y0), (x1, y1) = (*shape.points, (0.0, 0.0), (1.0, 1.0))[:2]
            if "rect" in shape.kind and not (x0 < x1 and y0 < y1):
                faults.append(f"{name}: {shape}")
            if shape.kind in ("disk", "circle", "ngon", "line", "polyline", "stroke") and min(shape.lengths) <= 0.0:
                faults.append(f"{name}: {shape}")
    assert not faults, (len(faults), faults[:5])


@pytest.mark.parametrize("screens", PLAIN)
def test_the_pointer_changes_what_it_is_over_and_nothing_else(tmp_path: Path, screens) -> None:
    faults, seen = list[str](), set[tuple[object, ...]]()
    with open_still_editor(tmp_path, write_many_things(tmp_path), screen=(3000.0, 3000.0)) as still:
        for name, title in screens(still):
            still.pane.point((1.0, 1.0))
            still.show(title, 4)
            before = still.pane.copy()
            for widget in before.widgets:
                box = *widget.points[0], *widget.points[1]
                kind = title, widget.text.split(".")[0][:9], round(box[2] - box[0]), round(box[3] - box[1])
                if widget.kind != "invisible_button" or kind in seen or not has_area(box, 3.0):
                    continue
                seen.add(kind)
                still.pane.point(((box[0] + box[2]) / 2, (box[1] + box[3]) / 2))
                still.show(title, 3)
                old, new = Counter(before.shapes), Counter(still.pane.shapes.shapes)
                changed = [*(old - new).elements(), *(new - old).elements()]
                if not changed and not widget.text.startswith(SURFACES):
                    faults.append(f"{name}: nothing shows that {widget} can be clicked")
                faults += [
                    f"{name}: {shape} changes with {widget}"
                    for shape in changed
                    if shape.points and not has_area(overlap(find_bounds(shape), box), -3.0)
                ]
            still.pane.point((1.0, 1.0))
    assert not faults, faults[:5]
