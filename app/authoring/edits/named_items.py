"""Named items of a value: adding, removing and renaming them, and what refers to them."""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import replace

from halation.nodes import Items, ItemSet, NamedItem

from ...errors import GraphError
from ...graph import Animation, Control, Expression, Graph, Port, find_declaration
from ...graph.named_items import check_new_item, split_path
from ...graph.notes import move_keys
from ...language.translation import translate

_NUMBER = re.compile(r"_[0-9]+$")


def find_items(graph: Graph, port: Port) -> tuple[Items, ItemSet]:
    """What items a value can hold, and those that it holds. Raises GraphError for a value of another type."""
    items, declaration = graph.value(port), find_declaration(graph.node(port.node), port.socket)
    if not isinstance(items, ItemSet) or declaration is None or declaration.items is None:
        raise GraphError(translate("'{port}' holds no named items", port=port))
    return declaration.items, items


def find_item(graph: Graph, port: Port, name: str) -> NamedItem:
    """The item of a name. Raises GraphError."""
    declared, items = find_items(graph, port)
    if name not in items:
        raise GraphError(translate("'{port}' has no {noun} '{name}'", port=port, noun=declared.noun, name=name))
    return items[name]


def fresh_item_name(stem: str, names: Collection[str]) -> str:
    """A free name with a number: `spot_1`, or for the stem `key_2` the next free one, `key_3`."""
    plain = _NUMBER.sub("", stem)
    number = 2 if plain == stem and stem in names else 1
    while f"{plain}_{number}" in names:
        number += 1
    return f"{plain}_{number}"


def insert_item(graph: Graph, port: Port, name: str, item: NamedItem) -> Graph:
    """The graph with one more named item. Raises GraphError for a name that is used, and if there is no room."""
    declared, items = find_items(graph, port)
    check_new_item(declared, items, name)
    if len(items) >= declared.most:
        raise GraphError(
            translate(
                "there is no room for another {noun}: '{port}' takes at most {most}",
                noun=declared.noun,
                port=port,
                most=declared.most,
            )
        )
    return _put_items(graph, port, items.with_item(name, item))


def drop_item(graph: Graph, port: Port, name: str) -> Graph:
    """The graph without a named item, its keys and the controls of its fields."""
    find_item(graph, port, name)
    inside, (declared, items) = f"{port.socket}.{name}.", find_items(graph, port)
    dropped = [end for end in graph.animation if end.node == port.node and end.socket.startswith(inside)]
    animation = {end: animation for end, animation in graph.animation.items() if end not in dropped}
    controls = {
        key: control
        for key, control in graph.controls.items()
        if not (control.target.node == port.node and control.target.socket.startswith(inside))
    }
    extra = move_keys(graph.extra, _keep_place(port, name))
    return _put_items(
        replace(graph, animation=animation, controls=controls, extra=extra),
        port,
        _rename_in_fields(declared, items.without_item(name), name, ""),
    )


def rename_item(graph: Graph, port: Port, old: str, new: str) -> Graph:
    """The graph where a named item has another name: keys, expressions and controls follow."""
    item = find_item(graph, port, old)
    declared, items = find_items(graph, port)
    if old == new:
        return graph
    check_new_item(declared, items, new)

    def move(end: Port) -> Port:
        head, name, field = split_path(end.socket)
        inside = end.node == port.node and head == port.socket and name == old
        return Port(end.node, f"{head}.{new}.{field}") if inside else end

    def rename(animation: Animation) -> Animation:
        if not isinstance(animation, Expression):
            return animation
        long = animation.rename(f"{port}.{old}", f"{port}.{new}")
        return long.rename(f"{port.node}.{old}", f"{port.node}.{new}")

    def aim(control: Control) -> Control:
        return control.with_target(move(control.target))

    moved = replace(
        graph,
        animation={move(end): rename(animation) for end, animation in graph.animation.items()},
        controls={key: aim(control) for key, control in graph.controls.items()},
        extra=move_keys(graph.extra, _keep_place(port, old), _keep_place(port, new)),
    )
    renamed = items.without_item(old).with_item(new, item)
    return _put_items(moved, port, _rename_in_fields(declared, renamed, old, new))


def exchange_items(graph: Graph, port: Port, first: str, second: str) -> Graph:
    """The graph where two named items have each other's name, and so each other's place in the order."""
    find_item(graph, port, second)
    if first == second:
        return graph
    between = fresh_item_name("moved", find_items(graph, port)[1])
    graph = rename_item(graph, port, first, between)
    return rename_item(rename_item(graph, port, second, first), port, between, second)


def copy_animation(graph: Graph, port: Port, source: str, target: str) -> Graph:
    """The graph where the fields of a named item change over time like those of another one."""
    start = f"{port.socket}.{source}."
    copies = {
        Port(end.node, f"{port.socket}.{target}.{end.socket.removeprefix(start)}"): animation
        for end, animation in graph.animation.items()
        if end.node == port.node and end.socket.startswith(start)
    }
    return replace(graph, animation={**graph.animation, **copies})


def _rename_in_fields(declared: Items, items: ItemSet, old: str, new: str) -> ItemSet:
    """The items where fields that name one of them follow its new name, or none."""
    changed: dict[str, NamedItem] = {}
    for name, item in items.items():
        for field, value in declared.by_name[item.kind].fields.items():
            if value.names_item and item.fields.get(field) == old:
                changed[name] = changed.get(name, item).with_field(field, new or None)
    return items.replace(changed)


def _put_items(graph: Graph, port: Port, items: ItemSet) -> Graph:
    """The graph with other items, which still change over time as they did."""
    return replace(graph.put(port, items), animation=graph.animation)


def _keep_place(port: Port, name: str) -> str:
    """Where a graph keeps unknown keys of an item."""
    return f"nodes.{port.node}.values.{port.socket}.{name}"
