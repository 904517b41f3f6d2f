"""What Halation can do: one class per file, found by walking the folders."""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping
from functools import cache, cached_property
from pathlib import Path

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
        self._found: dict[str, type[Node]] = {}

    @cached_property
    def _modules(self) -> dict[str, str]:
        return {name: f".{folder.name}.{name}" for folder in _folders() for name in _files(folder)}

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


def _folders() -> list[Path]:
    """The packages of nodes, without loading any."""
    found = Path(__file__).parent.iterdir()
    return sorted(item for item in found if "." not in item.name and not item.name.startswith("_"))


def _files(folder: Path) -> list[str]:
    """The nodes of a package."""
    names = [item.name for item in folder.iterdir()]
    return sorted(name.removesuffix(".py") for name in names if name.endswith(".py") and not name.startswith("_"))
