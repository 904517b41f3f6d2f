"""`halation edit`: the desktop editor."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..resources.sandbox import Sandbox, read_process_sandbox
from . import parsing
from .options import Inputs, locate_graph, resolve_inputs


def edit(
    graph: Annotated[
        Path | None,
        typer.Argument(
            parser=locate_graph,
            metavar="[GRAPH]",
            help="A graph file (JSON), the name of a preset, or a picture, which a new graph reads; without one the "
            "start screen opens.",
        ),
    ] = None,
    inputs: Inputs = None,
    show_errors: Annotated[
        bool, typer.Option("--show-errors", hidden=True, help="Show an error in a window: a menu has no terminal.")
    ] = False,
) -> int:
    """Open the editor."""
    from ..errors import HalationError

    try:
        return _open_editor(graph, inputs)
    except HalationError as fault:
        if show_errors:
            from ..desktop import show_error

            show_error(str(fault))
        raise


def _open_editor(graph: Path | None, inputs: list[str] | None) -> int:
    from ..errors import UsageError

    if graph is None and inputs:
        raise UsageError("-i needs a graph: name the graph file too")
    sandbox = read_process_sandbox()
    bindings: dict[str, str] = {}
    if graph is not None and graph.suffix.lower() != ".json" and _is_picture(graph):
        if inputs:
            raise UsageError(f"{graph}: -i is for the inputs of a graph, and this is a picture: leave -i out")
        _check_is_there(graph, sandbox)
    elif graph is not None:
        from .. import document

        bindings = resolve_inputs(document.load(graph, sandbox=sandbox), parsing.parse_inputs(inputs))
    from ..editor import edit as open_editor

    open_editor(graph, bindings, sandbox)
    return 0


def _is_picture(path: Path) -> bool:
    from ..media.pictures.file_endings import is_picture

    return is_picture(path)


def _check_is_there(path: Path, sandbox: Sandbox) -> None:
    """Raise InputError if there is no such picture, before a window opens."""
    from ..resources.input_files import check_file
    from ..watch.sequence_files import representative_file

    check_file(representative_file(path, sandbox=sandbox), sandbox)
