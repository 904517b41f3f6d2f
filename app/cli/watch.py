"""`halation watch`: rendered again whenever something changes."""

from __future__ import annotations

import json
import sys
import time
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import HalationError, UsageError
from . import parsing
from .options import (
    Frames,
    GraphFile,
    Inputs,
    Node,
    OneFrame,
    Precision,
    Scale,
    Sets,
    SizeText,
    open_graph,
    report_problems,
    resolve_inputs,
)
from .outcome import INTERRUPTED, note

if TYPE_CHECKING:
    from ..graph import Graph
    from ..renderer.jobs.job import JobProgress, JobReport
    from ..watch.rerendering import WatchReport

_LISTED = 3


def watch(
    graph: GraphFile,
    output: Annotated[
        list[str], typer.Option("-o", "--output", metavar="[NAME=]FILE", help="Where to write, as for render.")
    ],
    inputs: Inputs = None,
    sets: Sets = None,
    node: Node = "",
    size: SizeText = None,
    scale: Scale = 1.0,
    frame: OneFrame = None,
    frames: Frames = None,
    precision: Precision = None,
    view: Annotated[str, typer.Option(help="OpenColorIO view for pictures that are not EXR.")] = "",
    compression: Annotated[str, typer.Option(help="EXR compression.")] = "zip",
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object per line for every render.")] = False,
) -> int:
    """Render, and render again whenever the graph, its groups, code, pictures or shaders change, until Ctrl-C.

    What is broken is said in a sentence, and waited for.
    """
    from ..inputs.lazy_provider import LazyResourceProvider
    from ..renderer import Renderer, RenderRequest, open_device
    from ..renderer.jobs.job import OutputSettings, run_job
    from ..watch.rerendering import ContinuousRenderer

    if str(graph) == "-":
        raise UsageError("-: standard input cannot be watched: name the file of a graph")
    depth = parsing.precision(precision) if precision is not None else None
    canvas, proxy = parsing.size(size), parsing.scale(scale)
    files, chosen = parsing.paths(output), parsing.frames(frame, frames)
    renderer = Renderer(open_device())
    note(renderer.device.description)

    def load() -> Graph:
        graph_now = open_graph(graph, parsing.sets(sets))
        report_problems(graph, graph_now)
        return graph_now

    def render(graph_now: Graph, progress: JobProgress) -> JobReport:
        bindings, targets = resolve_inputs(graph_now, parsing.inputs(inputs)), parsing.targets(graph_now, node)
        first, last = (0, 0) if chosen else LazyResourceProvider().find_frames(graph_now, bindings)
        every = chosen or (tuple(range(first, last + 1)) if parsing.holds_frames(files) else (first,))
        request = RenderRequest(bindings, targets, canvas, proxy, precision=depth)
        return run_job(
            renderer,
            graph_now,
            request,
            OutputSettings(files, view, compression, depth or "half"),
            every,
            progress=progress,
        )

    renderings = ContinuousRenderer(graph, lambda found: resolve_inputs(found, parsing.inputs(inputs)), load, render)
    has_rendered = False
    try:
        for turn in renderings:
            if isinstance(turn.fault, UsageError) and not has_rendered:
                raise turn.fault  # what was typed will not change
            has_rendered = True
            _print_report_json(turn) if as_json else _print_report(turn)
    except KeyboardInterrupt:
        if not has_rendered:
            raise
        note("halation: interrupted; nothing unfinished was left behind")  # which is how it is meant to end
    finally:
        renderings.close()
    return INTERRUPTED


def _print_report(turn: WatchReport) -> None:
    """One line."""
    clock = time.strftime("%H:%M:%S")
    if turn.report is None:
        note(f"{clock}  {turn.fault}")
        return
    files = [str(path) for path in turn.report.written]
    written = files[0] if len(files) == 1 else f"{files[0]} and {len(files) - 1} more"
    names = [path.name for path in turn.changed]
    more = f" and {len(names) - _LISTED} more" if len(names) > _LISTED else ""
    why = f"  ({', '.join(names[:_LISTED])}{more} changed)" if names else ""
    note(f"{clock}  {written}  {turn.seconds:.2f} s, {turn.report.passes} passes{why}")


def _print_report_json(turn: WatchReport) -> None:
    record: dict[str, object] = {"changed": [str(path) for path in turn.changed], "seconds": round(turn.seconds, 4)}
    if turn.report is None:
        fault = turn.fault or HalationError()
        error = {"kind": type(fault).__name__, "message": str(fault), "exit_code": fault.exit_code}
        record["error"] = error
    else:
        record["written"] = [str(path) for path in turn.report.written]
        record["frames"] = [item.frame for item in turn.report.frames]
        record["passes"] = turn.report.passes
    print(json.dumps(record, ensure_ascii=False))
    sys.stdout.flush()
