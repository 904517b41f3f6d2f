"""Describes node types, for `halation nodes` and the page of all nodes."""

from __future__ import annotations

import inspect
import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, cast

if TYPE_CHECKING:
    from halation.nodes import ItemSet, Node, OutputSocket, Socket, Value


def node_doc(node: type[Node]) -> str:
    """The docstring of a node: a sentence, then details and sources."""
    return inspect.getdoc(node) or ""


def socket_type(socket: Socket) -> str:
    """The kind of a socket; of a Vector with its number of channels."""
    return f"{socket.kind}{socket.channels if socket.kind == 'Vector' else ''}"


def format_value(plain: object) -> str:
    """A value as a user types it."""
    if isinstance(plain, tuple):
        return ", ".join(format_value(part) for part in plain)
    if isinstance(plain, bool):
        return str(plain).lower()
    return f"{plain:g}" if isinstance(plain, float) else str(plain)


def default_text(value: Value) -> str:
    """The default of a value; of a curve or ramp the number of points, of named items their names."""
    default = value.default
    if isinstance(default, Mapping):
        return ", ".join(cast("Mapping[str, object]", default)) or "none"
    if isinstance(default, tuple) and value.type in ("curve", "ramp", "spline", "stroke"):
        word = {"curve": "point", "ramp": "stop", "spline": "point", "stroke": "point"}[value.type]
        count = len(default) // value.length
        return f"{count} {word}{'' if count == 1 else 's'}"
    return format_value(default)


def socket_note(socket: Socket) -> str:
    """The description of a socket, and of an optional input its value without a link."""
    optional = f"Optional: {format_value(socket.default)} if unlinked." if socket.optional else ""
    return " ".join(part for part in (socket.doc, optional) if part)


def soft_range(value: Value) -> str:
    """The range of the slider of a value."""
    return f"{value.low:g} .. {value.high:g}" if math.isfinite(value.low) and math.isfinite(value.high) else ""


def hard_range(value: Value) -> str:
    """The limits of a value, which typing cannot exceed either."""
    ends = (("at least", value.minimum), ("at most", value.maximum))
    return ", ".join(f"{word} {limit:g}" for word, limit in ends if math.isfinite(limit))


def output_type(output: OutputSocket) -> str:
    """The type of an output, such as `Image or Field as image`."""
    return f"{socket_type(output.socket)}{f' or Field as {output.follows}' if output.follows else ''}"


def node_facts(node: type[Node]) -> dict[str, Any]:
    """All facts about a node type, as JSON."""
    return {
        "id": node.id,
        "category": node.category,
        "version": node.version,
        **({"package": node.required_package} if node.required_package else {}),
        "doc": node_doc(node),
        "aliases": list(node.aliases),
        "inputs": {name: _socket_facts(socket) for name, socket in node.inputs.items()},
        "outputs": {
            name: _socket_facts(output.socket) | ({"follows": output.follows} if output.follows else {})
            for name, output in node.outputs.items()
        },
        "values": {value.name: _value_facts(value) for value in node.values.values()},
        "plan": plan_facts(node),
    }


def plan_facts(node: type[Node], values: Mapping[str, Any] = MappingProxyType({})) -> dict[str, Any]:
    """The passes that a node compiles to, at its defaults but for `values`, with what each writes."""
    from .. import compiler
    from .specimen import FULL_HD, drawable_outputs, plan_node

    if not drawable_outputs(node):
        return {"size": list(FULL_HD), "passes": [], "peak_bytes": 0}
    plan: dict[str, Any] = compiler.plan_as_json(plan_node(node, FULL_HD, values=values))
    surfaces = plan["surfaces"]
    passes = [
        {
            "label": " + ".join(item["functions"]),
            "writes": [{"size": surfaces[at]["size"], "format": surfaces[at]["format"]} for at in item["writes"]],
        }
        for item in plan["passes"]
    ]
    return {"size": list(FULL_HD), "passes": passes, "peak_bytes": plan["peak_bytes"]}


def _value_facts(value: Value) -> dict[str, Any]:
    from ..graph.named_items import describe_items

    facts: dict[str, Any] = {
        "type": value.type,
        "default": value.default
        if value.items is None
        else describe_items(value.items, cast("ItemSet", value.default)),
        "choices": list(value.choices),
        "unit": value.unit,
        "soft": _finite(value.low, value.high),
        "hard": _finite(value.minimum, value.maximum),
        "doc": value.doc,
    }
    kinds = value.items.kinds if value.items else ()
    fields = {kind.name: {part.name: _value_facts(part) for part in kind.declarations} for kind in kinds}
    return {**facts, "kinds": fields} if fields else facts


def _socket_facts(socket: Socket) -> dict[str, Any]:
    return {"type": socket_type(socket), "default": socket.default, "doc": socket.doc}


def _finite(low: float, high: float) -> list[float | None]:
    return [limit if math.isfinite(limit) else None for limit in (low, high)]
