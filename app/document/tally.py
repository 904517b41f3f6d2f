"""Counts the parts of a document that take longer to read than their text suggests, and refuses too many of them."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, cast, get_args

import msgspec
from halation.nodes import Value
from msgspec import Struct, field

from ..custom_nodes import Language
from ..graph.names import INPUTS, OUTPUTS
from ..graph.walk import describe_loop, find_loops, has_loops
from . import limits
from .records import GraphRecord, NodeRecord

_WORD = re.compile(r"[\w.]+|[^\w\s]")
"""A name, a number or a sign: what an expression is read by."""

_NAMING = frozenset({"group", *get_args(Language)})
"""Types of nodes that may be in a file of their own."""
_KEY_PARTS = 4
"""Parts of a key besides its value: the object, two entries and what separates it from the next."""

Fault = tuple[str, str]
"""The place of a part in its body, and a sentence about it."""


class PartTally(Struct):
    """The parts of a graph and of all groups in its file so far."""

    ends: int = 0
    links: int = 0
    keys: int = 0
    words: int = 0
    layout: int = 0
    unknown_nodes: int = 0
    unknown_keys: int = 0
    kept: int = 0
    texts: int = 0
    letters: int = 0
    files: int = 0
    items: int = 0
    numbers: int = 0
    units: int = 0
    formulas: set[str] = field(default_factory=set[str])

    def add(self, record: GraphRecord, is_known: Callable[[str], bool]) -> Fault | None:
        """Count the parts of a body, in which nodes of types that are not known are kept as they are.

        Returns the first fault, or None.
        """
        return next(self._find_faults(record, is_known), None)

    def _find_faults(self, record: GraphRecord, is_known: Callable[[str], bool]) -> Iterator[Fault]:
        for section, entries in (("inputs", record.inputs), ("outputs", record.outputs), ("controls", record.controls)):
            self.ends += len(entries)
            if len(entries) > limits.MAX_ENDS:
                yield section, _refuse(limits.MAX_ENDS, section, "there")
            if self.ends > limits.MAX_ALL_ENDS:
                yield section, _refuse(limits.MAX_ALL_ENDS, "inputs, outputs and controls", "in all groups together")
        self.links += len(record.links)
        if self.links > limits.MAX_LINKS:
            yield "links", _refuse(limits.MAX_LINKS, "links", "in all groups together")
        self.files += sum(bool(_get(end, "file")) for end in record.inputs.values())
        yield from self._find_animation_faults(record)
        self.layout += count_parts(record.ui)
        if self.layout > limits.MAX_LAYOUT:
            yield "ui", _refuse(limits.MAX_LAYOUT, "parts of the layout", "in all groups together")
        allowed = record.settings.get("allow")
        if isinstance(allowed, dict) and len(cast("Mapping[str, Any]", allowed)) > limits.MAX_ALLOWED:
            yield "settings.allow", _refuse(limits.MAX_ALLOWED, "entries", "there")
        yield from self._find_odd_nodes(record, is_known)
        yield from _find_odd_links(record)

    def _find_odd_nodes(self, record: GraphRecord, is_known: Callable[[str], bool]) -> Iterator[Fault]:
        """Too many nodes of types that nobody knows, or that name files."""
        types = Counter(type for node in record.nodes.values() if isinstance(type := _get(node, "type"), str))
        unknown = {type: count for type, count in types.items() if not is_known(type)}
        self.unknown_nodes += sum(unknown.values())
        if self.unknown_nodes > limits.MAX_ODD:
            yield "nodes", _refuse(limits.MAX_ODD, "nodes of types that are not installed", "in all groups together")
        if not _NAMING.isdisjoint(types):
            self.files += sum(bool(_get(node, "file") or _get(node, "path")) for node in record.nodes.values())
        if self.files > limits.MAX_FILES:
            yield "nodes", _refuse(limits.MAX_FILES, "names of files", "in all nodes together")

    def _find_animation_faults(self, record: GraphRecord) -> Iterator[Fault]:
        for entry in record.animation.values():
            if isinstance(entry, dict):
                self._add_animation(cast("Mapping[str, Any]", entry))
            if self.keys > limits.MAX_KEYS:
                yield "animation", _refuse(limits.MAX_KEYS, "keys", "of all values together")
            if self.numbers > limits.MAX_NUMBERS:
                yield "animation", _refuse(limits.MAX_NUMBERS, "numbers", "in values and keys together")
            if self.words > limits.MAX_WORDS:
                yield "animation", _refuse(limits.MAX_WORDS, "words and signs", "in all expressions together")

    def _add_animation(self, entry: Mapping[str, Any]) -> None:
        keys, text = entry.get("keys"), entry.get("expression")
        if isinstance(keys, list):
            count = len(cast("list[object]", keys))
            self.keys += max(count, limits.LEAST_KEYS)
            self.numbers += max(count_parts(cast("list[object]", keys)) - _KEY_PARTS * count, 0)
        if isinstance(text, str) and len(text) <= limits.MAX_FORMULA:
            words = text.count(".") if text in self.formulas else len(_WORD.findall(text))
            self.words += max(words, limits.LEAST_WORDS)
            self.formulas.add(text)

    def add_values(self, declared: Mapping[str, Value], record: NodeRecord) -> Fault | None:
        """Count texts, files, named items and numbers among the values of a node. Returns a fault, or None.

        They may have wrong types: it is asked before they are converted, which takes longer.
        """
        if not record.units and not any(map(_is_counted, record.values.values())):
            return None
        for name, setting in record.values.items():
            if isinstance(setting, dict | list):
                self.numbers += count_parts(cast("Any", setting))
                self.items += len(cast("Any", setting)) if isinstance(setting, dict) else 0
            elif isinstance(setting, str) and setting and name in declared:
                self.files += declared[name].type == "path"
                is_text = declared[name].type == "text"
                self.texts, self.letters = self.texts + is_text, self.letters + is_text * len(setting)
        self.units += bool(record.units)
        for count, most, parts in (
            (self.items, limits.MAX_ITEMS, "named items"),
            (self.numbers, limits.MAX_NUMBERS, "numbers"),
            (self.files, limits.MAX_FILES, "names of files"),
            (self.texts, limits.MAX_TEXTS, "texts"),
            (self.letters, limits.MAX_LETTERS, "letters of text"),
            (self.units, limits.MAX_UNITS, "nodes with units of their own"),
        ):
            if count > most:
                return "values", _refuse(most, parts, "in all nodes together")
        return None

    def keep(self, keys: Mapping[str, Any], *, is_node: bool = False) -> str | None:
        """Count what nobody knows and is kept: keys, or a node. Returns why it is refused, or None."""
        self.unknown_keys += 0 if is_node else len(keys)
        self.kept += count_parts(keys)
        if self.unknown_keys > limits.MAX_ODD:
            return _refuse(limits.MAX_ODD, "keys that mean nothing to this version", "in the file")
        if self.kept > limits.MAX_KEPT:
            return _refuse(limits.MAX_KEPT, "parts that mean nothing to this version", "in the file")
        return None


def count_parts(tree: Mapping[str, Any] | Sequence[Any]) -> int:
    """Objects, lists and their entries in a tree of JSON, as `syntax` counts those of a text: without a walk."""
    text = msgspec.json.encode(tree)
    if b"\\" in text:
        text = text.replace(b"\\\\", b"").replace(b'\\"', b"")
    outline = b"".join(text.split(b'"')[::2])
    return outline.count(b",") + outline.count(b"[") + outline.count(b"{")


def _find_odd_links(record: GraphRecord) -> Iterator[Fault]:
    """Too many links from or to nodes that are not there, or a loop among so many nodes.

    A graph with few of them is read, so that it can be repaired.
    """
    nodes = record.nodes
    if len(record.links) <= limits.MAX_ODD:
        return
    starts, ends = nodes.keys() | {INPUTS}, nodes.keys() | {OUTPUTS}
    feeding = dict[str, list[str]]()
    odd = list[str]()
    for target, source in record.links.items():
        end, start = target.partition(".")[0], source.partition(".")[0] if isinstance(source, str) else ""
        if start in starts and end in ends:
            feeding.setdefault(end, []).append(start)
        else:
            odd.append(target)
    if len(odd) > limits.MAX_ODD:
        yield (
            f"links.{odd[0][:40]}",
            _refuse(limits.MAX_ODD, "links from or to nodes that are not there", "from here on"),
        )
    if has_loops(feeding):
        loop = find_loops(feeding, 1)[0]
        yield f"nodes.{loop[0]}", f"in a graph of more than {limits.MAX_ODD:,} links, {describe_loop(loop)}"


def _get(node: object, key: str) -> object:
    return cast("Mapping[str, object]", node).get(key) if isinstance(node, dict) else None


def _is_counted(setting: object) -> bool:
    """False for a number: there is nothing to count of it."""
    return isinstance(setting, (dict, list, str))


def _refuse(most: int, parts: str, where: str) -> str:
    return f"{where} are more than {most:,} {parts}; that is no graph"
