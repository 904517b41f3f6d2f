"""The toolbar of the viewer; tools that do not fit are in a menu at its end."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui
from msgspec import Struct

from ...color.display import NO_LOOK, NO_VIEW, VIDEO_VIEW, list_displays, list_looks, list_views
from ...language.translation import mark, translate
from ..shared.coloring import find_color_manager
from ..theme.style import ui_scale
from ..toolkit.buttons import dropdown, entries, entry, tool, width_of_buttons
from ..toolkit.fields import number
from ..toolkit.labels import make_label, translate_label
from .focus import find_focus_port
from .picking import list_ports, pick_port
from .state import MEANINGS
from .wanted import A, B, has_overscan

if TYPE_CHECKING:
    from .context import ViewerContext

_SHORT: Mapping[str, str] = MappingProxyType(
    {
        "color": "RGB",
        "red": "R",
        "green": "G",
        "blue": "B",
        "alpha": "A",
        "luminance": mark("Lum"),
        "false color": mark("False"),
    }
)
_GAP, _APART = 2.0, 10.0
"""Between tools, and between groups of them."""

Draw = Callable[[], object]


class _ViewerTool(Struct, frozen=True):
    """How wide a tool is in the row, how it is drawn there, and how in the menu of what does not fit."""

    width: float
    draw: Draw
    draw_entry: Draw
    apart: bool = False
    """True begins a group."""


def draw_toolbar(context: ViewerContext, asked_view: str, is_data: bool) -> None:
    """Draw the tools in one row."""
    room = imgui.internal.get_current_window().inner_rect.max.x - imgui.get_cursor_screen_pos().x
    tools = _tools(context, asked_view, is_data)
    count = _count_tools(tools, room)
    for index, viewer_tool in enumerate(tools[:count]):
        if index:
            imgui.same_line(0.0, _space(viewer_tool))
        viewer_tool.draw()
    if count < len(tools):
        if count:
            imgui.same_line(0.0, _GAP * ui_scale())

        def rest() -> None:
            for viewer_tool in tools[count:]:
                viewer_tool.draw_entry()

        dropdown(context, icons.ICON_FA_ELLIPSIS, "button more tools", translate("More tools"), rest)


def _space(viewer_tool: _ViewerTool) -> float:
    return (_APART if viewer_tool.apart else _GAP) * ui_scale()


def _count_tools(tools: list[_ViewerTool], room: float) -> int:
    """How many tools fit, with the button of the menu for the others."""
    if sum(viewer_tool.width + _space(viewer_tool) for viewer_tool in tools) <= room:
        return len(tools)
    room -= width_of_buttons(icons.ICON_FA_ELLIPSIS) + _GAP * ui_scale()
    count = 0
    while count < len(tools) and room >= tools[count].width:
        room -= tools[count].width + _space(tools[min(count + 1, len(tools) - 1)])
        count += 1
    return count


def _tools(context: ViewerContext, asked_view: str, is_data: bool) -> list[_ViewerTool]:
    viewer = context.viewer
    tools = [
        _port(context, A),
        _menu(context, icons.ICON_FA_CLONE, "compare", translate("Compare A with B"), lit=viewer.compares),
    ]
    if viewer.compares:
        tools.append(_port(context, B))
    if is_data:
        tools += _range(context)
    if viewer.scene:
        tools.append(_action(context, icons.ICON_FA_CAMERA_ROTATE, "viewer.orbit"))
    if find_focus_port(context.session):
        tools.append(_action(context, icons.ICON_FA_CROSSHAIRS, "viewer.pick_focus"))
    lit, widest = viewer.channels != "color", max(width_of_buttons(translate(short)) for short in _SHORT.values())
    tools.append(
        _menu(
            context,
            translate(_SHORT[viewer.channels]),
            "channels",
            translate("Channels"),
            lit=lit,
            apart=True,
            width=widest,
        )
    )
    if not is_data or viewer.meaning == "image":  # other data is shown as it is
        tools += _brightness(context)
    tools += [
        _menu(
            context,
            f"1/{1 / viewer.proxy:.0f}",
            "proxy",
            translate("Proxy: compute at a lower resolution"),
            lit=viewer.proxy != 1.0,
            apart=True,
            more=lambda: _proxy_while_dragging(context),
        ),
        _action(context, icons.ICON_FA_PLAY if viewer.paused else icons.ICON_FA_PAUSE, "viewer.pause"),
        *_list_framing_tools(context),
        *_inspection(context),
    ]
    if not is_data or viewer.meaning == "image":
        tools.append(_view(context, asked_view))
    return tools


def _list_framing_tools(context: ViewerContext) -> list[_ViewerTool]:
    """Which part of the picture is shown, and how large."""
    tools = [
        _action(context, icons.ICON_FA_EXPAND, "viewer.fit", apart=True),
        _action(context, "1:1", "viewer.actual"),
    ]
    if context.viewer.pixel_aspect != 1.0:
        tools.append(_action(context, icons.ICON_FA_ARROWS_LEFT_RIGHT, "viewer.unsqueeze"))
    if has_overscan(context):
        tools.append(_action(context, icons.ICON_FA_OBJECT_UNGROUP, "viewer.overscan"))
    return tools


def _inspection(context: ViewerContext) -> list[_ViewerTool]:
    """What shows and keeps more of the picture than its colors."""
    viewer = context.viewer
    return [
        _menu(
            context,
            icons.ICON_FA_TRIANGLE_EXCLAMATION,
            "warnings",
            translate("Warnings"),
            lit=viewer.warn_clipping,
            apart=True,
        ),
        _action(context, icons.ICON_FA_CROP_SIMPLE, "viewer.region"),
        _action(context, icons.ICON_FA_TABLE_LIST, "viewer.table"),
        _action(context, icons.ICON_FA_FLOPPY_DISK, "viewer.save"),
        _menu(
            context,
            icons.ICON_FA_CHESS_BOARD,
            "background",
            translate("Background of transparent pixels"),
            lit=viewer.background != "checker",
        ),
    ]


def _action(context: ViewerContext, icon: str, id: str, apart: bool = False) -> _ViewerTool:
    glyph = icon if len(icon) == 1 else ""
    return _ViewerTool(
        width_of_buttons(icon),
        lambda: tool(context, icon, id),
        lambda: entry(context, context.actions[id], glyph),
        apart,
    )


def _dropdown(
    context: ViewerContext,
    label: str,
    name: str,
    doc: str,
    fill: Draw,
    lit: bool,
    apart: bool = False,
    width: float = 0.0,
) -> _ViewerTool:
    def draw_entry() -> None:
        if imgui.begin_menu(make_label(doc, name)):
            fill()
            imgui.end_menu()

    def draw() -> None:
        dropdown(context, label, f"button {name}", doc, fill, lit=lit, width=width)

    return _ViewerTool(width or width_of_buttons(label), draw, draw_entry, apart)


def _menu(
    context: ViewerContext,
    label: str,
    name: str,
    doc: str,
    *,
    lit: bool,
    apart: bool = False,
    more: Draw | None = None,
    width: float = 0.0,
) -> _ViewerTool:
    """A menu of the menu bar."""

    def fill() -> None:
        entries(context, f"Viewer/{name.title()}")
        if more:
            imgui.separator()
            more()

    return _dropdown(context, label, name, doc, fill, lit, apart, width)


def _port(context: ViewerContext, side: str) -> _ViewerTool:
    port = context.session.views.find_port("A" if side == A else "B")
    name = str(port) if port else translate("nothing")
    label = f"{side}  {name if len(name) <= 22 else f'{name[:21]}…'}"

    def draw_entry() -> None:
        if imgui.begin_menu(make_label(translate("{side} shows", side=side), f"{side}")):
            list_ports(context, side)
            imgui.end_menu()

    return _ViewerTool(width_of_buttons(label), lambda: pick_port(context, side, label), draw_entry)


def _number(width: float, draw: Callable[[float], object], apart: bool = False) -> _ViewerTool:
    return _ViewerTool(width, lambda: draw(width), lambda: draw(imgui.get_font_size() * 9), apart)


def _brightness(context: ViewerContext) -> list[_ViewerTool]:
    viewer, font = context.viewer, imgui.get_font_size()
    doc = translate("Exposure in the viewer, in stops: drag, or click and type; right click for 0")
    if viewer.compare == "difference":
        doc = translate("Gain of the difference in the viewer, in stops: drag, or click and type; right click for 0")

    def exposure(width: float) -> None:
        viewer.exposure = number(
            context,
            "viewer exposure",
            viewer.exposure,
            "%+.2f EV",
            width,
            doc,
            neutral=0.0,
            speed=0.02,
            low=-20.0,
            high=20.0,
        )

    def gamma(width: float) -> None:
        viewer.gamma = number(
            context,
            "viewer gamma",
            viewer.gamma,
            "\u03b3 %.2f",
            width,
            translate("Gamma in the viewer: drag, or click and type; right click for 1"),
            neutral=1.0,
            low=0.1,
            high=5.0,
        )

    reset = _action(context, icons.ICON_FA_ROTATE_LEFT, "viewer.neutral")
    return [_number(font * 4.6, exposure), _number(font * 3.6, gamma), reset]


def _range(context: ViewerContext) -> list[_ViewerTool]:
    """The tools for the display of data."""
    viewer, font = context.viewer, imgui.get_font_size()
    measured, (low, high) = viewer.low == viewer.high, viewer.span
    speed = max(abs(high - low), 1e-6) / 200

    def menu() -> None:
        for meaning in MEANINGS:
            title = translate("Show as {meaning}", meaning=translate(meaning, "meaning of data"))
            if meaning == "auto":
                title = translate("Detect automatically")
            if imgui.menu_item(make_label(title, meaning), "", viewer.meaning == meaning)[0]:
                viewer.meaning = meaning
        imgui.separator()
        if imgui.menu_item(translate_label("Measure the Range"), "", measured)[0]:
            viewer.low = viewer.high = 0.0

    def black(width: float) -> None:
        new_low = number(context, "data low", low, "%.3g", width, translate("Shown as black"), speed=speed)
        if new_low != low:
            viewer.low, viewer.high = new_low, high

    def white(width: float) -> None:
        new_high = number(context, "data high", high, "%.3g", width, translate("Shown as white"), speed=speed)
        if new_high != high:
            viewer.low, viewer.high = low, new_high

    how = _dropdown(context, icons.ICON_FA_RULER_HORIZONTAL, "range", translate("How to show data"), menu, not measured)
    return [_number(font * 4.4, black, apart=True), _number(font * 4.4, white), how]


_VIEW_WORDS = {"": mark("the default"), NO_VIEW: mark("no view"), VIDEO_VIEW: mark("no view, BT.1886")}
_VIEW_TITLES = {NO_VIEW: mark("No view"), VIDEO_VIEW: mark("No view (BT.1886)")}


def _view(context: ViewerContext, asked_view: str) -> _ViewerTool:
    viewer, color = context.viewer, find_color_manager(context)

    def menu() -> None:
        if context.coloring.fault:
            imgui.text_disabled(translate("The color config cannot be read: these are the built-in views"))
        view_name = translate(_VIEW_WORDS[asked_view]) if asked_view in _VIEW_WORDS else asked_view
        if imgui.menu_item(
            make_label(translate("From the output ({view})", view=view_name), "output"), "", not viewer.view
        )[0]:
            viewer.view = viewer.display = ""
        imgui.separator()
        for display in list_displays(color):
            if imgui.begin_menu(display):
                for view in list_views(display, color):
                    chosen = viewer.view == view and viewer.display in (display, "")
                    if imgui.menu_item(view, "", chosen)[0]:
                        viewer.view, viewer.display = view, display
                imgui.end_menu()
        if looks := list_looks(color):
            imgui.separator()
            if imgui.begin_menu(translate_label("Look")):
                usual = (("", translate("From the view")), (NO_LOOK, translate("None")))
                for look, title in (*usual, *((name, name) for name in looks)):
                    if imgui.menu_item(make_label(title, f"look {look}"), "", viewer.look == look)[0]:
                        viewer.look = look
                imgui.end_menu()

    view_name = viewer.view or asked_view or translate("Default")
    label = f"{icons.ICON_FA_DISPLAY}  {translate(_VIEW_TITLES[view_name]) if view_name in _VIEW_TITLES else view_name}"
    return _dropdown(context, label, "view", translate("Display and view (OpenColorIO)"), menu, bool(viewer.view), True)


def _proxy_while_dragging(context: ViewerContext) -> None:
    coarse = context.store.current.proxy_while_dragging
    if imgui.menu_item(translate_label("Lower resolution while dragging"), "", coarse)[0]:
        context.log.attempt(lambda: context.store.change(proxy_while_dragging=not coarse))


def context_menu(context: ViewerContext) -> None:
    """Draw the context menu of the picture."""
    if imgui.begin_popup("viewer menu"):
        for action in context.actions.in_menu("viewer"):
            entry(context, action)
        imgui.end_popup()
