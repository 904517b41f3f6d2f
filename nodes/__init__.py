"""What Halation can do: one class per file, found by walking the folders."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterator, Mapping
from functools import cache

from . import _declare
from ._declare import *  # noqa: F403  (the vocabulary: `_declare.__all__` names it)
from ._declare import Node

__all__ = ["catalogue"]
__all__ += _declare.__all__


class Catalogue(Mapping[str, type[Node]]):
    """Every node class by id, in the order of the menu: folder, then file.

    The names of the files say which there are; a file is loaded when its class is asked for.
    """

    def __init__(self) -> None:
        self._modules = {name: f".{folder}.{name}" for folder in _folders() for name in _files(folder)}
        self._found: dict[str, type[Node]] = {}

    def __getitem__(self, id: str) -> type[Node]:
        if id not in self._found:
            self._found[id] = self._load(id)
        return self._found[id]

    def __iter__(self) -> Iterator[str]:
        return iter(self._modules)

    def __len__(self) -> int:
        return len(self._modules)

    def __contains__(self, id: object) -> bool:
        return id in self._modules

    def _load(self, id: str) -> type[Node]:
        loaded = importlib.import_module(self._modules[id], __package__)
        for item in vars(loaded).values():
            if isinstance(item, type) and issubclass(item, Node) and item.__module__ == loaded.__name__:
                if item.id == id:
                    return item
                raise TypeError(f"the class {item.__name__} makes a node '{item.id}': its file must have that name")
        raise TypeError("there is no node in this file")


@cache
def catalogue() -> Mapping[str, type[Node]]:
    """Every node class by id, in the order of the menu: folder, then file."""
    return Catalogue()


def _folders() -> list[str]:
    """The packages of nodes."""
    found = pkgutil.iter_modules(importlib.import_module(__name__).__path__)
    return sorted(item.name for item in found if item.ispkg and not item.name.startswith("_"))


def _files(folder: str) -> list[str]:
    """The nodes of a package."""
    package = importlib.import_module(f".{folder}", __package__)
    return sorted(item.name for item in pkgutil.iter_modules(package.__path__) if not item.name.startswith("_"))
