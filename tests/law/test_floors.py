"""Imports only go down, and each library has one home."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FLOORS = (
    "errors",
    "version",
    "glsl",
    "written",
    "graph",
    "document",
    "compiler",
    "media",
    "lint",
    "renderer",
    "__init__",
    "suite",
    "editor",
    "cli",
)
"""Parts of app from the ground up. `__init__` is the public face of the engine, so it stands on the renderer."""

ROOMS = {
    "compiler": ("lowering", "fusion", "shading", "scheduling", "parts"),
    "renderer": ("opengl", "running", "viewing", "jobs", "reproducing"),
}
"""Folders of a floor, first to last. What lies beside them is what all of them speak of, or puts them together."""

HOMES = {
    "moderngl": "renderer",
    "glcontext": "renderer",
    "OpenImageIO": "media",
    "PyOpenColorIO": "media",
    "av": "media",
    "glfw": "editor",
    "imgui_bundle": "editor",
    "typer": "cli",
    "pytest": "suite.plugin",
}
"""Library -> the only part of app that may import it."""


def name_of(path: Path) -> str:
    """The dotted name of a file of the tree; a package's own name ends in `__init__`."""
    return ".".join(path.relative_to(ROOT).with_suffix("").parts)


MODULES = {name_of(path): path for top in ("app", "nodes", "shaders", "presets") for path in (ROOT / top).rglob("*.py")}


def resolve(name: str) -> str:
    """The module of the tree that importing `name` loads, or `name` itself if it is from outside."""
    if f"{name}.__init__" in MODULES:
        return f"{name}.__init__"
    return name


def targets(tree: ast.AST, package: str) -> Iterator[str]:
    """Every module that code inside `package` imports, wherever in the file it does so."""
    for statement in ast.walk(tree):
        if isinstance(statement, ast.Import):
            yield from (resolve(alias.name) for alias in statement.names)
        elif isinstance(statement, ast.ImportFrom):
            parts = package.split(".")
            above = parts[: len(parts) - statement.level + 1] if statement.level else []
            base = ".".join([*above, *filter(None, [statement.module])])
            for alias in statement.names:
                inner = resolve(f"{base}.{alias.name}".lstrip("."))
                yield inner if inner in MODULES else resolve(base)


def imports(name: str) -> set[str]:
    """What a module of the tree imports: names of the tree, and names of libraries."""
    return set(targets(ast.parse(MODULES[name].read_text(encoding="utf-8"), name), name.rpartition(".")[0]))


@cache
def links() -> tuple[tuple[str, str], ...]:
    """(module, what it imports) for the whole tree."""
    return tuple(sorted((name, target) for name in MODULES for target in imports(name)))


def test_the_reading_of_imports() -> None:
    code = "import numpy.linalg\nfrom ..errors import A\ndef f():\n from .. import media\n from ...nodes import B"
    assert set(targets(ast.parse(code), "app.compiler")) == {
        "numpy.linalg",
        "app.errors",
        "app.media.__init__",
        "nodes.__init__",
    }
    assert len(links()) > 50


def test_app_imports_only_lower_floors() -> None:
    wrong: list[str] = []
    for name, target in links():
        if name.startswith("app.") and target.startswith("app."):
            here, there = name.split(".")[1], target.split(".")[1]
            if here not in FLOORS or there not in FLOORS or FLOORS.index(there) > FLOORS.index(here):
                wrong.append(f"{name} imports {target}")
    assert not wrong


@pytest.mark.parametrize("floor", ROOMS)
def test_rooms_import_only_earlier_ones(floor: str) -> None:
    def place(name: str) -> int | None:
        parts = name.split(".")
        known = parts[:2] == ["app", floor] and len(parts) > 3 and parts[2] in ROOMS[floor]
        return ROOMS[floor].index(parts[2]) if known else None

    wrong: list[str] = []
    for name, target in links():
        here, there = place(name), place(target)
        if here is not None and there is not None and there > here:
            wrong.append(f"{name} imports {target}")
    assert not wrong
    assert {place(name) for name in MODULES} == {None, *range(len(ROOMS[floor]))}


