"""`halation explain`: what a graph compiles to."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from . import parsing
from .options import AsJson, Inputs, Scale, Sets, SizeText, bound, opened, report_problems
from .outcome import guarded, print_json


@guarded
def explain(
    graph: Annotated[Path, typer.Argument(help="A graph, as JSON.")],
    inputs: Inputs = (),  # type: ignore[assignment]
    sets: Sets = (),  # type: ignore[assignment]
    size: SizeText = None,
    scale: Scale = 1.0,
    form: Annotated[str, typer.Option(metavar="fragment|compute", help="Plan for this form of passes.")] = "compute",
    precision: Annotated[str, typer.Option(metavar="half|float", help="Precision of color intermediates.")] = "float",
    dot: Annotated[bool, typer.Option("--dot", help="Print Graphviz.")] = False,
    as_json: AsJson = False,
) -> None:
    """Print passes, fused nodes, formats, slots, bytes and the peak of memory. Needs no OpenGL."""
    from dataclasses import replace

    from .. import compiler
    from ..media.pictures import Pictures

    parsing.choice(form, ("fragment", "compute"), "--form")
    parsing.choice(precision, ("half", "float"), "--precision")
    opened_graph = opened(graph, sets)
    report_problems(graph, opened_graph)
    pictures = Pictures()
    bindings = pictures.bind(opened_graph, bound(opened_graph, inputs))
    request = compiler.Request(bindings=bindings, size=parsing.size(size), scale=parsing.scale(scale))
    target = replace(compiler.NULL, form=form)  # type: ignore[arg-type]
    plan = compiler.compile_graph(
        opened_graph, request, pictures.probe, target=target, precision=precision  # type: ignore[arg-type]
    )
    if as_json:
        print_json(compiler.as_json(plan))
    else:
        print(compiler.dot(plan) if dot else compiler.explain(plan))
