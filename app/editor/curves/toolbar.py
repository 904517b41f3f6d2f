"""The row of tools, the context menu, and the legend."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui
from msgspec import Struct

from ...authoring.commands import SetKey
from ...authoring.edits.naming import value_label
from ...graph import Interpolation
from ...language.translation import mark, translate
from ..theme.style import u32, ui_scale, vec4
from ..toolkit.buttons import dropdown, entry, quiet_button, tip_of, tool, width_of_buttons
from ..toolkit.keys import display_shortcut
from ..toolkit.labels import make_label
from . import commands
from .paint import paint_key
from .state import Mode

if TYPE_CHECKING:
    from .context import CurvesContext

LOOKS: tuple[Interpolation, ...] = ("constant", "linear", "smooth", "bezier")
_GAP, _GROUP_GAP = 2.0, 10.0
_MEANING = {
    "constant": mark("holds the value until the next key"),
    "linear": mark("changes linearly to the next key"),
    "smooth": mark("changes smoothly, without overshooting"),
    "bezier": mark("follows the handles"),
}
_MOUSE = (
    (mark("Drag keys"), mark("move them; Shift: between frames")),
    (mark("Alt + drag, ends of the bar"), mark("scale the keys in time")),
    (mark("Drag on empty space"), mark("select with a box; Shift adds, Ctrl toggles")),
    (mark("Double click"), mark("add a key on the curve")),
    (mark("Wheel"), mark("zoom; in curves, Ctrl: time only, Shift: values only")),
    (mark("Middle drag"), mark("pan")),
    (mark("Curves: Ctrl, Shift + drag"), mark("values only, time only")),
    (mark("Alt + drag a handle"), mark("turn only this handle; Shift keeps it horizontal")),
)


class _CurveTool(Struct, frozen=True):
    width: float
    draw: Callable[[], object]
    starts_group: bool = False


def draw_toolbar(context: CurvesContext, room: float) -> None:
    """Draw the tools in one row; tools that do not fit are in the menu behind the dots."""
    scale = ui_scale()
    tools = _make_tools(context)
    more = width_of_buttons(icons.ICON_FA_ELLIPSIS) + _GROUP_GAP * scale
    first = True
    for place, curve_tool in enumerate(tools):
        gap = 0.0 if first else (_GROUP_GAP if curve_tool.starts_group else _GAP) * scale
        needed = gap + curve_tool.width + (more if place + 1 < len(tools) else 0.0)
        if needed > room:
            imgui.same_line(0.0, _GROUP_GAP * scale)
            dropdown(
                context,
                icons.ICON_FA_ELLIPSIS,
                "button more keys",
                translate("More tools"),
                lambda: draw_keys_menu(context),
            )
            return
        if not first:
            imgui.same_line(0.0, gap)
        first = False
        room -= gap + curve_tool.width
        curve_tool.draw()


def _make_tools(context: CurvesContext) -> list[_CurveTool]:
    return [*_make_view_tools(context), *_make_key_tools(context), *_make_panel_tools(context)]


def _make_view_tools(context: CurvesContext) -> list[_CurveTool]:
    """The modes, the filter of rows, and the menu that animates another value."""
    state, square = context.curves, imgui.get_frame_height()

    def make_mode_tool(mode: Mode, icon: str, label: str) -> _CurveTool:
        def draw() -> None:
            keys = display_shortcut(context.actions.shortcut("keys.mode"))
            if quiet_button(context, icon, f"button keys {mode}", f"{label} ({keys})", lit=state.mode == mode):
                state.mode = mode

        return _CurveTool(square, draw)

    rows = translate("Selected nodes") if state.only_selected else translate("All values")
    width = max(
        map(
            width_of_buttons,
            (
                f"{icons.ICON_FA_FILTER}  {translate('Selected nodes')}",
                f"{icons.ICON_FA_FILTER}  {translate('All values')}",
            ),
        )
    )
    return [
        make_mode_tool("sheet", icons.ICON_FA_BARS_STAGGERED, translate("Dope sheet")),
        make_mode_tool("curves", icons.ICON_FA_BEZIER_CURVE, translate("Curves")),
        _CurveTool(
            width,
            lambda: dropdown(
                context,
                f"{icons.ICON_FA_FILTER}  {rows}",
                "button keys filter",
                translate("Which values are listed"),
                lambda: _draw_filters(context),
                lit=state.only_selected,
                width=width,
            ),
            True,
        ),
        _CurveTool(
            square,
            lambda: dropdown(
                context,
                icons.ICON_FA_PLUS,
                "button keys add",
                translate("Animate a value of the selected nodes"),
                lambda: draw_animatable(context),
            ),
        ),
    ]


def _make_key_tools(context: CurvesContext) -> list[_CurveTool]:
    """The shape, the easing and the handles of keys."""
    has_keys, square = commands.has_chosen_keys(context), imgui.get_frame_height()

    def make_menu_tool(icon: str, name: str, doc: str, actions: str, starts_group: bool = False) -> _CurveTool:
        return _CurveTool(
            width_of_buttons(icon),
            lambda: dropdown(context, icon, f"button keys {name}", doc, lambda: draw_entries(context, actions)),
            starts_group,
        )

    tools = [
        _CurveTool(square, lambda look=look: _draw_shape_button(context, look, has_keys), look == "constant")
        for look in LOOKS
    ]
    tools += [
        _CurveTool(square, lambda how=how: _draw_ease_button(context, how), how == "keys.ease_in")
        for how in ("keys.ease_in", "keys.ease", "keys.ease_out")
    ]
    tools += [
        make_menu_tool(
            f"{translate('Handles')}  {icons.ICON_FA_CARET_DOWN}",
            "handles",
            translate("The handles of the selected keys"),
            "keys handles",
            starts_group=True,
        ),
        make_menu_tool(
            f"{translate('Outside')}  {icons.ICON_FA_CARET_DOWN}",
            "outside",
            translate("Before the first and after the last key"),
            "keys outside",
        ),
    ]
    return tools


def _make_panel_tools(context: CurvesContext) -> list[_CurveTool]:
    """Snapping, fitting the view, and the legend."""
    square = imgui.get_frame_height()
    return [
        _CurveTool(square, lambda: tool(context, icons.ICON_FA_MAGNET, "keys.snap"), True),
        _CurveTool(square, lambda: tool(context, icons.ICON_FA_EXPAND, "keys.fit_all")),
        _CurveTool(
            square,
            lambda: dropdown(
                context,
                icons.ICON_FA_CIRCLE_QUESTION,
                "button keys legend",
                translate("Key shapes and mouse controls"),
                lambda: draw_legend(context),
            ),
        ),
    ]


def _draw_shape_button(context: CurvesContext, look: Interpolation, has_keys: bool) -> None:
    action = context.actions[f"keys.{look}"]
    if quiet_button(context, " ", f"button keys.{look}", tip_of(context, action), enabled=has_keys):
        context.actions.run(action.id)
    left, top, right, bottom = context.places[f"button keys.{look}"]
    ink = u32(context.palette.text, 1.0 if has_keys else 0.4)
    paint_key(imgui.get_window_draw_list(), (left + right) / 2, (top + bottom) / 2, 5.5 * ui_scale(), look, ink)


def _draw_ease_button(context: CurvesContext, id: str) -> None:
    """A button with a small curve on it."""
    action = context.actions[id]
    enabled = context.actions.is_enabled(action)
    if quiet_button(context, " ", f"button {id}", tip_of(context, action), enabled=enabled):
        context.actions.run(id)
    left, top, right, bottom = context.places[f"button {id}"]
    pad = (right - left) * 0.26
    curve = {
        "keys.ease_in": lambda t: math.sin(t * math.pi / 2),
        "keys.ease_out": lambda t: 1 - math.cos(t * math.pi / 2),
        "keys.ease": lambda t: (1 - math.cos(t * math.pi)) / 2,
    }[id]
    line: list[imgui.ImVec2Like] = [
        imgui.ImVec2(left + pad + (right - left - 2 * pad) * t, bottom - pad - (bottom - top - 2 * pad) * curve(t))
        for t in (place / 12 for place in range(13))
    ]
    ink = u32(context.palette.text, 1.0 if enabled else 0.4)
    imgui.get_window_draw_list().add_polyline(line, ink, 1.8 * ui_scale(), 0)


def _draw_filters(context: CurvesContext) -> None:
    for label, only in ((translate("All Values"), False), (translate("Selected Nodes"), True)):
        if imgui.menu_item(make_label(label, str(only)), "", context.curves.only_selected == only)[0]:
            context.curves.only_selected = only


def draw_entries(context: CurvesContext, menu: str) -> None:
    """Draw the actions of a context as entries of the open menu."""
    for action in context.actions.in_menu(menu):
        entry(context, action)


def draw_animatable(context: CurvesContext) -> None:
    """Draw the list of values of the selected nodes that can be animated."""
    ports = commands.list_animatable(context)
    if not ports:
        imgui.text_colored(vec4(context.palette.dim), translate("Select a node with values that can be animated"))
    node = ""
    for port in ports:
        if port.node != node:
            node = port.node
            imgui.separator_text(node)
        if imgui.menu_item(make_label(value_label(context.session.graph, port), str(port)), "", False)[0]:
            context.log.attempt(lambda port=port: context.session.apply(SetKey(port)))


def draw_keys_menu(context: CurvesContext) -> None:
    """Draw the menu of the selected keys."""
    for label, menu in (
        (translate("Interpolation"), "keys interpolation"),
        (translate("Ease"), "keys ease"),
        (translate("Handles"), "keys handles"),
        (translate("Outside of Keys"), "keys outside"),
    ):
        if imgui.begin_menu(make_label(label, menu)):
            draw_entries(context, menu)
            imgui.end_menu()
    imgui.separator()
    draw_entries(context, "keys")
    imgui.separator()
    for id in ("keys.here", "keys.all", "keys.fit_all", "keys.fit_chosen", "keys.snap"):
        entry(context, context.actions[id])


def draw_legend(context: CurvesContext) -> None:
    """Draw the legend: the shapes of keys, and the mouse."""
    scale, line = ui_scale(), imgui.get_text_line_height()
    for look in LOOKS:
        corner = imgui.get_cursor_screen_pos()
        paint_key(
            imgui.get_window_draw_list(),
            corner.x + 8 * scale,
            corner.y + line / 2,
            5.0 * scale,
            look,
            u32(context.palette.text),
        )
        imgui.dummy((18 * scale, line))
        imgui.same_line()
        imgui.text(translate(look.title()))
        imgui.same_line(100 * scale)
        imgui.text_colored(vec4(context.palette.dim), translate(_MEANING[look]))
    imgui.separator()
    column = max(imgui.calc_text_size(translate(keys)).x for keys, _ in _MOUSE) + 24 * scale
    for keys, act in _MOUSE:
        imgui.text(translate(keys))
        imgui.same_line(column)
        imgui.text_colored(vec4(context.palette.dim), translate(act))


__all__ = ["draw_animatable", "draw_entries", "draw_keys_menu", "draw_legend", "draw_toolbar"]
