"""The rooms of the editor: imports only go down, and panels do not know each other."""

from __future__ import annotations

from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest
from import_graph import links

ROOT = Path(__file__).parents[2] / "app" / "editor"

LEVELS = {"theme": 0, "shared": 1, "toolkit": 2, "fields": 3, "workflows": 4, "actions": 6, "window": 7, "__init__": 8}
"""Rooms that are no panels, from the ground up; panels are on level 5."""

PANELS = tuple(sorted({path.parent.name for path in ROOT.glob("*/__init__.py")} - set(LEVELS)))
"""All other rooms, one folder each. They share what lies below them, and get what they use from the window."""

WITHOUT_WINDOW = ("shared", "workflows", "actions")
"""Rooms that draw nothing: they import no window library."""


def room_of(module: str) -> str:
    """The folder of the editor that a module lies in; `__init__` is the editor's own."""
    _, _, room, *rest = module.split(".")
    return room if rest else "__init__"


@cache
def list_links() -> list[tuple[str, str, str]]:
    """(room, room that it imports, the import in words); what only type checkers see counts too."""
    return [
        (room_of(module), room_of(target), f"{module} imports {target}")
        for module, target in links()
        if module.startswith("halation.editor.")
        and target.startswith("halation.editor.")
        and room_of(module) != room_of(target)
    ]


def level(room: str) -> int:
    """How high a room stands."""
    return 5 if room in PANELS else LEVELS[room]


def test_every_folder_has_a_level() -> None:
    assert {path.parent.name for path in ROOT.glob("*/__init__.py")} >= set(LEVELS) - {"__init__"} and PANELS
    assert len(list_links()) > 100


def test_rooms_import_only_lower_ones() -> None:
    assert not [words for here, there, words in list_links() if level(there) >= level(here)]


def test_no_room_is_part_of_a_cycle() -> None:
    below: dict[str, set[str]] = {}
    for here, there, _ in list_links():
        below.setdefault(here, set()).add(there)
    try:
        TopologicalSorter(below).prepare()
    except CycleError as cycle:
        pytest.fail(" -> ".join(cycle.args[1]))


@pytest.mark.parametrize("room", WITHOUT_WINDOW)
def test_what_draws_nothing_imports_no_window_library(room: str) -> None:
    libraries = {"imgui_bundle", "glfw"}
    inside = [(module, target) for module, target in links() if module.startswith(f"halation.editor.{room}.")]
    assert inside
    assert not [module for module, target in inside if target.split(".")[0] in libraries]
