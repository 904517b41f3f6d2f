"""The parts of a document by name: each can differ, and be merged, on its own.

A part is addressed by the keys that lead to it. A key of an animation is addressed by its frame, not by its place in
the list; a conflict of an unfinished merge by the part that it is about.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from enum import Enum
from typing import Any, Final, TypeGuard

from ...graph import Graph
from ..canonical import pretty
from ..migrations import FORMAT
from ..writing import dumps

PartPath = tuple[str | float, ...]
"""Where a part is: ("nodes", "bloom", "values", "sigma"), or ("animation", "bloom.sigma", "keys", 12)."""

Tree = dict[Any, Any]

CONFLICTS = "conflicts"
"""The key of a document that holds the conflicts of an unfinished merge."""

_SECTIONS: Final = ("settings", "inputs", "outputs", "controls", "nodes", "links", "animation", CONFLICTS)
_BODIES: Final = ("graph", "path", "code", "file")


class AbsentPart(Enum):
    """Stands for a part that does not exist; None stands for the null of JSON."""

    ABSENT = "absent"


ABSENT: Final = AbsentPart.ABSENT


class _KeyedList(dict[Any, Any]):
    """A list of a document as an object, by what identifies its entries."""


def is_tree(item: Any) -> TypeGuard[Tree]:
    """True for a JSON object."""
    return isinstance(item, dict)


def is_list(item: Any) -> TypeGuard[list[Any]]:
    """True for a JSON list."""
    return isinstance(item, list)


def parts_of(graph: Graph) -> Tree:
    """A graph as it would be saved, by parts. Raises GraphError for what cannot be saved."""
    return _split_body(json.loads(dumps(graph)))


def write_parts(parts: Tree) -> str:
    """The document that has these parts."""
    return pretty({"halation": FORMAT, **to_document(parts)})


def keep_kind(parts: Tree, before: Tree) -> Tree:
    """Entries as the same kind of object as another: a keyed list stays one."""
    return _KeyedList(parts) if isinstance(before, _KeyedList) else parts


def to_document(part: Any) -> Any:
    """A part as a document writes it: keyed lists are lists again."""
    if isinstance(part, _KeyedList):
        return [to_document(part[key]) for key in sorted(part)]
    if is_tree(part):
        return {key: to_document(inner) for key, inner in part.items()}
    return part


def equals(first: Any, second: Any) -> bool:
    """True if two parts are equal in JSON: 1 equals 1.0, and does not equal true."""
    if is_tree(first) and is_tree(second):
        return first.keys() == second.keys() and all(equals(part, second[key]) for key, part in first.items())
    if is_list(first) and is_list(second):
        return len(first) == len(second) and all(map(equals, first, second))
    return isinstance(first, bool) == isinstance(second, bool) and first == second


def get_part(parts: Any, at: PartPath) -> Any:
    """The part at a path, or ABSENT."""
    for key in at:
        if not is_tree(parts) or key not in parts:
            return ABSENT
        parts = parts[key]
    return parts


def put_part(parts: Tree, at: PartPath, part: Any) -> Tree:
    """The parts with the one at a path replaced; ABSENT removes it."""
    key, rest = at[0], at[1:]
    if rest:
        inner = parts.get(key)
        part = put_part(inner if is_tree(inner) else _KeyedList() if key == "keys" else {}, rest, part)
    remaining_parts = {name: item for name, item in parts.items() if name != key}
    return keep_kind(remaining_parts if part is ABSENT else remaining_parts | {key: part}, parts)


def local_path(at: PartPath) -> PartPath:
    """The address inside of the innermost group."""
    while len(at) >= 3 and at[0] == "nodes" and at[2] == "graph":
        at = at[3:]
    return at


def is_section(at: PartPath) -> bool:
    """True for an object that means the same if it is empty and if it is absent."""
    here = local_path(at)
    return (
        not here
        or (len(here) == 1 and here[0] in _SECTIONS)
        or (len(here) == 3 and here[0] == "nodes" and here[2] == "values")
    )


def is_container(at: PartPath) -> bool:
    """True for an object that can be merged entry by entry even if both sides added it."""
    here = local_path(at)
    return len(here) <= 1 or here[0] == "ui" or is_section(at)


def is_whole(at: PartPath, *versions: Any) -> bool:
    """True if versions of a part are of different kinds, so that their entries cannot be compared one by one."""
    here, present = local_path(at), [item for item in versions if item is not ABSENT]
    if not all(map(is_tree, present)):
        return True
    if is_container(at):
        return False
    if len(present) < len(versions):
        return True
    if len(here) == 2 and here[0] == "nodes":
        return len({_kind(item) for item in present}) > 1
    if is_named_item(here):
        return len({str(item.get("kind")) for item in present}) > 1
    return len(here) == 2 and here[0] == "animation" and len({"keys" in item for item in present}) > 1


def sort_keys(versions: Iterator[Any]) -> list[Any]:
    """The keys of several objects, each once, in order."""
    return sorted({key for item in versions if is_tree(item) for key in item})


def path_text(at: PartPath) -> str:
    """The address as messages write it: `nodes.bloom.values.sigma`."""
    return ".".join(map(str, at))


def conflict_key(at: Any) -> str:
    """The key that identifies a conflict: the path that it is about."""
    return json.dumps(at)


def is_named_item(here: PartPath) -> bool:
    """True for an item of a value that holds named items: versions of two kinds have other fields."""
    return len(here) == 5 and here[0] == "nodes" and here[2] == "values"


def _kind(node: Tree) -> tuple[str, ...]:
    """What two versions of a node must share so that their values mean the same."""
    return (str(node.get("type")), str(node.get("version")), *(key for key in _BODIES if key in node))


def _split_body(body: Tree) -> Tree:
    parts = {key: part for key, part in body.items() if key != "halation"}
    if is_tree(animation := parts.get("animation")):
        parts["animation"] = {target: _split_animation(item) for target, item in animation.items()}
    if is_tree(nodes := parts.get("nodes")):
        parts["nodes"] = {id: _split_group(node) for id, node in nodes.items()}
    if is_list(open := parts.get(CONFLICTS)) and all(is_tree(item) and "at" in item for item in open):
        parts[CONFLICTS] = _KeyedList({conflict_key(item["at"]): item for item in open})
    return parts


def _split_group(node: Tree) -> Tree:
    return {**node, "graph": _split_body(node["graph"])} if node["type"] == "group" and "graph" in node else node


def _split_animation(item: Tree) -> Tree:
    return {**item, "keys": _KeyedList({key["frame"]: key for key in item["keys"]})} if "keys" in item else item
