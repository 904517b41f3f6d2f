"""What a graph keeps beside its logic: the layout in `ui` and unknown keys in `extra`."""

from __future__ import annotations

from collections.abc import Container, Mapping
from types import MappingProxyType
from typing import Any, TypeVar, cast

T = TypeVar("T")
K = TypeVar("K")


def without(known: Mapping[K, T], key: K) -> dict[K, T]:
    """The mapping without one entry."""
    return {name: item for name, item in known.items() if name != key}


def rename_key(known: Mapping[K, T], old: K, new: K) -> dict[K, T]:
    """The mapping with one key changed, in the same order."""
    return {new if name == old else name: item for name, item in known.items()}


def move_layout(ui: Mapping[str, Any], old: str, new: str = "") -> Mapping[str, Any]:
    """`ui` after a node or end of the graph was renamed, or removed if `new` is empty.

    Ends are called as `ui["nodes"]` does: `inputs.beauty`.
    """

    def moved(name: str) -> str:
        inside = name == old or name.startswith(f"{old}.")
        return new and new + name.removeprefix(old) if inside else name

    def keys(section: str) -> dict[str, Any]:
        return {there: entry for name, entry in _section(ui, section).items() if (there := moved(name))}

    viewers = _section(ui, "viewers").items()
    ports = {number: moved(port) if isinstance(port, str) else port for number, port in viewers}
    shown = {number: port for number, port in ports.items() if port != ""}
    return _with_sections(ui, {"nodes": keys("nodes"), "routes": keys("routes"), "viewers": shown})


def keep_linked_routes(ui: Mapping[str, Any], links: Container[str]) -> Mapping[str, Any]:
    """`ui` without the routes of links that are no more."""
    routes = _section(ui, "routes")
    return _with_sections(ui, {"routes": {target: dots for target, dots in routes.items() if target in links}})


def without_route(ui: Mapping[str, Any], target: str) -> Mapping[str, Any]:
    """`ui` after the link to `target` was drawn anew: it is straight."""
    return _with_sections(ui, {"routes": without(_section(ui, "routes"), target)})


def move_keys(extra: Mapping[str, Mapping[str, Any]], old: str, new: str = "") -> dict[str, Mapping[str, Any]]:
    """`extra` after the object at JSON path `old` was moved to `new`, or removed if that is empty."""
    inside = {path for path in extra if path == old or path.startswith(f"{old}.")}
    kept = {path: keys for path, keys in extra.items() if path not in inside}
    return kept | ({new + path.removeprefix(old): extra[path] for path in inside} if new else {})


def _section(ui: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    found = ui.get(name)
    return cast("Mapping[str, Any]", found) if isinstance(found, Mapping) else {}


def _with_sections(ui: Mapping[str, Any], changed: Mapping[str, Mapping[str, Any]]) -> Mapping[str, Any]:
    """`ui` with other sections; one that became empty goes, one that was no object stays."""
    before = {name: _section(ui, name) for name in changed}
    if before == changed:
        return ui
    different = {name: entries for name, entries in changed.items() if entries != before[name]}
    kept = {name: MappingProxyType(dict(entries)) for name, entries in different.items() if entries}
    return MappingProxyType({**{name: part for name, part in ui.items() if name not in different}, **kept})
