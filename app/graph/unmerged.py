"""What a merge of two versions left to be decided, for those who look for problems.

Such a document says it under the key `conflicts`, which a graph keeps as one that means nothing to it.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any, cast

CONFLICTS = "conflicts"
_LONG = 40


def find_unmerged(extra: Mapping[str, Mapping[str, Any]]) -> Iterator[tuple[str, str, str, str]]:
    """Node, socket, sentence and JSON path of every conflict, given what a graph keeps.

    The node is a path through groups.
    """
    found: object = extra.get("", {}).get(CONFLICTS, ())
    entries = cast("tuple[object, ...]", found) if isinstance(found, tuple) else (found,)
    for entry in entries:
        known = cast("Mapping[str, object]", entry if isinstance(entry, Mapping) else {})
        at = known.get("at")
        keys = tuple(map(str, cast("tuple[object, ...]", at))) if isinstance(at, tuple) else ()
        if not keys:
            yield "", "", f"'{CONFLICTS}' marks an unfinished merge, but does not say where: remove it", CONFLICTS
            return
        sides = ", ".join(f"{side} {_said(known, side)}" for side in ("ours", "theirs"))
        path = ".".join(keys)
        sentence = f"{path} was changed by both sides of a merge ({sides}): choose with halation merge --resolve"
        yield *_place(keys), sentence, path


def _said(entry: Mapping[str, object], side: str) -> str:
    """What a side has there, where that is short enough to be read."""
    if side not in entry:
        return "has none"
    part = entry[side]
    if isinstance(part, Mapping):
        return "has one"
    words = json.dumps(part, ensure_ascii=False, default=dict)
    return f"has {words}" if len(words) <= _LONG else "has another"


def _place(keys: tuple[str, ...]) -> tuple[str, str]:
    """Node and socket that an address belongs to."""
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
