"""`halation export`: writes a graph in the formats of other programs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..resources.render_choices import DEFAULT_TIMEOUT
from ..resources.sandbox import Sandbox
from . import parsing
from .options import (
    AsJson,
    GraphFile,
    Inputs,
    Node,
    OneFrame,
    Sets,
    SizeText,
    open_graph,
    report_problems,
    resolve_inputs,
)
from .outcome import print_json, print_note
from .watchdog import Timeout, run_watched

if TYPE_CHECKING:
    from ..export import ExportReport, TableOptions
    from ..graph import Graph, Port
    from ..renderer import Renderer

Selection = Annotated[
    str,
    typer.Option("--select", metavar="ID,ID,...", help="Export only these nodes; the links into them become inputs."),
]


_Kind = Annotated[
    str,
    typer.Option(
        "--to",
        metavar="KIND",
        help="isf, web, glsl, wgsl, python, reshade, godot, unity, cube, clf or png; by default what the ending of "
        "the file says.",
    ),
]
_Output = Annotated[Path | None, typer.Option("-o", "--output", metavar="FILE", help="The file or folder to write.")]
_Encoding = Annotated[
    str,
    typer.Option(metavar="linear|srgb", help="For a table: whether its numbers are linear light or display codes."),
]
_ColorRange = Annotated[
    str, typer.Option("--range", metavar="LOW,HIGH", help="For a table: the range of light that it covers.")
]
_LutSize = Annotated[
    int, typer.Option("--lut-size", metavar="N", help="For a table: the number of colors along each side.")
]
_Check = Annotated[bool, typer.Option("--check", help="For a table: print its largest and mean error over a picture.")]


def export(
    graph: GraphFile,
    kind: _Kind = "",
    output: _Output = None,
    inputs: Inputs = None,
    sets: Sets = None,
    node: Node = "",
    selection: Selection = "",
    size: SizeText = None,
    frame: OneFrame = None,
    encoding: _Encoding = "",
    color_range: _ColorRange = "",
    lut_size: _LutSize = 33,
    check: _Check = False,
    timeout: Timeout = DEFAULT_TIMEOUT,
    as_json: AsJson = False,
    *,
    sandbox: Sandbox,
) -> int:
    """Write a graph in the format of another program.

    Writes pages for browsers, shaders, scripts and tables of colors. Where a node cannot be part of the format, the
    command names it with the reason.
    """
    from ..errors import UsageError
    from ..export import ExportOrder, choose_kind

    chosen = choose_kind(kind, output)
    if as_json and output is None:
        raise UsageError("--json and the shader would both go to standard output: write the shader to a file with -o")
    table = _parse_table_options(encoding, color_range, lut_size, check)
    opened_graph = open_graph(graph, parsing.parse_sets(sets), sandbox=sandbox)
    report_problems(graph, opened_graph)
    opened_graph = select_nodes(opened_graph, selection)
    order = ExportOrder(
        opened_graph,
        graph.stem,
        choose_port(opened_graph, node),
        sandbox,
        lambda: _open_renderer(sandbox),
        output,
        resolve_inputs(opened_graph, parsing.parse_inputs(inputs)),
        parsing.parse_size(size),
        frame,
        table,
    )

    def work() -> int:
        report_export(graph, chosen.export(order), as_json)
        return 0

    return run_watched(work, (opened_graph,), timeout, as_json)


def select_nodes(graph: Graph, selection: str) -> Graph:
    """The graph of the nodes that --select names, or all of it. Raises UsageError."""
    from ..errors import GraphError, UsageError
    from ..graph.selection import select_nodes as select

    if not selection:
        return graph
    try:
        return select(graph, [part.strip() for part in selection.split(",") if part.strip()])
    except GraphError as fault:
        raise UsageError(f"--select {selection}: {fault}") from None


def choose_port(graph: Graph, node: str) -> Port:
    """The port to export: the only output of the graph, or the one that --node names. Raises UsageError."""
    from ..errors import UsageError
    from ..graph import OUTPUTS, Port

    targets = parsing.find_targets(graph, node)
    if node:
        return next(iter(targets.values()))
    if len(graph.outputs) != 1:
        names = ", ".join(graph.outputs) or "none"
        raise UsageError(f"an export has one output, and the outputs of this graph are {names}: choose one with --node")
    return Port(OUTPUTS, next(iter(graph.outputs)))


def report_export(graph: Path, report: ExportReport, as_json: bool) -> None:
    """Print the notes and figures of an export, or the text that it made."""
    for line in report.notes:
        print_note(f"{graph}: {line}")
    if as_json:
        figures = {name.replace(" ", "_"): figure for name, figure in report.figures.items()}
        print_json({"file": report.files[0], "notes": list(report.notes), **figures})
    elif report.text:
        print(report.text, end="")
    else:
        for name, figure in report.figures.items():
            print(f"{name:14} {figure if isinstance(figure, str) else f'{figure:.4g}'}")


def _parse_table_options(encoding: str, color_range: str, side: int, checks: bool) -> TableOptions:
    from typing import get_args

    from ..errors import UsageError
    from ..export import TableOptions
    from ..export.order import Encoding

    chosen = next((name for name in get_args(Encoding) if name == encoding), None)
    if encoding and chosen is None:
        raise UsageError(f"--encoding {encoding}: choose linear or srgb")
    low = high = None
    if color_range:
        try:
            low, high = (float(part) for part in color_range.split(","))
        except ValueError:
            raise UsageError(f"--range {color_range}: write two numbers with a comma between, such as 0,16") from None
    return TableOptions(chosen, low, high, side, checks)


def _open_renderer(sandbox: Sandbox) -> Renderer:
    from ..renderer import Renderer, open_device

    return Renderer(open_device(sandbox=sandbox), sandbox=sandbox)
