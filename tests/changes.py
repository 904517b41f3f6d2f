"""Which test files `--changed` runs: those that name what git says has changed since the last commit.

By the imports in the code, without running anything: a test file covers the modules that it imports, what a package
among them hands on, and what those modules import themselves. It also covers the file of its own name in the room of
its own name (in quick rooms the whole room), the shaders of the nodes that it covers, its helpers and its fixtures. Of
the tests that try all nodes, the cases of a changed node run. Commands and panels reach far more than that through
other modules, so this is for a save, and everything is for a commit.
"""

from __future__ import annotations

import ast
import re
import subprocess
from collections.abc import Collection
from functools import cache
from pathlib import Path

import pytest
from import_graph import MODULES, ROOT, imports, targets

TESTS = ROOT / "tests"

QUICK_ROOMS = ("color", "compiler", "document", "graph", "lint", "renderer")
"""Rooms whose tests all run after a change in the room of their name: none takes more than two minutes."""

_INCLUDE = re.compile(r'^#include "(.+)"', re.M)


@cache
def list_changes(root: Path = ROOT) -> frozenset[Path]:
    """The files that differ from the last commit, new ones included."""
    commands = (("diff", "--name-only", "HEAD"), ("ls-files", "--others", "--exclude-standard"))
    try:
        lists = [subprocess.check_output(["git", *words], cwd=root, text=True) for words in commands]
    except (OSError, subprocess.CalledProcessError):
        raise pytest.UsageError(f"--changed asks git, which does not know {root}: leave the option out") from None
    return frozenset(root / name for names in lists for name in names.splitlines())


def covers(test: Path, changes: Collection[Path]) -> bool:
    """True if a test file covers one of the files."""
    return not set(changes).isdisjoint(_list_covered(test))


def name_changed_nodes(changes: Collection[Path], root: Path = ROOT) -> frozenset[str]:
    """The ids of built-in nodes whose class or shader is among the files."""
    places = (path.relative_to(root).parts for path in changes if path.is_relative_to(root))
    stems = (
        Path(*parts[1:]).with_suffix("") for parts in places if len(parts) == 3 and parts[0] in ("nodes", "shaders")
    )
    return frozenset(stem.name for stem in stems if (root / "nodes" / stem).with_suffix(".py").is_file())


@cache
def tries_all_nodes(test: Path) -> bool:
    """True for a file with tests that have a case for each node."""
    text = test.read_text("utf-8")
    return "parametrize" in text and re.search(r"\b(catalogue|built_in_nodes)\(\)", text) is not None


def is_case_of(test: str, ids: Collection[str]) -> bool:
    """True for the name of a test whose case has the id of one of these nodes: `test_it[bloom]`."""
    return not set(ids).isdisjoint(test.partition("[")[2].removesuffix("]").split("-"))


@cache
def _list_covered(test: Path) -> frozenset[Path]:
    helpers = list_helpers(test)
    names = {name for path in helpers if path.name != "conftest.py" for name in _read_targets(path) if name in MODULES}
    names |= {inner for name in names if name.endswith("__init__") for inner in _read_imports(name) if inner in MODULES}
    names |= {inner for name in names if not name.endswith("__init__") for inner in _read_imports(name)}
    modules = {MODULES[name] for name in names if name in MODULES}
    room = ROOT / "app" / test.parent.relative_to(TESTS)
    twins = room.rglob("*.py") if room.name in QUICK_ROOMS else [room / f"{test.stem.removeprefix('test_')}.py"]
    shaders = {shader for module in modules for shader in _list_shaders(module)}
    return frozenset({*helpers, *modules, *shaders, *twins})


def list_helpers(test: Path) -> tuple[Path, ...]:
    """The test file, the fixtures of its folders, and the helpers that they import."""
    fixtures = (folder / "conftest.py" for folder in test.parents if folder.is_relative_to(TESTS))
    todo = [test, *(path for path in fixtures if path.is_file())]
    seen = dict.fromkeys(todo)
    while todo:
        helpers = (TESTS / f"{name}.py" for name in _read_targets(todo.pop()))
        new = [path for path in helpers if path.is_file() and path not in seen]
        seen |= dict.fromkeys(new)
        todo += new
    return tuple(seen)


@cache
def _read_imports(module: str) -> frozenset[str]:
    return frozenset(imports(module))


@cache
def _read_targets(path: Path) -> frozenset[str]:
    return frozenset(targets(ast.parse(path.read_text("utf-8")), ""))


@cache
def _list_shaders(module: Path) -> frozenset[Path]:
    """The shader of a node, and what it includes."""
    todo, seen = [ROOT / "shaders" / module.relative_to(ROOT / module.relative_to(ROOT).parts[0])], set[Path]()
    while todo:
        shader = todo.pop().with_suffix(".glsl")
        if shader.is_file() and shader not in seen:
            seen.add(shader)
            todo += [ROOT / "shaders" / name for name in _INCLUDE.findall(shader.read_text("utf-8"))]
    return frozenset(seen)
