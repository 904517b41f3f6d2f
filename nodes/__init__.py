"""What Halation can do: one class per file, found by walking the folders."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Mapping
from functools import cache
from types import MappingProxyType

from . import _declare
from ._declare import *  # noqa: F403  (the vocabulary: `_declare.__all__` names it)
from ._declare import Node

__all__ = ["catalogue"]
__all__ += _declare.__all__


@cache
def catalogue() -> Mapping[str, type[Node]]:
    """Every node class by id, in the order of the menu: folder, then file."""
    found: dict[str, type[Node]] = {}
    for folder in sorted(pkgutil.iter_modules(__path__), key=lambda item: item.name):  # noqa: F405
        if not folder.ispkg or folder.name.startswith("_"):
            continue
        package = importlib.import_module(f".{folder.name}", __package__)
        for module in sorted(pkgutil.iter_modules(package.__path__), key=lambda item: item.name):
            if module.name.startswith("_"):
                continue
            loaded = importlib.import_module(f".{folder.name}.{module.name}", __package__)
            for item in vars(loaded).values():
                if isinstance(item, type) and issubclass(item, Node) and item.__module__ == loaded.__name__:
                    found[item.id] = item
    return MappingProxyType(found)
