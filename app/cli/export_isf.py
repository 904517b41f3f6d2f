"""`halation export-isf`: writes a graph as one shader for other programs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..resources.sandbox import Sandbox
from . import parsing
from .options import AsJson, GraphFile, Node, Sets, SizeText, open_graph, report_problems
from .outcome import print_json, print_note

if TYPE_CHECKING:
    from ..graph import Graph, Port


def export_isf(
    graph: GraphFile,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE.fs", help="The file to write; by default standard output."),
    ] = None,
    sets: Sets = None,
    node: Node = "",
    selection: Annotated[
        str,
        typer.Option(
            "--select", metavar="ID,ID,...", help="Export only these nodes; the links into them become inputs."
        ),
    ] = "",
    size: SizeText = None,
    as_json: AsJson = False,
    *,
    sandbox: Sandbox,
) -> int:
    """Write a graph as one ISF shader.

    Programs that play the Interactive Shader Format can use it. Inputs and controls of the graph become inputs of the
    shader. If a node cannot be part of a shader, the command lists each such node with the reason.
    """
    from ..compiler.isf import export_isf as export_shader
    from ..errors import GraphError, UsageError, describe_owner
    from ..inputs.lazy_provider import LazyResourceProvider

    if as_json and output is None:
        raise UsageError("--json and the shader would both go to standard output: write the shader to a file with -o")
    opened_graph = open_graph(graph, parsing.parse_sets(sets), sandbox=sandbox)
    report_problems(graph, opened_graph)
    if selection:
        from ..graph.selection import select_nodes

        try:
            opened_graph = select_nodes(opened_graph, [part.strip() for part in selection.split(",") if part.strip()])
        except GraphError as fault:
            raise UsageError(f"--select {selection}: {fault}") from None
    target = _choose_port(opened_graph, node)
    shader = export_shader(opened_graph, target, LazyResourceProvider(sandbox), size=parsing.parse_size(size))
    if shader.reasons:
        reasons = [f"{describe_owner(owner) if owner else 'it'} {why}" for owner, why in shader.reasons]
        for line in reasons[1:] if len(reasons) > 1 else ():
            print_note(f"{graph}: {line}")
        more = f" (the first of {len(reasons)} reasons)" if len(reasons) > 1 else ""
        raise GraphError(f"{graph}: it cannot be written as one shader: {reasons[0]}{more}", node=shader.reasons[0][0])
    for line in shader.notes:
        print_note(f"{graph}: {line}")
    if output is None:
        print(shader.text, end="")
    else:
        from ..resources.atomic_write import write_text_atomically

        write_text_atomically(output, shader.text, sandbox=sandbox)
    if as_json:
        print_json({"file": str(output), "notes": list(shader.notes)})
    return 0


def _choose_port(graph: Graph, node: str) -> Port:
    """The port to export: the only output of the graph, or the one that --node names. Raises UsageError."""
    from ..errors import UsageError

    targets = parsing.find_targets(graph, node)
    if node:
        return next(iter(targets.values()))
    from ..graph import OUTPUTS, Port

    if len(graph.outputs) != 1:
        names = ", ".join(graph.outputs) or "none"
        raise UsageError(f"a shader has one output, and the outputs of this graph are {names}: choose one with --node")
    return Port(OUTPUTS, next(iter(graph.outputs)))
