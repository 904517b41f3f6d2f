"""The mask and the mix of a node: its result where they are 1, and the picture that it was given where they are 0.

It is one pointwise operation after the node, which fuses with what reads it. A node without a mask, whose mix is 1, is
lowered as if there were no masks.
"""

from __future__ import annotations

from collections.abc import Container

from halation.nodes import INVERT_MASK, MASK, MIX, Node, Temporal

from ..ir import Builder, Call, Operand, Parameter, Ref, UniformConstant
from .node_inputs import NodeInputs
from .pictures import PictureBuilder


def hides_node(node: Node) -> bool:
    """True if the mix of a node is 0, so that its picture passes through; a node with a memory still has to work."""
    return node.has_mix and node.setting(MIX) == 0.0 and not isinstance(node, Temporal)


def is_masked(node: Node, linked: Container[str]) -> bool:
    """True if a mask is linked to a node, or its mix is not 1. `linked` are the inputs and values that have links."""
    has_link = (node.has_mask and MASK in linked) or MIX in linked
    return node.has_mix and (has_link or node.setting(MIX) != 1.0)


def add_mask(
    builder: Builder, pictures: PictureBuilder, inputs: NodeInputs, before: Operand, after: Operand
) -> Operand:
    """The operand that shows `after` where the mask of a node is 1, else `before`."""
    if not isinstance(after, Ref):
        return after
    shape, node = builder.shape(after), inputs.node

    def fit(operand: Operand) -> Operand:
        return pictures.fit(operand, shape.size, inputs.path) if isinstance(operand, Ref) else operand

    glsl = "float" if shape.channels == 1 else "vec4"
    mask: Operand = UniformConstant(1.0)
    inverted: Operand = UniformConstant(False)
    if node.has_mask and MASK in inputs.linked:
        mask = fit(inputs.inputs[MASK])
        inverted = inputs.wires.get(INVERT_MASK, UniformConstant(bool(node.setting(INVERT_MASK))))
    parameters = (
        Parameter(glsl, fit(before)),
        Parameter(glsl, after),
        Parameter("float", mask),
        Parameter("float", fit(inputs.wires.get(MIX, UniformConstant(float(node.setting(MIX)))))),
        Parameter("bool", fit(inverted)),
    )
    return builder.add(Call((shape,), inputs.path, "primitive/mask", f"mask_{glsl}", parameters))
