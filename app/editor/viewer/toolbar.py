"""The row of tools above the picture; what does not fit is in a menu at its end."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...media import displays, views
from ..theme.style import ui_scale
from .controls import button, dropdown, entry, last_rectangle, menu_of, number, tool
from .picking import pick_port
from .state import MEANINGS
from .wanted import A, B

if TYPE_CHECKING:
    from ..editor import Editor

_ACTIONS_AT_END = (
    (icons.ICON_FA_CROP_SIMPLE, "viewer.region"), (icons.ICON_FA_TABLE_LIST, "viewer.table"),
    (icons.ICON_FA_FLOPPY_DISK, "viewer.save"),
)
_SHORT: Mapping[str, str] = MappingProxyType({
    "color": "RGB", "red": "R", "green": "G", "blue": "B", "alpha": "A", "luminance": "Lum", "false color": "False",
})


@dataclass(frozen=True)
class _Item:
    """A tool: how wide it is, and how it is drawn, in the row or (True) in a menu."""

    width: float
    draw: Callable[[bool], object]


def draw_toolbar(editor: Editor, asked_view: str, is_data: bool) -> None:
    """Draw the tools in one row."""
    room = imgui.internal.get_current_window().inner_rect.max.x - imgui.get_cursor_screen_pos().x
    gap = 2.0 * ui_scale()
    items = _items(editor, asked_view, is_data)
    more = _text_width(icons.ICON_FA_ELLIPSIS)
    count, left = len(items), room
    if sum(item.width + gap for item in items) > room:
        left -= more + gap
        count = 0
        while count < len(items) and left >= items[count].width:
            left -= items[count].width + gap
            count += 1
    for index, item in enumerate(items[:count]):
        if index:
            imgui.same_line(0.0, gap)
        item.draw(False)
    if count < len(items):
        if count:
            imgui.same_line(0.0, gap)
        if button(editor, f"{icons.ICON_FA_ELLIPSIS}##more"):
            imgui.open_popup("more tools")
        left, _, _, bottom = editor.places["button more tools"] = last_rectangle()
        imgui.set_item_tooltip("More tools")
        imgui.set_next_window_pos((left, bottom + 2), imgui.Cond_.appearing)
        if imgui.begin_popup("more tools"):
            for item in items[count:]:
                item.draw(True)
            imgui.end_popup()


def _items(editor: Editor, asked_view: str, is_data: bool) -> list[_Item]:
    viewer = editor.viewer
    font = imgui.get_font_size()
    found = [_port(editor, A, font)]
    found.append(_Item(_text_width(icons.ICON_FA_CLONE), lambda menu: _compare(editor, menu)))
    if viewer.compares:
        found.append(_port(editor, B, font))
    if is_data:
        found.append(_Item(font * 8.4, lambda menu: _range(editor, font)))
    found.append(_Item(_text_width(_SHORT[viewer.channels]), lambda menu: _channels(editor, menu)))
    if not is_data or viewer.meaning == "image":  # other data is shown as it is
        found.append(_Item(font * 4.6, lambda menu: _exposure(editor, font)))
        found.append(_Item(font * 3.6, lambda menu: _gamma(editor, font)))
        if viewer.exposure != 0.0 or viewer.gamma != 1.0:
            found.append(_tool(editor, icons.ICON_FA_ROTATE_LEFT, "viewer.neutral"))
    found.append(_Item(_text_width(f"1/{1 / viewer.proxy:.0f}"), lambda menu: _proxy(editor, menu)))
    found.append(_tool(editor, icons.ICON_FA_PLAY if viewer.paused else icons.ICON_FA_PAUSE, "viewer.pause"))
    found.append(_tool(editor, icons.ICON_FA_EXPAND, "viewer.fit"))
    found.append(_Item(_text_width("1:1"), lambda menu: tool(editor, "1:1", "viewer.actual", menu)))
    found.append(_Item(_text_width(icons.ICON_FA_TRIANGLE_EXCLAMATION), lambda menu: _warnings(editor, menu)))
    found += (_tool(editor, icon, id) for icon, id in _ACTIONS_AT_END)
    found.append(_Item(_text_width(icons.ICON_FA_CHESS_BOARD), lambda menu: _background(editor, menu)))
    if is_data and viewer.meaning != "image":
        return found
    label = f"{icons.ICON_FA_DISPLAY}  {viewer.view or asked_view or 'Default'}"
    found.append(_Item(_text_width(label), lambda menu: _view(editor, label, asked_view, menu)))
    return found


def _tool(editor: Editor, icon: str, id: str) -> _Item:
    return _Item(_text_width(icon), lambda menu: tool(editor, icon, id, menu))


def _text_width(label: str) -> float:
    return imgui.calc_text_size(label).x + 2 * imgui.get_style().frame_padding.x


def _port(editor: Editor, side: str, font: float) -> _Item:
    port = editor.session.viewed("A" if side == A else "B")
    name = str(port) if port else "nothing"
    short = name if len(name) <= 22 else f"{name[:21]}…"
    label = f"{side}  {short}"
    return _Item(_text_width(label), lambda menu: pick_port(editor, side, label, menu))


def _compare(editor: Editor, in_menu: bool) -> None:
    def menu() -> None:
        menu_of(editor, "Viewer/Compare")

    dropdown(editor, icons.ICON_FA_CLONE, "compare", menu, "Compare A with B", editor.viewer.compares, in_menu)


def _channels(editor: Editor, in_menu: bool) -> None:
    viewer = editor.viewer

    def menu() -> None:
        menu_of(editor, "Viewer/Channels")

    dropdown(editor, _SHORT[viewer.channels], "channels", menu, "Channels", viewer.channels != "color", in_menu)


def _exposure(editor: Editor, font: float) -> None:
    viewer = editor.viewer
    doc = "Gain of the difference" if viewer.compare == "difference" else "Exposure"
    viewer.exposure = number(
        editor, "viewer exposure", viewer.exposure, "%+.2f EV", font * 4.6,
        f"{doc} in the viewer, in stops: drag, or click and type; right click for 0", neutral=0.0, speed=0.02,
        low=-20.0, high=20.0,
    )


def _gamma(editor: Editor, font: float) -> None:
    viewer = editor.viewer
    viewer.gamma = number(
        editor, "viewer gamma", viewer.gamma, "\u03b3 %.2f", font * 3.6,
        "Gamma in the viewer: drag, or click and type; right click for 1", neutral=1.0, low=0.1, high=5.0,
    )


def _range(editor: Editor, font: float) -> None:
    """How data is made visible."""
    viewer = editor.viewer
    measured = viewer.low == viewer.high

    def menu() -> None:
        for meaning in MEANINGS:
            if imgui.menu_item(f"Show as {meaning}" if meaning != "auto" else "Show as it says", "",
                               viewer.meaning == meaning)[0]:
                viewer.meaning = meaning
        imgui.separator()
        if imgui.menu_item("Measure the range", "", measured)[0]:
            viewer.low = viewer.high = 0.0

    low, high = viewer.span
    speed = max(abs(high - low), 1e-6) / 200
    low = number(editor, "data low", low, "%.4g", font * 3.2, "Shown as black", speed=speed)
    imgui.same_line(0.0, 2.0 * ui_scale())
    high = number(editor, "data high", high, "%.4g", font * 3.2, "Shown as white", speed=speed)
    if (low, high) != viewer.span:
        viewer.low, viewer.high = low, high
    imgui.same_line(0.0, 2.0 * ui_scale())
    dropdown(editor, icons.ICON_FA_RULER_HORIZONTAL, "range", menu, "How data is shown", not measured)


def _view(editor: Editor, label: str, asked: str, in_menu: bool) -> None:
    viewer = editor.viewer

    def menu() -> None:
        if imgui.menu_item(f"As the output asks ({asked or 'default'})", "", not viewer.view)[0]:
            viewer.view = viewer.display = ""
        imgui.separator()
        for display in displays():
            if imgui.begin_menu(display):
                for view in views(display):
                    chosen = viewer.view == view and viewer.display in (display, "")
                    if imgui.menu_item(view, "", chosen)[0]:
                        viewer.view, viewer.display = view, display
                imgui.end_menu()

    dropdown(editor, label, "view", menu, "Display and view (OpenColorIO)", bool(viewer.view), in_menu)


def _background(editor: Editor, in_menu: bool) -> None:
    def menu() -> None:
        menu_of(editor, "Viewer/Background")

    dropdown(editor, icons.ICON_FA_CHESS_BOARD, "background", menu, "Behind what is transparent",
             editor.viewer.background != "checker", in_menu)


def _warnings(editor: Editor, in_menu: bool) -> None:
    def menu() -> None:
        menu_of(editor, "Viewer/Warnings")

    dropdown(editor, icons.ICON_FA_TRIANGLE_EXCLAMATION, "warnings", menu, "Warnings", editor.viewer.warn_clipping,
             in_menu)


def _proxy(editor: Editor, in_menu: bool) -> None:
    viewer = editor.viewer

    def menu() -> None:
        menu_of(editor, "Viewer/Proxy")
        imgui.separator()
        coarse = editor.store.now.proxy_while_dragging
        if imgui.menu_item("Coarser while dragging", "", coarse)[0]:
            editor.attempt(lambda: editor.store.change(proxy_while_dragging=not coarse))

    label = f"1/{1 / viewer.proxy:.0f}"
    dropdown(editor, label, "proxy", menu, "Proxy: compute fewer pixels", viewer.proxy != 1.0, in_menu)


def context_menu(editor: Editor) -> None:
    """What a right click on the picture offers."""
    if imgui.begin_popup("viewer menu"):
        for action in editor.actions.context("viewer"):
            entry(editor, action)
        imgui.end_popup()
