"""Converts lengths of a graph to other units, so that pictures stay as they are."""

from __future__ import annotations

from dataclasses import replace

from halation.nodes import Node, Plain, convert_length
from msgspec import structs

from .animation import Animation
from .expressions import Expression
from .graph import Graph
from .length_units import choose_length_unit, pin_node
from .model import Port


def convert_length_unit(graph: Graph, port: Port, unit: str, height: float) -> Graph:
    """The graph where a length is in another unit: px, height, or px at a height such as px@1080. Raises GraphError.

    The number is converted, with its keys or expression, so that a picture of this height stays as it is.
    """
    before = graph.declaration(port)
    node = choose_length_unit(port, graph.node(port.node), unit, graph.settings)
    node = node.with_values(**{port.socket: convert_length(before.default, before.unit, unit, height)})
    animation = dict(graph.animation)
    if port in animation:
        animation[port] = _convert_animation(animation[port], before.unit, unit, height)
    return replace(graph, nodes={**graph.nodes, port.node: node}, animation=animation)


def pin_length_units(graph: Graph, reference_height: int | None) -> Graph:
    """The graph with the same lengths for a body with another reference height: nodes say the units of their own.

    For nodes that move from one body to another, as when a group is dissolved or nodes are pasted.
    """
    before = graph.settings.reference_height
    if before == reference_height:
        return graph
    nodes = {id: pin_node(item, before) if isinstance(item, Node) else item for id, item in graph.nodes.items()}
    return replace(graph, nodes=nodes, settings=replace(graph.settings, reference_height=reference_height))


def _convert_animation(animation: Animation, unit: str | None, new_unit: str, height: float) -> Animation:
    factor = convert_length(1.0, unit, new_unit, height)
    if isinstance(animation, Expression):
        return Expression(f"({animation.text}) * {factor!r}")

    def convert(plain: Plain) -> Plain:
        return convert_length(plain, unit, new_unit, height)

    keys = tuple(
        structs.replace(
            key, value=convert(key.value), left=_scale_handle(key.left, factor), right=_scale_handle(key.right, factor)
        )
        for key in animation.keys
    )
    return structs.replace(animation, keys=keys)


def _scale_handle(handle: tuple[float, ...], factor: Plain) -> tuple[float, ...]:
    """A handle of a key for other units: its first number is in frames."""
    scale = factor if isinstance(factor, float) else 1.0
    return (*handle[:1], *(part * scale for part in handle[1:]))
