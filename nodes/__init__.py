"""What Halation can do: one class per file, found by walking the folders, and the nodes of installed plug-ins."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache, cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _declare
from ._declare import *  # noqa: F403  (the vocabulary: `_declare.__all__` names it)
from ._declare import Node
from ._plugins import (
    NodeImportError,
    Plugin,
    find_fault_place,
    import_node,
    list_files,
    plugins,
    refuse_double_ids,
)

if TYPE_CHECKING:
    from ._declare.item_kinds import *  # noqa: F403

__all__ = [
    "NodeImportError",
    "Plugin",
    "built_in_nodes",
    "catalogue",
    "find_fault_place",
    "plugins",
    "reload_catalogue",
]
__all__ += _declare.__all__


class BuiltInNodes(Mapping[str, type[Node]]):
    """The node classes of this package by id, in the order of the menu: folder, then file.

    The names of the files say which there are; a file is loaded when its class is asked for.
    """

    def __init__(self) -> None:
        self._loaded: dict[str, type[Node]] = {}

    @cached_property
    def menus(self) -> dict[str, str]:
        """The menu of every node."""
        files = list(list_files(Path(__file__).parent))
        refuse_double_ids(files, "nodes")
        return {id: menu for menu, id in files}

    def __getitem__(self, id: str) -> type[Node]:
        if id not in self._loaded:
            module = f"{__package__}.{self.menus[id]}.{id}"
            self._loaded[id] = import_node(module, id, Path(__file__).parent, "nodes")
        return self._loaded[id]

    def __iter__(self) -> Iterator[str]:
        return iter(self.menus)

    def __len__(self) -> int:
        return len(self.menus)

    def __contains__(self, id: object) -> bool:
        return id in self.menus


class Catalogue(Mapping[str, type[Node]]):
    """The built-in node classes, then those of plug-ins; in every menu the built-in ones come first.

    An id without a namespace never makes it look for plug-ins.
    """

    def __init__(self, built_in: BuiltInNodes) -> None:
        self._built_in = built_in

    @cached_property
    def _added(self) -> dict[str, type[Node]]:
        return {id: node for plugin in plugins() for id, node in plugin.nodes.items()}

    @cached_property
    def _ids(self) -> tuple[str, ...]:
        if not self._added:
            return tuple(self._built_in)
        menus = self._built_in.menus | {id: node.category for id, node in self._added.items()}
        return tuple(sorted(menus, key=lambda id: (menus[id], "." in id)))

    def __getitem__(self, id: str) -> type[Node]:
        return self._added[id] if "." in id else self._built_in[id]

    def __iter__(self) -> Iterator[str]:
        return iter(self._ids)

    def __len__(self) -> int:
        return len(self._ids)

    def __contains__(self, id: object) -> bool:
        return id in (self._added if isinstance(id, str) and "." in id else self._built_in)


@cache
def built_in_nodes() -> BuiltInNodes:
    """Every node class of Halation itself by id, in the order of the menu: folder, then file."""
    return BuiltInNodes()


@cache
def catalogue() -> Mapping[str, type[Node]]:
    """Every node class by id, plug-ins included, in the order of the menu."""
    return Catalogue(built_in_nodes())


def reload_catalogue() -> Mapping[str, type[Node]]:
    """The same of the modules as they are now."""
    built_in_nodes.cache_clear()
    catalogue.cache_clear()
    dict(built_in_nodes())
    return catalogue()


def __getattr__(name: str) -> Any:
    """What `_declare` loads when it is asked for: kinds of named items."""
    return getattr(_declare, name)
