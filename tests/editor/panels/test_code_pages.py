"""The panel of code keeps what was typed, whatever is selected next."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from halation.authoring.commands import AddNode
from halation.editor.code.page import PAUSE
from halation.editor.code.panel import MAX_PAGES
from imgui_bundle import imgui
from still_editor import StillEditor, open_still_editor


@pytest.fixture
def still(tmp_path: Path) -> Iterator[StillEditor]:
    with open_still_editor(tmp_path, size=(700.0, 500.0)) as still:
        yield still


def read_text(still: StillEditor, id: str) -> str:
    code = still.editor.session.code_files.find_code(id)
    assert code is not None
    return code.text


def type_text(still: StillEditor, text: str) -> None:
    """Put a text into the widget; a frame sees that it is another one."""
    panel: object = still.find("Code")
    panel._page.widget.set_text(text)  # pyright: ignore
    still.show("Code", 1)


def test_a_text_becomes_code_after_a_pause_or_when_another_node_is_selected(still) -> None:
    session, io = still.editor.session, imgui.get_io()
    first, second = session.apply(AddNode("glsl")), session.apply(AddNode("glsl"))
    still.select(first)
    still.show("Code")
    text = read_text(still, first)
    type_text(still, text + "// one\n")
    assert read_text(still, first) == text, "while somebody types, nothing is compiled"
    io.delta_time = PAUSE / 2
    still.show("Code", 1)
    assert read_text(still, first) == text
    still.show("Code", 2)
    io.delta_time = 1.0 / 60.0
    assert read_text(still, first) == text + "// one\n"
    type_text(still, text + "// two\n")
    still.select(second)
    still.show("Code", 1)
    assert read_text(still, first) == text + "// two\n" and read_text(still, second) == text
    session.undo()
    assert read_text(still, first) == text + "// one\n", "to select another node begins a new step"
    session.undo()
    assert read_text(still, first) == text


def test_pages_are_kept_for_the_last_nodes(still) -> None:
    """A page that was left long ago begins anew: with the text of its node."""
    panel: object = still.find("Code")
    added = [still.editor.session.apply(AddNode("glsl")) for _ in range(MAX_PAGES + 1)]
    pages = []
    for id in (*added[:2], added[0], *added[2:]):
        still.select(id)
        still.show("Code", 1)
        pages.append(panel._page)  # pyright: ignore
    assert pages[0] is pages[2]
    for id, page in ((added[0], pages[0]), (added[1], None)):
        still.select(id)
        still.show("Code", 1)
        assert (panel._page is page) == (page is not None) and panel._page.id == id  # pyright: ignore
