"""Plug-ins: installed packages that bring nodes, shaders and presets of their own.

A package is a plug-in if it has an entry point in the group `halation.nodes` whose value is its import name:

    [project.entry-points."halation.nodes"]
    acme_glow = "acme_glow"

It is laid out as Halation is: `nodes/<menu>/<id>.py`, `shaders/<menu>/<id>.glsl` and `presets/*.json`. The import name
is also the namespace: the class `SoftGlow` becomes the node `acme_glow.soft_glow` (see `Node`), so that the nodes of
two packages cannot be confused.

A plug-in is accepted or refused as a whole. One that cannot be loaded has a `fault` and no nodes; all others work.
Entry points are looked up when the first id with a namespace is asked for, or when all nodes are listed: graphs that
use no plug-ins never pay for the search.
"""

from __future__ import annotations

import importlib
import os
import re
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from importlib.machinery import PathFinder
from importlib.util import find_spec
from pathlib import Path
from types import MappingProxyType, ModuleType
from typing import TYPE_CHECKING, NamedTuple

from ._declare import Node

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

GROUP = "halation.nodes"
"""The group of entry points that makes a package a plug-in."""
PLUGINS_VARIABLE = "HALATION_PLUGINS"
"""The packages that are loaded as plug-ins, separated by commas; `none` loads none. Without it all are loaded."""


class Plugin(NamedTuple):
    """An installed package that brings nodes, or the reason why it brings none."""

    package: str
    """The name to install it by, such as `acme-glow`."""
    version: str
    namespace: str
    """The import name, such as `acme_glow`, with which the ids of its nodes start."""
    folder: Path | None = None
    """Where its code lies."""
    nodes: Mapping[str, type[Node]] = MappingProxyType({})
    """Its node classes by id."""
    fault: str = ""
    """Why it is refused."""

    @property
    def requirement(self) -> str:
        """What pip installs: `acme-glow==1.2.0`."""
        return f"{self.package}=={self.version}"

    def __str__(self) -> str:
        return f"{self.package} {self.version}"


@cache
def plugins() -> tuple[Plugin, ...]:
    """Every installed plug-in by name, refused ones included; of those that HALATION_PLUGINS allows, if it is set."""
    allowed = _list_allowed()
    if allowed == {"none"} or (
        not any(map(_may_hold_plugins, sys.path)) and not any(map(_finds_packages, sys.meta_path))
    ):
        return ()
    from importlib.metadata import entry_points  # to import and ask it takes 20 ms

    points = entry_points(group=GROUP)
    loaded = [_load(point) for point in points if not allowed or _normalize(_name_package(point)) in allowed]
    return tuple(_refuse_shared_ids(sorted(loaded, key=lambda plugin: plugin.package)))


def _list_allowed() -> set[str]:
    """The packages that the user allows; empty if all are allowed."""
    return {_normalize(name) for name in os.environ.get(PLUGINS_VARIABLE, "").split(",") if name.strip()}


def _normalize(name: str) -> str:
    """The name of a package for comparison, as PEP 503 defines it."""
    return re.sub(r"[-_.]+", "-", name.strip()).lower()


def _name_package(point: EntryPoint) -> str:
    return point.dist.name if point.dist else point.name


def _may_hold_plugins(folder: str) -> bool:
    """False if no package that is installed in a folder has an entry point of a plug-in; True if it cannot be seen."""
    try:
        with os.scandir(folder or ".") as entries:
            records = [entry.path for entry in entries if entry.name.lower().endswith((".dist-info", ".egg-info"))]
    except FileNotFoundError:
        return False
    except OSError:  # such as an archive
        return True
    return folder.endswith(".egg") or any(map(_names_plugins, records))


def _names_plugins(record: str) -> bool:
    """True if the record of an installed package, which is a folder, has entry points of plug-ins."""
    try:
        with open(f"{record}{os.sep}entry_points.txt", "rb", buffering=0) as file:  # noqa: PTH123 - half the time
            return GROUP.encode() in file.read()
    except OSError:
        return False


def _finds_packages(finder: object) -> bool:
    """True for an import hook that knows installed packages which are in no folder of `sys.path`."""
    return finder is not PathFinder and hasattr(finder, "find_distributions")


def list_files(folder: Path) -> Iterator[tuple[str, str]]:
    """The menu and the id of every node in a folder of nodes, without loading any."""
    for menu in sorted(item for item in folder.iterdir() if "." not in item.name and not item.name.startswith("_")):
        names = [item.name for item in menu.iterdir()]
        ids = (name.removesuffix(".py") for name in names if name.endswith(".py") and not name.startswith("_"))
        yield from ((menu.name, id) for id in sorted(ids))


def find_class(module: ModuleType, id: str) -> type[Node]:
    """The node class that a module declares. Raises TypeError if there is none of that id."""
    for item in vars(module).values():
        if isinstance(item, type) and issubclass(item, Node) and item.__module__ == module.__name__:
            if item.id == id:
                return item
            raise TypeError(f"the class {item.__name__} makes a node '{item.id}': its file must have that name")
    raise TypeError("there is no node in this file")


