"""`halation fit`: finds values that make the picture of a graph like a reference."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from msgspec import Struct, structs
from msgspec.structs import asdict

from ..fit.value_patterns import CURVE_POINTS
from ..resources.render_choices import DEFAULT_TIMEOUT
from ..resources.sandbox import Sandbox
from . import parsing
from .fit_arguments import parse_comparison, parse_duration
from .fit_progress import follow_fit
from .options import (
    AsJson,
    GraphFile,
    Inputs,
    Node,
    OneFrame,
    Sets,
    SizeText,
    View,
    choose_output,
    open_graph,
    report_problems,
    resolve_inputs,
)
from .outcome import print_json, print_note
from .watchdog import Timeout, rerun_watched

if TYPE_CHECKING:
    from ..fit.fitting import Comparison
    from ..fit.results import FitResult
    from ..fit.value_patterns import ValuePattern
    from ..graph import Graph, Port

_To = Annotated[Path, typer.Option("--to", metavar="FILE", help="The picture that the graph is to come close to.")]
_Values = Annotated[
    list[str],
    typer.Option(
        "--values",
        metavar="NODE.VALUE[=LOW..HIGH],...",
        help="The values that may change, controls by their names, * for several; by default in the ranges of their "
        "sliders.",
    ),
]
_Output = Annotated[Path, typer.Option("-o", "--output", metavar="FILE", help="The graph to write, with new values.")]
_Report = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Also write a page (HTML) of pictures, errors and values.")
]
_By = Annotated[
    str,
    typer.Option(
        "--by",
        metavar="pixels|look",
        help="Compare pixel by pixel with the same frame, or tones, colors and grain with any picture.",
    ),
]
_Budget = Annotated[str, typer.Option(metavar="60s", help="How long it may take: 90s, 5m or 1h.")]
_Renders = Annotated[int, typer.Option(min=1, metavar="N", help="The most pictures that it may render.")]
_Points = Annotated[
    int, typer.Option(min=2, max=17, metavar="N", help="A curve of two points gets so many that may change.")
]
_Follow = Annotated[
    bool,
    typer.Option("--follow", help="Print each better set of values as a line of JSON, and the result as the last one."),
]
_Show = Annotated[
    str, typer.Option("--show", metavar="NAME", help="Compare this output of the graph; by default the first.")
]


def fit(
    context: typer.Context,
    graph: GraphFile,
    to: _To,
    values: _Values,
    output: _Output,
    report: _Report = None,
    by: _By = "pixels",
    budget: _Budget = "60s",
    renders: _Renders = 5000,
    points: _Points = CURVE_POINTS,
    inputs: Inputs = None,
    sets: Sets = None,
    node: Node = "",
    show: _Show = "",
    size: SizeText = None,
    frame: OneFrame = None,
    view: View = "",
    timeout: Timeout = DEFAULT_TIMEOUT,
    follow: _Follow = False,
    as_json: AsJson = False,
    *,
    sandbox: Sandbox,
) -> int:
    """Find values that make a picture like a reference.

    Writes the graph with these values. Ctrl-C ends the search and keeps the best values so far.
    """
    from ..fit.libraries import check_fit_libraries
    from ..fit.report import write_fit_report
    from ..fit.value_patterns import parse_patterns

    limits = (parse_duration(budget), renders)
    comparison, patterns, canvas = parse_comparison(by), parse_patterns(values), parsing.parse_size(size)
    check_fit_libraries()
    _check_files(output, report, sandbox)
    opened_graph = open_graph(graph, parsing.parse_sets(sets), sandbox=sandbox)
    report_problems(graph, opened_graph)
    if (code := rerun_watched(context, graph, opened_graph, timeout)) is not None:
        return code
    bindings = resolve_inputs(opened_graph, parsing.parse_inputs(inputs))
    targets = parsing.find_targets(opened_graph, node)
    shown = choose_output(opened_graph, show, node)
    request = _FitRequest(bindings, targets, canvas, frame, shown, view, to, comparison, points, limits, follow)
    result = _search(opened_graph, patterns, request, sandbox)
    _write_graph(result.graph, output, sandbox)
    if report is not None:
        write_fit_report(result, f"{graph.stem if str(graph) != '-' else 'graph'} like {to.name}", report, sandbox)
    if follow:
        print(json.dumps(_fit_facts(result, output, report)))
    elif as_json:
        print_json(_fit_facts(result, output, report))
    else:
        _print_result(result, output, report)
    return 0


class _FitRequest(Struct, frozen=True):
    """What the command line says of the pictures, and of the search."""

    inputs: Mapping[str, str]
    targets: Mapping[str, Port]
    size: tuple[int, int] | None
    frame: int | None
    output: str
    view: str
    reference: Path
    comparison: Comparison
    points: int
    limits: tuple[float, int]
    prints_lines: bool


def _search(graph: Graph, patterns: Sequence[ValuePattern], options: _FitRequest, sandbox: Sandbox) -> FitResult:
    from ..fit.fitting import FitTask
    from ..fit.search_space import find_search_space
    from ..fit.shown_output import ShownOutput, holds_light
    from ..renderer import Renderer, RenderRequest, open_device

    space = find_search_space(graph, patterns, options.points)
    is_light = holds_light(options.reference, sandbox)
    renderer = Renderer(open_device(sandbox=sandbox), sandbox=sandbox)
    request = RenderRequest(options.inputs, options.targets, options.size, precision="float")
    frame = renderer.find_frames(graph, request)[0] if options.frame is None else options.frame
    output = ShownOutput(renderer, graph, structs.replace(request, frame=frame), options.output, options.view, is_light)
    reference = output.read_reference(options.reference, sandbox)
    task = FitTask(space, output, reference, options.comparison, *options.limits)
    result = follow_fit(task, options.prints_lines)
    renderer.close()
    return result


def _check_files(output: Path, report: Path | None, sandbox: Sandbox) -> None:
    """Raise UsageError for a file that cannot be written, before anything is rendered."""
    from ..errors import UsageError
    from ..regression.report import check_report

    check_report(output, report, sandbox=sandbox)
    if output.suffix.casefold() != ".json":
        raise UsageError(f"-o {output}: this is the graph that is written: give it the ending .json")


def _write_graph(graph: Graph, output: Path, sandbox: Sandbox) -> None:
    from .. import document
    from ..graph.paths import rebase_paths

    document.save(rebase_paths(graph, str(output.parent)), output, sandbox=sandbox)


def _print_result(result: FitResult, output: Path, report: Path | None) -> None:
    from ..fit.report import describe_errors

    width = max(len(item.name) for item in result.values)
    for item in result.values:
        weak = "" if item.is_determined else "  (weak: the reference says little about it)"
        print(f"{item.name:<{width}}  {item.before:10.5g} -> {item.after:<10.5g}{weak}")
    print(describe_errors(result))
    ended = f", ended {result.stopped}" if result.stopped else ""
    files = f"{output} and {report}" if report else str(output)
    print_note(f"{files}  {result.renders} renders, {result.seconds:.1f} s{ended}")


def _fit_facts(result: FitResult, output: Path, report: Path | None) -> dict[str, Any]:
    return {
        "written": str(output),
        **({"report": str(report)} if report else {}),
        "error": list(result.errors),
        **({"delta_e": list(result.delta_e)} if result.delta_e else {}),
        "values": [asdict(item) for item in result.values],
        "settings": dict(result.settings),
        "renders": result.renders,
        "seconds": round(result.seconds, 3),
        "stopped": result.stopped,
    }
