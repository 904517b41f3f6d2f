"""Arrow keys in the browser of files: rows are as long as the grid is wide, and no key leaves the files."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from halation.editor.browser import browser
from halation.editor.browser.browser import FileBrowser
from imgui_bundle import imgui

COUNT = 57


def press(
    monkeypatch: pytest.MonkeyPatch, key: imgui.Key, chosen: int, columns: int, elsewhere: bool = False, **facts: Any
) -> tuple[int | None, bool]:
    """The file that is chosen after a key, None if it is not asked for, and whether the view goes there."""
    found = list[int]()
    monkeypatch.setattr(browser.imgui, "is_key_pressed", lambda pressed: pressed == key)
    browsing: Any = SimpleNamespace(
        query=facts.get("query", ""), chosen=chosen, items=[None] * COUNT, choose=found.append,
        browse=SimpleNamespace(saving=facts.get("saving", False)),
    )  # fmt: skip
    table, grid = SimpleNamespace(reveal=False), SimpleNamespace(reveal=False)
    shown: Any = SimpleNamespace(_elsewhere=elsewhere, _table=table, _grid=grid)
    FileBrowser._move_by_arrows(shown, browsing, columns)  # pyright: ignore[reportPrivateUsage]
    assert table.reveal is grid.reveal is bool(found)
    return (found[0] if found else None), bool(found)


@pytest.mark.parametrize("columns", [1, 4, 7])
@pytest.mark.parametrize("chosen", [0, 3, 30, COUNT - 1])
def test_rows_and_columns(monkeypatch: pytest.MonkeyPatch, columns: int, chosen: int) -> None:
    steps = {imgui.Key.down_arrow: (1, 0), imgui.Key.up_arrow: (-1, 0), imgui.Key.page_down: (10, 0),
             imgui.Key.page_up: (-10, 0), imgui.Key.right_arrow: (0, 1), imgui.Key.left_arrow: (0, -1)}  # fmt: skip
    for key, (rows, across) in steps.items():
        if columns == 1 and across:
            assert press(monkeypatch, key, chosen, columns) == (None, False), "a list has no left and right"
            continue
        wanted = chosen + rows * columns + across
        assert press(monkeypatch, key, chosen, columns) == (sorted((0, wanted, COUNT - 1))[1], True)


@pytest.mark.parametrize("facts", [{"query": "a"}, {"saving": True}])
def test_left_and_right_are_of_the_text_where_there_is_one(monkeypatch: pytest.MonkeyPatch, facts) -> None:
    for key in (imgui.Key.left_arrow, imgui.Key.right_arrow):
        assert press(monkeypatch, key, 30, 4, **facts) == (None, False)
    assert press(monkeypatch, imgui.Key.down_arrow, 30, 4, **facts) == (34, True)


def test_no_key_and_keys_of_another_field_move_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    assert press(monkeypatch, imgui.Key.f12, 30, 4) == (None, False)
    assert press(monkeypatch, imgui.Key.down_arrow, 30, 4, elsewhere=True) == (None, False)
