"""What lies under the pointer or beside it: pixels, objects of a cryptomatte, sizes of lights, shapes of scopes."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from halation.editor.fields.color_field import _read_color  # pyright: ignore[reportPrivateUsage]
from halation.editor.viewer import mattes, scopes_panel, toolbar
from halation.editor.viewer.brush import PaintBrush
from halation.editor.viewer.handles import pixel_place
from halation.editor.viewer.light_sizes import LEAST, SizeHandle
from halation.editor.viewer.state import ViewerState
from halation.graph import Port
from halation.nodes import PaintTool


def test_a_pixel_is_picked_in_its_middle() -> None:
    viewer = ViewerState(pixel=(0, 3), picture=(8, 4))
    assert pixel_place(viewer) == (0.0625, 0.875)
    assert pixel_place(ViewerState(pixel=(2, 0), picture=(3, 7))) == (round(2.5 / 3, 5), round(0.5 / 7, 5))


@pytest.mark.parametrize("turn", [0.0, 0.5, 2.0])
def test_a_handle_measures_along_its_own_line(turn: float) -> None:
    """Its end is 50 pixels from the middle and stands for 3: twice as far along the line is 6."""
    across, along = np.array((math.cos(turn), math.sin(turn))), np.array((-math.sin(turn), math.cos(turn)))
    center = np.array((200.0, 100.0))
    lamp: Any = None
    handle = SizeHandle(lamp, "size", tuple(center), tuple(center + 50.0 * across), 3.0)
    for share in (1.0, 2.0, 0.5):
        for beside in (-40.0, 0.0, 15.0):
            at = center + 50.0 * share * across + beside * along
            assert handle.measure(tuple(at)) == pytest.approx(3.0 * share)
    assert handle.measure(tuple(center - 9.0 * across)) == LEAST
    assert SizeHandle(lamp, "size", (5.0, 5.0), (5.0, 5.0), 3.0).measure((9.0, 9.0)) == LEAST


@pytest.mark.parametrize(
    ("size", "count", "columns"),
    [((1600.0, 100.0), 4, 4), ((100.0, 1600.0), 4, 1), ((1600.0, 1000.0), 4, 2), ((1600.0, 1000.0), 1, 1),
     ((1600.0, 500.0), 2, 2), ((800.0, 1000.0), 2, 1), ((1600.0, 666.0), 6, 3)],
)  # fmt: skip
def test_scopes_are_about_as_wide_as_screens(size: tuple[float, float], count: int, columns: int) -> None:
    assert scopes_panel._columns(*size, count) == columns  # pyright: ignore[reportPrivateUsage]


def test_no_other_number_of_columns_makes_scopes_more_like_screens() -> None:
    """A scope that is twice as wide as 16:10 is as bad as one that is twice as high."""
    chance = np.random.default_rng(4)
    for _ in range(300):
        (width, height), count = chance.uniform(50.0, 2000.0, 2), int(chance.integers(1, 9))
        columns = np.arange(1, count + 1)
        shapes = width / columns / (height / np.ceil(count / columns))
        errors = abs(np.log(shapes / 1.6))
        chosen = scopes_panel._columns(width, height, count)  # pyright: ignore[reportPrivateUsage]
        assert errors[chosen - 1] == pytest.approx(errors.min(), abs=1e-9)


def test_the_vectorscope_is_square_in_the_middle() -> None:
    square = scopes_panel._square  # pyright: ignore[reportPrivateUsage]
    assert square((10.0, 20.0, 110.0, 60.0)) == (40.0, 20.0, 80.0, 60.0)
    assert square((10.0, 20.0, 50.0, 120.0)) == (10.0, 50.0, 50.0, 90.0)


@pytest.mark.parametrize("room", range(0, 200, 7))
def test_as_many_tools_are_shown_as_fit(monkeypatch: pytest.MonkeyPatch, room: int) -> None:
    """With the button of the menu where some are left out; never more than fit, never one less than could."""
    monkeypatch.setattr(toolbar, "ui_scale", lambda: 1.0)
    monkeypatch.setattr(toolbar, "width_of_buttons", lambda text: 12.0)
    tools: Any = [
        SimpleNamespace(width=float(width), apart=apart) for width, apart in ((20, 0), (30, 0), (10, 1), (40, 0))
    ]
    gap, apart = toolbar._GAP, toolbar._APART  # pyright: ignore[reportPrivateUsage]
    spaces = [apart if tool.apart else gap for tool in tools]
    count = toolbar._count_tools(tools, float(room))  # pyright: ignore[reportPrivateUsage]
    widths = [sum(tool.width for tool in tools[:some]) + sum(spaces[1:some]) for some in range(5)]
    if widths[4] + spaces[0] <= room:
        assert count == 4
    else:
        assert count == max(some for some in range(5) if some == 0 or widths[some] + 12.0 + gap <= room)


@pytest.mark.parametrize(
    ("text", "color"),
    [
        ("0.1, 0.2, 0.3", (0.1, 0.2, 0.3, 0.5)), ("0.1 0.2 0.3 1", (0.1, 0.2, 0.3, 1.0)),
        ("1,2,3", (1.0, 2.0, 3.0, 0.5)), ("1 2", None), ("1 2 3 4 5", None), ("red", None), ("1 x 3", None),
    ],
)  # fmt: skip
def test_numbers_are_a_color(text: str, color: tuple[float, ...] | None) -> None:
    found = _read_color(text, (0.0, 0.0, 0.0, 0.5))
    assert (found and found.value) == color


def test_hexadecimal_is_a_color_of_the_screen() -> None:
    white, black = _read_color("#ffffff", (0.0, 0.0, 0.0, 0.5)), _read_color("000000", (1.0, 1.0, 1.0, 0.25))
    assert white is not None and white.value == pytest.approx((1.0, 1.0, 1.0, 0.5))
    assert black is not None and black.value == pytest.approx((0.0, 0.0, 0.0, 0.25))


def test_a_stroke_says_what_is_not_its_default() -> None:
    plain = PaintBrush().describe_stroke((0.5, 0.5), 5, 9)
    assert not {"lifetime", "first", "last", "offset", "source"} & {*plain}
    brush = PaintBrush(
        size=0.123456789, hardness=0.12345, opacity=0.98765, color=(0.1234567891, 0.5, 0.25), range="here"
    )
    fields = brush.describe_stroke((0.5, 0.5), 5, 9)
    assert (fields["size"], fields["hardness"], fields["opacity"]) == (0.12346, 0.123, 0.988)
    assert fields["color"] == (0.123457, 0.5, 0.25)
    assert (fields["lifetime"], fields["first"], fields["last"]) == ("range", 5, 5)
    brush.range = "onward"
    onward = brush.describe_stroke((0.5, 0.5), 5, 9)
    assert (onward["first"], onward["last"]) == (5, 9)


def test_a_clone_keeps_its_distance() -> None:
    brush = PaintBrush(tool=PaintTool.CLONE)
    brush.copy_from((0.75, 0.25))
    assert brush.describe_stroke((0.5, 0.5), 1, 1)["offset"] == (0.25, -0.25) and brush.copied is None
    assert brush.describe_stroke((0.1, 0.9), 1, 1)["offset"] == (0.25, -0.25)
    other = PaintBrush(tool=PaintTool.BRUSH, copied=(0.75, 0.25))
    assert "offset" not in other.describe_stroke((0.5, 0.5), 1, 1) and other.copied == (0.75, 0.25)


@pytest.mark.parametrize(
    ("name", "on", "words"), [("", False, "id 0000002a: the file has no name for it"), ("car", False, "car")]
)
def test_an_object_has_a_name_or_its_id(name: str, on: bool, words: str) -> None:
    matte: Any = None
    assert mattes.MatteHit(Port("a", "b"), matte, 42, name, on).words == words
    assert mattes.MatteHit(Port("a", "b"), matte, 42, "car", True).words.endswith("  car")