class NodeImportError(ImportError):
    """A file of a node cannot be imported, or does not declare the node that its name promises."""


def import_node(module: str, id: str, folder: Path, label: str) -> type[Node]:
    """The node class of a module. Raises NodeImportError, which names the file and the line at fault.

    `folder` holds the code of the package, which messages call `label`.
    """
    try:
        return find_class(importlib.import_module(module), id)
    except (Exception, SystemExit) as fault:
        reason = fault.msg if isinstance(fault, SyntaxError) else str(fault)
        place = _locate_fault(fault, folder, label) or f"{module.removeprefix('halation.').replace('.', '/')}.py"
        raise NodeImportError(f"{place}: {type(fault).__name__}: {reason}") from fault


def _locate_fault(fault: BaseException, folder: Path, label: str) -> str:
    """The file and the line of a package at which an import failed: the last one that ran; "" if none did.

    The declarations of Halation, which check a class while it is made, are never at fault.
    """
    places = _list_places(fault)
    if isinstance(fault, SyntaxError) and fault.filename:
        places.append((fault.filename, fault.lineno))
    own_folder = Path(__file__).parent
    for name, line in reversed(places):
        path = Path(name)
        is_declaration = path.parent == own_folder or path.is_relative_to(own_folder / "_declare")
        if path.is_relative_to(folder) and not is_declaration:
            return f"{label}/{path.relative_to(folder).as_posix()}, line {line}"
    return ""


def _list_places(fault: BaseException) -> list[tuple[str, int | None]]:
    """The files and lines that ran when something failed, the innermost last."""
    places: list[tuple[str, int | None]] = []
    step = fault.__traceback__
    while step is not None:
        places.append((step.tb_frame.f_code.co_filename, step.tb_lineno))
        step = step.tb_next
    return places


def find_fault_place(fault: BaseException, node: type[Node]) -> str:
    """The file and the line of a node at which its code failed, the last one that ran; "" if none of it ran."""
    file = getattr(sys.modules.get(node.__module__), "__file__", None)
    lines = [line for name, line in _list_places(fault) if name == file]
    return f"{node.__module__.removeprefix('halation.').replace('.', '/')}.py, line {lines[-1]}" if lines else ""


def _load(point: EntryPoint) -> Plugin:
    """The plug-in of an entry point. Whatever goes wrong in its code becomes its fault."""
    plugin = Plugin(_name_package(point), point.dist.version if point.dist else "0", point.value)
    if not point.value.isidentifier():
        return plugin._replace(fault=f"its entry point names '{point.value}', which is no top-level package")
    try:
        spec = find_spec(plugin.namespace)
        if spec is None or not spec.submodule_search_locations:
            fault = f"its entry point names the package '{plugin.namespace}', which is not there"
            return plugin._replace(fault=f"{fault}: correct the entry point, or install {plugin.package} again")
        folder = next(
            (path for path in map(Path, spec.submodule_search_locations) if (path / "nodes").is_dir()),
            Path(spec.submodule_search_locations[0]),
        )
        return plugin._replace(folder=folder, nodes=_load_nodes(plugin, folder / "nodes"))
    except NodeImportError as fault:
        return plugin._replace(fault=str(fault))
    except (Exception, SystemExit) as fault:
        return plugin._replace(fault=f"{type(fault).__name__}: {fault}")


def _load_nodes(plugin: Plugin, folder: Path) -> dict[str, type[Node]]:
    files = list(list_files(folder)) if folder.is_dir() else []
    refuse_double_ids(files, f"{plugin.namespace}/nodes")
    nodes: dict[str, type[Node]] = {}
    for menu, name in files:
        module = f"{plugin.namespace}.nodes.{menu}.{name}"
        node = import_node(module, f"{plugin.namespace}.{name}", folder.parent, plugin.namespace)
        node.required_package = plugin.requirement
        nodes[node.id] = node
    return nodes


def refuse_double_ids(files: Iterable[tuple[str, str]], folder: str) -> None:
    """Raise NodeImportError if two files (menu and id) of a folder have the same id."""
    menus: dict[str, str] = {}
    for menu, id in files:
        if id in menus:
            paths = " and ".join(f"{folder}/{name}/{id}.py" for name in (menus[id], menu))
            raise NodeImportError(f"{paths} both make the node '{id}': rename one of them")
        menus[id] = menu


def _refuse_shared_ids(loaded: list[Plugin]) -> Iterator[Plugin]:
    """Refuse all plug-ins that bring a node which another one brings too: no graph could say which it means.

    They share an import name and so a folder: pip removes files of both when it uninstalls one.
    """
    counts = Counter(id for plugin in loaded for id in plugin.nodes)
    for plugin in loaded:
        shared = next((id for id in plugin.nodes if counts[id] > 1), "")
        if shared:
            rivals = " and ".join(str(rival) for rival in loaded if shared in rival.nodes)
            fault = f"{rivals} both bring a node '{shared}': uninstall both, then install one of them"
            yield plugin._replace(nodes={}, fault=fault)
        else:
            yield plugin
