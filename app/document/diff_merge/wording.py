"""Parts of a document as texts for users: numbers with their units, keys with their frames."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, Final, cast

from halation.nodes import Value

from ...graph import Graph, Group, find_declaration
from .parts import ABSENT, PartPath, Tree, is_list, is_tree, to_document

_PLAIN: Final = ("ratio", "count")
"""Units that are not written after a number."""

_LONG = 8
"""The longest list of numbers that is written out: what fits into a line of a terminal, a choice."""

_WIDE = 60
"""Columns that any other text may take, a choice for terminals of 80 columns or more."""


def item_text(node: Tree) -> str:
    """A node in words: its type. Other lines list its values."""
    muted = ", muted" if node.get("muted") else ""
    if node.get("type") != "group":
        return f"{node.get('type')}{muted}"
    if "path" in node:
        return f"group {node['path']}{muted}"
    count = len(node["graph"].get("nodes", {})) if is_tree(node.get("graph")) else 0
    return f"group of {count} node{'' if count == 1 else 's'}{muted}"


def end_text(end: Tree, exact: bool = False) -> str:
    """An input, output or control: its type or target, and what else is set."""
    rest = [
        f"{name} {value_text(part, None, exact)}"
        for name, part in sorted(end.items())
        if name not in ("type", "target")
    ]
    return ", ".join([str(end.get("type") or end.get("target")), *rest])


def animation_text(item: Tree, value: Value | None, exact: bool = False) -> str:
    """Keys as `value at frame`, or an expression."""
    if "expression" in item:
        return f"= {item['expression']}"
    keys = [f"{key_text(key, value, exact)} at {frame:g}" for frame, key in sorted(item.get("keys", {}).items())]
    outside = [f"outside {item['outside']}"] if "outside" in item else []
    return _shorten(", ".join([*keys, *outside]), exact)


def key_text(key: Tree, value: Value | None, exact: bool = False) -> str:
    """The value of a key and its interpolation."""
    way = key.get("interpolation", "smooth")
    handles = [f" {side} {value_text(key[side], None, exact)}" for side in ("left", "right") if side in key]
    return value_text(key.get("value"), value, exact) + ("" if way == "smooth" else f" {way}") + "".join(handles)


def change_text(before: Any, after: Any, value: Value | None = None, exact: bool = False) -> str:
    """`old -> new`, with as many digits as are needed to see the difference."""
    text_before, text_after = value_text(before, value, exact), value_text(after, value, exact)
    return (
        f"{text_before} -> {text_after}"
        if text_before != text_after or exact
        else change_text(before, after, value, True)
    )


def value_text(part: Any, value: Value | None = None, exact: bool = False) -> str:
    """A value with its unit; one that is absent is the default."""
    if part is ABSENT:
        return "not set" if value is None else f"{value_text(value.default, value, exact)} (default)"
    if isinstance(part, Mapping) and value and value.items and not exact:
        return _shorten(", ".join(cast("Mapping[str, object]", part)))
    unit = f" {value.unit}" if value and value.unit and value.unit not in _PLAIN else ""
    if isinstance(part, bool) or part is None:
        return json.dumps(part)
    if isinstance(part, int | float):
        return (repr(part).removesuffix(".0") if exact else f"{part:.6g}") + unit
    if isinstance(part, tuple):
        return value_text(list(part), value, exact)  # pyright: ignore[reportUnknownArgumentType]
    if is_list(part) and all(isinstance(number, int | float) and not isinstance(number, bool) for number in part):
        if len(part) > _LONG and not exact:
            return f"{len(part)} numbers"
        return f"({', '.join(value_text(number, None, exact) for number in part)}){unit}"
    return _shorten(json.dumps(to_document(part), ensure_ascii=False), exact)


def value_at(graph: Graph, at: PartPath) -> Value | None:
    """The declaration of the value at an address, through groups; None if it is not a value."""
    while len(at) > 3 and at[0] == "nodes" and at[2] == "graph":
        item = graph.nodes.get(str(at[1]))
        if not isinstance(item, Group):
            return None
        graph, at = item.graph, at[3:]
    if len(at) >= 4 and at[0] == "nodes" and at[2] == "values":
        node, name = str(at[1]), ".".join(map(str, at[3:]))
    elif len(at) >= 2 and at[0] == "animation":
        node, _, name = str(at[1]).partition(".")
    else:
        return None
    item = graph.nodes.get(node)
    return None if item is None else find_declaration(item, name)


def _shorten(words: str, whole: bool = False) -> str:
    return words if whole or len(words) <= _WIDE else f"{words[: _WIDE - 1]}…"
