"""`halation explain`: prints the passes that a graph compiles to."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple

import typer

from ..resources.render_choices import DEFAULT_TIMEOUT
from ..resources.sandbox import Sandbox
from . import parsing
from .options import (
    AsJson,
    GraphFile,
    Inputs,
    Memory,
    Node,
    OneFrame,
    PassPrecision,
    Scale,
    Sets,
    SizeText,
    open_graph,
    report_problems,
    resolve_inputs,
)
from .outcome import print_json
from .watchdog import Timeout, run_watched

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from ..compiler import Form, Plan, Request, ResolvedLength, Target
    from ..graph import Graph, Output
    from ..inputs.lazy_provider import LazyResourceProvider
    from ..inputs.provider import Binding

_Form = Annotated[
    str,
    typer.Option(
        metavar="fragment|compute|device",
        help="Plan passes as fragment or as compute shaders, or as the device of this machine needs them.",
    ),
]
_Dot = Annotated[bool, typer.Option("--dot", help="Print the passes as a Graphviz graph.")]
_Html = Annotated[
    Path | None, typer.Option("--html", metavar="FILE", help="Run the passes, and write a page of their pictures.")
]


def explain(
    graph: GraphFile,
    inputs: Inputs = None,
    sets: Sets = None,
    node: Node = "",
    size: SizeText = None,
    scale: Scale = 1.0,
    frame: OneFrame = None,
    form: _Form = "",
    precision: PassPrecision = None,
    memory: Memory = None,
    dot: _Dot = False,
    html: _Html = None,
    timeout: Timeout = DEFAULT_TIMEOUT,
    as_json: AsJson = False,
    *,
    sandbox: Sandbox,
) -> int:
    """Print the passes that a graph compiles to.

    Prints their nodes, texture formats and slots, bytes and the peak of memory, and how many pixels each length is.
    Needs no OpenGL, except for --html and --form device, which also prints which form of passes the device of this
    machine needs, and why.
    """
    from ..compiler import Request
    from ..errors import UsageError
    from ..inputs.lazy_provider import LazyResourceProvider

    if dot + as_json + (html is not None) > 1:
        raise UsageError("--dot, --html and --json: choose one")
    form_or_device, memory_limit = parsing.parse_form_or_device(form or "compute"), parsing.parse_memory(memory)
    opened_graph = open_graph(graph, parsing.parse_sets(sets), sandbox=sandbox)
    report_problems(graph, opened_graph)
    provider = LazyResourceProvider(sandbox)
    bindings = resolve_inputs(opened_graph, parsing.parse_inputs(inputs))
    request = Request(
        parsing.find_targets(opened_graph, node),
        provider.bind(opened_graph, bindings),
        parsing.parse_size(size),
        parsing.parse_scale(scale),
        frame if frame is not None else provider.find_frames(opened_graph, bindings)[0],
    )
    if html is not None:
        wanted_form = form_or_device if form and form_or_device != "device" else None
        title = graph.stem.replace("_", " ").capitalize()
        order = _PageOrder(html, title, opened_graph, bindings, wanted_form, memory_limit, precision)
        page = partial(_write_page, order, request, sandbox)
        return run_watched(page, (opened_graph,), timeout, as_json, memory=memory_limit)
    plan = _compile(opened_graph, request, provider, _choose_target(form_or_device, memory_limit, sandbox), precision)
    _print_plan(opened_graph, plan, request, provider, "dot" if dot else "json" if as_json else "text")
    return 0


def _compile(
    graph: Graph, request: Request, provider: LazyResourceProvider, target: Target, precision: str | None
) -> Plan:
    """The plan for one EXR file per output."""
    from msgspec.structs import replace

    from ..compiler import compile_graph

    request = replace(request, by_rows=frozenset(request.targets or graph.outputs))
    return compile_graph(graph, request, provider, target=target, precision=parsing.parse_precision(precision))


def _print_plan(
    graph: Graph,
    plan: Plan,
    request: Request,
    provider: LazyResourceProvider,
    layout: Literal["text", "json", "dot"],
) -> None:
    """Print a plan, and how many pixels each length of the graph is, which a Graphviz graph has no place for."""
    from .. import compiler

    if layout == "dot":
        print(compiler.write_dot(plan))
        return
    lengths = compiler.resolve_lengths(graph, request, provider)
    if layout == "json":
        print_json({**compiler.plan_as_json(plan), "lengths": [_length_facts(item) for item in lengths]})
    else:
        views = _describe_views(graph, plan, provider)
        print(compiler.explain(plan, views), *(f"length    {item}" for item in lengths), sep="\n")


def _length_facts(length: ResolvedLength) -> dict[str, Any]:
    return {"value": str(length.port), "number": length.number, "unit": length.unit, "pixels": length.pixels}


class _PageOrder(NamedTuple):
    """A page to write, and how its passes are planned and run."""

    output: Path
    title: str
    graph: Graph
    bindings: Mapping[str, Binding | Callable[[int], Binding]]
    form: Form | None
    memory: int
    precision: str | None


def _write_page(order: _PageOrder, request: Request, sandbox: Sandbox) -> int:
    """Run the passes of one frame, write a page of what they make, and return 0.

    Raises OutputError, and errors of renders.
    """
    from ..document.about import find_about
    from ..export.passes_page import PassesPage
    from ..inputs.default_view import choose_default_view
    from ..renderer import Renderer, RenderRequest, open_device
    from ..resources.atomic_write import write_text_atomically

    renderer = Renderer(open_device(order.form, order.memory, sandbox=sandbox), budget=0, sandbox=sandbox)
    graph, output, targets = order.graph, order.output, request.targets
    plan = renderer.compile(
        graph,
        RenderRequest(
            order.bindings,
            targets,
            request.size,
            request.scale,
            request.frame,
            parsing.parse_precision(order.precision),
        ),
    )
    renderer.runner.measure(plan)  # a first run, in which drivers compile: the times of the second one are shown
    name, surface = next(iter(plan.outputs.items()))
    view = graph.outputs[name].view if name in graph.outputs else ""
    view = view or choose_default_view(plan, surface, renderer.pictures)
    page = PassesPage(plan, order.title, find_about(graph).doc, view)
    page.add_pixels({upload.surface: renderer.pictures.load_pixels(upload.picture) for upload in plan.uploads})
    for trace in renderer.runner.trace(plan):
        page.add_pass(trace)
    write_text_atomically(output, page.text, sandbox)
    return 0


def _describe_views(graph: Graph, plan: Plan, provider: LazyResourceProvider) -> dict[str, str]:
    """Through which view each output is written into formats for screens, and why; by its name. Vectors have none."""
    from halation.nodes import Kind

    return {
        name: _describe_view(output, plan, name, provider)
        for name, output in graph.outputs.items()
        if name in plan.outputs and output.kind is not Kind.VECTOR
    }


def _describe_view(output: Output, plan: Plan, name: str, provider: LazyResourceProvider) -> str:

    if not output.kind.is_color:
        return "none, since it is data: its numbers are written"
    if output.view:
        return f"{output.view}, as the output says"
    if not plan.uploads:  # so no picture has to be read, and no library be loaded
        return "that of the config"
    from ..inputs.default_view import choose_default_view

    if choose_default_view(plan, plan.outputs[name], provider.pictures):
        return "none, since its pictures are made for a screen"
    return "that of the config, since it has light of a scene"


def _choose_target(form: Form | Literal["device"], memory: int, sandbox: Sandbox) -> Target:
    """The device to plan for, with so much memory: that of this machine, or a null device with a form."""
    from msgspec.structs import replace

    if form != "device":
        from ..compiler import NULL

        return replace(NULL, form=form, memory=memory)
    from ..renderer import open_device

    return replace(open_device(sandbox=sandbox).target, memory=memory)
