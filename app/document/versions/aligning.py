"""Nodes that have another id in another version and are the same in all else."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from ...graph import Graph, Group, Item, Port

Ids = Mapping[str, str]
"""Old ids to new ones."""


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
    while found := _unique(gone, come, certain):
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
    """Everything that a graph says of one of its nodes."""

    def __init__(self, graph: Graph, id: str) -> None:
        self.id, self.item = id, graph.nodes[id]
        self.feeding = {end.socket: start for end, start in graph.links.items() if end.node == id}
        self.fed = {end: start.socket for end, start in graph.links.items() if start.node == id}
        moving = {port.socket: item for port, item in graph.animation.items() if port.node == id}
        shown = {(name, item) for name, item in graph.controls.items() if item.target.node == id}
        controls = frozenset((name, item.target.socket, item.label, item.doc) for name, item in shown)
        kept = {path.removeprefix(f"nodes.{id}"): keys for path, keys in graph.extra.items() if _inside(path, id)}
        self.rest: Any = (id in graph.muted, moving, controls, kept)

    def same(self, other: _Look, ids: Ids) -> bool:
        """True if the other is this one, where `ids` are the new names of all that have one."""
        links = {socket: _moved(start, ids) for socket, start in self.feeding.items()}
        ends = {_moved(end, ids): socket for end, socket in self.fed.items()}
        return self._alike(other) and (links, ends) == (other.feeding, other.fed)

    def may_be(self, other: _Look, ids: Ids, gone: Iterable[str], come: Iterable[str]) -> bool:
        """The same where nodes of which nothing is known yet may be any."""
        open, free = {*gone}.difference(ids), {*come}.difference(ids.values())
        links = {(socket, _veiled(start, ids, open)) for socket, start in self.feeding.items()}
        others = {(socket, _veiled(start, {}, free)) for socket, start in other.feeding.items()}
        ends = sorted((str(_veiled(end, ids, open)), socket) for end, socket in self.fed.items())
        other_ends = sorted((str(_veiled(end, {}, free)), socket) for end, socket in other.fed.items())
        return self._alike(other) and (links, ends) == (others, other_ends)

    def _alike(self, other: _Look) -> bool:
        return self.item == other.item and self.rest == other.rest


def _unique(gone: Mapping[str, _Look], come: Mapping[str, _Look], certain: Ids) -> dict[str, str]:
    """Pairs of which neither could go with another."""
    taken = {*certain.values()}
    fits = {
        old: [new for new, other in come.items() if new not in taken and look.may_be(other, certain, gone, come)]
        for old, look in gone.items() if old not in certain
    }
    wanted = [new for news in fits.values() for new in news]
    return {old: news[0] for old, news in fits.items() if len(news) == 1 and wanted.count(news[0]) == 1}


def _moved(port: Port, ids: Ids) -> Port:
    return Port(ids.get(port.node, port.node), port.socket)


def _veiled(port: Port, ids: Ids, open: Iterable[str]) -> Port:
    return Port("", port.socket) if port.node in open else _moved(port, ids)


def _inside(path: str, id: str) -> bool:
    return path == f"nodes.{id}" or path.startswith(f"nodes.{id}.")
