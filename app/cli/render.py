"""`halation render`: a graph in, finished pictures out."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from . import parsing
from .options import AsJson, Inputs, Scale, Sets, SizeText, bound, opened, report_problems
from .outcome import guarded, note, print_json

if TYPE_CHECKING:
    from ..compiler import Pass
    from ..graph import Graph, Port
    from ..renderer.job import Report


@guarded
def render(
    graph: Annotated[Path, typer.Argument(help="A graph, as JSON.")],
    output: Annotated[
        list[str],
        typer.Option("-o", "--output", metavar="[NAME=]FILE", help="Where to write; .exr holds all outputs as layers."),
    ],
    inputs: Inputs = (),  # type: ignore[assignment]
    sets: Sets = (),  # type: ignore[assignment]
    node: Annotated[str, typer.Option(metavar="ID[.OUTPUT]", help="Render this node instead of the outputs.")] = "",
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
    as_json: AsJson = False,
) -> None:
    """Render a graph to files."""
    started = time.perf_counter()
    parsing.choice(precision, ("half", "float"), "--precision")
    parsing.choice(form, ("fragment", "compute"), "--form")
    destinations = parsing.paths(output)
    opened_graph = opened(graph, sets)
    report_problems(graph, opened_graph)
    from ..renderer import Renderer, Wanted, open_device
    from ..renderer.job import Writing, run_job

    wanted = Wanted(
        bound(opened_graph, inputs), _targets(opened_graph, node), parsing.size(size), parsing.scale(scale), frame,
        precision,  # type: ignore[arg-type]
    )
    renderer = Renderer(open_device(form), budget=0)  # type: ignore[arg-type]
    if not as_json:
        note(renderer.device.description)
    writing = Writing(destinations, view, compression, precision or "half")
    with _Bar(quiet=as_json) as bar:
        report = run_job(renderer, opened_graph, wanted, writing, bar.step)
    _tell(report, renderer.device.description, time.perf_counter() - started, as_json)


def _targets(graph: Graph, node: str) -> dict[str, Port]:
    """The output of the node that --node names."""
    from ..graph import node_output

    return {node: node_output(graph, node)} if node else {}


def _tell(report: Report, device: str, seconds: float, as_json: bool) -> None:
    from ..compiler.explain import size_text

    for path, count in report.repaired.items():
        note(f"{path}: {count} pixels that are not numbers were filled from their neighbors")
    if as_json:
        spent = {name: round(part, 4) for name, part in {**report.seconds, "total": seconds}.items()}
        print_json(
            {
                "written": [str(path) for path in report.written], "device": device, "passes": report.passes,
                "programs": report.programs, "peak_bytes": report.peak_bytes, "repaired": dict(report.repaired),
                "seconds": spent,
            }
        )
        return
    for path in report.written:
        note(
            f"{path}  {seconds:.2f} s, {report.passes} passes, {size_text(report.peak_bytes)} of textures at the peak"
        )


class _Bar:
    """A progress bar on standard error, where that is a terminal and the work is long enough to watch."""

    def __init__(self, quiet: bool) -> None:
        import sys

        self._quiet = quiet or not sys.stderr.isatty()
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
            columns = (TextColumn("{task.description}"), BarColumn(), count)
            self._progress = Progress(*columns, console=Console(stderr=True), transient=True)
            self._progress.start()
            self._progress.add_task("render", total=total)
        self._progress.update(self._progress.task_ids[0], completed=done, description=one.nodes[-1])
