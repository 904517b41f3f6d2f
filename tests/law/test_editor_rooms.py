"""The rooms of the editor: imports only go down, and panels do not know each other."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2] / "app" / "editor"

LEVELS = {"theme": 0, "shared": 1, "toolkit": 2, "fields": 3, "workflows": 4, "actions": 6, "window": 7, "__init__": 8}
"""Rooms that are no panels, from the ground up; panels are on level 5."""

PANELS = tuple(sorted({path.parent.name for path in ROOT.glob("*/__init__.py")} - set(LEVELS)))
"""All other rooms, one folder each. They share what lies below them, and get what they use from the window."""

WITHOUT_WINDOW = ("shared", "workflows", "actions")
"""Rooms that draw nothing: they import no window library."""


def imports_at_run_time(tree: ast.AST) -> Iterator[ast.Import | ast.ImportFrom]:
    """Every import that runs, those inside of functions included; what only type checkers see does not count."""
    for statement in ast.iter_child_nodes(tree):
        if isinstance(statement, ast.If) and "TYPE_CHECKING" in ast.unparse(statement.test):
            for other in statement.orelse:
                yield from imports_at_run_time(other)
        elif isinstance(statement, ast.Import | ast.ImportFrom):
            yield statement
        else:
            yield from imports_at_run_time(statement)


def room_of(module: tuple[str, ...]) -> str:
    """The folder of the editor that a module lies in; `__init__` is the editor's own."""
    return module[0] if len(module) > 1 or (ROOT / module[0]).is_dir() else "__init__"


def links() -> list[tuple[str, str, str]]:
    """(room, room that it imports, the import in words)."""
    pairs: list[tuple[str, str, str]] = []
    for path in sorted(ROOT.rglob("*.py")):
        module = path.relative_to(ROOT).with_suffix("").parts
        for statement in imports_at_run_time(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(statement, ast.ImportFrom) and statement.level and statement.level <= len(module):
                above = module[: len(module) - statement.level]
                names = [[*filter(None, (statement.module or "").split("."))]] if statement.module else []
                for parts in names or [[alias.name] for alias in statement.names]:
                    here, there = room_of(module), room_of((*above, *parts))
                    if here != there:
                        pairs.append((here, there, f"{'.'.join(module)} imports {'.'.join((*above, *parts))}"))
    return pairs


LINKS = links()


def level(room: str) -> int:
    """How high a room stands."""
    return 5 if room in PANELS else LEVELS[room]


def test_every_folder_has_a_level() -> None:
    assert {path.parent.name for path in ROOT.glob("*/__init__.py")} >= set(LEVELS) - {"__init__"} and PANELS
    assert len(LINKS) > 100


def test_rooms_import_only_lower_ones() -> None:
    assert not [words for here, there, words in LINKS if level(there) >= level(here)]


def test_no_room_is_part_of_a_cycle() -> None:
    below: dict[str, set[str]] = {}
    for here, there, _ in LINKS:
        below.setdefault(here, set()).add(there)
    try:
        TopologicalSorter(below).prepare()
    except CycleError as cycle:
        pytest.fail(" -> ".join(cycle.args[1]))


@pytest.mark.parametrize("room", WITHOUT_WINDOW)
def test_what_draws_nothing_imports_no_window_library(room: str) -> None:
    users: list[str] = []
    for path in (ROOT / room).rglob("*.py"):
        for statement in imports_at_run_time(ast.parse(path.read_text(encoding="utf-8"))):
            is_from = isinstance(statement, ast.ImportFrom)
            modules = [statement.module or ""] if is_from else [alias.name for alias in statement.names]
            users += [path.name for module in modules if module.split(".")[0] in ("imgui_bundle", "glfw")]
    assert not users
