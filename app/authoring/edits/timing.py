"""Moves keys and expressions with their values from one graph to another."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from ...errors import GraphError
from ...graph import Animation, Expression, Graph, Port, animation_fault
from ...graph.names import fresh_name
from ...language.translation import translate

Animations = Mapping[Port, Animation]


def rename_in_expression(animation: Animation, names: Mapping[str, str]) -> Animation:
    """An expression with nodes, controls or values (`node.value`) renamed, all at once; keys stay as they are."""
    if not isinstance(animation, Expression):
        return animation
    heads = {name.partition(".")[0] for name in animation.names}
    renames = [(old, new) for old, new in names.items() if old != new and old.partition(".")[0] in heads]
    taken_names = {*heads, *names, *names.values()}
    waiting: list[tuple[str, str]] = []
    for old, new in sorted(renames, key=lambda pair: -pair[0].count(".")):
        between = fresh_name("between", taken_names)
        taken_names.add(between)
        animation = animation.rename(old, between)
        waiting.append((between, new))
    for between, new in waiting:
        animation = animation.rename(between, new)
    return animation


def animation_of(graph: Graph, ids: Collection[str]) -> dict[Port, Animation]:
    """The animation of some nodes."""
    return {port: item for port, item in graph.animation.items() if port.node in ids}


def split_animation(
    graph: Graph, ids: Collection[str], group: str
) -> tuple[dict[Port, Animation], dict[Port, Animation]]:
    """The animation of what becomes a group, and of what is left around it.

    Values with a control stay animated outside, as what the group shows.
    """
    exposed = {item.target: name for name, item in graph.controls.items() if item.target.node in ids}
    names = {str(target): f"{group}.{name}" for target, name in exposed.items()}
    inner, outer = dict[Port, Animation](), dict[Port, Animation]()
    for port, item in graph.animation.items():
        if port in exposed:
            outer[Port(group, exposed[port])] = rename_in_expression(item, names)
        elif port.node in ids:
            inner[port] = item
        else:
            outer[port] = rename_in_expression(item, names)
    return inner, outer


def join_animation(graph: Graph, body: Graph, group: str, nodes: Mapping[str, str]) -> dict[Port, Animation]:
    """The animation of a graph where the body of one of its groups stands in its place, its nodes called as `nodes`."""
    targets = {
        name: Port(nodes[item.target.node], item.target.socket)
        for name, item in body.controls.items()
        if item.target.node in nodes
    }
    inside = dict(nodes) | {name: str(port) for name, port in targets.items() if name not in body.nodes}
    animation = {
        Port(nodes[port.node], port.socket): rename_in_expression(item, inside)
        for port, item in body.animation.items()
        if port.node in nodes
    }
    outside = {f"{group}.{name}": str(port) for name, port in targets.items()}
    for port, item in graph.animation.items():
        there = targets.get(port.socket) if port.node == group else port
        if there is not None:
            animation[there] = rename_in_expression(item, outside)
    return animation


def check_names(before: Graph, after: Graph, animation: Animations) -> None:
    """Raise GraphError if an expression of `after` no longer finds what it reads."""
    for port, item in animation.items():
        if not isinstance(item, Expression) or animation_fault(after, port, item) is None:
            continue
        if port not in before.animation or animation_fault(before, port, before.animation[port]) is None:
            raise GraphError(
                translate(
                    "the expression of '{port}' reads a value from the other side of the group's border: "
                    "bake it into keys first, or make that value a control",
                    port=port,
                )
            )
