"""`halation render`: a graph in, finished pictures out."""

from __future__ import annotations

import json
import sys
import time
from typing import TYPE_CHECKING, Annotated

import typer

from . import parsing
from .options import AsJson, GraphFile, Inputs, Node, Scale, Sets, SizeText, bound, opened, report_problems
from .outcome import note, print_json

if TYPE_CHECKING:
    from ..compiler import Pass
    from ..renderer.job import Report


def render(
    graph: GraphFile,
    output: Annotated[
        list[str],
        typer.Option("-o", "--output", metavar="[NAME=]FILE", help="Where to write; .exr holds all outputs as layers."),
    ],
    inputs: Inputs = None,
    sets: Sets = None,
    node: Node = "",
    size: SizeText = None,
    scale: Scale = 1.0,
    frame: Annotated[int, typer.Option(help="The frame that nodes which change over time show.")] = 1,
    precision: Annotated[
        str | None, typer.Option(metavar="half|float", help="Precision of intermediates and of EXR files.")
    ] = None,
    view: Annotated[
        str, typer.Option(help="OpenColorIO view for PNG, JPEG, TIFF and WebP; 'none' for plain sRGB.")
    ] = "",
    compression: Annotated[
        str, typer.Option(help="EXR compression: none, rle, zips, zip, piz, pxr24, dwaa, ...")
    ] = "zip",
    form: Annotated[
        str | None, typer.Option(metavar="fragment|compute", help="How passes run; by default what suits the device.")
    ] = None,
    progress: Annotated[
        str, typer.Option(metavar="bar|json", help="A bar, on a terminal only, or a JSON object per pass.")
    ] = "bar",
    as_json: AsJson = False,
) -> int:
    """Render a graph to files."""
    started = time.perf_counter()
    depth = parsing.precision(precision) if precision is not None else None
    passes = parsing.form(form) if form is not None else None
    step = _print_step if parsing.progress(progress) == "json" else None
    destinations = parsing.paths(output)
    canvas, proxy = parsing.size(size), parsing.scale(scale)
    opened_graph = opened(graph, sets or ())
    report_problems(graph, opened_graph)
    bindings, targets = bound(opened_graph, inputs or ()), parsing.targets(opened_graph, node)
    from ..renderer import Renderer, Wanted, open_device
    from ..renderer.job import Writing, run_job

    loaded = time.perf_counter()
    renderer = Renderer(open_device(passes), budget=0)
    note(renderer.device.description)
    ready = time.perf_counter()
    wanted = Wanted(bindings, targets, canvas, proxy, frame, depth)
    writing = Writing(destinations, view, compression, depth or "half")
    with _Bar() as bar:
        report = run_job(renderer, opened_graph, wanted, writing, step or bar.step)
    spent = {"load": loaded - started, "open": ready - loaded, **report.seconds}
    _tell(report, renderer.device.description, {**spent, "total": time.perf_counter() - started}, as_json)
    return 0


def _tell(report: Report, device: str, seconds: dict[str, float], as_json: bool) -> None:
    from ..compiler.explain import size_text

    for path, count in report.repaired.items():
        note(f"{path}: {count} pixels that are not numbers were filled from their neighbors")
    if as_json:
        print_json(
            {
                "written": [str(path) for path in report.written], "device": device, "passes": report.passes,
                "programs": report.programs, "peak_bytes": report.peak_bytes, "repaired": dict(report.repaired),
                "seconds": {name: round(part, 4) for name, part in seconds.items()},
            }
        )
        return
    peak = size_text(report.peak_bytes)
    for path in report.written:
        note(f"{path}  {seconds['total']:.2f} s, {report.passes} passes, {peak} of textures at the peak")


def _print_step(done: int, total: int, one: Pass) -> None:
    """One line of JSON on standard error."""
    note(json.dumps({"pass": done, "passes": total, "nodes": one.nodes}))


class _Bar:
    """A progress bar on standard error, where that is a terminal and the work is long enough to watch."""

    def __init__(self) -> None:
        self._quiet = not sys.stderr.isatty()
        self._progress = None
        self._started = time.perf_counter()

    def __enter__(self) -> _Bar:
        return self

    def __exit__(self, *fault: object) -> None:
        if self._progress is not None:
            self._progress.stop()

    def step(self, done: int, total: int, one: Pass) -> None:
        """Show that `done` of `total` passes are through."""
        if self._quiet or time.perf_counter() - self._started < 0.3:
            return
        if self._progress is None:
            from rich.console import Console
            from rich.progress import BarColumn, Progress, TextColumn

            count = TextColumn("{task.completed}/{task.total} passes")
            columns = (TextColumn("{task.description}", markup=False), BarColumn(), count)
            self._progress = Progress(*columns, console=Console(stderr=True), transient=True)
            self._progress.start()
            self._progress.add_task("render", total=total)
        self._progress.update(self._progress.task_ids[0], completed=done, description=one.nodes[-1])
