"""What clicks do in panels and dialogs: nothing happens without one, each does something, and the button of an action
does what the action does.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from still_acts import describe, list_clicked, open_prepared
from still_editor import StillEditor

PANELS = (
    ("Viewer", ""), ("Log", ""), ("History", ""), ("Renders", ""), ("Animation", ""), ("Preferences", "preferences"),
    ("Export", "export"), ("Command palette", "palette"), ("Node", "node"), ("Timeline", ""),
    ("Shortcuts", "shortcuts"), ("About", "about"), ("Problems", ""), ("Start", "start"), ("Save as preset", "preset"),
    ("Scopes", ""), ("Inspector", ""), ("Graph", ""),
)  # fmt: skip

PRESSED = "button", "checkbox", "radio_button", "small_button", "selectable", "menu_item"
"""Widgets that do something when they are clicked."""

AS_IT_IS = ("viewer.fit", "viewer.actual", "viewer.neutral", "time.first", "page Interface", "theme dark",
            "category all", "button view bloom", "viewer.save", "info", "measure node", "Selection", "Whole graph",
            "selected", "export frame", "history 4", "compare 2")  # fmt: skip
"""Buttons of what is so already, or that a picture must be there for."""

SWITCHES = "render resume", "export preview"
"""Checkboxes of forms, which only the library draws."""


def list_buttons(still: StillEditor, title: str) -> list[str]:
    """The places of widgets that do something when they are clicked."""
    boxes = {(*shape.points[0], *shape.points[1]) for shape in still.pane.widgets if shape.kind in PRESSED}
    return [place for place in list_clicked(still, title) if still.places[place] in boxes]


@pytest.mark.parametrize(("title", "dialog"), PANELS)
def test_nothing_happens_without_a_click_and_something_with_one(tmp_path: Path, title: str, dialog: str) -> None:
    for still in open_prepared(tmp_path, title, dialog):
        still.show(title, 5)
        before = describe(still)
        still.show(title, 8)
        assert describe(still) == before
        buttons = list_buttons(still, title)
    idle = list[str]()
    for place in buttons[:40]:
        for still in open_prepared(tmp_path, title, dialog):
            still.click(title, place, part=(0.3, 0.4))
            if describe(still) == before and not place.endswith((*AS_IT_IS, *SWITCHES)):
                idle.append(place)
    assert not idle


@pytest.mark.parametrize(("title", "dialog"), PANELS)
def test_a_button_of_an_action_does_what_the_action_does(tmp_path: Path, title: str, dialog: str) -> None:
    for still in open_prepared(tmp_path, title, dialog):
        ids = {f"button {action.id}": action.id for action in still.editor.actions.all}
        named = [place for place in list_clicked(still, title) if place in ids]
    for place in named:
        results = list[dict[str, object]]()
        for is_clicked in (True, False):
            for still in open_prepared(tmp_path, title, dialog):
                still.pane.point(still.find_point(place))
                if is_clicked:
                    still.click(title, place)
                else:
                    still.editor.actions.run(ids[place])
                still.calm(title)
                still.show(title, 3)
                results.append(describe(still))
        clicked, ran = results
        assert {key for key in clicked if clicked[key] != ran[key]} == set(), place
