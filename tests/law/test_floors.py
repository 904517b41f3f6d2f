"""Imports only go down, and each library has one home."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
import tomllib
from graphlib import CycleError, TopologicalSorter
from importlib.metadata import packages_distributions

import pytest
from import_graph import FOLDERS, MODULES, ROOT, imports, links, targets

DATA = ("nodes", "shaders", "presets")
"""What the machine is fed with: every floor may import these packages, and they import none of the floors."""

FLOORS = (
    "errors", "version", "language", "glsl", "resources", "custom_nodes", "graph", "document", "compiler", "color",
    "media", "render_layers", "inputs", "reference", "lint", "renderer", "scripting", "__init__", "serving", "cluster",
    "watch", "regression", "export", "fit", "desktop", "authoring", "editor", "cli",
)  # fmt: skip
"""Parts of the machine from the ground up. `__init__` is the public face of the engine: it stands on the renderer."""

ROOMS = {
    "compiler": ("ir", "lowering", "fusion", "codegen", "scheduling", "tiling"),
    "authoring": ("edits", "state", "commands", "recovery", "session", "background", "render_queue", "preview"),
    "renderer": ("opengl", "execution", "viewing", "jobs", "provenance"),
}
"""Folders of a floor, first to last. What lies beside them is what all of them speak of, or puts them together."""

SCRIPTS = "halation.export.python.functions"
"""Functions whose text goes into scripts: they use what a script may use."""

HOMES = {
    "moderngl": "renderer.opengl",
    "glcontext": "renderer.opengl",
    "OpenImageIO": "media",
    "PyOpenColorIO": "color",
    "av": "media",
    "uharfbuzz": "media",
    "bidi": "media",
    "distributed": "cluster",
    "pyoidn": "media",
    "cma": "fit",
    "scipy": "fit",
    "glfw": "editor",
    "imgui_bundle": "editor",
    "typer": "cli",
    "pytest": "regression.plugin",
}
"""Library -> the only part of the machine that may import it."""


def floor_of(name: str) -> str:
    """The part of the machine, or of the data, that a module of the tree belongs to."""
    return name.split(".")[1]


def test_the_reading_of_imports() -> None:
    code = "import numpy.linalg\nfrom ..errors import A\ndef f():\n from .. import media\n from halation.nodes import B"
    assert set(targets(ast.parse(code), "halation.compiler")) == {
        "numpy.linalg",
        "halation.errors",
        "halation.media.__init__",
        "halation.nodes.__init__",
    }
    assert len(links()) > 50


def test_each_floor_imports_only_lower_ones() -> None:
    def height(name: str) -> int:
        return -1 if floor_of(name) in DATA else FLOORS.index(floor_of(name))

    ours = [(name, target) for name, target in links() if target in MODULES]
    assert not [f"{name} imports {target}" for name, target in ours if height(target) > height(name)]


@pytest.mark.parametrize("floor", ROOMS)
def test_rooms_import_only_earlier_ones(floor: str) -> None:
    def place(name: str) -> int | None:
        parts = name.split(".")
        known = parts[:2] == ["halation", floor] and len(parts) > 3 and parts[2] in ROOMS[floor]
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
    assert not [
        f"{name} imports {target}"
        for name, target in links()
        if name.startswith("halation.nodes.")
        and not target.startswith("halation.nodes.")
        and target.split(".")[0] not in sys.stdlib_module_names
        and not (name.startswith("halation.nodes._declare.") and target.split(".")[0] == "msgspec")
    ]


def test_shaders_and_presets_know_nothing_of_the_rest() -> None:
    alone = ("halation.shaders.__init__", "halation.presets.__init__")
    assert {name for name in MODULES if floor_of(name) in ("shaders", "presets")} == set(alone)
    assert {target.split(".")[0] for name in alone for target in imports(name)} <= sys.stdlib_module_names


def test_imports_are_relative_within_a_folder_and_absolute_to_another() -> None:
    """Then editors find both: no folder lies where the package of another one is."""
    wrong: list[str] = []
    for name, path in MODULES.items():
        own = FOLDERS[path.relative_to(ROOT).parts[0]]
        for item in ast.walk(ast.parse(path.read_text(encoding="utf-8"), name)):
            if isinstance(item, ast.ImportFrom) and not item.level and (item.module or "").split(".")[0] == "halation":
                foreign = [f"{item.module}.{alias.name}.".split(".")[1] for alias in item.names]
                if own != "halation" or not set(foreign) <= set(DATA):
                    wrong.append(f"{name} says from {item.module}")
            elif isinstance(item, ast.ImportFrom) and item.level:
                wrong += [f"{name} says from {'.' * item.level}" for _ in [0] if leaves(item, name, own)]
    assert not wrong
    assert not {f"{name} says import {target}" for name, target in links() if target == "halation"}


def leaves(item: ast.ImportFrom, name: str, own: str) -> bool:
    """True if a relative import reaches out of the folder of the module."""
    depth = name.count(".") - own.count(".")
    inside = depth - item.level
    return inside < 0 or (own == "halation" and inside == 0 and (item.module or "").split(".")[0] in DATA)


def test_functions_of_scripts_are_text() -> None:
    """They are copied into scripts, which stand alone, and nothing in Halation imports them."""
    assert not {name for name, target in links() if target.startswith(SCRIPTS) and not name.startswith(SCRIPTS)}
    used = {target.split(".")[0] for name, target in links() if name.startswith(f"{SCRIPTS}.")}
    assert used - {"halation"} <= {"numpy", "scipy", "OpenImageIO", *sys.stdlib_module_names}


@pytest.mark.parametrize("library", HOMES)
def test_a_library_has_one_home(library: str) -> None:
    users = {name for name, target in links() if target.split(".")[0] == library and not name.startswith(SCRIPTS)}
    home = f"halation.{HOMES[library]}"
    assert all(f"{name}.".startswith(f"{home}.") for name in users), users


def test_only_the_room_of_opengl_speaks_of_its_library() -> None:
    """Textures and programs elsewhere are handles of the `Device` protocol."""
    home = ROOT / "app" / "renderer" / "opengl"
    files = [path for path in (ROOT / "app").rglob("*.py") if home not in path.parents]
    files = [path for path in files if path.stem != "about"]  # which lists the libraries for the user
    assert not [path for path in files if re.search(r"\bmoderngl\b|\.glo\b", path.read_text(encoding="utf-8"))]


@pytest.mark.parametrize("part", ["errors", "graph", "document", "cli"])
def test_parts_without_pixels_do_without_numpy(part: str) -> None:
    assert not {
        name for name, target in links() if name.startswith(f"halation.{part}") and target.split(".")[0] == "numpy"
    }


@pytest.mark.parametrize("part", ["glsl", "compiler"])
def test_what_each_command_loads_has_no_dataclasses(part: str) -> None:
    """Making one takes forty times as long as making a struct. What exports is seldom loaded."""
    users = {name for name, target in links() if target == "dataclasses" and name.startswith(f"halation.{part}.")}
    assert not {name for name in users if not name.startswith("halation.compiler.isf.")}


def test_no_module_is_part_of_a_cycle() -> None:
    inside = {name: {target for target in imports(name) if target in MODULES} for name in MODULES}
    try:
        TopologicalSorter(inside).prepare()
    except CycleError as cycle:
        pytest.fail(" -> ".join(cycle.args[1]))


def test_every_library_is_declared() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"]
    listed = [*project["dependencies"], *extras["video"], *extras["denoise"], *extras["cluster"], *extras["fit"]]
    declared = {re.split(r"[^\w-]", line)[0].lower() for line in listed}
    providers = packages_distributions()
    ours = {"halation"}
    used = {target.split(".")[0] for _, target in links()} - ours - sys.stdlib_module_names
    used -= {"pytest"}  # it loads our plugin, never we it
    packages = {
        name: {name.lower(), *map(str.lower, providers.get(name, []))} for name in used
    }  # extras may be missing
    assert not {name for name in used if not declared & packages[name]}


@pytest.mark.parametrize(
    ("module", "absent"),
    [
        ("halation.nodes", ("numpy", "moderngl")),
        ("halation.cli", ("numpy", "moderngl", "OpenImageIO", "PyOpenColorIO", "glfw", "imgui_bundle")),
        ("halation.renderer", ("glfw", "imgui_bundle", "typer")),
        ("halation.inputs.prefetch", ("halation.compiler", "moderngl")),
    ],
)
def test_importing_stays_light(module: str, absent: tuple[str, ...]) -> None:
    code = f"import sys, {module}; print(*(name for name in {absent!r} if name in sys.modules))"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout.strip() == ""


@pytest.mark.parametrize("command", ["bench", "fit", "gallery", "render", "reproduce", "sweep", "test", "watch"])
def test_commands_without_windows_know_no_editor(command: str) -> None:
    """Neither their modules nor anything that these import, inside of functions too."""
    reached, waiting = set[str](), [f"halation.cli.{command}"]
    while waiting:
        for target in (imports(waiting.pop()) & MODULES.keys()) - reached:
            reached.add(target)
            waiting.append(target)
    assert not [module for module in reached if floor_of(module) in ("authoring", "editor")]


def test_no_folder_is_part_of_a_cycle() -> None:
    """What only type checkers see counts too. A folder and those inside of it are one house, whatever its doors."""
    folders: dict[str, set[str]] = {}
    for name, target in links():
        here, there = name.rpartition(".")[0], target.rpartition(".")[0]
        if target in MODULES and not f"{here}.".startswith(f"{there}.") and not f"{there}.".startswith(f"{here}."):
            folders.setdefault(here, set()).add(there)
    try:
        TopologicalSorter(folders).prepare()
    except CycleError as cycle:
        pytest.fail(" -> ".join(cycle.args[1]))
