"""From a Graph to the text of a document.

Only what differs from the defaults is written, in one canonical form (`canonical`): sorted keys, fixed line breaks, the
shortest numbers that read back equal. So equal graphs give equal bytes, and a diff shows only what changed. Unknown
keys that reading kept are put back into their objects.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sized
from dataclasses import fields
from functools import cached_property
from pathlib import Path
from typing import Any

from halation.nodes import ItemSet, Plain, Value

from ..custom_nodes import CustomNode
from ..errors import DocumentError, GraphError, OutputError
from ..graph import Control, Graph, Group, Input, Item, Output, Port, Settings, Unknown, find_declaration, signature
from ..graph.named_items import describe_items
from ..graph.names import find_name_fault
from ..graph.scalars import describe_scalar
from ..graph.values import coerce, describe_type
from ..resources.atomic_write import write_text_atomically
from ..resources.sandbox import Sandbox
from . import limits
from .animation import describe_animation
from .canonical import pretty, write_parts
from .code import describe_code
from .migrations import FORMAT
from .reading import loads
from .records import type_name

Section = dict[str, Any]


class LazySection(Mapping[str, Any]):
    """A section that is made when its first entry is asked for: a comparison often ends before it.

    It has as many entries as `parts`.
    """

    def __init__(self, parts: Sized, make: Callable[[], Mapping[str, Any]]) -> None:
        self._parts, self._make = parts, make

    @cached_property
    def _entries(self) -> Mapping[str, Any]:
        return self._make()

    def __len__(self) -> int:
        return len(self._parts)

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __getitem__(self, name: str) -> Any:
        return self._entries[name]


def dumps(graph: Graph) -> str:
    """The canonical text of a graph. Raises GraphError for a value that JSON cannot hold."""
    text = pretty(_document(graph))
    try:
        text.encode()
    except UnicodeEncodeError as error:
        raise GraphError(f"the graph holds {error.object[error.start]!r}, which is not valid Unicode") from None
    return text


def find_first_difference(graph: Graph, text: str) -> int | None:
    """The first line in which a text differs from the canonical one of a graph, from 1 on; None if they are equal.

    No more of the canonical text is written than that. Raises GraphError for names and values that cannot be saved.
    """
    place = 0
    for part in write_parts(_document(graph)):
        if not text.startswith(part, place):
            pairs = enumerate(zip(text[place : place + len(part)], part, strict=False))
            shared = next((count for count, (here, there) in pairs if here != there), len(text) - place)
            place += shared
            # Where one of them ends, the other has a line more.
            ends = place == len(text) and part[shared] == "\n"
            return text.count("\n", 0, place) + 1 + ends
        place += len(part)
    if place == len(text):
        return None
    return text.count("\n", 0, place) + 1 + (text[place] == "\n")


def save(graph: Graph, path: str | Path, sandbox: Sandbox) -> None:
    """Write a graph, whole or not at all: after any failure the old file is still there.

    Raises OutputError, also for a graph that could not be read again, or GraphError as `dumps` does.
    """
    write_text_atomically(Path(path), dump_readable(graph, str(path)), sandbox=sandbox)


def dump_readable(graph: Graph, file: str) -> str:
    """The canonical text of a graph for a file. Raises OutputError if it could not be read again from there.

    So it is read. Files of groups are not, since one that is missing does not keep the graph from being saved: their
    nodes are counted as they are now.
    """
    text = dumps(graph)
    fault = limits.size_fault(len(text.encode()))
    if not fault and _count_nodes(graph, {}) > limits.MAX_NODES:
        fault = limits.refuse_nodes()
    if not fault:
        try:
            loads(text, file, sandbox=None)
        except DocumentError as refusal:
            fault = ": ".join(filter(None, (refusal.path, refusal.fault)))
    if fault:
        raise OutputError(f"{file}: it is not saved, because it could not be read again: {fault}")
    return text


def _count_nodes(graph: Graph, known: dict[int, int]) -> int:
    """The nodes of a graph when all groups are expanded, as `reading` counts them; equal bodies are counted once."""
    if id(graph) not in known:
        groups = (item.graph for item in graph.nodes.values() if isinstance(item, Group))
        known[id(graph)] = len(graph.nodes) + sum(limits.GROUP_COST - 1 + _count_nodes(body, known) for body in groups)
    return known[id(graph)]


def _document(graph: Graph) -> Section:
    return {"halation": FORMAT, **_graph(graph)}


def _graph(graph: Graph) -> Section:
    """A body, without empty sections. The large ones are written only when they are read: see `LazySection`."""
    extra = graph.extra

    def entries(section: str, sections: Mapping[str, Section]) -> Section:
        return {name: {**extra.get(f"{section}.{name}", {}), **entry} for name, entry in sections.items()}

    _check_names(graph)
    sections: dict[str, Mapping[str, Any]] = {
        "settings": {**extra.get("settings", {}), **_settings(graph.settings, extra.get("settings.color", {}))},
        "inputs": entries("inputs", {name: _input(name, end) for name, end in graph.inputs.items()}),
        "outputs": entries("outputs", {name: _output(end) for name, end in graph.outputs.items()}),
        "controls": entries("controls", {name: _control(item) for name, item in graph.controls.items()}),
        "nodes": LazySection(
            graph.nodes,
            lambda: entries("nodes", {id: _item(id, item, graph) for id, item in graph.nodes.items()}),
        ),
        "links": LazySection(graph.links, lambda: {str(target): str(source) for target, source in graph.links.items()}),
        "animation": entries(
            "animation",
            {str(port): describe_animation(item, _find_value(graph, port)) for port, item in graph.animation.items()},
        ),
        "ui": graph.ui,
    }
    return {**extra.get("", {}), **{name: section for name, section in sections.items() if section}}


def _settings(settings: Settings, unknown_color: Mapping[str, Any]) -> Section:
    """The settings that differ from the defaults; `unknown_color` are unknown keys of `color`."""
    plain = Settings()
    changed = {
        field.name: current
        for field in fields(Settings)
        if (current := getattr(settings, field.name)) != getattr(plain, field.name)
    }
    color = {**unknown_color, **_fill({"config": settings.color.config, "working": settings.color.working})}
    return {**changed, "color": color} if color else changed


def _input(name: str, end: Input) -> Section:
    default = end.default
    if isinstance(default, str | bool):
        raise GraphError(f"inputs.{name}.default: {default!r} cannot be saved; set a number or a list of numbers")
    if isinstance(default, tuple):
        default = tuple(float(part) for part in default)
    elif default is not None:
        default = float(default)
    facts = {
        "file": end.file,
        "layer": end.layer,
        "doc": end.doc,
        "missing": end.missing if end.missing != "error" else "",
        "color_space": end.color_space,
    }
    return {"type": type_name(end.kind, end.width)} | _fill(facts) | ({} if default is None else {"default": default})


def _output(end: Output) -> Section:
    facts = {"type": type_name(end.kind, end.width)} | _fill({"layer": end.layer, "view": end.view})
    return facts | ({"overscan": True} if end.overscan else {})


def _control(item: Control) -> Section:
    return {"target": str(item.target)} | _fill({"label": item.label, "doc": item.doc})


def _fill(texts: Mapping[str, str]) -> Section:
    return {name: text for name, text in texts.items() if text}


def _item(id: str, item: Item, graph: Graph) -> Section:
    """A node as JSON: what differs from the defaults, and what a newer version may have written.

    Values that are the default object itself are left out before they are converted: most are, and a file may have
    100,000 nodes.
    """
    muted = {"muted": True} if id in graph.muted else {}
    unknown_values = graph.extra.get(f"nodes.{id}.values", {})
    if isinstance(item, Unknown):
        return {**item.raw, **muted, "type": item.type}
    if isinstance(item, Group):
        body = {"path": item.path} if item.path else {"graph": _graph(item.graph)}
        declared = signature(item).values
        converted = {
            name: describe_scalar(declared[name], _value(id, declared[name], plain))
            for name, plain in item.values.items()
            if name in declared
        }
        values = {**unknown_values, **item.values, **converted, **_describe_items(id, graph, declared, item.values)}
        return {"type": "group"} | body | muted | ({"values": values} if values else {})
    settings, units = item.settings, dict(item.length_units)
    set_values = {
        name: _value(id, value, settings[name])
        for name, value in item.values.items()
        if settings[name] is not value.default or name in units or value.items
    }
    changed = {name: plain for name, plain in set_values.items() if name in units or plain != item.values[name].default}
    values = {**unknown_values, **changed}
    if item.item_values:
        values |= _describe_items(id, graph, item.values, set_values)
    type_facts = describe_code(item.code) if isinstance(item, CustomNode) else {"version": item.version}
    if item.required_package:
        type_facts["package"] = graph.extra.get(f"nodes.{id}", {}).get("package", item.required_package)
    unit_facts = {"units": units} if units else {}
    return {"type": item.id} | type_facts | muted | ({"values": values} if values else {}) | unit_facts


def _find_value(graph: Graph, port: Port) -> Value | None:
    """The declaration of an animated value; None if there is none, as for a node whose package is missing."""
    item = graph.nodes.get(port.node)
    return None if item is None else find_declaration(item, port.socket)


def _describe_items(id: str, graph: Graph, declared: Mapping[str, Value], values: Mapping[str, Plain]) -> Section:
    """Values with named items as a file holds them, also at their default: so each field differs on its own."""
    sections: Section = {}
    for name, items in values.items():
        kinds = declared[name].items if name in declared else None
        if isinstance(items, ItemSet) and kinds:
            path = f"nodes.{id}.values.{name}"
            objects = describe_items(kinds, items)
            kept = {key: graph.extra.get(f"{path}.{key}", {}) for key in objects}
            sections[name] = {**graph.extra.get(path, {}), **{key: {**kept[key], **objects[key]} for key in objects}}
    return sections


def _value(id: str, value: Value, setting: object) -> Plain:
    plain = coerce(value, setting)
    if plain is None:
        raise GraphError(f"nodes.{id}.values.{value.name}: {setting!r} cannot be saved; set {describe_type(value)}")
    return plain


def _check_names(graph: Graph) -> None:
    """Refuse values that could not be read again."""
    sections = {"input": graph.inputs, "output": graph.outputs, "control": graph.controls, "node": graph.nodes}
    for end_kind, section in sections.items():
        if fault := find_name_fault(section, end_kind):
            raise GraphError(fault)
