"""Finds the conflicts of a merge that are not resolved yet.

A merged file lists them under the key `conflicts`, which a graph keeps among its unknown keys.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any, cast

CONFLICTS = "conflicts"
_SHOWN_CHARACTERS = 40
"""How much of a value a message repeats."""


def find_unmerged(extra: Mapping[str, Mapping[str, Any]]) -> Iterator[tuple[str, str, str, str]]:
    """Node, socket, sentence and JSON path of every conflict among the unknown keys of a graph.

    The node is a path through groups.
    """
    section: object = extra.get("", {}).get(CONFLICTS, ())
    entries = cast("tuple[object, ...]", section) if isinstance(section, tuple) else (section,)
    for entry in entries:
        conflict = cast("Mapping[str, object]", entry if isinstance(entry, Mapping) else {})
        at = conflict.get("at")
        keys = tuple(map(str, cast("tuple[object, ...]", at))) if isinstance(at, tuple) else ()
        if not keys:
            yield "", "", f"'{CONFLICTS}' marks an unfinished merge, but does not say where: remove it", CONFLICTS
            return
        sides = ", ".join(f"{side} {_describe_side(conflict, side)}" for side in ("ours", "theirs"))
        path = ".".join(keys)
        sentence = f"{path} was changed by both sides of a merge ({sides}): choose with halation merge --resolve"
        yield *_find_socket(keys), sentence, path


def _describe_side(entry: Mapping[str, object], side: str) -> str:
    """What one side has at the place of a conflict, if that is short."""
    if side not in entry:
        return "has none"
    part = entry[side]
    if isinstance(part, Mapping):
        return "has one"
    words = json.dumps(part, ensure_ascii=False, default=dict)
    return f"has {words}" if len(words) <= _SHOWN_CHARACTERS else "has another"


def _find_socket(keys: tuple[str, ...]) -> tuple[str, str]:
    """The node and the socket that a path of keys belongs to."""
    groups: list[str] = []
    while len(keys) > 3 and keys[0] == "nodes" and keys[2] == "graph":
        groups.append(keys[1])
        keys = keys[3:]
    section, name = (*keys, "")[:2]
    if section in ("links", "animation"):
        node, _, socket = name.partition(".")
    elif section == "nodes":
        node, socket = name, keys[3] if len(keys) > 3 and keys[2] == "values" else ""
    elif section in ("inputs", "outputs", "controls"):
        node, socket = section, name
    else:
        node, socket = "", ""
    return "/".join([*groups, node] if node else groups), socket
