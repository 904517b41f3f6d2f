"""What there is to say of a node type, for every page that shows one."""

from __future__ import annotations

import inspect
import math
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from halation.nodes import Node, Socket, Value


def doc_of(node: type[Node]) -> str:
    """What a node says of itself: a sentence, then where it comes from."""
    return inspect.getdoc(node) or ""


def type_of(socket: Socket) -> str:
    """A socket's kind, and how many numbers a Vector has."""
    return f"{socket.kind}{socket.channels if socket.kind == 'Vector' else ''}"


def plain_text(plain: object) -> str:
    """A value as a person writes it."""
    if isinstance(plain, tuple):
        return ", ".join(plain_text(part) for part in plain)
    if isinstance(plain, bool):
        return str(plain).lower()
    return f"{plain:g}" if isinstance(plain, float) else str(plain)


def default_text(value: Value) -> str:
    """The default of a value; of a long list how many entries it has."""
    default = value.default
    if isinstance(default, tuple) and value.type in ("curve", "ramp", "lights"):
        word = {"curve": "point", "ramp": "stop", "lights": "light"}[value.type]
        count = len(default) // value.length
        return f"{count} {word}{'' if count == 1 else 's'}"
    return plain_text(default)


def socket_note(socket: Socket) -> str:
    """What there is to say of a socket, and of an input what it is without a link."""
    optional = f"Optional: {plain_text(socket.default)} if unlinked." if socket.optional else ""
    return " ".join(part for part in (socket.doc, optional) if part)


def soft_range(value: Value) -> str:
    """From where to where a slider goes."""
    return f"{value.low:g} .. {value.high:g}" if math.isfinite(value.low) and math.isfinite(value.high) else ""


def hard_range(value: Value) -> str:
    """What typing cannot leave."""
    ends = (("at least", value.minimum), ("at most", value.maximum))
    return ", ".join(f"{word} {limit:g}" for word, limit in ends if math.isfinite(limit))


def facts_of(node: type[Node]) -> dict[str, Any]:
    """Everything, for machines."""
    return {
        "id": node.id,
        "category": node.category,
        "version": node.version,
        **({"package": node.required_package} if node.required_package else {}),
        "doc": doc_of(node),
        "inputs": {name: _socket_facts(socket) for name, socket in node.inputs.items()},
        "outputs": {name: _socket_facts(output.socket) for name, output in node.outputs.items()},
        "values": {
            value.name: {
                "type": value.type,
                "default": value.default,
                "choices": list(value.choices),
                "unit": value.unit,
                "soft": _finite(value.low, value.high),
                "hard": _finite(value.minimum, value.maximum),
                "doc": value.doc,
            }
            for value in node.values.values()
        },
        "plan": passes_of(node),
    }


def passes_of(node: type[Node]) -> dict[str, Any]:
    """What a node compiles to at its defaults: its passes, with what each writes."""
    from .. import compiler
    from .specimen import FULL_HD, drawable_outputs, plan_node

    if not drawable_outputs(node):
        return {"size": list(FULL_HD), "passes": [], "peak_bytes": 0}
    plan: dict[str, Any] = compiler.plan_as_json(plan_node(node, FULL_HD))
    surfaces = plan["surfaces"]
    passes = [
        {
            "label": " + ".join(item["functions"]),
            "writes": [{"size": surfaces[at]["size"], "format": surfaces[at]["format"]} for at in item["writes"]],
        }
        for item in plan["passes"]
    ]
    return {"size": list(FULL_HD), "passes": passes, "peak_bytes": plan["peak_bytes"]}


def _socket_facts(socket: Socket) -> dict[str, Any]:
    return {"type": type_of(socket), "default": socket.default, "doc": socket.doc}


def _finite(low: float, high: float) -> list[float | None]:
    return [limit if math.isfinite(limit) else None for limit in (low, high)]
