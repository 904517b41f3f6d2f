"""Buttons, and widgets that run actions."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

from imgui_bundle import ImVec2, imgui

from ...language.translation import translate
from ..theme.palette import RGB
from ..theme.style import mix, u32, ui_scale, vec4
from .keys import display_shortcut
from .labels import make_label
from .places import WidgetSurface, item_rect, record
from .words import tip

if TYPE_CHECKING:
    from ..shared.action import Actions, ListedAction


class ActionSurface(WidgetSurface, Protocol):
    """A surface whose widgets run actions."""

    @property
    def actions(self) -> Actions: ...


def quiet_button(
    surface: WidgetSurface,
    label: str,
    name: str,
    doc: str,
    *,
    lit: bool = False,
    enabled: bool = True,
    width: float = 0.0,
) -> bool:
    """A button without a background, a square one if `label` is an icon; `name` is its place, `doc` its tooltip."""
    palette, square = surface.palette, len(label) == 1
    imgui.push_style_color(imgui.Col_.button, vec4(palette.accent, 0.18 if lit else 0.0))
    imgui.push_style_color(imgui.Col_.text, vec4(palette.accent if lit else palette.text))
    padding = imgui.get_style().frame_padding
    imgui.push_style_var(imgui.StyleVar_.frame_padding, ImVec2(0.0 if square else padding.x, padding.y))
    imgui.begin_disabled(not enabled)
    clicked = imgui.button(make_label(label, name), ImVec2(width or (imgui.get_frame_height() if square else 0.0), 0.0))
    imgui.end_disabled()
    imgui.pop_style_var()
    imgui.pop_style_color(2)
    record(surface, name)
    tip(doc)
    return clicked


def width_of_buttons(*labels: str, gap: float | None = None) -> float:
    """The width of quiet buttons with these labels side by side."""
    style = imgui.get_style()
    between = style.item_spacing.x if gap is None else gap
    widths = (
        imgui.get_frame_height() if len(label) == 1 else imgui.calc_text_size(label).x + 2 * style.frame_padding.x
        for label in labels
    )
    return sum(widths) + between * (len(labels) - 1)


def measure_buttons(*labels: str, least: float = 96.0) -> float:
    """The width in pixels of buttons that are as wide as the widest of them; at least `least` units."""
    widest = max(imgui.calc_text_size(label).x for label in labels)
    return max(widest + 4 * imgui.get_style().frame_padding.x, least * ui_scale())


def align_right(*labels: str) -> None:
    """Move the cursor so that buttons with these labels end at the right border, on the same line if they fit."""
    width = width_of_buttons(*labels)
    imgui.same_line()
    if imgui.get_content_region_avail().x < width:
        imgui.new_line()
    room = max(imgui.get_content_region_avail().x - width, 0.0)
    imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + room)


def main_button(surface: WidgetSurface, label: str, name: str, *, width: float = 0.0, enabled: bool = True) -> bool:
    """The main button of a dialog, in the accent color."""
    palette = surface.palette
    for color, lit in ((imgui.Col_.button, 0.0), (imgui.Col_.button_hovered, 0.12), (imgui.Col_.button_active, 0.25)):
        imgui.push_style_color(color, vec4(mix(palette.accent, palette.text, lit)))
    imgui.push_style_color(imgui.Col_.text, vec4(palette.on_accent))
    imgui.begin_disabled(not enabled)
    clicked = imgui.button(make_label(label, name), ImVec2(width, 0))
    imgui.end_disabled()
    imgui.pop_style_color(4)
    record(surface, name)
    return clicked


def close_button(surface: WidgetSurface, name: str) -> bool:
    """The button at the lower right that ends a dialog."""
    width = measure_buttons(translate("Close"))
    imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + imgui.get_content_region_avail().x - width)
    clicked = main_button(surface, translate("Close"), name, width=width)
    imgui.set_item_default_focus()
    return clicked


def outline(color: RGB, thickness: float = 2.0) -> None:
    """Draw a border around the last widget."""
    left, top, right, bottom = item_rect()
    radius = imgui.get_style().frame_rounding
    imgui.get_window_draw_list().add_rect((left, top), (right, bottom), u32(color), radius, thickness * ui_scale())


def dropdown(
    surface: WidgetSurface,
    label: str,
    name: str,
    doc: str,
    fill: Callable[[], object],
    *,
    lit: bool = False,
    width: float = 0.0,
) -> None:
    """A quiet button that opens a menu below it."""
    if quiet_button(surface, label, name, doc, lit=lit, width=width):
        imgui.open_popup(name)
    left, _, _, bottom = surface.places[name]
    imgui.set_next_window_pos((left, bottom + 2), imgui.Cond_.appearing)
    imgui.set_next_window_size_constraints((0, 0), (1e6, imgui.get_font_size() * 28))
    if imgui.begin_popup(name):
        fill()
        imgui.end_popup()


# --- actions ---------------------------------------------------------------------------------------------------------


def tip_of(surface: ActionSurface, action: ListedAction) -> str:
    """The text of an action's tooltip."""
    shortcut = surface.actions.shortcut(action.id)
    title = translate(action.label).removesuffix("...")
    title = f"{title} ({display_shortcut(shortcut)})" if shortcut else title
    return f"{title}\n{translate(action.doc)}" if action.doc else title


def tool(surface: ActionSurface, icon: str, id: str) -> None:
    """A quiet button that runs an action, lit while the action is checked."""
    action = surface.actions[id]
    lit = surface.actions.is_checked(action)
    if quiet_button(
        surface, icon, f"button {id}", tip_of(surface, action), lit=lit, enabled=surface.actions.is_enabled(action)
    ):
        surface.actions.run(id)


def entry(surface: ActionSurface, action: ListedAction, icon: str = "") -> None:
    """Draw an action as an entry of the open menu."""
    checked = surface.actions.is_checked(action)
    title = translate(action.label)
    label = f"{icon}  {title}" if icon else title
    shortcut = display_shortcut(surface.actions.shortcut(action.id))
    clicked, _ = imgui.menu_item(make_label(label, action.id), shortcut, checked, surface.actions.is_enabled(action))
    record(surface, f"menu {action.id}")
    tip(translate(action.doc))
    if clicked:
        surface.actions.run(action.id)


def entries(surface: ActionSurface, menu: str) -> None:
    """Draw the actions of a menu of the menu bar as entries of the open menu."""
    for action in surface.actions.all:
        if action.menu == menu:
            entry(surface, action)
