"""Shortcuts grouped by menu, for the sheet of shortcuts and for Preferences."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from ...language.translation import mark
from .action import Actions, ListedAction

_SCOPES = {
    "graph": mark("Graph, with the mouse over it", "menu"),
    "viewer": mark("Viewer, with the mouse over it", "menu"),
    "animation": mark("Animation, with the mouse over it", "menu"),
}

MOUSE: tuple[tuple[str, str], ...] = (
    (mark("Middle drag, Alt+drag"), mark("Move the view")),
    (mark("Wheel"), mark("Zoom")),
    (mark("Right click"), mark("Context menu")),
    (mark("Shift+click"), mark("Select more")),
    (mark("Drag on empty space"), mark("Select with a box")),
    (mark("Ctrl+Right drag"), mark("Cut links")),
)


def group_actions(actions: Actions, every: bool = False) -> Iterator[tuple[str, tuple[ListedAction, ...]]]:
    """Actions by scope and menu, those with a shortcut; `every` gives all. The titles have the context "menu"."""
    by_title: dict[str, list[ListedAction]] = {}
    for action in actions.all:
        if every or actions.shortcut(action.id):
            title = _SCOPES.get(action.scope, action.menu.split("/")[0] or mark("Everywhere", "menu"))
            by_title.setdefault(title, []).append(action)
    return ((title, tuple(group)) for title, group in by_title.items())


def condense_rows(lines: Iterable[tuple[str, str]]) -> tuple[tuple[str, str], ...]:
    """Keys and labels, with rows that only count up merged: `1 - 9`, `View 1 - 9`."""
    rows: list[tuple[str, str]] = []
    for keys, label in lines:
        before = (re.sub(r"\d", "#", keys), re.sub(r"\d", "#", label))
        if rows and "#" in before[0] and "#" in before[1] and (_stem(rows[-1][0]), _stem(rows[-1][1])) == before:
            digit = re.findall(r"\d", keys)[-1]
            rows[-1] = (_through(rows[-1][0], digit), _through(rows[-1][1], digit))
        else:
            rows.append((keys, label))
    return tuple(rows)


def _stem(text: str) -> str:
    return re.sub(r"\d( - \d)?", "#", text)


def _through(text: str, digit: str) -> str:
    return re.sub(r"(\d)( - \d)?", rf"\1 - {digit}", text)


def balance_columns(sizes: tuple[int, ...], count: int) -> tuple[tuple[int, ...], ...]:
    """Blocks of these heights in columns as equal as their order allows: the indices of the blocks of each column."""
    lowest, highest = max(sizes, default=0), sum(sizes)
    while lowest < highest:
        middle = (lowest + highest) // 2
        if len(_fill_columns(sizes, middle)) <= count:
            highest = middle
        else:
            lowest = middle + 1
    return _fill_columns(sizes, highest)


def _fill_columns(sizes: tuple[int, ...], height: int) -> tuple[tuple[int, ...], ...]:
    columns: list[list[int]] = []
    room = 0
    for index, size in enumerate(sizes):
        if not columns or size > room:
            columns.append([])
            room = height
        columns[-1].append(index)
        room -= size
    return tuple(map(tuple, columns))
