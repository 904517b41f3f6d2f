"""Renders one graph many times: a sheet with a picture for every combination of some values."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import product
from math import ceil
from pathlib import Path

import numpy as np
from halation.nodes import Kind, Socket
from msgspec import Struct, structs

from ...errors import UsageError
from ...graph import OUTPUTS, Graph, Port
from ...media.comparison.contact_sheet import make_grid_sheet, make_grouped_sheet, show_data, show_over_checker
from ..engine import Renderer, RenderRequest
from ..execution.decoding import Array
from ..frame_renderer import FrameRenderer
from .destinations import OutputSettings
from .job import run_job

LABEL_SIZE = 16
"""Pixels of the letters under a cell: chosen by eye, legible at 1:1."""
MAX_CELLS = 400
"""More pictures are refused before the first is rendered: a mistyped range is likelier. Chosen by judgement."""
_CONSTANT_SIDE = 64
"""Pixels of the side by which a picture of one pixel, a constant, is shown: any square will do."""
FRAME = "frame"
_SHEET_ASPECT = 1.7
"""Width over height of a sheet whose cells wrap: close to a screen of 16:9, with some room for labels."""


class SweepStep(Struct, frozen=True):
    """One value of an axis: as the user typed it, and a function that sets it in a graph."""

    text: str
    apply: Callable[[Graph], Graph]
    frame: int | None = None


class SweepAxis(Struct, frozen=True):
    """What varies along one side of a sheet: `blur.sigma`, a control, or the frame; cells show its `label`."""

    name: str
    label: str
    steps: tuple[SweepStep, ...]


class SweepCell(Struct, frozen=True):
    """One picture of a sheet: a step of every axis, the graph with their values, and its frame."""

    steps: tuple[tuple[SweepAxis, SweepStep], ...]
    graph: Graph
    frame: int

    @property
    def label(self) -> str:
        """The text in the cell: `sigma 4`."""
        return "  ".join(f"{axis.label} {step.text}" for axis, step in self.steps)

    @property
    def file_stem(self) -> str:
        """The name of the cell's own file: `blur.sigma=4`, `blur.sigma=4,frame=0012`."""
        return ",".join(f"{axis.name}={_format_step(step.text, axis.name == FRAME)}" for axis, step in self.steps)


class SweepRequest(Struct, frozen=True):
    """What to render of each graph, and how it is shown. `width` is that of a cell in pixels, 0 for the picture's."""

    request: RenderRequest
    output: str
    view: str = ""
    width: int = 480
    columns: int = 0
    output_settings: OutputSettings | None = None
    """How each picture is also written as a file, with the folder as its only file; None if it is not."""
    ending: str = ".png"
    title: str = ""


class SweepSheet(Struct, frozen=True):
    """The sheet as light of the display, its cells, and the files that were written beside it."""

    light: Array
    cells: tuple[SweepCell, ...]
    files: tuple[Path, ...] = ()


def list_cells(graph: Graph, axes: Sequence[SweepAxis], frame: int) -> tuple[SweepCell, ...]:
    """All combinations, the last axis fastest. Raises UsageError for more than a sheet can show."""
    if not axes:
        raise UsageError("nothing is swept: give several values, such as --set blur.sigma=1,2,4,8, or --frames")
    if len(axes) > 2:
        names = ", ".join(axis.name for axis in axes)
        raise UsageError(f"{names}: a sheet has rows and columns, no more: give all but two of them one value")
    count = int(np.prod([len(axis.steps) for axis in axes]))
    if count > MAX_CELLS:
        raise UsageError(f"{count} pictures are more than the {MAX_CELLS} that a sheet can hold: sweep fewer values")
    return tuple(_combine_steps(graph, axes, frame))


def _combine_steps(graph: Graph, axes: Sequence[SweepAxis], frame: int) -> Iterator[SweepCell]:
    for steps in product(*(axis.steps for axis in axes)):
        changed, at = graph, frame
        for step in steps:
            changed, at = step.apply(changed), at if step.frame is None else step.frame
        yield SweepCell(tuple(zip(axes, steps, strict=True)), changed, at)


