"""How a node of user code that looks around in its pictures is drawn."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from halation.nodes import Draw, Drawn, Edge, Filter, Value

PARAMETER = "halation_"
"""The prefix of parameters in functions that are drawn: without it a value named `size` or `edge` would be taken for an
option of the draw. Code of users cannot use such names."""


def make_passes(node: Filter, draw: Draw, function: str, edge: Edge) -> Mapping[str, Drawn]:
    """One draw for each output."""
    pictures = tuple(node.inputs.values())
    values = {f"{PARAMETER}{name}": _find_argument(node, value) for name, value in node.values.items()}
    return {
        name: draw(f"{function}_{name}", *pictures, edge=edge, result=output.socket, **values)
        for name, output in node.outputs.items()
    }


def _find_argument(node: Filter, value: Value) -> Any:
    """What the function gets for a value: for a choice its number, since a draw looks a text up by the parameter."""
    setting = node.setting(value.name)
    return value.choices.index(setting) if value.choices else setting
