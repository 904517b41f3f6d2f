"""`halation sweep`: a contact sheet of one graph at many values."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..resources.render_choices import DEFAULT_TIMEOUT
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
    open_graph,
    report_problems,
    resolve_inputs,
)
from .outcome import note, print_json
from .sweeping import axes
from .watchdog import Timeout, rerun_watched

if TYPE_CHECKING:
    from ..graph import Graph


def sweep(
    context: typer.Context,
    graph: GraphFile,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="FILE", help="The sheet: .png, .jpg, .tif, .webp.")],
    sets: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="NODE.VALUE=X,Y,...",
            help="What to sweep: 1,2,4 or 1..8/4 or 1..100/5log; * for all choices; colors and vectors with ; between.",
        ),
    ] = None,
    inputs: Inputs = None,
    node: Node = "",
    size: SizeText = None,
    scale: Scale = 1.0,
    frame: Annotated[
        int | None, typer.Option(help="The frame of all pictures; by default the first of the graph.")
    ] = None,
    frames: Annotated[str | None, typer.Option(metavar="1-24x8", help="Sweep these frames.")] = None,
    show: Annotated[str, typer.Option("--show", metavar="NAME", help="The output to show; by default the first.")] = "",
    view: Annotated[str, typer.Option(help="OpenColorIO view; 'none' for plain sRGB.")] = "",
    cell: Annotated[
        int, typer.Option(metavar="PIXELS", min=16, max=4096, help="Width of a picture on the sheet.")
    ] = 480,
    columns: Annotated[int, typer.Option(min=0, help="Pictures side by side; by default what makes a good shape.")] = 0,
    cells: Annotated[
        Path | None, typer.Option("--cells", metavar="DIR", help="Write each picture alone into this folder too.")
    ] = None,
    ending: Annotated[str, typer.Option(metavar=".png|.exr|...", help="What kind of files --cells writes.")] = ".png",
    precision: Precision = None,
    timeout: Timeout = DEFAULT_TIMEOUT,
    as_json: AsJson = False,
) -> int:
    """Render a graph at many values, onto one sheet with labels.

    One value that is swept makes a row that wraps, two make a grid; a value that is given once is just set.
    """
    from halation.nodes import Kind

    from .. import media
    from ..errors import UsageError
    from ..inputs.lazy_provider import LazyResourceProvider
    from ..renderer import DEFAULT_BUDGET, RenderRequest
    from ..renderer.jobs import sweep as sweeping
    from ..renderer.jobs.job import OutputSettings

    started = time.perf_counter()
    depth = parsing.precision(precision) if precision is not None else None
    chosen = parsing.frames(frame, frames) or ()
    canvas, proxy = parsing.size(size), parsing.scale(scale)
    whole, swept = axes(open_graph(graph), sets or (), chosen)
    report_problems(graph, whole)
    if (code := rerun_watched(context, graph, whole, timeout)) is not None:
        return code
    bindings, targets = resolve_inputs(whole, parsing.inputs(inputs)), parsing.targets(whole, node)
    at = chosen[0] if chosen else LazyResourceProvider().find_frames(whole, bindings)[0]
    name = _output(whole, show, node)
    look = view or ("" if node else whole.outputs[name].view)
    count = len(sweeping.list_cells(whole, swept, at))
    media.check_destination(output, {"": Kind.IMAGE}, {"": (1, 1)}, view=look)
    if output.suffix.casefold() in (".exr", ".hdr"):
        raise UsageError(f"{output}: a sheet is for eyes: write it as .png, .jpg, .tif or .webp")
    written = OutputSettings((("", cells),), view, precision=depth or "half") if cells is not None else None
    request = RenderRequest(bindings, targets, canvas, proxy, precision=depth)
    title = f"{graph.stem if str(graph) != '-' else 'graph'}: {', '.join(axis.name for axis in swept)}"
    with open_batch(cells or output.parent, count, DEFAULT_BUDGET) as work:
        how = sweeping.SweepRequest(request, name, look, cell, columns, written, _suffix(ending), title)
        sheet = sweeping.render_sweep(work.renderer, whole, swept, how, at, work.step)
        device = work.device
    metadata = {"ImageDescription": "\n".join(item.label for item in sheet.cells)}
    media.write_picture(output, {"": sheet.light}, kinds={"": Kind.IMAGE}, view="none", metadata=metadata)
    spent = time.perf_counter() - started
    if as_json:
        print_json(_as_json(output, sheet, device, spent))
    else:
        height, width = sheet.light.shape[:2]
        note(f"{output}  {count} pictures, {width}x{height}, {spent:.2f} s")
    return 0


def _output(graph: Graph, show: str, node: str) -> str:
    """The output to show. Raises UsageError."""
    from ..errors import UsageError
    from ..graph import did_you_mean

    if node:
        if show:
            raise UsageError("--show and --node: choose one")
        return node
    if not graph.outputs:
        raise UsageError("the graph has no output to show: take a node with --node")
    if show and show not in graph.outputs:
        raise UsageError(f"--show {show}: there is no output '{show}'{did_you_mean(show, graph.outputs)}")
    return show or next(iter(graph.outputs))


def _suffix(text: str) -> str:
    return text if text.startswith(".") else f".{text}"


def _as_json(output: Path, sheet: Any, device: str, spent: float) -> dict[str, Any]:
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
        "seconds": round(spent, 3),
    }
