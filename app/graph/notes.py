"""What a graph keeps beside its logic: the layout in `ui["nodes"]` and unknown keys in `extra`."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, TypeVar, cast

T = TypeVar("T")
K = TypeVar("K")


def without(known: Mapping[K, T], key: K) -> dict[K, T]:
    """The mapping without one entry."""
    return {name: item for name, item in known.items() if name != key}


def renamed(known: Mapping[K, T], old: K, new: K) -> dict[K, T]:
    """The mapping with one key changed, in the same order."""
    return {new if name == old else name: item for name, item in known.items()}


def moved_layout(ui: Mapping[str, Any], old: str, new: str = "") -> Mapping[str, Any]:
    """`ui` after a node was renamed, or removed if `new` is empty."""
    places = ui.get("nodes")
    if not isinstance(places, Mapping) or old not in places:
        return ui
    known = cast("Mapping[str, Any]", places)
    kept = without(known, old) | ({new: known[old]} if new else {})
    return MappingProxyType({**ui, "nodes": MappingProxyType(kept)})


def moved_keys(extra: Mapping[str, Mapping[str, Any]], old: str, new: str = "") -> dict[str, Mapping[str, Any]]:
    """`extra` after the object at JSON path `old` was moved to `new`, or removed if that is empty."""
    inside = {path for path in extra if path == old or path.startswith(f"{old}.")}
    kept = {path: keys for path, keys in extra.items() if path not in inside}
    return kept | ({new + path.removeprefix(old): extra[path] for path in inside} if new else {})
