"""Random nodes, sockets, values and named items of a session, now and then one that does not exist."""

from __future__ import annotations

from random import Random

from halation.authoring.edits.element_id import ElementId
from halation.authoring.session import Session
from halation.graph import Group, Port, signature
from halation.nodes import ItemSet


def any_node(session: Session, rng: Random) -> str:
    return rng.choice([*session.graph.nodes, "nobody"])


def any_group(session: Session, rng: Random) -> str:
    groups = [id for id, item in session.graph.nodes.items() if isinstance(item, Group)]
    return rng.choice([*groups, any_node(session, rng)])


def any_key(session: Session, rng: Random) -> ElementId:
    return rng.choice([*session.elements, ElementId("nobody")])


def some_keys(session: Session, rng: Random) -> list[ElementId]:
    known = [*session.elements]
    return rng.sample(known, min(len(known), rng.choice([0, 1, 2, 3, 9])))


def any_target(session: Session, rng: Random) -> Port:
    graph = session.graph
    sockets = [
        Port(id, name)
        for id, item in graph.nodes.items()
        for name in (*signature(item).inputs, *signature(item).values)
    ]
    return rng.choice([*graph.links, *sockets, *(Port("outputs", name) for name in graph.outputs), Port("no", "body")])


def any_source(session: Session, rng: Random) -> Port:
    graph = session.graph
    sockets = [Port(id, name) for id, item in graph.nodes.items() for name in signature(item).outputs]
    return rng.choice([*sockets, *(Port("inputs", name) for name in graph.inputs), Port("no", "body")])


def any_value(session: Session, rng: Random) -> Port:
    graph = session.graph
    return rng.choice(
        [Port("no", "body"), *(Port(id, name) for id, item in graph.nodes.items() for name in signature(item).values)]
    )


def any_items(session: Session, rng: Random) -> Port:
    graph = session.graph
    holders = [
        Port(id, name)
        for id, item in graph.nodes.items()
        for name, value in signature(item).values.items()
        if value.items
    ]
    return rng.choice([*holders, *holders, any_value(session, rng)])


def any_item(session: Session, rng: Random) -> tuple[Port, str]:
    port = any_items(session, rng)
    value = signature(session.graph.nodes[port.node]).values.get(port.socket) if port.node != "no" else None
    names = [*value.default] if value and isinstance(value.default, ItemSet) else []
    return port, rng.choice([*names, "nobody"])


def spot(rng: Random) -> tuple[float, float]:
    return rng.uniform(-500, 500), rng.choice([0.0, 100.0, rng.uniform(-500, 500)])
