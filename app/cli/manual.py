"""Writes the catalogue of nodes as one Markdown page."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from ..reference.facts import default_text, hard_range, node_doc, output_type, socket_note, socket_type, soft_range

if TYPE_CHECKING:
    from halation.nodes import Node, Socket, Value

_INTRODUCTION = """\
# Nodes

{count} nodes in {menus} menus. A value has a default, a range that its slider covers, and limits that typing cannot
leave. Units: `px` pixels at full size, `height` a fraction of the height of the picture, `deg` degrees, `EV`
photographic stops, `ratio` a factor, `count` a whole number of things, `s` seconds, `scene` the units of the scene,
`K` kelvin, `mm` millimeters.

Every node that changes its input `image` at the same size has a mask: an input `mask` says where the change is seen,
from 0 to 1, and without a link it is seen everywhere. The value `mix` (0 to 1) says how much of it is seen, and
`invert_mask` exchanges inside and outside. Both apply to the first output. Nodes with a mask of their own say what it
does, and have only the mix. An output that is an `Image or Field as image` is a Field if a Field is linked to `image`.
"""


def catalogue_page(nodes: Sequence[type[Node]]) -> str:
    """The page: for each menu a table, then a section per node."""
    menus: dict[str, list[type[Node]]] = {}
    for node in nodes:
        menus.setdefault(node.category, []).append(node)
    contents = ", ".join(f"[{name}](#{_slug(_menu_title(name, menu))})" for name, menu in menus.items())
    blocks = [_INTRODUCTION.format(count=len(nodes), menus=len(menus)).rstrip(), contents]
    for name, menu in menus.items():
        blocks += [f"## {_menu_title(name, menu)}", _menu_table(menu)]
        for node in menu:
            blocks += write_node_section(node)
    return "\n\n".join(blocks) + "\n"


def _menu_title(name: str, menu: Sequence[type[Node]]) -> str:
    """The name of a menu and its number of nodes, so that its anchor differs from those of nodes."""
    return f"{name.capitalize()} ({len(menu)})"


def _slug(heading: str) -> str:
    """The anchor that Markdown viewers give a heading."""
    return re.sub(r"[^\w-]", "", heading.lower().replace(" ", "-"))


def _menu_table(nodes: Iterable[type[Node]]) -> str:
    rows = [
        (
            f"[{node.id}](#{_slug(node.id)})",
            escape_markdown(node_doc(node).splitlines()[0]),
            _list_sockets(node.inputs),
            ", ".join(f"`{name}` {output_type(output)}" for name, output in node.outputs.items()),
        )
        for node in nodes
    ]
    return _table(("node", "what it does", "inputs", "outputs"), rows)


def write_node_section(node: type[Node]) -> Iterator[str]:
    """The Markdown blocks about a node: its heading, what it does, and tables of inputs, outputs and values."""
    yield f"### {node.id}"
    if node.required_package:
        yield _escape_paragraph(f"From the plug-in {node.required_package.replace('==', ' ')}.")
    for paragraph in node_doc(node).split("\n\n"):
        yield _escape_paragraph(paragraph)
    if node.aliases:
        yield _escape_paragraph(f"Also known as {', '.join(node.aliases)}.")
    outputs = {name: output.socket for name, output in node.outputs.items()}
    for title, sockets in (("input", node.inputs), ("output", outputs)):
        explained = {name: socket for name, socket in sockets.items() if socket_note(socket) and not socket.folded}
        if explained:
            rows = [
                (f"`{name}`", socket_type(socket), escape_markdown(socket_note(socket)))
                for name, socket in explained.items()
            ]
            yield _table((title, "type", ""), rows)
    values = [value for value in node.values.values() if not value.folded]
    if values:
        yield _table(("value", "type", "default", "range", "limits", "unit", ""), map(_value_row, values))


def _value_row(value: Value) -> tuple[str, ...]:
    choices = ", ".join(f"`{choice}`" for choice in value.choices)
    return (
        f"`{value.name}`",
        value.type,
        escape_markdown(default_text(value)),
        soft_range(value),
        hard_range(value),
        value.unit or "",
        escape_markdown(". ".join(filter(None, (choices, value.doc)))),
    )


def _list_sockets(sockets: Mapping[str, Socket]) -> str:
    return ", ".join(f"`{name}` {socket_type(socket)}" for name, socket in sockets.items())


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *([cell.replace("|", "\\|") for cell in row] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _escape_paragraph(text: str) -> str:
    """Escape a paragraph, also where its start looks like a list or the line under a heading."""
    return re.sub(r"^(\d+)(?=[.)] )|^(?=[-+=] )", r"\1\\", escape_markdown(text))


def escape_markdown(text: str) -> str:
    """Escape a text for Markdown and put it on one line; text between backticks stays as it is."""
    parts = " ".join(text.split()).split("`")
    parts[::2] = [re.sub(r"([\\*_<>\[\]~#]|&(?=\w))", r"\\\1", part) for part in parts[::2]]
    return "`".join(parts)
