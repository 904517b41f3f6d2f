"""Migrations: documents of older formats, converted to the newest one format at a time.

A migration works on plain JSON, before anything is checked, and never on classes of this version: these change later,
and an old migration must not change with them. Values of nodes are not converted here: each node converts its own
(`upgrade`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

Document = dict[str, Any]
Migration = Callable[[Document], Document]
"""A pure function from a body (a document, or the graph of an inline group) of one format to the next."""

MIGRATIONS: Mapping[int, Migration] = MappingProxyType({})
"""By the format that they start from, without gaps. A frozen file of each format is tested."""


def newest(migrations: Mapping[int, Migration]) -> int:
    """The format that these migrations lead to."""
    return max(migrations, default=0) + 1


FORMAT = newest(MIGRATIONS)
"""The format that is written."""


def migrate(document: Document, format: int, migrations: Mapping[int, Migration]) -> Document:
    """`document` of `format` in the newest format. For a damaged document the migration raises its own exception."""
    for number in range(format, newest(migrations)):
        document = _everywhere(document, migrations[number])
    return document


def _everywhere(body: Document, step: Migration) -> Document:
    """The body after one step, and the graphs of its inline groups too."""
    body = step(body)
    nodes: Document = body.get("nodes", {})
    moved = {id: {**node, "graph": _everywhere(node["graph"], step)} for id, node in nodes.items() if _is_inline(node)}
    return {**body, "nodes": {**nodes, **moved}} if moved else body


def _is_inline(node: Any) -> bool:
    return isinstance(node, dict) and node.get("type") == "group" and isinstance(node.get("graph"), dict)  # pyright: ignore
