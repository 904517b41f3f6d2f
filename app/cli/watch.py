"""`halation watch`: renders again whenever a file of the graph changes."""

from __future__ import annotations

import json
import sys
import time
from functools import partial
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import HalationError, UsageError
from ..resources.render_choices import DEFAULT_TIMEOUT
from ..resources.sandbox import Sandbox
from . import parsing
from .options import (
    Frames,
    GraphFile,
    Inputs,
    Node,
    OneFrame,
    Outputs,
    Precision,
    Scale,
    Sets,
    SizeText,
    View,
    open_graph,
    report_problems,
    resolve_inputs,
)
from .outcome import INTERRUPTED, print_note, write_count
from .watchdog import Timeout, run_session

if TYPE_CHECKING:
    from ..graph import Graph
    from ..renderer import Renderer
    from ..renderer.jobs.reports import JobProgress, JobReport
    from ..watch.rerendering import ContinuousRenderer, WatchReport

_LISTED = 3
"""Changed files that a line names. Chosen by judgement: a line stays short."""


_Output = Annotated[
    list[str],
    Outputs,
]
_Compression = Annotated[str, typer.Option(help="EXR compression, as for render.")]
_AsJson = Annotated[bool, typer.Option("--json", help="Print a line with a JSON object for every render.")]


def watch(
    graph: GraphFile,
    output: _Output,
    inputs: Inputs = None,
    sets: Sets = None,
    node: Node = "",
    size: SizeText = None,
    scale: Scale = 1.0,
    frame: OneFrame = None,
    frames: Frames = None,
    precision: Precision = None,
    view: View = "",
    compression: _Compression = "zip",
    as_json: _AsJson = False,
    timeout: Timeout = DEFAULT_TIMEOUT,
    *,
    sandbox: Sandbox,
) -> int:
    """Render again whenever a file changes, until Ctrl-C.

    Watches the graph and its groups, code, pictures and shaders. After an error it waits for the next change.
    """
    if str(graph) == "-":
        raise UsageError("-: standard input cannot be watched: name a graph file")
    parsed_precision = parsing.parse_precision(precision)
    canvas, proxy = parsing.parse_size(size), parsing.parse_scale(scale)
    destinations, named_frames = parsing.parse_destinations(output), parsing.parse_frame_options(frame, frames)

    def load_graph() -> Graph:
        graph_now = open_graph(graph, parsing.parse_sets(sets), sandbox=sandbox)
        report_problems(graph, graph_now)
        return graph_now

    def render(renderer: Renderer, graph_now: Graph, progress: JobProgress) -> JobReport:
        from ..graph.frames import list_range
        from ..inputs.lazy_provider import LazyResourceProvider
        from ..renderer import RenderRequest
        from ..renderer.jobs.job import OutputSettings, run_job

        bindings = resolve_inputs(graph_now, parsing.parse_inputs(inputs))
        targets = parsing.find_targets(graph_now, node)
        first, last = (0, 0) if named_frames else LazyResourceProvider(sandbox).find_frames(graph_now, bindings)
        every = named_frames or (list_range(first, last) if parsing.have_frame_number(destinations) else (first,))
        request = RenderRequest(bindings, targets, canvas, proxy, precision=parsed_precision)
        return run_job(
            renderer,
            graph_now,
            request,
            OutputSettings(destinations, view, compression, parsed_precision or "half"),
            every,
            progress=progress,
        )

    def work() -> int:
        from ..renderer import Renderer, open_device
        from ..watch.rerendering import ContinuousRenderer

        renderer = Renderer(open_device(sandbox=sandbox), sandbox=sandbox)
        print_note(renderer.device.description)
        continuous_renderer = ContinuousRenderer(
            graph,
            lambda graph_now: resolve_inputs(graph_now, parsing.parse_inputs(inputs)),
            load_graph,
            partial(render, renderer),
            sandbox,
        )
        return _follow(continuous_renderer, as_json)

    return run_session(work, timeout, as_json)


def _follow(reports: ContinuousRenderer, as_json: bool) -> int:
    """Print what each render says until Ctrl-C."""
    has_rendered = False
    try:
        for report in reports:
            if isinstance(report.fault, UsageError) and not has_rendered:
                raise report.fault  # waiting cannot mend the command line
            has_rendered = True
            _print_report_json(report) if as_json else _print_report(report)
    except KeyboardInterrupt:
        if not has_rendered:
            raise
        print_note("halation: interrupted; no unfinished file is left")  # the usual end of this command
    finally:
        reports.close()
    return INTERRUPTED


def _print_report(turn: WatchReport) -> None:
    """Print a line about one render."""
    clock = time.strftime("%H:%M:%S")
    if turn.report is None:
        print_note(f"{clock}  {turn.fault}")
        return
    files = [str(path) for path in turn.report.written]
    written = files[0] if len(files) == 1 else f"{files[0]} and {len(files) - 1} more"
    names = [path.name for path in turn.changed]
    more = f" and {len(names) - _LISTED} more" if len(names) > _LISTED else ""
    why = f"  ({', '.join(names[:_LISTED])}{more} changed)" if names else ""
    passes = write_count(turn.report.passes, "pass", "passes")
    print_note(f"{clock}  {written}  {turn.seconds:.2f} s, {passes}{why}")


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
