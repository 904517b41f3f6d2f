"""Every entry of every menu and list that a click opens does something, unless it is what is so already."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from drawn_shapes import Shape
from halation.authoring.commands import ReplaceGraph
from halation.graph import Port
from halation.nodes import catalogue
from imgui_bundle import imgui
from still_acts import describe, list_clicked, open_prepared
from still_editor import StillEditor, name_kind
from still_window import CHOSEN, DISABLED

PANELS = "Viewer", "Viewer of data", "Log", "Renders", "Animation", "Timeline", "Scopes", "Inspector", "Graph", "Code"

ITEMS = "menu_item", "selectable"

CHOSEN_BY_CLICKS = "selected", "curves spots", "words", "places"
"""What a click on an element chooses before its menu opens, and what is drawn of it."""

_ANY = int(imgui.PopupFlags_.any_popup)


def open_shown(folder: Path, title: str) -> Iterator[StillEditor]:
    """An editor with something of everything, whose panel has been drawn; "Viewer of data" shows a mask."""
    name, _, is_data = title.partition(" of ")
    for still in open_prepared(folder, name):
        if is_data:
            session = still.editor.session
            graph = session.root.add("measure", catalogue()["luminance"]())
            session.apply(ReplaceGraph("Measure", graph.connect(Port("bloom", "out"), Port("measure", "image"))))
            session.views.show(Port("measure", "out"))
            still.show(name, 2)
            still.compute()
            still.editor.viewer.low, still.editor.viewer.high = 0.1, 0.9
        still.show(name, 5)
        yield still


def open_menu(still: StillEditor, title: str, place: str, button: int) -> list[Shape]:
    """Click; the entries of what it has opened."""
    still.click(title, place, button, (0.3, 0.5))
    return [widget for widget in still.pane.widgets if widget.kind in ITEMS] if imgui.is_popup_open("", _ANY) else []


def leave(still: StillEditor, title: str) -> dict[str, object]:
    """What there is once menus are closed."""
    still.calm(title)
    still.show(title, 3)
    return describe(still) | {"range": (still.editor.viewer.low, still.editor.viewer.high)}


def list_menus(folder: Path, shown: str) -> list[tuple[str, int]]:
    """The places of a panel that open a menu, and by which button of the mouse: one of each kind."""
    title = shown.partition(" of ")[0]
    for still in open_shown(folder, shown):
        places = list_clicked(still, title)
    kinds = {name_kind(place): place for place in places}
    menus = list[tuple[str, int]]()
    for place in kinds.values():
        for button in (0, 1):
            for still in open_shown(folder, shown):
                if open_menu(still, title, place, button):
                    menus.append((place, button))
    return menus


@pytest.mark.parametrize("shown", PANELS)
def test_entries_do_something_and_menus_alone_nothing(tmp_path: Path, shown: str) -> None:
    title, idle = shown.partition(" of ")[0], list[str]()
    for still in open_shown(tmp_path, shown):
        untouched = leave(still, title)
    for place, button in list_menus(tmp_path, shown):
        for still in open_shown(tmp_path, shown):
            still.click(title, place, button, (0.3, 0.5))
            before = leave(still, title)
        for frames in (5, 6):  # whatever is changed in each frame comes back in one of two
            for still in open_shown(tmp_path, shown):
                entries = open_menu(still, title, place, button)
                still.show(title, frames)
                assert leave(still, title) == before, f"{place}: its menu has done something by itself"
        kept = {name: fact for name, fact in before.items() if name not in CHOSEN_BY_CLICKS}
        assert all(untouched[name] == fact for name, fact in kept.items()), (
            f"{place}: its menu has done something by itself"
        )
        for number, entry in enumerate(entries):
            for still in open_shown(tmp_path, shown):
                (left, top), (right, bottom) = open_menu(still, title, place, button)[number].points
                still.click_at(title, ((left + right) / 2, (top + bottom) / 2))
                if leave(still, title) == before and not entry.color & (CHOSEN | DISABLED):
                    idle.append(f"{place} {button}: {entry.text}")
    assert not idle
