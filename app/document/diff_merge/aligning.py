"""Nodes that have another id in another version and are the same in all else."""

from __future__ import annotations

from collections import Counter
from collections.abc import Container, Mapping
from dataclasses import dataclass, replace

from ...graph import Graph, Group, Item, Port
from ...graph.notes import moved_keys
from ..writing import dumps

Ids = Mapping[str, str]
"""Old ids to new ones."""

_ANY = "node"
_ROUNDS = 32
"""How far from nodes that are known others are looked for that can only be told by their neighbors."""


@dataclass(frozen=True)
class Renamed:
    """A node that was renamed; `group` are the ids of the groups that it is in, from the outside."""

    group: tuple[str, ...]
    old: str
    new: str


def renames(before: Graph, after: Graph) -> Ids:
    """The nodes that were certainly renamed: type, values and wiring are the same, and no other node could be meant."""
    gone = {id: _Look(before, id) for id in before.nodes if id not in after.nodes}
    come = {id: _Look(after, id) for id in after.nodes if id not in before.nodes}
    certain: dict[str, str] = {}
    for _ in range(_ROUNDS):
        if not (found := _unique(gone, come, certain)):
            break
        certain |= found
    while wrong := [old for old, new in certain.items() if not gone[old].same(come[new], certain)]:
        for old in wrong:
            del certain[old]
    return certain


def align(before: Graph, after: Graph, group: tuple[str, ...] = ()) -> tuple[Graph, tuple[Renamed, ...]]:
    """`before` with the ids of `after`, groups included, and what was renamed."""
    ids = renames(before, after)
    before, found = rename_all(before, ids), [Renamed(group, old, new) for old, new in sorted(ids.items())]
    inner: dict[str, Item] = {}
    for id, item in before.nodes.items():
        other = after.nodes.get(id)
        if isinstance(item, Group) and isinstance(other, Group):
            graph, more = align(item.graph, other.graph, (*group, id))
            found += more
            inner[id] = replace(item, graph=graph)
    return with_items(before, inner), tuple(found)


def align_three(base: Graph, ours: Graph, theirs: Graph) -> tuple[Graph, Graph, Graph]:
    """Three versions with the ids that either side gave to nodes of the base."""
    mine, others = renames(base, ours), renames(base, theirs)
    here = {old: new for old, new in mine.items() if old not in others and new not in theirs.nodes}
    there = {old: new for old, new in others.items() if old not in mine and new not in ours.nodes}
    both = {old: new for old, new in mine.items() if others.get(old) == new}
    taken = [*here.values(), *there.values()]
    clash = {new for new in taken if taken.count(new) > 1}
    here = {old: new for old, new in here.items() if new not in clash}
    there = {old: new for old, new in there.items() if new not in clash}
    base, ours = rename_all(base, {**here, **there, **both}), rename_all(ours, there)
    theirs = rename_all(theirs, here)
    sides = (base, ours, theirs)
    inner: tuple[dict[str, Item], ...] = ({}, {}, {})
    for id in base.nodes:
        items = [side.nodes.get(id) for side in sides]
        groups = [item for item in items if isinstance(item, Group)]
        if len(groups) == len(sides):
            for made, item, graph in zip(inner, groups, align_three(*(item.graph for item in groups)), strict=True):
                made[id] = replace(item, graph=graph)
    base, ours, theirs = (with_items(side, made) for side, made in zip(sides, inner, strict=True))
    return base, ours, theirs


def rename_all(graph: Graph, ids: Ids) -> Graph:
    """A graph with other ids; those that it does not have are left out."""
    for old, new in ids.items():
        graph = graph.rename(old, new) if old in graph.nodes else graph
    return graph


def with_items(graph: Graph, items: Mapping[str, Item]) -> Graph:
    """A graph with other nodes in some places and all links as they were."""
    return replace(graph, nodes={**graph.nodes, **items}) if items else graph


class _Look:
    """Everything that a graph says of one of its nodes, apart from its id."""

    def __init__(self, graph: Graph, id: str) -> None:
        self.feeding = {(end.socket, start) for end, start in graph.links.items() if end.node == id}
        self.fed = {(start.socket, end) for end, start in graph.links.items() if start.node == id}
        alone = Graph(
            {_ANY: graph.nodes[id]},
            controls={
                name: replace(item, target=Port(_ANY, item.target.socket))
                for name, item in graph.controls.items()
                if item.target.node == id
            },
            animation={Port(_ANY, port.socket): item for port, item in graph.animation.items() if port.node == id},
            muted=frozenset({_ANY} if id in graph.muted else ()),
            extra=moved_keys(
                {path: keys for path, keys in graph.extra.items() if _inside(path, id)}, f"nodes.{id}", f"nodes.{_ANY}"
            ),
        )
        self.text = dumps(alone)

    def same(self, other: _Look, ids: Ids) -> bool:
        """True if the other is this one, where `ids` are the new names of all that have one."""
        return self.key(ids, ()) == other.key({}, ())

    def key(self, ids: Ids, open: Container[str]) -> tuple[object, ...]:
        """What tells it from others; nodes in `open`, of which nothing is known yet, may be any."""

        def ports(links: set[tuple[str, Port]]) -> tuple[tuple[str, Port], ...]:
            return tuple(sorted((socket, _moved(port, ids, open)) for socket, port in links))

        return self.text, ports(self.feeding), ports(self.fed)


def _unique(gone: Mapping[str, _Look], come: Mapping[str, _Look], certain: Ids) -> dict[str, str]:
    """Pairs of which neither could go with another."""
    open, free = gone.keys() - certain.keys(), come.keys() - set(certain.values())
    olds = {old: gone[old].key(certain, open) for old in open}
    news = {new: come[new].key({}, free) for new in free}
    there, here = Counter(olds.values()), Counter(news.values())
    found = {key: new for new, key in news.items() if here[key] == 1}
    return {old: found[key] for old, key in olds.items() if there[key] == 1 and key in found}


def _moved(port: Port, ids: Ids, open: Container[str]) -> Port:
    return Port("" if port.node in open else ids.get(port.node, port.node), port.socket)


def _inside(path: str, id: str) -> bool:
    return path == f"nodes.{id}" or path.startswith(f"nodes.{id}.")
