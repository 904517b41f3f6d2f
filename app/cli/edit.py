"""`halation edit`: the desktop editor."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..resources.sandbox import read_process_sandbox
from . import parsing
from .options import Inputs, locate_graph, resolve_inputs


def edit(
    graph: Annotated[
        Path | None,
        typer.Argument(
            parser=locate_graph,
            metavar="[GRAPH]",
            help="A graph file (JSON), or the name of a preset; without one the start screen opens.",
        ),
    ] = None,
    inputs: Inputs = None,
) -> int:
    """Open the editor."""
    from ..errors import UsageError

    if graph is None and inputs:
        raise UsageError("-i needs a graph: name the graph file too")
    sandbox = read_process_sandbox()
    bindings: dict[str, str] = {}
    if graph is not None:
        from .. import document

        bindings = resolve_inputs(document.load(graph, sandbox=sandbox), parsing.parse_inputs(inputs))
    from ..editor import edit as open_editor

    open_editor(graph, bindings, sandbox)
    return 0