def render_sweep(
    renderer: Renderer,
    graph: Graph,
    axes: Sequence[SweepAxis],
    sweep: SweepRequest,
    frame: int,
    report_step: Callable[[str], None] = lambda name: None,
) -> SweepSheet:
    """Render all cells and put them on a sheet; `report_step` is called with the label of each cell before.

    Results that several pictures share are computed once. Raises the errors of `app.errors`.
    """
    cells = list_cells(graph, axes, frame)
    pictures: list[Array] = []
    files: list[Path] = []
    for cell in cells:
        report_step(cell.label)
        pictures.append(_shrink(_render_cell(renderer, cell, sweep), sweep.width))
        if sweep.output_settings is not None:
            files += _write_cell(renderer, cell, sweep)
    light = _show_cells(graph, pictures, sweep)
    if len(axes) == 2:
        heads = [[f"{axis.label} {step.text}" for step in axis.steps] for axis in axes]
        across = len(heads[1])
        rows = [light[start : start + across] for start in range(0, len(light), across)]
        return SweepSheet(make_grid_sheet(rows, *heads, width=sweep.width, title=sweep.title), cells, tuple(files))
    named = dict(zip((cell.label for cell in cells), light, strict=True))
    columns = sweep.columns or _choose_columns(len(named), light[0])
    sheet = make_grouped_sheet({sweep.title: named}, columns, sweep.width, letters=LABEL_SIZE)
    return SweepSheet(sheet, cells, tuple(files))


def _render_cell(renderer: Renderer, cell: SweepCell, sweep: SweepRequest) -> Array:
    frame_renderer = FrameRenderer(renderer, cell.graph, sweep.request)
    try:
        return frame_renderer.render_frame(cell.frame)[sweep.output]
    finally:
        frame_renderer.close()


def _write_cell(renderer: Renderer, cell: SweepCell, sweep: SweepRequest) -> tuple[Path, ...]:
    """Write a picture as `halation render` does; results of the sheet are not computed again."""
    assert sweep.output_settings is not None
    ((_, folder),) = sweep.output_settings.files
    file = folder / f"{cell.file_stem}{sweep.ending}"
    settings = structs.replace(sweep.output_settings, files=((sweep.output, file),))
    return run_job(renderer, cell.graph, sweep.request, settings, (cell.frame,)).written


def _shrink(array: Array, width: int) -> Array:
    """Every n-th pixel of a picture that is much larger than its cell, so that a sheet takes little memory."""
    step = max(1, array.shape[1] // (4 * width)) if width else 1
    return np.ascontiguousarray(array[::step, ::step])


def _show_cells(graph: Graph, pictures: Sequence[Array], sweep: SweepRequest) -> list[Array]:
    """Pictures as light of the display; data is shown between the smallest and largest number of all of them."""
    port = sweep.request.targets.get(sweep.output, Port(OUTPUTS, sweep.output))
    socket = graph.target(port) if port.node == OUTPUTS else graph.source(port)
    kind = socket.kind if isinstance(socket, Socket) else Kind.IMAGE
    if kind.is_color:
        return [show_over_checker(_widen(array), sweep.view) for array in pictures]
    finite = [array[np.isfinite(array)].astype(np.float64) for array in pictures]
    low = min((float(part.min()) for part in finite if part.size), default=0.0)
    high = max((float(part.max()) for part in finite if part.size), default=1.0)
    return [show_data(_widen(array), min(low, 0.0), high if high > low else low + 1.0) for array in pictures]


def _widen(array: Array) -> Array:
    """A single value as a picture of that value."""
    return np.tile(array, (_CONSTANT_SIDE, _CONSTANT_SIDE, 1)) if array.shape[:2] == (1, 1) else array


def _choose_columns(count: int, first: Array) -> int:
    """The number of columns: few cells stay in one row, many form about the shape of a screen."""
    if count <= 4:
        return count
    columns = min(count, ceil((_SHEET_ASPECT * count * first.shape[0] / first.shape[1]) ** 0.5))
    return ceil(count / ceil(count / columns))  # rows of about the same length


def _format_step(text: str, is_frame: bool) -> str:
    """A value as a part of a file name."""
    return f"{int(text):04d}" if is_frame else re.sub(r"[^\w.+-]+", "_", text)


def choose_labels(names: Sequence[str], labels: Mapping[str, str]) -> dict[str, str]:
    """The label of each name in cells: its own label, or the whole name if two labels would be equal."""
    return {
        name: labels[name] if sum(labels[other_name] == labels[name] for other_name in names) == 1 else name
        for name in names
    }
