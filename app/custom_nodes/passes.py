"""How a node of user code that looks around in its pictures is drawn."""

from __future__ import annotations

from collections.abc import Mapping

from halation.nodes import Draw, Drawn, Edge, Filter


def make_passes(node: Filter, draw: Draw, function: str, edge: Edge) -> Mapping[str, Drawn]:
    """One draw for each output."""
    pictures = tuple(node.inputs.values())
    values = {name: getattr(node, name) for name in node.values}
    return {
        name: draw(f"{function}_{name}", *pictures, edge=edge, result=output.socket, **values)
        for name, output in node.outputs.items()
    }
