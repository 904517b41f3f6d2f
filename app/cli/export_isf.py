"""`halation export-isf`: what `halation export --to isf` does."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..resources.sandbox import Sandbox
from .export import Selection, export
from .options import AsJson, GraphFile, Node, Sets, SizeText


def export_isf(
    graph: GraphFile,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE.fs", help="The file to write; by default standard output."),
    ] = None,
    sets: Sets = None,
    node: Node = "",
    selection: Selection = "",
    size: SizeText = None,
    as_json: AsJson = False,
    *,
    sandbox: Sandbox,
) -> int:
    """Write a graph as one ISF shader: the same as export --to isf."""
    return export(
        graph,
        "isf",
        output,
        sets=sets,
        node=node,
        selection=selection,
        size=size,
        as_json=as_json,
        sandbox=sandbox,
    )
