"""`halation export-isf`: a graph as one shader for other programs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from . import parsing
from .options import AsJson, GraphFile, Node, Sets, SizeText, open_graph, report_problems
from .outcome import note, print_json

if TYPE_CHECKING:
    from ..graph import Graph, Port


def export_isf(
    graph: GraphFile,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FILE.fs", help="The shader; by default standard output.")
    ] = None,
    sets: Sets = None,
    node: Node = "",
    selection: Annotated[
        str, typer.Option("--select", metavar="ID,ID,...", help="Only these nodes: what feeds them becomes pictures.")
    ] = "",
    size: SizeText = None,
    as_json: AsJson = False,
) -> int:
    """Write a graph as one shader in the Interactive Shader Format, for programs that play such shaders.

    Its pictures become pictures of the shader, its controls inputs. What no shader can do is listed, node by node.
    """
    from ..compiler.isf import export_isf as exported
    from ..errors import GraphError, UsageError
    from ..inputs.lazy_provider import LazyResourceProvider

    if as_json and output is None:
        raise UsageError("--json and a shader would both go to standard output: write the shader to a file with -o")
    opened_graph = open_graph(graph, parsing.sets(sets))
    report_problems(graph, opened_graph)
    if selection:
        from ..graph.selection import selected

        try:
            opened_graph = selected(opened_graph, [part.strip() for part in selection.split(",") if part.strip()])
        except GraphError as fault:
            raise UsageError(f"--select {selection}: {fault}") from None
    target = _target(opened_graph, node)
    shader = exported(opened_graph, target, LazyResourceProvider(), size=parsing.size(size))
    if shader.reasons:
        reasons = [f"{_owner(owner)} {why}" for owner, why in shader.reasons]
        for line in reasons[1:] if len(reasons) > 1 else ():
            note(f"{graph}: {line}")
        more = f" (the first of {len(reasons)} reasons)" if len(reasons) > 1 else ""
        raise GraphError(f"{graph}: it cannot be written as one shader: {reasons[0]}{more}", node=shader.reasons[0][0])
    for line in shader.notes:
        note(f"{graph}: {line}")
    if output is None:
        print(shader.text, end="")
    else:
        from ..resources.atomic_write import write_text_atomically

        write_text_atomically(output, shader.text)
    if as_json:
        print_json({"file": str(output), "notes": list(shader.notes)})
    return 0


def _target(graph: Graph, node: str) -> Port:
    """The only output of the graph, or that of a node."""
    from ..errors import UsageError

    targets = parsing.targets(graph, node)
    if node:
        return next(iter(targets.values()))
    from ..graph import OUTPUTS, Port

    if len(graph.outputs) != 1:
        names = ", ".join(graph.outputs) or "none"
        raise UsageError(f"a shader makes one picture, and the outputs of this graph are {names}: choose by --node")
    return Port(OUTPUTS, next(iter(graph.outputs)))


def _owner(owner: str) -> str:
    if not owner:
        return "it"
    return f"input '{owner.removeprefix('inputs.')}'" if owner.startswith("inputs.") else f"node '{owner}'"
