"""`halation sweep`: a contact sheet of one graph at many values."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..resources.render_choices import DEFAULT_TIMEOUT
from ..resources.sandbox import Sandbox
from . import parsing
from .batch import open_batch
from .options import (
    AsJson,
    GraphFile,
    Inputs,
    Node,
    Precision,
    Scale,
    SizeText,
    View,
    choose_output,
    open_graph,
    report_problems,
    resolve_inputs,
)
from .outcome import print_json, print_note
from .sweeping import parse_axes
from .watchdog import Timeout, rerun_watched

if TYPE_CHECKING:
    from ..renderer.jobs.sweep import SweepSheet


_Output = Annotated[
    Path, typer.Option("-o", "--output", metavar="FILE", help="The sheet to write: .png, .jpg, .tif or .webp.")
]
_Sets = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NODE.VALUE=X,Y,...",
        help="Render at each of these values: 1,2,4 or 1..8/4 (4 values) or 1..100/5log; * for all choices; write "
        "; between colors or vectors.",
    ),
]
_Frame = Annotated[
    int | None, typer.Option(help="Render all pictures at this frame; by default the first frame of the graph.")
]
_Frames = Annotated[str | None, typer.Option(metavar="1-24x8", help="Render a picture at each of these frames.")]
_Show = Annotated[
    str, typer.Option("--show", metavar="NAME", help="Show this output of the graph; by default the first.")
]
_Cell = Annotated[int, typer.Option(metavar="PIXELS", min=16, max=4096, help="Width of a picture on the sheet.")]
_Columns = Annotated[int, typer.Option(min=0, help="Pictures per row; by default as fits the number of pictures.")]
_Cells = Annotated[
    Path | None, typer.Option("--cells", metavar="DIR", help="Also write each picture as a file into this folder.")
]
_Ending = Annotated[str, typer.Option(metavar=".png|.exr|...", help="The file type of --cells.")]


def sweep(
    context: typer.Context,
    graph: GraphFile,
    output: _Output,
    sets: _Sets = None,
    inputs: Inputs = None,
    node: Node = "",
    size: SizeText = None,
    scale: Scale = 1.0,
    frame: _Frame = None,
    frames: _Frames = None,
    show: _Show = "",
    view: View = "",
    cell: _Cell = 480,
    columns: _Columns = 0,
    cells: _Cells = None,
    ending: _Ending = ".png",
    precision: Precision = None,
    timeout: Timeout = DEFAULT_TIMEOUT,
    as_json: AsJson = False,
    *,
    sandbox: Sandbox,
) -> int:
    """Render a graph at many values onto one sheet.

    One swept value gives rows, two give a grid. A --set with a single value sets it for all pictures.
    """
    from ..inputs.lazy_provider import LazyResourceProvider
    from ..renderer import DEFAULT_BUDGET, RenderRequest
    from ..renderer.jobs import sweep as sweeping
    from ..renderer.jobs.job import OutputSettings

    started = time.perf_counter()
    parsed_precision = parsing.parse_precision(precision)
    named_frames = parsing.parse_frame_options(frame, frames) or ()
    canvas, proxy = parsing.parse_size(size), parsing.parse_scale(scale)
    opened_graph, sweep_axes = parse_axes(open_graph(graph, sandbox=sandbox), sets or (), named_frames)
    report_problems(graph, opened_graph)
    if (code := rerun_watched(context, graph, opened_graph, timeout)) is not None:
        return code
    bindings = resolve_inputs(opened_graph, parsing.parse_inputs(inputs))
    targets = parsing.find_targets(opened_graph, node)
    frame_of_all = (named_frames or LazyResourceProvider(sandbox).find_frames(opened_graph, bindings))[0]
    shown_output = choose_output(opened_graph, show, node)
    shown_view = view or ("" if node else opened_graph.outputs[shown_output].view)
    count = len(sweeping.list_cells(opened_graph, sweep_axes, frame_of_all))
    _check_sheet(output, shown_view, sandbox)
    cell_files = OutputSettings((("", cells),), view, precision=parsed_precision or "half") if cells else None
    request = RenderRequest(bindings, targets, canvas, proxy, precision=parsed_precision)
    title = f"{graph.stem if str(graph) != '-' else 'graph'}: {', '.join(axis.name for axis in sweep_axes)}"
    with open_batch(cells or output.parent, count, DEFAULT_BUDGET, sandbox=sandbox) as batch:
        sweep_request = sweeping.SweepRequest(
            request, shown_output, shown_view, cell, columns, cell_files, _add_dot(ending), title
        )
        sheet = sweeping.render_sweep(batch.renderer, opened_graph, sweep_axes, sweep_request, frame_of_all, batch.step)
        device = batch.device
    _write_sheet(output, sheet, sandbox)
    _report_sheet(output, sheet, device, time.perf_counter() - started, as_json)
    return 0


def _check_sheet(output: Path, view: str, sandbox: Sandbox) -> None:
    """Raise UsageError for a file that no sheet can be written to. Sheets are made for the eye, so not as light."""
    from halation.nodes import Kind

    from .. import media
    from ..errors import UsageError

    media.check_destination(output, {"": Kind.IMAGE}, {"": (1, 1)}, view=view, sandbox=sandbox)
    if output.suffix.casefold() in (".exr", ".hdr"):
        raise UsageError(f"{output}: a sheet cannot be written in this format: use .png, .jpg, .tif or .webp")


def _write_sheet(output: Path, sheet: SweepSheet, sandbox: Sandbox) -> None:
    """Write a sheet, with the labels of its cells as its description."""
    from halation.nodes import Kind

    from .. import media

    media.write_picture(
        output,
        {"": sheet.light},
        kinds={"": Kind.IMAGE},
        view="none",
        metadata={"ImageDescription": "\n".join(item.label for item in sheet.cells)},
        sandbox=sandbox,
    )


def _add_dot(text: str) -> str:
    return text if text.startswith(".") else f".{text}"


def _report_sheet(output: Path, sheet: SweepSheet, device: str, seconds: float, as_json: bool) -> None:
    """Print what was written, in a line or as JSON."""
    if as_json:
        print_json(_sweep_facts(output, sheet, device, seconds))
        return
    height, width = sheet.light.shape[:2]
    print_note(f"{output}  {len(sheet.cells)} pictures, {width}x{height}, {seconds:.2f} s")


def _sweep_facts(output: Path, sheet: SweepSheet, device: str, seconds: float) -> dict[str, Any]:
    return {
        "written": str(output),
        "size": list(sheet.light.shape[1::-1]),
        "device": device,
        "cells": [
            {
                "label": cell.label,
                "frame": cell.frame,
                "values": {axis.name: step.text for axis, step in cell.steps if step.frame is None},
                **({"file": str(sheet.files[place])} if sheet.files else {}),
            }
            for place, cell in enumerate(sheet.cells)
        ],
        "seconds": round(seconds, 3),
    }
