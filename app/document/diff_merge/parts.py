"""The parts of a document by name: what can differ and be merged on its own.

A part is addressed by the keys that lead to it. Keys of an animation count by their frame, not by their place in the
list, and the conflicts of an unfinished merge by the part that they are about.
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

At = tuple[str | float, ...]
"""Where a part is: ("nodes", "bloom", "values", "sigma"), or ("animation", "bloom.sigma", "keys", 12)."""

Tree = dict[Any, Any]

CONFLICTS = "conflicts"
"""The key of a document whose merge left something to be decided."""

_SECTIONS: Final = ("settings", "inputs", "outputs", "controls", "nodes", "links", "animation", CONFLICTS)
_BODIES: Final = ("graph", "path", "code", "file")


class Absent(Enum):
    """What stands for a part that is not there; null may be."""

    ABSENT = "absent"


ABSENT: Final = Absent.ABSENT


class _Listed(dict[Any, Any]):
    """What a document writes as a list, by what tells its entries apart."""


def is_tree(item: Any) -> TypeGuard[Tree]:
    """True for a JSON object."""
    return isinstance(item, dict)


def is_list(item: Any) -> TypeGuard[list[Any]]:
    """True for a JSON list."""
    return isinstance(item, list)


def parts_of(graph: Graph) -> Tree:
    """A graph as it would be saved, by parts. Raises GraphError for what cannot be saved."""
    return _by_name(json.loads(dumps(graph)))


def text_of(parts: Tree) -> str:
    """The document that has these parts."""
    return pretty({"halation": FORMAT, **plain(parts)})


def like(parts: Tree, before: Tree) -> Tree:
    """The same kind of object as another with other entries."""
    return _Listed(parts) if isinstance(before, _Listed) else parts


def plain(part: Any) -> Any:
    """A part as a document has it: lists are lists again."""
    if isinstance(part, _Listed):
        return [plain(part[key]) for key in sorted(part)]
    if is_tree(part):
        return {key: plain(inner) for key, inner in part.items()}
    return part


def same(one: Any, other: Any) -> bool:
    """Equality as JSON sees it: 1 is 1.0, and not true."""
    if is_tree(one) and is_tree(other):
        return one.keys() == other.keys() and all(same(part, other[key]) for key, part in one.items())
    if is_list(one) and is_list(other):
        return len(one) == len(other) and all(map(same, one, other))
    return isinstance(one, bool) == isinstance(other, bool) and one == other


def at_part(parts: Any, at: At) -> Any:
    """The part there, or ABSENT."""
    for key in at:
        if not is_tree(parts) or key not in parts:
            return ABSENT
        parts = parts[key]
    return parts


def put_part(parts: Tree, at: At, part: Any) -> Tree:
    """The same parts with another one there; ABSENT removes it."""
    key, rest = at[0], at[1:]
    if rest:
        inner = parts.get(key)
        part = put_part(inner if is_tree(inner) else _Listed() if key == "keys" else {}, rest, part)
    kept = {name: item for name, item in parts.items() if name != key}
    return like(kept if part is ABSENT else kept | {key: part}, parts)


def local(at: At) -> At:
    """The address inside of the innermost group."""
    while len(at) >= 3 and at[0] == "nodes" and at[2] == "graph":
        at = at[3:]
    return at


def is_section(at: At) -> bool:
    """True for an object that is nothing by itself: to have none is the same as to have an empty one."""
    here = local(at)
    return (
        not here
        or (len(here) == 1 and here[0] in _SECTIONS)
        or (len(here) == 3 and here[0] == "nodes" and here[2] == "values")
    )


def is_container(at: At) -> bool:
    """True for an object whose entries go together with those of another version that began it on its own."""
    here = local(at)
    return len(here) <= 1 or here[0] == "ui" or is_section(at)


def is_whole(at: At, *versions: Any) -> bool:
    """True where versions differ so much in kind that their parts do not go together."""
    here, found = local(at), [item for item in versions if item is not ABSENT]
    if not all(map(is_tree, found)):
        return True
    if is_container(at):
        return False
    if len(found) < len(versions):
        return True
    if len(here) == 2 and here[0] == "nodes":
        return len({_kind(item) for item in found}) > 1
    return len(here) == 2 and here[0] == "animation" and len({"keys" in item for item in found}) > 1


def names_of(versions: Iterator[Any]) -> list[Any]:
    """The keys of several objects, each once, in order."""
    return sorted({key for item in versions if is_tree(item) for key in item})


def path_of(at: At) -> str:
    """The address as messages write it: `nodes.bloom.values.sigma`."""
    return ".".join(map(str, at))


def about(at: Any) -> str:
    """What tells a conflict from others."""
    return json.dumps(at)


def _kind(node: Tree) -> tuple[str, ...]:
    """What two versions of a node must share so that their values mean the same."""
    return (str(node.get("type")), str(node.get("version")), *(key for key in _BODIES if key in node))


def _by_name(body: Tree) -> Tree:
    found = {key: part for key, part in body.items() if key != "halation"}
    if is_tree(animation := found.get("animation")):
        found["animation"] = {target: _by_frame(item) for target, item in animation.items()}
    if is_tree(nodes := found.get("nodes")):
        found["nodes"] = {id: _inside(node) for id, node in nodes.items()}
    if is_list(open := found.get(CONFLICTS)) and all(is_tree(item) and "at" in item for item in open):
        found[CONFLICTS] = _Listed({about(item["at"]): item for item in open})
    return found


def _inside(node: Tree) -> Tree:
    return {**node, "graph": _by_name(node["graph"])} if node["type"] == "group" and "graph" in node else node


def _by_frame(item: Tree) -> Tree:
    return {**item, "keys": _Listed({key["frame"]: key for key in item["keys"]})} if "keys" in item else item
