"""Panels and dialogs draw their shapes, colors and words where they drew them when the layout guide was made.

The guide is made from the editor, so it proves nothing: it notices that something has changed, which nobody may have
wanted. Look at the screen, and make it anew if the change is right:

HALATION_RENEW=1 python -m pytest -n 0 tests/editor/panels/test_layout_guide.py
"""

from __future__ import annotations

import os
import platform
import re
import sys
import zlib
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from drawn_shapes import Shape
from still_editor import StillEditor
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
    Screens,
    show_animation,
    show_dialogs,
    show_more_dialogs,
    show_panels,
    show_renders,
    show_typical_nodes,
    show_values,
)
from still_window import WIDGETS, Drawing

GUIDE = Path(__file__).parents[2] / "data/layout_guide.npz"
"""The screens, and of each the kinds of its shapes, their colors, what they say, and points and lengths in tenths."""

TENTHS = 10.0
"""Numbers for a pixel."""

SLACK = 6
"""Tenths of a pixel that a shape may lie elsewhere: places are rounded to whole pixels, up or down."""

SHADES = 3
"""Steps of 255 that a color may differ: some fade in while a screen is drawn."""

BROWSES = "###choose file"
"""The button of screens that browse files: they list the folders of the machine, and are left out."""

RENEW = bool(os.environ.get("HALATION_RENEW"))

SCREENS: tuple[Callable[[StillEditor], Screens], ...] = (
    show_typical_nodes, show_values, show_panels, show_animation, show_renders, show_handles, show_viewer, show_files,
    show_passes, show_lessons, show_search, show_status, show_opened_fields, show_opened_panels, show_dialogs,
    show_more_dialogs, show_gestures, show_lamps, show_flipbooks, show_wide_panels,
)  # fmt: skip

Place = tuple[str, int, int, list[int]]
"""The kind of a shape, its color, a sum of what it says, and its numbers."""


def measure(shape: Shape) -> Place:
    """Where a shape is, and what it is like."""
    numbers = np.array([*(part for point in shape.points for part in point), *shape.lengths])
    rounded = np.round(np.clip(numbers, -3e3, 3e3) * TENTHS).astype(int).tolist()
    is_said = shape.kind == "text" or shape.kind in WIDGETS
    return shape.kind, shape.color, sum_words(shape.text) if is_said else zlib.crc32(shape.text.encode()), rounded


def sum_words(text: str) -> int:
    """A sum of the letters of a text without its id: numbers may be dates, times and sizes of the machine."""
    words = text.partition("##")[0].replace(platform.platform(), "")
    return zlib.crc32(re.sub(r"[\d.,]+", "", words).encode())


def is_same(one: Place, other: Place) -> bool:
    """Whether two places are those of one shape."""
    colors = zip(one[1].to_bytes(4, "little"), other[1].to_bytes(4, "little"), strict=True)
    return (
        (one[0], one[2], len(one[3])) == (other[0], other[2], len(other[3]))
        and all(abs(a - b) <= SHADES for a, b in colors)
        and all(abs(a - b) <= SLACK for a, b in zip(one[3], other[3], strict=True))
    )


def compare(old: list[Place], shapes: list[Shape]) -> str:
    """The first shape that is not what it was; "" if all are."""
    for number, (place, shape) in enumerate(zip(old, shapes, strict=False)):
        if not is_same(place, measure(shape)):
            return f"shape {number} was a {place[0]} of color {place[1]:08x} at {place[3]} tenths, and is {shape}"
    return "" if len(old) == len(shapes) else f"{len(old)} shapes have become {len(shapes)}"


@cache
def read_guide() -> dict[str, list[Place]]:
    """The places of the shapes of every screen."""
    with np.load(GUIDE) as stored:
        kinds = stored["kind_names"][stored["kinds"]].tolist()
        rows = [row.tolist() for row in np.split(stored["numbers"], np.cumsum(stored["lengths"])[:-1])]
        places = [*zip(kinds, stored["colors"].tolist(), stored["words"].tolist(), rows, strict=True)]
        ends = np.cumsum(stored["counts"]).tolist()
        spans = zip(stored["screens"].tolist(), [0, *ends], ends, strict=False)
        return {name: places[start:end] for name, start, end in spans}


def write_guide(screens: Mapping[str, list[Place]]) -> None:
    """Keep the places of the shapes of every screen."""
    kinds, colors, words, rows = zip(*(place for places in screens.values() for place in places), strict=True)
    kind_names = sorted({*kinds})
    np.savez_compressed(
        GUIDE,
        screens=np.array([*screens]),
        counts=np.array([len(places) for places in screens.values()], np.int32),
        kind_names=np.array(kind_names),
        kinds=np.array([kind_names.index(kind) for kind in kinds], np.uint8),
        colors=np.array(colors, np.uint32),
        words=np.array(words, np.uint32),
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
    faults = {name: compare(read_guide()[name], shapes) for name, shapes in drawings.items()}
    assert not {name: fault for name, fault in faults.items() if fault}


@pytest.mark.skipif(sys.platform != "linux", reason="the guide was made on Linux")
def test_the_guide_has_all_screens(draw) -> None:
    drawings = {name: shapes for screens in SCREENS for name, shapes in name_drawings(draw(screens), screens).items()}
    if RENEW:
        write_guide({name: [*map(measure, shapes)] for name, shapes in drawings.items()})
    assert {*drawings} == {*read_guide()}