def test_nodes_import_the_standard_library_and_themselves() -> None:
    """And msgspec, whose frozen classes are made in a twentieth of the time of dataclasses: the vocabulary has many."""
    wrong = [
        f"{name} imports {target}"
        for name, target in links()
        if name.startswith("nodes.")
        and target.split(".")[0] not in {"nodes", *sys.stdlib_module_names}
        and not (name.startswith("nodes._declare.") and target.split(".")[0] == "msgspec")
    ]
    assert not wrong


def test_shaders_and_presets_know_nothing_of_the_rest() -> None:
    assert {name for name in MODULES if not name.startswith(("app.", "nodes."))} == {
        "shaders.__init__",
        "presets.__init__",
    }
    found = imports("shaders.__init__") | imports("presets.__init__")
    assert {name.split(".")[0] for name in found} <= sys.stdlib_module_names


def test_imports_inside_the_project_are_relative() -> None:
    def statements(name: str) -> Iterator[ast.AST]:
        return ast.walk(ast.parse(MODULES[name].read_text(encoding="utf-8"), name))

    tops = {"halation", "app", "nodes", "shaders", "presets"}
    assert not [
        f"{name} says from {item.module}"
        for name in MODULES
        for item in statements(name)
        if isinstance(item, ast.ImportFrom) and not item.level and (item.module or "").split(".")[0] in tops
    ]
    assert not {f"{name} says import {target}" for name, target in links() if target.split(".")[0] == "halation"}


@pytest.mark.parametrize("library", HOMES)
def test_a_library_has_one_home(library: str) -> None:
    users = {name for name, target in links() if target.split(".")[0] == library}
    assert all(name.startswith(f"app.{HOMES[library]}.") or name == f"app.{HOMES[library]}" for name in users), users


def test_the_editor_works_without_a_window_below_its_panels() -> None:
    drawn = (
        "theme",
        "toolkit",
        "window",
        "canvas",
        "code",
        "curves",
        "inspector",
        "viewer",
        "panels",
        "timeline",
        "keys",
    )
    assert not [
        f"{name} imports {target}"
        for name, target in links()
        if name.startswith("app.editor.")
        and name.split(".")[2] not in drawn
        and (target.split(".")[0] in {"glfw", "imgui_bundle"} or target.startswith("app.editor.window."))
        and name != "app.editor.__init__"
    ]


@pytest.mark.parametrize("part", ["errors", "graph", "document", "cli"])
def test_parts_without_pixels_do_without_numpy(part: str) -> None:
    assert not {name for name, target in links() if name.startswith(f"app.{part}") and target.split(".")[0] == "numpy"}


@pytest.mark.parametrize("part", ["glsl", "compiler"])
def test_what_each_command_loads_has_no_dataclasses(part: str) -> None:
    """Making one takes forty times as long as making a struct. What exports is seldom loaded."""
    users = {name for name, target in links() if target == "dataclasses" and name.startswith(f"app.{part}.")}
    assert not {name for name in users if not name.startswith("app.compiler.isf.")}


def test_no_module_is_part_of_a_cycle() -> None:
    inside = {name: {target for target in imports(name) if target in MODULES} for name in MODULES}
    try:
        TopologicalSorter(inside).prepare()
    except CycleError as cycle:
        pytest.fail(" -> ".join(cycle.args[1]))


def test_every_library_is_declared() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    listed = [*project["dependencies"], *project["optional-dependencies"]["video"]]
    declared = {re.split(r"[^\w-]", line)[0].lower() for line in listed}
    providers = packages_distributions()
    ours = {name.split(".")[0] for name in MODULES}
    used = {target.split(".")[0] for _, target in links()} - ours - sys.stdlib_module_names
    used -= {"pytest"}  # it loads our plugin, never we it
    assert not {name for name in used if not declared & {provider.lower() for provider in providers.get(name, [])}}


@pytest.mark.parametrize(
    ("module", "absent"),
    [
        ("halation.nodes", ("numpy", "moderngl")),
        ("halation.app.cli", ("numpy", "moderngl", "OpenImageIO", "PyOpenColorIO", "glfw", "imgui_bundle")),
        ("halation.app.renderer", ("glfw", "imgui_bundle", "typer")),
        ("halation.app.media.ahead", ("halation.app.compiler", "moderngl")),
    ],
)
def test_importing_stays_light(module: str, absent: tuple[str, ...]) -> None:
    code = f"import sys, {module}; print(*(name for name in {absent!r} if name in sys.modules))"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout.strip() == ""
