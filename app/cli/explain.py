"""`halation explain`: what a graph compiles to."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

import typer

from . import parsing
from .options import (
    AsJson,
    GraphFile,
    Inputs,
    Memory,
    Node,
    Scale,
    Sets,
    SizeText,
    open_graph,
    report_problems,
    resolve_inputs,
)
from .outcome import print_json

if TYPE_CHECKING:
    from ..compiler import Form, Target


def explain(
    graph: GraphFile,
    inputs: Inputs = None,
    sets: Sets = None,
    node: Node = "",
    size: SizeText = None,
    scale: Scale = 1.0,
    frame: Annotated[int | None, typer.Option(help="The frame to plan; by default the first of the graph.")] = None,
    form: Annotated[
        str,
        typer.Option(
            metavar="fragment|compute|device",
            help="Plan for this form of passes, or for the device that is here.",
        ),
    ] = "compute",
    precision: Annotated[
        str | None, typer.Option(metavar="half|float", help="Precision of color intermediates.")
    ] = None,
    memory: Memory = None,
    dot: Annotated[bool, typer.Option("--dot", help="Print Graphviz.")] = False,
    as_json: AsJson = False,
) -> int:
    """Print passes, fused nodes, formats, slots, bytes and the peak of memory. Needs no OpenGL.

    With --form device it says which form of passes the device here is given, and why.
    """
    from msgspec.structs import replace

    from .. import compiler
    from ..errors import UsageError
    from ..inputs.lazy_provider import LazyResourceProvider

    if dot and as_json:
        raise UsageError("--dot and --json: choose one")
    way, most = parsing.form_or_device(form), parsing.memory(memory)
    depth = parsing.precision(precision) if precision is not None else None
    opened_graph = open_graph(graph, parsing.sets(sets))
    report_problems(graph, opened_graph)
    lazy = LazyResourceProvider()
    bindings = resolve_inputs(opened_graph, parsing.inputs(inputs))
    request = compiler.Request(
        parsing.targets(opened_graph, node),
        lazy.bind(opened_graph, bindings),
        parsing.size(size),
        parsing.scale(scale),
        frame if frame is not None else lazy.find_frames(opened_graph, bindings)[0],
    )
    target = replace(_target(way), memory=most)
    # As if each went into an EXR of its own.
    request = replace(request, by_rows=frozenset(request.targets or opened_graph.outputs))
    plan = compiler.compile_graph(opened_graph, request, lazy, target=target, precision=depth)
    if as_json:
        print_json(compiler.plan_as_json(plan))
    else:
        print(compiler.write_dot(plan) if dot else compiler.explain(plan))
    return 0


def _target(form: Form | Literal["device"]) -> Target:
    """What to plan for: the device that is here, or none."""
    from msgspec.structs import replace

    if form != "device":
        from ..compiler import NULL

        return replace(NULL, form=form)
    from ..renderer import open_device

    return open_device().target
