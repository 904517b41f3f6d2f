"""The row of the brush above the picture: its tool, size, hardness, opacity, color, blend and frames."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

from halation.nodes import PAINT_STROKES, PaintTool
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...language.translation import mark, translate
from ..fields.colors import from_display, swatch
from ..fields.item_facts import icon_of
from ..shared.declared_words import name_choice, raise_first
from ..theme.style import ui_scale
from ..toolkit.buttons import dropdown, quiet_button, tool
from ..toolkit.fields import number
from ..toolkit.labels import make_label, translate_label
from ..toolkit.places import record
from ..toolkit.words import tip
from .brush import MOST_SIZE, BrushRange
from .painting import can_paint

if TYPE_CHECKING:
    from .context import ViewerContext

_RANGES: Mapping[BrushRange, str] = MappingProxyType(
    {"all": mark("All frames"), "here": mark("This frame"), "onward": mark("From here on")}
)


def draw_brush_bar(context: ViewerContext) -> None:
    """Draw the row, if the active node can be painted on."""
    if not can_paint(context):
        return
    brush, font, gap = context.viewer.brush, imgui.get_font_size(), 2.0 * ui_scale()
    imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + 2.0 * gap)
    tool(context, icons.ICON_FA_PEN, "viewer.paint")
    imgui.same_line(0.0, 5.0 * gap)
    for kind in PaintTool:
        doc = f"{raise_first(name_choice(kind.value))}\n{translate(PAINT_STROKES.by_name[kind].doc)}"
        if quiet_button(context, icon_of(kind), f"brush {kind.value}", doc, lit=brush.is_on and brush.tool is kind):
            brush.tool, brush.is_on = kind, True
        imgui.same_line(0.0, gap)
    doc = translate("Size of the brush, as a fraction of the height. Drag with Shift on the picture")
    brush.resize(
        number(context, "brush size", brush.size, "%.3f", font * 4.0, doc, speed=0.001, low=0.001, high=MOST_SIZE)
    )
    imgui.same_line(0.0, gap)
    doc = translate("Hardness: the part of the brush that covers fully")
    brush.hardness = _fraction(context, "brush hardness", brush.hardness, doc)
    imgui.same_line(0.0, gap)
    brush.opacity = _fraction(context, "brush opacity", brush.opacity, translate("Opacity of the stroke"))
    imgui.same_line(0.0, 5.0 * gap)
    if brush.tool is PaintTool.BRUSH:
        _draw_color(context)
        imgui.same_line(0.0, gap)
        dropdown(
            context,
            _name_blend(brush.blend),
            "brush blend",
            translate("How the color is combined"),
            lambda: _list_blends(context),
        )
        imgui.same_line(0.0, 5.0 * gap)
    if brush.tool in (PaintTool.CLONE, PaintTool.REVEAL):
        label, doc = raise_first(name_choice(brush.source)), translate("What is copied")
        dropdown(context, label, "brush source", doc, lambda: _list_sources(context))
        imgui.same_line(0.0, 5.0 * gap)
    words, doc = translate(_RANGES[brush.range]), translate("The frames of new strokes")
    dropdown(context, words, "brush range", doc, lambda: _list_ranges(context))


def _fraction(context: ViewerContext, name: str, value: float, doc: str) -> float:
    part = number(context, name, value, "%.2f", imgui.get_font_size() * 3.2, doc, speed=0.005, low=0.0, high=1.0)
    return min(max(part, 0.0), 1.0)


def _draw_color(context: ViewerContext) -> None:
    """The color as it looks; its picker works on display numbers, as screens show them."""
    brush = context.viewer.brush
    flags = imgui.ColorEditFlags_.no_inputs | imgui.ColorEditFlags_.no_label
    edited, shown = imgui.color_edit3("##brush color", [*swatch(brush.color)], int(flags))
    if edited:
        brush.color = from_display((shown[0], shown[1], shown[2]), 0.0, 1.0)[:3]
    record(context, "brush color")
    tip(translate("Color of the brush"))


def _name_blend(blend: str) -> str:
    return raise_first(name_choice(blend))


def _list_blends(context: ViewerContext) -> None:
    brush = context.viewer.brush
    for blend in PAINT_STROKES.by_name["brush"].fields["blend"].choices:
        if imgui.menu_item(make_label(_name_blend(blend), blend), "", brush.blend == blend)[0]:
            brush.blend = blend


def _list_sources(context: ViewerContext) -> None:
    brush = context.viewer.brush
    for source in PAINT_STROKES.by_name[brush.tool].fields["source"].choices:
        if imgui.menu_item(make_label(raise_first(name_choice(source)), source), "", source == brush.source)[0]:
            brush.sources[brush.tool] = source
        record(context, f"brush source {source}")


def _list_ranges(context: ViewerContext) -> None:
    brush = context.viewer.brush
    for name, label in _RANGES.items():
        if imgui.menu_item(translate_label(label), "", brush.range == name)[0]:
            brush.range = name
        record(context, f"brush range {name}")
