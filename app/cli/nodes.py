"""`halation nodes`: the catalogue."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .options import AsJson
from .outcome import print_json

if TYPE_CHECKING:
    from ...nodes import Node, Socket, Value


def nodes(
    id: Annotated[str, typer.Argument(help="A node; without one, all are listed.")] = "",
    as_json: AsJson = False,
) -> int:
    """List the nodes, or show one with its sockets, values, ranges and units."""
    from ...nodes import catalogue
    from ..errors import UsageError
    from ..graph import did_you_mean

    known = catalogue()
    if id and id not in known:
        raise UsageError(f"there is no node '{id}'{did_you_mean(id, known)}")
    if as_json:
        print_json(_facts(known[id]) if id else {"nodes": [_facts(node) for node in known.values()]})
    elif id:
        _page(known[id])
    else:
        _list(list(known.values()))
    return 0


def _list(classes: list[type[Node]]) -> None:
    width = max(len(node.id) for node in classes)
    category = ""
    for node in classes:
        if node.category != category:
            category = node.category
            print(f"\n{category}")
        print(f"  {node.id:<{width}}  {_doc(node).splitlines()[0]}")


def _page(node: type[Node]) -> None:
    print(f"{node.id}  ({node.category}, version {node.version})\n\n{_doc(node)}\n")
    for title, sockets in (
        ("inputs", node.inputs), ("outputs", {name: output.socket for name, output in node.outputs.items()})
    ):
        if sockets:
            print(title)
            for name, socket in sockets.items():
                print(f"  {name:<16} {_type(socket):<10} {_socket_note(socket, title)}".rstrip())
            print()
    if node.values:
        print("values")
        for value in node.values.values():
            print(f"  {value.name:<16} {value.type:<10} {_shown(value.default):<14} {_range(value)}".rstrip())
            if value.doc:
                print(f"  {'':<16} {value.doc}")


def _doc(node: type[Node]) -> str:
    return inspect.getdoc(node) or ""


def _type(socket: Socket) -> str:
    return f"{socket.kind}{socket.channels if socket.kind == 'Vector' else ''}"


def _socket_note(socket: Socket, title: str) -> str:
    optional = f"optional, {_shown(socket.default)} if unlinked" if title == "inputs" and socket.optional else ""
    return "; ".join(part for part in (socket.doc, optional) if part)


def _shown(plain: object) -> str:
    if isinstance(plain, tuple):
        return ", ".join(_shown(part) for part in plain)
    return f"{plain:g}" if isinstance(plain, float) else str(plain)


def _range(value: Value) -> str:
    if value.choices:
        return " | ".join(value.choices)
    if value.unit is None:
        return ""
    soft = f"{value.low:g} .. {value.high:g} {value.unit}"
    hard = [
        f"{word} {limit:g}"
        for word, limit in (("at least", value.minimum), ("at most", value.maximum)) if abs(limit) != float("inf")
    ]
    return f"{soft} ({', '.join(hard)})" if hard else soft


def _facts(node: type[Node]) -> dict[str, Any]:
    return {
        "id": node.id, "category": node.category, "version": node.version, "doc": _doc(node),
        "inputs": {name: _socket_facts(socket) for name, socket in node.inputs.items()},
        "outputs": {name: _socket_facts(output.socket) for name, output in node.outputs.items()},
        "values": {
            value.name: {
                "type": value.type, "default": value.default, "choices": list(value.choices), "unit": value.unit,
                "soft": _finite(value.low, value.high), "hard": _finite(value.minimum, value.maximum), "doc": value.doc,
            }
            for value in node.values.values()
        },
    }


def _socket_facts(socket: Socket) -> dict[str, Any]:
    return {"type": _type(socket), "default": socket.default, "doc": socket.doc}


def _finite(low: float, high: float) -> list[float | None]:
    return [None if abs(limit) == float("inf") else limit for limit in (low, high)]
