"""Where lines and words lie over scopes, against BT.709, and the name of an object beside the pointer; no window."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from drawn_shapes import DrawnShapes
from halation.editor.theme.palette import PALETTES
from halation.editor.viewer import graticules, mattes
from halation.editor.viewer.geometry import Sight

PALETTE = PALETTES["dark"]
BOX = (100.0, 40.0, 500.0, 240.0)


@pytest.fixture
def make_lines(monkeypatch: pytest.MonkeyPatch):
    def make(scale: float = 1.0, mouse: tuple[float, float] = (0.0, 0.0)) -> Any:
        lines = DrawnShapes(16.0 * scale)
        imgui = SimpleNamespace(
            calc_text_size=lines.measure, get_font_size=lambda: lines.em, get_font=lambda: None,
            get_mouse_pos=lambda: SimpleNamespace(x=mouse[0], y=mouse[1]), get_window_draw_list=lambda: lines,
        )  # fmt: skip
        for module in (graticules, mattes):
            monkeypatch.setattr(module, "imgui", imgui)
            monkeypatch.setattr(module, "ui_scale", lambda: scale)
        return lines

    return make


def list_texts(lines: DrawnShapes) -> dict[str, tuple[float, float]]:
    return {shape.text: shape.points[0] for shape in lines.list_kinds("text")}


@pytest.mark.parametrize(("low", "high"), [(0.0, 1.0), (-0.5, 1.5)])
def test_levels_of_a_waveform_and_of_a_histogram(make_lines, low: float, high: float) -> None:
    lines = make_lines()
    graticules.level_lines(lines, PALETTE, BOX, low, high)
    graticules.range_lines(lines, PALETTE, BOX, low, high)
    levels, ranges = lines.list_kinds("line")[:5], lines.list_kinds("line")[5:]
    for level, across, down in zip((0.0, 0.25, 0.5, 0.75, 1.0), levels, ranges, strict=True):
        part = (level - low) / (high - low)
        assert across.points == ((100.0, 240.0 - 200.0 * part), (500.0, 240.0 - 200.0 * part))
        assert down.points == ((100.0 + 400.0 * part, 40.0), (100.0 + 400.0 * part, 240.0))
        assert across.color == down.color == (levels[0] if level in (0.0, 1.0) else levels[1]).color
    assert levels[0].color >> 24 == 89 and levels[1].color >> 24 == 31  # 0.35 and 0.12 of 255
    texts = list_texts(lines)
    assert [*texts] == ["0", "0.25", "0.5", "0.75", "1"] and {x for x, _ in texts.values()} == {104.0}
    top = 240.0 - 200.0 * (1.0 - low) / (high - low)
    assert texts["1"][1] == round(top + 2.0)  # below its line, the others above theirs
    assert texts["0.5"][1] == round(240.0 - 200.0 * (0.5 - low) / (high - low) - 15.2)


def test_a_low_waveform_names_only_black_and_white(make_lines) -> None:
    lines = make_lines()
    graticules.level_lines(lines, PALETTE, (0.0, 0.0, 400.0, 120.0), 0.0, 1.0)
    assert [*list_texts(lines)] == ["0", "1"]
    lines = make_lines()
    graticules.level_lines(lines, PALETTE, (0.0, 0.0, 400.0, 121.0), 0.0, 1.0)
    assert len(list_texts(lines)) == 5


def test_the_boxes_of_a_vectorscope_are_those_of_75_percent_bars(make_lines) -> None:
    """BT.709: Cb = (B - Y) / 1.8556 and Cr = (R - Y) / 1.5748; 0.5 is the inner border of a margin of 6 percent."""
    lines = make_lines()
    graticules.chroma_lines(lines, PALETTE, (100.0, 40.0, 300.0, 240.0))
    bars = {"R": (1, 0, 0), "Yl": (1, 1, 0), "G": (0, 1, 0), "Cy": (0, 1, 1), "B": (0, 0, 1), "Mg": (1, 0, 1)}
    radius = 100.0 / 1.06
    for (name, bar), shape in zip(bars.items(), lines.list_kinds("rect"), strict=True):
        red, green, blue = 0.75 * np.array(bar)
        luma = 0.2126 * red + 0.7152 * green + 0.0722 * blue
        x = 200.0 + 2.0 * radius * (blue - luma) / 1.8556
        y = 140.0 - 2.0 * radius * (red - luma) / 1.5748
        (left, top), (right, bottom) = shape.points
        assert ((left + right) / 2, (top + bottom) / 2) == pytest.approx((x, y), abs=1e-3)
        assert right - left == pytest.approx(8.0) and bottom - top == pytest.approx(8.0)
        assert list_texts(lines)[name] == pytest.approx((x + 4.0 + 2.0, y - 4.0 - 11.2), abs=0.51)
    assert [shape.lengths[0] for shape in lines.list_kinds("circle")] == pytest.approx([radius / 2.0, radius])
    across, down, skin = lines.list_kinds("line")
    assert across.points == ((100.0, 140.0), (300.0, 140.0)) and down.points == ((200.0, 40.0), (200.0, 240.0))
    way = math.radians(123.0)  # the I axis of NTSC
    assert skin.points[1] == pytest.approx((200.0 + radius * math.cos(way), 140.0 - radius * math.sin(way)))
    assert skin.points[0] == (200.0, 140.0)


def test_a_small_vectorscope_has_no_words(make_lines) -> None:
    for size, count in ((140.0, 0), (141.0, 6)):
        lines = make_lines()
        graticules.chroma_lines(lines, PALETTE, (0.0, 0.0, size, size))
        assert len(list_texts(lines)) == count and len(lines.list_kinds("rect")) == 6


def test_a_hint_is_in_the_upper_right_corner_if_it_fits(make_lines) -> None:
    lines = make_lines()
    graticules.hint(lines, PALETTE, BOX, "4 % clipped")
    ((x, y),) = list_texts(lines).values()
    assert (x, y) == (round(500.0 - 11 * 8.0 * 0.78 - 5.0), 43.0)
    lines = make_lines()
    graticules.hint(lines, PALETTE, (100.0, 40.0, 197.0, 240.0), "4 % clipped")  # 68.6 of 97
    assert not lines.shapes


def draw_name(
    make_lines, monkeypatch, mouse: tuple[float, float], scale: float = 1.0, **facts: Any
) -> tuple[DrawnShapes, Any]:
    lines = make_lines(scale, mouse)
    hit = SimpleNamespace(**{"words": "pillar", "name": "pillar", "on": False, **facts})
    monkeypatch.setattr(mattes, "picks", lambda context: True)
    monkeypatch.setattr(mattes, "find_matte_hit", lambda context, sight, at: hit if at == mouse else None)
    context: Any = SimpleNamespace(viewer=SimpleNamespace(hovered=True), palette=PALETTE, places={})
    origin, panel = (100.0 * scale, 50.0 * scale), (round(800 * scale), round(600 * scale))
    mattes.draw_name(context, Sight(origin, panel, (400, 200), density=2.0))
    return lines, context.places["matte name"]


@pytest.mark.parametrize("mouse", [(150.0, 80.0), (480.0, 80.0), (150.0, 340.0), (495.0, 345.0)])
def test_the_name_of_an_object_stays_in_the_panel_beside_the_pointer(make_lines, monkeypatch, mouse) -> None:
    """The panel is 400x300 on the screen; the name 60x22."""
    lines, box = draw_name(make_lines, monkeypatch, mouse)
    left, top, right, bottom = box
    assert (right - left, bottom - top) == (48 + 12, 16 + 6)
    assert left == min(mouse[0] + 14.0, 500.0 - 48.0 - 18.0)
    assert top == (mouse[1] + 18.0 if mouse[1] < 300.0 else mouse[1] - 28.0)
    assert left >= 100.0 and right <= 500.0 and top >= 50.0 and bottom <= 350.0
    assert {shape.points for shape in lines.list_kinds("rect", "filled rect")} == {((left, top), (right, bottom))}
    assert list_texts(lines)["pillar"] == (left + 6.0, top + 3.0)


@pytest.mark.parametrize("mouse", [(150.0, 80.0), (480.0, 80.0), (150.0, 340.0)])
def test_the_name_of_an_object_grows_with_the_interface(make_lines, monkeypatch, mouse) -> None:
    small, _ = draw_name(make_lines, monkeypatch, mouse)
    large, _ = draw_name(make_lines, monkeypatch, (2.0 * mouse[0], 2.0 * mouse[1]), scale=2.0)
    doubled = [shape.change(2.0, (0.0, 0.0)) for shape in small.shapes]
    assert [(shape.kind, shape.points, shape.color) for shape in large.shapes] == [
        (shape.kind, shape.points, shape.color) for shape in doubled
    ]


def test_a_picked_object_has_an_edge_of_the_accent(make_lines, monkeypatch) -> None:
    colors = {}
    for on in (True, False):
        lines, _ = draw_name(make_lines, monkeypatch, (150.0, 80.0), on=on)
        colors[on] = lines.list_kinds("rect")[0].color
    assert colors[False] == 0x40FFFFFF and colors[True] >> 24 == 230 and colors[True] & 0xFFFFFF != 0xFFFFFF
    named, nameless = (draw_name(make_lines, monkeypatch, (150.0, 80.0), name=name)[0] for name in ("a", ""))
    assert named.list_kinds("text")[0].color == 0xFFFFFFFF != nameless.list_kinds("text")[0].color
