"""Nodes that follow the shape of the pixels that they read."""

from __future__ import annotations

from msgspec.structs import replace

from ..ir import Builder, Gather, Read, Ref
from ..ir.pixel_aspects import find_pixel_aspects
from .node_inputs import NodeInputs

_ANY = 2.0
"""Some ratio that is not 1: with it a node that follows the shape of pixels is another one."""


def follow_pixel_aspect(builder: Builder, inputs: NodeInputs) -> NodeInputs:
    """The inputs with the node as it is for pixels of the shape that its first picture has."""
    node = inputs.node
    if node.with_pixel_aspect(_ANY) is node:
        return inputs
    ref = next((operand for operand in inputs.inputs.values() if isinstance(operand, Ref)), None)
    if ref is None:
        return inputs
    for number, op in enumerate(builder.ops[: ref.op + 1]):
        if isinstance(op, Read) or (isinstance(op, Gather) and op.stretches):
            builder.inspect(Ref(number))
    aspect = find_pixel_aspects(builder.ops[: ref.op + 1]).get(ref, 1.0)
    return replace(inputs, node=node.with_pixel_aspect(aspect))
