"""Finds the body of a group in a graph, and puts a changed body back."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

from ...errors import GraphError
from ...graph import INPUTS, OUTPUTS, Graph, Group, Port, signature
from ...graph.model import MAX_GROUP_DEPTH
from ...graph.notes import move_layout
from ...language.translation import translate
from . import timing
from .routes import tidy_routes

CONTROLS = "controls"

GroupPath = tuple[str, ...]
"""Ids of groups, each inside the one before."""

Moves = Mapping[Port, Port]
"""Renamed ends and controls of a body: the new `inputs.a`, `outputs.a` or `controls.a` by the old one."""


def find_group(graph: Graph, id: str) -> Group:
    """The group of that id. Raises GraphError."""
    item = graph.node(id)
    if not isinstance(item, Group):
        raise GraphError(translate("node '{id}' is not a group", id=id))
    return item


def body_at(graph: Graph, path: GroupPath) -> Graph:
    """The body at `path`, with the values that its groups set. Raises GraphError."""
    for id in path:
        graph = find_group(graph, id).body()
    return graph


def is_place(graph: Graph, path: GroupPath) -> bool:
    """True if there is a group at `path`."""
    try:
        body_at(graph, path)
    except GraphError:
        return False
    return True


def find_borrowed_group(graph: Graph, path: GroupPath) -> tuple[GroupPath, str] | None:
    """The outermost group on the path whose body comes from a file, and the file's path; None if there is none."""
    for depth, id in enumerate(path, 1):
        item = find_group(graph, id)
        if item.path:
            return path[:depth], item.path
        graph = item.body()
    return None


def put_body(graph: Graph, path: GroupPath, body: Graph, moves: Moves | None = None) -> Graph:
    """The outermost graph, where `body` is what is inside at `path`.

    The values that groups on the way set become part of their bodies. Links to and from ends that were renamed
    follow them; those of ends that are gone go too. Raises GraphError for a body that belongs to another file.
    """
    if not path:
        return body
    if borrowed_group := find_borrowed_group(graph, path):
        file = f"'{borrowed_group[1]}'"
        raise GraphError(
            translate(
                "group '{group}' comes from the file {file}: make it local first, or open that file",
                group=borrowed_group[0][-1],
                file=file,
            )
        )
    for depth in range(len(path) - 1, -1, -1):
        body = _put_group_body(body_at(graph, path[:depth]), path[depth], body, moves or {})
        moves = None
    return body


def reread_groups(graph: Graph, body: Callable[[Path], Graph]) -> Graph:
    """The graph with the bodies of groups that come from files as `body` reads them; the same one if none differs."""
    changed: dict[str, Group] = {}
    for id, item in graph.nodes.items():
        if isinstance(item, Group):
            body_now = body(Path(graph.folder, item.path)) if item.path else reread_groups(item.graph, body)
            if body_now is not item.graph and body_now != item.graph:
                changed[id] = replace(item, graph=body_now)
    return replace(graph, nodes={**graph.nodes, **changed}) if changed else graph


def check_depth(graph: Graph) -> None:
    """Raise GraphError for groups nested deeper than a file may hold."""
    todo = [(graph, 0)]
    while todo:
        body, depth = todo.pop()
        for id, item in body.nodes.items():
            if isinstance(item, Group):
                if depth >= MAX_GROUP_DEPTH:
                    raise GraphError(
                        translate(
                            "group '{id}' would be nested deeper than {depth}: ungroup some groups",
                            id=id,
                            depth=MAX_GROUP_DEPTH,
                        )
                    )
                todo.append((item.graph, depth + 1))


def _put_group_body(outer: Graph, id: str, body: Graph, moves: Moves) -> Graph:
    """`outer` with another body in group `id`.

    `moves` are renamed ends of the body. Links, controls, animation and layout of the outer graph follow them; those of
    ends that the new body lacks are removed.
    """
    item = Group(replace(body, folder=outer.folder))
    old, new = signature(outer.nodes[id]), signature(item)
    removed_sockets = {name for name in (*old.inputs, *old.values) if name not in new.inputs and name not in new.values}
    removed_outputs = old.outputs.keys() - new.outputs.keys()

    def follow(port: Port, side: str) -> Port:
        there = moves.get(Port(side, port.socket)) if port.node == id else None
        return Port(id, there.socket) if there else port

    ends = {end: follow(end, INPUTS if end.socket in old.inputs else CONTROLS) for end in outer.links}
    links = {ends[end]: follow(start, OUTPUTS) for end, start in outer.links.items()}
    links = {
        end: start
        for end, start in links.items()
        if not (end.node == id and end.socket in removed_sockets)
        and not (start.node == id and start.socket in removed_outputs)
    }
    controls = {name: item.with_target(follow(item.target, CONTROLS)) for name, item in outer.controls.items()}
    controls = {
        name: item
        for name, item in controls.items()
        if item.target.node != id or item.target.socket not in removed_sockets
    }
    names = {f"{id}.{port.socket}": f"{id}.{there.socket}" for port, there in moves.items() if port.node == CONTROLS}
    animation = {
        follow(port, CONTROLS): timing.rename_in_expression(item, names) for port, item in outer.animation.items()
    }
    animation = {
        port: item for port, item in animation.items() if port.node != id or port.socket not in removed_sockets
    }
    ui = outer.ui
    for before, after in moves.items():
        ui = move_layout(ui, f"{id}.{before.socket}", f"{id}.{after.socket}")
    return tidy_routes(
        replace(outer, nodes={**outer.nodes, id: item}, links=links, controls=controls, animation=animation, ui=ui)
    )
