"""`halation reproduce`: renders a picture again from its own header."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..resources.render_choices import DEFAULT_TIMEOUT
from ..resources.sandbox import Sandbox
from . import parsing
from .options import AsJson, report_problems
from .outcome import print_json, print_note
from .watchdog import Timeout, rerun_watched

if TYPE_CHECKING:
    from ..renderer.provenance.file_finder import LocatedFile
    from ..renderer.provenance.recipe import Recipe
    from ..renderer.provenance.reproduction import LayerDifference, Reproduction

_SHORT = 12
"""Digits of a hash that are printed, as many as git prints in large repositories."""


_Picture = Annotated[Path, typer.Argument(help="A picture that Halation rendered: EXR, PNG, TIFF or JPEG.")]
_Output = Annotated[
    list[Path] | None, typer.Option("-o", "--output", metavar="FILE", help="Also write the new picture.")
]
_Inputs = Annotated[
    list[str] | None,
    typer.Option(
        "-i",
        "--input",
        metavar="NAME=FILE",
        help="The file of an input, or of a node that reads a file, if it has moved.",
    ),
]
_Search = Annotated[
    list[Path] | None,
    typer.Option(
        "--search", metavar="DIR", help="Search for moved files in this folder and below, by name and by content."
    ),
]
_Graph = Annotated[
    Path | None,
    typer.Option("--graph", metavar="FILE", help="Save the graph of the picture; without -o nothing is rendered."),
]
_Tolerance = Annotated[
    float | None,
    typer.Option(
        metavar="X",
        min=0.0,
        help="The largest allowed difference of a number; by default 0 if the renderer is the same.",
    ),
]


def reproduce(
    context: typer.Context,
    picture: _Picture,
    output: _Output = None,
    inputs: _Inputs = None,
    search: _Search = None,
    graph: _Graph = None,
    tolerance: _Tolerance = None,
    timeout: Timeout = DEFAULT_TIMEOUT,
    as_json: AsJson = False,
    *,
    sandbox: Sandbox,
) -> int:
    """Render a picture again from its header, and compare.

    Prints what differs, and exits with 0 if the pixels are the same, else with 1.
    """
    from ..renderer.provenance.file_finder import FileFinder, describe_missing
    from ..renderer.provenance.recipe import read_recipe

    given_files = parsing.parse_assignments(inputs or (), "-i")
    recipe = read_recipe(picture, sandbox=sandbox)
    located_files = FileFinder(recipe, given_files, search or (), sandbox=sandbox).find_all()
    saved_path = _save_graph(recipe, located_files, graph, sandbox=sandbox) if graph else ""
    if graph and not output:
        if as_json:
            print_json(
                {"picture": str(picture), "graph": saved_path, "inputs": [_input_facts(item) for item in located_files]}
            )
        return 0
    if fault := describe_missing(located_files, picture):
        raise fault
    report_problems(picture, recipe.graph)
    if (code := rerun_watched(context, picture, recipe.graph, timeout)) is not None:
        return code
    from ..renderer import Renderer
    from ..renderer.provenance.reproduction import open_matching_device, reproduce

    renderer = Renderer(open_matching_device(recipe, sandbox=sandbox), budget=0, sandbox=sandbox)
    print_note(renderer.device.description)
    reproduction = reproduce(renderer, recipe, located_files, tuple(output or ()), tolerance)
    if as_json:
        print_json(_reproduction_facts(recipe, located_files, reproduction, saved_path))
    else:
        _print_reproduction(recipe, located_files, reproduction)
    return 0 if reproduction.is_same else 1


def _save_graph(recipe: Recipe, files: tuple[LocatedFile, ...], path: Path, sandbox: Sandbox) -> str:
    """Save the graph with the paths of the located files; the path that it was saved to."""
    from dataclasses import replace

    from .. import document
    from ..graph.paths import rebase_paths
    from ..renderer.provenance.file_finder import relink_files

    linked_graph = relink_files(recipe.graph, files)
    folder = str(path.absolute().parent)
    moved_graph = rebase_paths(replace(linked_graph, folder=str(recipe.path.absolute().parent)), folder)
    if str(path) == "-":
        print(document.dumps(moved_graph), end="")
        return "-"
    document.save(moved_graph, path, sandbox=sandbox)
    print_note(f"{path}: the graph of {recipe.path}")
    return str(path)


def _print_reproduction(recipe: Recipe, files: tuple[LocatedFile, ...], reproduction: Reproduction) -> None:
    proxy = f", scale {recipe.settings.scale:g}" if recipe.settings.scale != 1.0 else ""
    print(f"{recipe.path}: frame {recipe.settings.frame}{proxy}, by Halation {recipe.version} on {recipe.renderer}")
    for item in reproduction.differences:
        print(f"  {item.name:<9} was {item.recorded}, is {item.current}")
    for item in files:
        name = item.recorded.pattern or item.recorded.name
        old_digest = item.recorded.sequence_digest or item.recorded.digest
        if item.state == "same":
            moved = f" (now {item.path})" if Path(item.path).name != name else ""
            print(f"  input     {_input_name(item)}: {name}: the same{moved}")
        else:
            new_state = f"changed, was {old_digest[:_SHORT]}, is {item.digest[:_SHORT]} ({item.path})"
            print(f"  input     {_input_name(item)}: {name}: {new_state}")
    for layer in reproduction.layers:
        print(f"  pixels    {f'{layer.name}: ' if layer.name else ''}{_describe_layer(layer, reproduction.tolerance)}")
    for path in reproduction.written:
        print_note(f"{path}  the new picture")


def _describe_layer(layer: LayerDifference, tolerance: float) -> str:
    measured = layer.compared
    if measured.fault:
        return f"differ: {measured.fault}"
    if measured.equal:
        return "the same, bit for bit"
    within = "within" if layer.farthest <= tolerance else "beyond"
    x, y = measured.worst or (0, 0)
    return (
        f"{'the same' if within == 'within' else 'differ'}: at most {measured.max_abs:.3g} apart at {x},{y}, "
        f"rms {measured.rms:.3g}, {measured.failing:.2%} of the pixels; {within} the tolerance of {tolerance:.3g}"
    )


def _input_name(item: LocatedFile) -> str:
    return item.recorded.owner.removeprefix("inputs.")


def _input_facts(item: LocatedFile) -> dict[str, Any]:
    used = item.recorded
    return {
        "name": _input_name(item),
        "file": used.pattern or used.name,
        "layer": used.layer,
        "state": item.state,
        "path": item.path,
        "then": used.sequence_digest or used.digest,
        "now": item.digest,
    }


def _reproduction_facts(
    recipe: Recipe, files: tuple[LocatedFile, ...], reproduction: Reproduction, saved: str
) -> dict[str, Any]:
    return {
        "picture": str(recipe.path),
        "same": reproduction.is_same,
        "tolerance": reproduction.tolerance,
        "frame": recipe.settings.frame,
        "version": recipe.version,
        "renderer": recipe.renderer,
        "differences": [
            {"what": item.name, "then": item.recorded, "now": item.current} for item in reproduction.differences
        ],
        "inputs": [_input_facts(item) for item in files],
        "pixels": [
            {
                "layer": layer.name,
                "equal": layer.compared.equal,
                "farthest": _make_json_safe(layer.farthest),
                "max_abs": _make_json_safe(layer.compared.max_abs),
                "rms": _make_json_safe(layer.compared.rms),
                "failing": layer.compared.failing,
                "fault": layer.compared.fault,
            }
            for layer in reproduction.layers
        ],
        "graph": saved,
        "written": [str(path) for path in reproduction.written],
    }


def _make_json_safe(measure: float) -> float | None:
    """The measure, or None for infinity, which JSON does not have."""
    return measure if measure < float("inf") else None
