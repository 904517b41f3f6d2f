"""A panel draws the same wherever it is, and everything twice as large on an interface of twice the size.

Places and lengths follow from the panel's own corner, its size and the scale of the interface: one that does not, a sum
in place of a difference or a length in pixels, breaks one of these. Nothing here knows how a panel looks.
"""

from __future__ import annotations

import re

import pytest
from drawn_shapes import Shape
from still_pictures import (
    show_files,
    show_flipbooks,
    show_gestures,
    show_handles,
    show_lamps,
    show_lessons,
    show_opened_fields,
    show_opened_panels,
    show_passes,
    show_search,
    show_status,
    show_viewer,
    show_wide_panels,
)
from still_screens import (
    show_animation,
    show_dialogs,
    show_more_dialogs,
    show_panels,
    show_renders,
    show_typical_nodes,
    show_values,
)

DATE = re.compile(r"\d{4}-\d\d-\d\d \d\d:\d\d")

PIXELS = re.compile(r"[\d.]+ %|\d+, \d+")
"""The zoom of the picture, and its pixel under the pointer: a larger panel has more pixels."""

CLICKED = "button", "small_button", "checkbox", "radio_button", "invisible_button", "selectable", "drag_float"
"""Widgets that take clicks."""

UNEVEN = ("Graph", "Animation ", "sheet ", "curves ", "start", "palette with letters", "flipbook ", "wide Animation")
"""How screens begin that do not grow evenly: a grid has as many lines as pixels allow, a curve as many points; keys
have a margin in pixels; and the rows of the start screen, the letters of a command and the names of what is played are
rounded one by one."""


MOVED = (
    show_typical_nodes, show_values, show_panels, show_animation, show_renders, show_handles, show_viewer, show_files,
    show_passes, show_lessons, show_search, show_status, show_gestures, show_lamps, show_flipbooks, show_wide_panels,
    show_opened_fields, show_opened_panels,
)  # fmt: skip
"""What lies in its panel; dialogs lie in the middle of the screen."""


EXACT, ROUNDED = 0.01, 2.0
"""How far a thing may lie from its place. Places are rounded to whole pixels, and the widths of texts too."""


def compare(
    first: list[Shape],
    second: list[Shape],
    factor: float,
    shift: tuple[float, float] = (0.0, 0.0),
    slack: float = EXACT,
) -> str:
    """The first thing that is not where it should be."""
    for one, other in zip(first, second, strict=False):
        expected = one.change(factor, shift)
        is_zoom = slack != EXACT and PIXELS.fullmatch(one.text) and PIXELS.fullmatch(other.text)
        is_date = DATE.fullmatch(one.text) and DATE.fullmatch(other.text)  # a folder of the tree may change meanwhile
        is_other = one.text != other.text and not (is_zoom or is_date)
        if is_other or (one.kind, one.color) != (other.kind, other.color):
            return f"{one} has become {other}"
        wanted = [*(number for point in expected.points for number in point), *expected.lengths]
        drawn = [*(number for point in other.points for number in point), *other.lengths]
        if len(wanted) != len(drawn) or any(abs(a - b) > slack for a, b in zip(wanted, drawn, strict=True)):
            return f"{expected} is {other}"
    return "" if len(first) == len(second) else f"{len(first)} shapes have become {len(second)}"


@pytest.mark.parametrize("screens", MOVED)
def test_a_panel_that_is_moved_draws_the_same(draw, screens) -> None:
    here, there = draw(screens), draw(screens, at=(220.0, 130.0))
    assert not {
        name: fault for name in here if (fault := compare(here[name].all, there[name].all, 1.0, (200.0, 100.0)))
    }


@pytest.mark.parametrize("screens", [*MOVED, show_dialogs, show_more_dialogs])
def test_everything_grows_with_the_interface(draw, screens) -> None:
    small, large = draw(screens), draw(screens, scale=2.0)
    faults = {name: fault for name in small if (fault := compare(small[name].all, large[name].all, 2.0, slack=3.0))}
    faults = {name: fault for name, fault in faults.items() if not name.startswith(UNEVEN)}
    assert not faults


@pytest.mark.parametrize("screens", [show_viewer, show_handles, show_lamps, show_opened_panels])
def test_a_screen_of_twice_as_many_pixels_draws_the_same(draw, screens) -> None:
    """All that the picture carries is drawn in units of the interface: only the zoom says that it has more pixels."""
    coarse, fine = draw(screens), draw(screens, density=2.0)
    faults = {name: compare(coarse[name].all, fine[name].all, 1.0, slack=ROUNDED) for name in coarse}
    assert not {name: fault for name, fault in faults.items() if fault}


@pytest.mark.parametrize("screens", [show_typical_nodes, show_values, show_panels, show_animation, show_renders])
def test_nothing_that_can_be_clicked_lies_half_over_another_or_outside(draw, screens) -> None:
    """A field may lie on a larger surface, such as the canvas."""
    faults = list[str]()
    for name, drawing in draw(screens).items():
        if name == "compare":  # an open menu lies over the panel
            continue
        widgets = [shape for shape in drawing.widgets if shape.kind in CLICKED and shape.points[0] != shape.points[1]]
        boxes = [(*shape.points[0], *shape.points[1], shape.text) for shape in widgets]
        for index, (left, top, right, bottom, text) in enumerate(boxes):
            if left < 20.0 - 1.0 or right > 360.0 + 1.0:
                faults.append(f"{name}: {text} from {left} to {right}")
            for x0, y0, x1, y1, other in boxes[index + 1 :]:
                wide, high = min(right, x1) - max(left, x0), min(bottom, y1) - max(top, y0)
                if min(wide, high) > 1.0 and wide < min(right - left, x1 - x0) - 1.0:
                    faults.append(f"{name}: {text} and {other} have {wide} x {high} in common")
    assert not faults, faults[:5]
