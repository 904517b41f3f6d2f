"""Panels and dialogs draw their shapes where they drew them when the layout guide was made.

The guide is made from the editor, so it proves nothing: it notices that something has moved, which nobody may have
wanted. Look at the screen, and make it anew if the change is right:

HALATION_RENEW=1 python -m pytest -n 0 tests/editor/panels/test_layout_guide.py
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from drawn_shapes import Shape
from still_editor import StillEditor
from still_pictures import (
    show_files,
    show_handles,
    show_lessons,
    show_opened_fields,
    show_opened_panels,
    show_passes,
    show_search,
    show_viewer,
)
from still_screens import (
    Screens,
    show_animation,
    show_dialogs,
    show_more_dialogs,
    show_panels,
    show_renders,
    show_typical_nodes,
    show_values,
)
from still_window import Drawing

GUIDE = Path(__file__).parents[2] / "data/layout_guide.npz"
"""The screens, and of each the kinds of its shapes, and their numbers: points and lengths in tenths of a pixel."""

TENTHS = 10.0
"""Numbers for a pixel."""

SLACK = 6
"""Tenths of a pixel that a shape may lie elsewhere: places are rounded to whole pixels, up or down."""

BROWSES = "###choose file"
"""The button of screens that browse files: they list the folders of the machine, and are left out."""

RENEW = bool(os.environ.get("HALATION_RENEW"))

SCREENS: tuple[Callable[[StillEditor], Screens], ...] = (
    show_typical_nodes, show_values, show_panels, show_animation, show_renders, show_handles, show_viewer, show_files,
    show_passes, show_lessons, show_search, show_opened_fields, show_opened_panels, show_dialogs, show_more_dialogs,
)  # fmt: skip

Places = tuple[list[str], list[list[int]]]
"""The kind and the numbers of each shape."""


def measure(shapes: list[Shape]) -> Places:
    """Where the shapes of a screen are."""
    numbers = [[*(part for point in shape.points for part in point), *shape.lengths] for shape in shapes]
    rounded = [np.round(np.clip(row, -3e3, 3e3) * TENTHS).astype(int).tolist() for row in map(np.array, numbers)]
    return [shape.kind for shape in shapes], rounded


def compare(old: Places, new: Places, shapes: list[Shape]) -> str:
    """The first shape that is not where it was; "" if all are."""
    for place, (kind, row) in enumerate(zip(*old, strict=True)):
        if place == len(shapes):
            return f"a {kind} at {row} tenths is not drawn"
        other_kind, other_row = new[0][place], new[1][place]
        is_same = kind == other_kind and len(row) == len(other_row)
        if not is_same or any(abs(a - b) > SLACK for a, b in zip(row, other_row, strict=True)):
            return f"shape {place} was a {kind} at {row} tenths, and is {shapes[place]}"
    return f"{shapes[len(old[0])]} is new" if len(shapes) > len(old[0]) else ""


@cache
def read_guide() -> dict[str, Places]:
    """The places of the shapes of every screen."""
    with np.load(GUIDE) as stored:
        kinds = stored["kind_names"][stored["kinds"]].tolist()
        rows = [row.tolist() for row in np.split(stored["numbers"], np.cumsum(stored["lengths"])[:-1])]
        ends = np.cumsum(stored["counts"]).tolist()
        spans = zip(stored["screens"].tolist(), [0, *ends], ends, strict=False)
        return {name: (kinds[start:end], rows[start:end]) for name, start, end in spans}


def write_guide(screens: Mapping[str, Places]) -> None:
    """Keep the places of the shapes of every screen."""
    kinds = [kind for names, _ in screens.values() for kind in names]
    rows = [row for _, numbers in screens.values() for row in numbers]
    kind_names = sorted({*kinds})
    np.savez_compressed(
        GUIDE,
        screens=np.array([*screens]),
        counts=np.array([len(names) for names, _ in screens.values()], np.int32),
        kind_names=np.array(kind_names),
        kinds=np.array([kind_names.index(kind) for kind in kinds], np.uint8),
        lengths=np.array([*map(len, rows)], np.uint8),
        numbers=np.array([number for row in rows for number in row], np.int16),
    )


def name_drawings(drawings: Mapping[str, Drawing], screens: Callable[[StillEditor], Screens]) -> dict[str, list[Shape]]:
    """The shapes of each screen that is in the guide, by its name there."""
    named = {f"{screens.__name__.removeprefix('show_')} {name}": drawing.all for name, drawing in drawings.items()}
    return {name: shapes for name, shapes in named.items() if not any(BROWSES in shape.text for shape in shapes)}


@pytest.mark.skipif(RENEW, reason="makes the guide")
@pytest.mark.skipif(sys.platform != "linux", reason="the guide was made on Linux")
@pytest.mark.parametrize("screens", SCREENS)
def test_everything_is_where_it_was(draw, screens) -> None:
    drawings = name_drawings(draw(screens), screens)
    faults = {name: compare(read_guide()[name], measure(shapes), shapes) for name, shapes in drawings.items()}
    assert not {name: fault for name, fault in faults.items() if fault}


@pytest.mark.skipif(sys.platform != "linux", reason="the guide was made on Linux")
def test_the_guide_has_all_screens(draw) -> None:
    drawings = {name: shapes for screens in SCREENS for name, shapes in name_drawings(draw(screens), screens).items()}
    if RENEW:
        write_guide({name: measure(shapes) for name, shapes in drawings.items()})
    assert {*drawings} == {*read_guide()}
