"""`halation explain`: what a graph compiles to."""

from __future__ import annotations

from typing import Annotated

import typer

from . import parsing
from .options import AsJson, GraphFile, Inputs, Lazy, Node, Scale, Sets, SizeText, opened, report_problems
from .outcome import print_json


def explain(
    graph: GraphFile,
    inputs: Inputs = None,
    sets: Sets = None,
    node: Node = "",
    size: SizeText = None,
    scale: Scale = 1.0,
    frame: Annotated[int | None, typer.Option(help="The frame to plan; by default the first of the graph.")] = None,
    form: Annotated[str, typer.Option(metavar="fragment|compute", help="Plan for this form of passes.")] = "compute",
    precision: Annotated[str, typer.Option(metavar="half|float", help="Precision of color intermediates.")] = "float",
    dot: Annotated[bool, typer.Option("--dot", help="Print Graphviz.")] = False,
    as_json: AsJson = False,
) -> int:
    """Print passes, fused nodes, formats, slots, bytes and the peak of memory. Needs no OpenGL."""
    from dataclasses import replace

    from .. import compiler
    from ..errors import UsageError

    if dot and as_json:
        raise UsageError("--dot and --json: choose one")
    target = replace(compiler.NULL, form=parsing.form(form))
    depth = parsing.precision(precision)
    opened_graph = opened(graph, sets or ())
    report_problems(graph, opened_graph)
    lazy = Lazy()
    request = compiler.Request(
        parsing.targets(opened_graph, node), lazy.bind(opened_graph, inputs or ()), parsing.size(size),
        parsing.scale(scale), frame if frame is not None else lazy.frames(opened_graph, inputs or ())[0],
    )
    plan = compiler.compile_graph(opened_graph, request, lazy, target=target, precision=depth)
    if as_json:
        print_json(compiler.as_json(plan))
    else:
        print(compiler.dot(plan) if dot else compiler.explain(plan))
    return 0
