"""Small widgets that the viewer and the scopes share."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from ..keys import shown as shown_shortcut
from ..theme.style import vec4

if TYPE_CHECKING:
    from ..action import Action
    from ..editor import Editor


def tip(editor: Editor, action: Action) -> str:
    """What the tooltip of an action says."""
    shortcut = editor.actions.shortcut(action.id)
    title = f"{action.label.removesuffix('...')} ({shown_shortcut(shortcut)})" if shortcut else action.label
    return f"{title}\n{action.doc}" if action.doc else title


def tool(editor: Editor, icon: str, id: str, labeled: bool = False) -> None:
    """A button that runs an action, lit while the action is checked; `labeled` in menus."""
    action = editor.actions[id]
    lit = action.checked is not None and action.checked(editor)
    if labeled:
        clicked, _ = imgui.menu_item(f"{icon}  {action.label}", "", lit, action.enabled(editor))
    else:
        clicked = button(editor, f"{icon}##{id}", lit, action.enabled(editor))
        imgui.set_item_tooltip(tip(editor, action))
    editor.places[f"button {id}"] = last_rectangle()
    if clicked:
        editor.actions.run(id, editor)


def button(editor: Editor, label: str, lit: bool = False, enabled: bool = True) -> bool:
    """A button without a background, its text in the accent color while `lit`."""
    palette = editor.palette
    imgui.push_style_color(imgui.Col_.button, vec4(palette.accent, 0.16 if lit else 0.0))
    imgui.push_style_color(imgui.Col_.text, vec4(palette.accent if lit else palette.text))
    imgui.begin_disabled(not enabled)
    clicked = imgui.button(label)
    imgui.end_disabled()
    imgui.pop_style_color(2)
    return clicked


def dropdown(
    editor: Editor, label: str, id: str, draw: Callable[[], object], doc: str, lit: bool = False, in_menu: bool = False
) -> None:
    """A button that opens a menu, which `draw` fills; itself in a menu, it is a menu in that."""
    if in_menu:
        if imgui.begin_menu(f"{doc}##{id}"):
            draw()
            imgui.end_menu()
        return
    if button(editor, f"{label}##{id}", lit):
        imgui.open_popup(id)
    left, _, _, bottom = editor.places[f"button {id}"] = last_rectangle()
    imgui.set_item_tooltip(doc)
    imgui.set_next_window_pos((left, bottom + 2), imgui.Cond_.appearing)
    if imgui.begin_popup(id):
        draw()
        imgui.end_popup()


def menu_of(editor: Editor, menu: str) -> None:
    """The actions of a menu of the menu bar, as entries of the menu that is open."""
    for action in editor.actions.all:
        if action.menu == menu:
            entry(editor, action)


def entry(editor: Editor, action: Action) -> None:
    """An action as an entry of the menu that is open."""
    checked = action.checked is not None and action.checked(editor)
    shortcut = shown_shortcut(text) if (text := editor.actions.shortcut(action.id)) else ""
    clicked, _ = imgui.menu_item(f"{action.label}##{action.id}", shortcut, checked, action.enabled(editor))
    if action.doc:
        imgui.set_item_tooltip(action.doc)
    if clicked:
        editor.actions.run(action.id, editor)


def number(
    editor: Editor, id: str, value: float, form: str, width: float, doc: str, *, neutral: float | None = None,
    speed: float = 0.01, low: float = 0.0, high: float = 0.0, logarithmic: bool = False,
) -> float:
    """A number that is dragged or typed, in the color of errors while it is not neutral; a right click makes it so."""
    changed = neutral is not None and value != neutral
    if changed:
        imgui.push_style_color(imgui.Col_.text, vec4(editor.palette.error))
    imgui.set_next_item_width(width)
    flags = int(imgui.SliderFlags_.logarithmic) if logarithmic else 0
    edited, dragged = imgui.drag_float(f"##{id}", value, speed, low, high, form, flags)
    value = dragged if edited else value  # what is not edited would lose digits
    editor.places[f"field {id}"] = last_rectangle()
    if changed:
        imgui.pop_style_color()
    imgui.set_item_tooltip(doc)
    if neutral is not None and imgui.is_item_clicked(imgui.MouseButton_.right):
        value = neutral
    return value


def last_rectangle() -> tuple[float, float, float, float]:
    """Where the last widget is on the screen."""
    low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    return low.x, low.y, high.x, high.y
