"""Every entry of every menu and list that a click opens does something, unless it is what is so already."""

from __future__ import annotations

from pathlib import Path

import pytest
from drawn_shapes import Shape
from imgui_bundle import imgui
from still_acts import describe, list_clicked, open_prepared
from still_editor import StillEditor
from still_window import CHOSEN, DISABLED

PANELS = "Viewer", "Log", "Renders", "Animation", "Timeline", "Scopes", "Inspector", "Graph", "Code"

ITEMS = "menu_item", "selectable"

_ANY = int(imgui.PopupFlags_.any_popup)


def open_menu(still: StillEditor, title: str, place: str, button: int) -> list[Shape]:
    """Click; the entries of what it has opened."""
    still.click(title, place, button, (0.3, 0.5))
    return [widget for widget in still.pane.widgets if widget.kind in ITEMS] if imgui.is_popup_open("", _ANY) else []


def list_menus(folder: Path, title: str) -> list[tuple[str, int]]:
    """The places of a panel that open a menu, and by which button of the mouse: one of each kind."""
    for still in open_prepared(folder, title):
        still.show(title, 4)
        places = list_clicked(still, title)
    kinds = {" ".join(place.split()[: 2 if place.startswith("button") else 1]): place for place in places}
    menus = list[tuple[str, int]]()
    for place in kinds.values():
        for button in (0, 1):
            for still in open_prepared(folder, title):
                if open_menu(still, title, place, button):
                    menus.append((place, button))
    return menus


@pytest.mark.parametrize("title", PANELS)
def test_entries_do_something(tmp_path: Path, title: str) -> None:
    idle = list[str]()
    for place, button in list_menus(tmp_path, title):
        for still in open_prepared(tmp_path, title):
            entries = open_menu(still, title, place, button)
            still.calm(title)
            still.show(title, 3)
            before = describe(still)
        for number, entry in enumerate(entries):
            for still in open_prepared(tmp_path, title):
                shown = open_menu(still, title, place, button)[number]
                (left, top), (right, bottom) = shown.points
                still.click_at(title, ((left + right) / 2, (top + bottom) / 2))
                still.calm(title)
                still.show(title, 3)
                if describe(still) == before and not entry.color & (CHOSEN | DISABLED):
                    idle.append(f"{place} {button}: {entry.text}")
    assert not idle
