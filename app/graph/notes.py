"""Edits of what does not change the pictures of a graph: its layout (`ui`) and its unknown keys (`extra`)."""

from __future__ import annotations

from collections.abc import Container, Mapping
from types import MappingProxyType
from typing import Any, TypeVar, cast

T = TypeVar("T")
K = TypeVar("K")


def without(mapping: Mapping[K, T], key: K) -> dict[K, T]:
    """The mapping without one entry."""
    return {name: item for name, item in mapping.items() if name != key}


def rename_key(mapping: Mapping[K, T], old: K, new: K) -> dict[K, T]:
    """The mapping with one key changed, in the same order."""
    return {new if name == old else name: item for name, item in mapping.items()}


def move_layout(ui: Mapping[str, Any], old: str, new: str = "") -> Mapping[str, Any]:
    """The layout after a node, input or output is renamed, or removed if `new` is empty.

    Inputs and outputs have names such as `inputs.beauty`, as in `ui["nodes"]`.
    """

    def move_name(name: str) -> str:
        inside = name == old or name.startswith(f"{old}.")
        return new and new + name.removeprefix(old) if inside else name

    def move_section(section: str) -> dict[str, Any]:
        return {there: entry for name, entry in _section(ui, section).items() if (there := move_name(name))}

    viewers = _section(ui, "viewers").items()
    ports = {number: move_name(port) if isinstance(port, str) else port for number, port in viewers}
    viewer_ports = {number: port for number, port in ports.items() if port != ""}
    return _replace_sections(
        ui, {"nodes": move_section("nodes"), "routes": move_section("routes"), "viewers": viewer_ports}
    )


def keep_linked_routes(ui: Mapping[str, Any], links: Container[str]) -> Mapping[str, Any]:
    """The layout without the routes of links that no longer exist."""
    routes = _section(ui, "routes")
    return _replace_sections(ui, {"routes": {target: dots for target, dots in routes.items() if target in links}})


def without_route(ui: Mapping[str, Any], target: str) -> Mapping[str, Any]:
    """The layout without the route of the link to `target`."""
    return _replace_sections(ui, {"routes": without(_section(ui, "routes"), target)})


def move_keys(extra: Mapping[str, Mapping[str, Any]], old: str, new: str = "") -> dict[str, Mapping[str, Any]]:
    """The unknown keys after the object at JSON path `old` is moved to `new`, or removed if that is empty."""
    inside = {path for path in extra if path == old or path.startswith(f"{old}.")}
    other_keys = {path: keys for path, keys in extra.items() if path not in inside}
    return other_keys | ({new + path.removeprefix(old): extra[path] for path in inside} if new else {})


def keys_of_nodes(extra: Mapping[str, Mapping[str, Any]], ids: Container[str]) -> dict[str, Mapping[str, Any]]:
    """The part of `extra` that belongs to some nodes."""
    return {path: keys for path, keys in extra.items() if path.startswith("nodes.") and path.split(".", 2)[1] in ids}


def _section(ui: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    section = ui.get(name)
    return cast("Mapping[str, Any]", section) if isinstance(section, Mapping) else {}


def _replace_sections(ui: Mapping[str, Any], changed: Mapping[str, Mapping[str, Any]]) -> Mapping[str, Any]:
    """The layout with other sections; empty ones are removed, and ones that are not JSON objects stay."""
    before = {name: _section(ui, name) for name in changed}
    if before == changed:
        return ui
    different = {name: entries for name, entries in changed.items() if entries != before[name]}
    new_sections = {name: MappingProxyType(dict(entries)) for name, entries in different.items() if entries}
    return MappingProxyType({**{name: part for name, part in ui.items() if name not in different}, **new_sections})
