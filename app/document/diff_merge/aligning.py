"""Finding nodes that were renamed: they have another id in the other version, and are the same in all else.

Every node that only one version has is described by what its graph says of it (`_NodeDescription`). Its text is the
document of a graph that holds only this node, under a fixed id. Its links name other nodes, whose ids may have changed
too. So matching goes in rounds: at first, a neighbor that is not matched yet may be any node. Two nodes are matched if
no other node on either side has the same description. Each match makes the descriptions of its neighbors more exact,
and the next round can tell these apart. At the end every match is tested with the ids of all others filled in, and the
ones that fail are dropped until all that is left is consistent. Twins that nothing tells apart stay unmatched: a
deleted and a new node are a correct answer too, and a wrong match would not be.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Container, Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

from msgspec import Struct

from ...graph import Animation, Control, Graph, Group, Item, Port
from ...graph.notes import move_keys
from ..writing import dumps

IdMapping = Mapping[str, str]
"""Old ids to new ones."""

_ANY = "node"
_ROUNDS = 32
"""How many links a match can travel along. A choice: a longer chain of renamed nodes without any value that tells them
apart is not worth the time."""


class NodeRename(Struct, frozen=True):
    """A node with its old and new id; `group` are the ids of the groups that it is in, from the outside."""

    group: tuple[str, ...]
    old: str
    new: str


def find_renames(before: Graph, after: Graph) -> IdMapping:
    """New ids by old ones, of nodes that were renamed: type, values and links are the same, and only one node fits."""
    removed = _describe_nodes(before, [id for id in before.nodes if id not in after.nodes])
    added = _describe_nodes(after, [id for id in after.nodes if id not in before.nodes])
    certain: dict[str, str] = {}
    for _ in range(_ROUNDS):
        if not (matches := _match_unique(removed, added, certain)):
            break
        certain |= matches
    while refuted := [old for old, new in certain.items() if not removed[old].same(added[new], certain)]:
        for old in refuted:
            del certain[old]
    return certain


def align_two(before: Graph, after: Graph, group: tuple[str, ...] = ()) -> tuple[Graph, tuple[NodeRename, ...]]:
    """`before` with the ids of `after`, groups included, and what was renamed."""
    ids = find_renames(before, after)
    before, all_renames = rename_all(before, ids), [NodeRename(group, old, new) for old, new in sorted(ids.items())]
    inner: dict[str, Item] = {}
    for id, item in before.nodes.items():
        counterpart = after.nodes.get(id)
        if isinstance(item, Group) and isinstance(counterpart, Group):
            graph, inner_renames = align_two(item.graph, counterpart.graph, (*group, id))
            all_renames += inner_renames
            inner[id] = replace(item, graph=graph)
    return replace_items(before, inner), tuple(all_renames)


def align_three(base: Graph, ours: Graph, theirs: Graph) -> tuple[Graph, Graph, Graph]:
    """Three versions with the same ids: a new id that one side gave to a node of the base is used in all of them.

    Without this, a renamed node would look removed and added, and each change of the other side to it would be a
    conflict. Where both sides renamed the same node differently, or two nodes to the same id, the old ids stay.
    """
    our_renames, their_renames = find_renames(base, ours), find_renames(base, theirs)
    only_ours = {old: new for old, new in our_renames.items() if old not in their_renames and new not in theirs.nodes}
    only_theirs = {old: new for old, new in their_renames.items() if old not in our_renames and new not in ours.nodes}
    both = {old: new for old, new in our_renames.items() if their_renames.get(old) == new}
    new_ids = [*only_ours.values(), *only_theirs.values()]
    clashing = {new for new, count in Counter(new_ids).items() if count > 1}
    only_ours = {old: new for old, new in only_ours.items() if new not in clashing}
    only_theirs = {old: new for old, new in only_theirs.items() if new not in clashing}
    base, ours = rename_all(base, {**only_ours, **only_theirs, **both}), rename_all(ours, only_theirs)
    theirs = rename_all(theirs, only_ours)
    sides = (base, ours, theirs)
    inner: tuple[dict[str, Item], ...] = ({}, {}, {})
    for id in base.nodes:
        items = [side.nodes.get(id) for side in sides]
        groups = [item for item in items if isinstance(item, Group)]
        if len(groups) == len(sides):
            for new_items, item, graph in zip(
                inner, groups, align_three(*(item.graph for item in groups)), strict=True
            ):
                new_items[id] = replace(item, graph=graph)
    base, ours, theirs = (replace_items(side, new_items) for side, new_items in zip(sides, inner, strict=True))
    return base, ours, theirs


def rename_all(graph: Graph, ids: IdMapping) -> Graph:
    """A graph with other ids; an id that the graph does not have is ignored."""
    for old, new in ids.items():
        graph = graph.rename(old, new) if old in graph.nodes else graph
    return graph


def replace_items(graph: Graph, items: Mapping[str, Item]) -> Graph:
    """A graph with some nodes replaced; all links stay as they are."""
    return replace(graph, nodes={**graph.nodes, **items}) if items else graph


class _NodeDescription:
    """Everything that a graph says of one of its nodes, apart from its id."""

    def __init__(self, item: Item) -> None:
        self.links_in: set[tuple[str, Port]] = set()
        self.links_out: set[tuple[str, Port]] = set()
        self.alone = Graph({_ANY: item})

    @cached_property
    def text(self) -> str:
        """The document of the node alone."""
        return dumps(self.alone)

    def same(self, description: _NodeDescription, ids: IdMapping) -> bool:
        """True if both describe the same node; `ids` are new ids by old ones."""
        return self.key(ids, ()) == description.key({}, ())

    def key(self, ids: IdMapping, open: Container[str]) -> tuple[object, ...]:
        """The text and links of the node, to be compared with those of others; a neighbor in `open` is left blank."""

        def ports(links: set[tuple[str, Port]]) -> tuple[tuple[str, Port], ...]:
            return tuple(sorted((socket, _rename_port(port, ids, open)) for socket, port in links))

        return self.text, ports(self.links_in), ports(self.links_out)


def _describe_nodes(graph: Graph, ids: Collection[str]) -> dict[str, _NodeDescription]:
    """Descriptions of nodes by id, in one walk over the graph: a node for itself would look at all links."""
    descriptions = {id: _NodeDescription(graph.nodes[id]) for id in ids}
    controls: dict[str, dict[str, Control]] = {}
    animations: dict[str, dict[Port, Animation]] = {}
    extras: dict[str, dict[str, Mapping[str, Any]]] = {}
    for end, start in graph.links.items():
        if end.node in descriptions:
            descriptions[end.node].links_in.add((end.socket, start))
        if start.node in descriptions:
            descriptions[start.node].links_out.add((start.socket, end))
    for name, control in graph.controls.items():
        target = Port(_ANY, control.target.socket)
        controls.setdefault(control.target.node, {})[name] = control.with_target(target)
    for port, animation in graph.animation.items():
        animations.setdefault(port.node, {})[Port(_ANY, port.socket)] = animation
    for path, keys in graph.extra.items():
        section, _, rest = path.partition(".")
        if section == "nodes":
            extras.setdefault(rest.partition(".")[0], {})[path] = keys
    for id, description in descriptions.items():
        description.alone = replace(
            description.alone,
            controls=controls.get(id, {}),
            animation=animations.get(id, {}),
            muted=frozenset({_ANY} if id in graph.muted else ()),
            extra=move_keys(extras.get(id, {}), f"nodes.{id}", f"nodes.{_ANY}"),
        )
    return descriptions


def _match_unique(
    removed: Mapping[str, _NodeDescription], added: Mapping[str, _NodeDescription], certain: IdMapping
) -> dict[str, str]:
    """New ids by old ones, of pairs that have the same description and share it with no other node."""
    open, free = removed.keys() - certain.keys(), added.keys() - set(certain.values())
    olds = {old: removed[old].key(certain, open) for old in open}
    news = {new: added[new].key({}, free) for new in free}
    there, here = Counter(olds.values()), Counter(news.values())
    unique_ids = {key: new for new, key in news.items() if here[key] == 1}
    return {old: unique_ids[key] for old, key in olds.items() if there[key] == 1 and key in unique_ids}


def _rename_port(port: Port, ids: IdMapping, open: Container[str]) -> Port:
    return Port("" if port.node in open else ids.get(port.node, port.node), port.socket)
