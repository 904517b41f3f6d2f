"""`halation reproduce`: a picture again, from its own header."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..resources.render_choices import DEFAULT_TIMEOUT
from . import parsing
from .options import AsJson, report_problems
from .outcome import note, print_json
from .watchdog import Timeout, rerun_watched

if TYPE_CHECKING:
    from ..renderer.provenance.file_finder import LocatedFile
    from ..renderer.provenance.recipe import Recipe
    from ..renderer.provenance.reproduction import LayerDifference, Reproduction

_SHORT = 12


def reproduce(
    context: typer.Context,
    picture: Annotated[Path, typer.Argument(help="A picture that Halation rendered: EXR, PNG, TIFF or JPEG.")],
    output: Annotated[
        list[Path] | None, typer.Option("-o", "--output", metavar="FILE", help="Keep the rebuilt picture too.")
    ] = None,
    inputs: Annotated[
        list[str] | None,
        typer.Option("-i", "--input", metavar="NAME=FILE", help="Where an input, or a file that a node reads, is now."),
    ] = None,
    search: Annotated[
        list[Path] | None,
        typer.Option("--search", metavar="DIR", help="Look for inputs below this folder, by name and by content."),
    ] = None,
    graph: Annotated[
        Path | None,
        typer.Option("--graph", metavar="FILE", help="Save the graph that made the picture; renders only with -o."),
    ] = None,
    tolerance: Annotated[
        float | None,
        typer.Option(metavar="X", min=0.0, help="How far numbers may be apart; by default 0 on the same renderer."),
    ] = None,
    timeout: Timeout = DEFAULT_TIMEOUT,
    as_json: AsJson = False,
) -> int:
    """Rebuild a picture from its own header, and say what differs: 0 if the pixels are the same, 1 if not."""
    from ..renderer.provenance.file_finder import FileFinder, describe_missing
    from ..renderer.provenance.recipe import read_recipe

    given_files = parsing.assignments(inputs or (), "-i")
    recipe = read_recipe(picture)
    files = FileFinder(recipe, given_files, search or ()).find_all()
    saved = _save_graph(recipe, files, graph) if graph else ""
    if graph and not output:
        if as_json:
            print_json({"picture": str(picture), "graph": saved, "inputs": [_input_facts(item) for item in files]})
        return 0
    if fault := describe_missing(files, picture):
        raise fault
    report_problems(picture, recipe.graph)
    if (code := rerun_watched(context, picture, recipe.graph, timeout)) is not None:
        return code
    from ..renderer import Renderer
    from ..renderer.provenance.reproduction import open_matching_device, reproduce

    renderer = Renderer(open_matching_device(recipe), budget=0)
    note(renderer.device.description)
    reproduction = reproduce(renderer, recipe, files, tuple(output or ()), tolerance)
    if as_json:
        print_json(_as_json(recipe, files, reproduction, saved))
    else:
        _print(recipe, files, reproduction)
    return 0 if reproduction.same else 1


def _save_graph(recipe: Recipe, files: tuple[LocatedFile, ...], path: Path) -> str:
    """Save the graph with what was found in it; where to."""
    from dataclasses import replace

    from .. import document
    from ..graph.paths import rebased
    from ..renderer.provenance.file_finder import relink_files

    whole = relink_files(recipe.graph, files)
    folder = str(path.absolute().parent)
    below = rebased(replace(whole, folder=str(recipe.path.absolute().parent)), folder)
    if str(path) == "-":
        print(document.dumps(below), end="")
        return "-"
    document.save(below, path)
    note(f"{path}: the graph of {recipe.path}")
    return str(path)


def _print(recipe: Recipe, files: tuple[LocatedFile, ...], reproduction: Reproduction) -> None:
    proxy = f", scale {recipe.scale:g}" if recipe.scale != 1.0 else ""
    print(f"{recipe.path}: frame {recipe.frame}{proxy}, by Halation {recipe.version} on {recipe.renderer}")
    for item in reproduction.differences:
        print(f"  {item.what:<9} was {item.then}, is {item.now}")
    for item in files:
        name = item.used.pattern or item.used.name
        then = item.used.together or item.used.digest
        if item.state == "same":
            moved = f" (now {item.path})" if Path(item.path).name != name else ""
            print(f"  input     {_name(item)}: {name}: the same{moved}")
        else:
            now = f"changed, was {then[:_SHORT]}, is {item.digest[:_SHORT]} ({item.path})"
            print(f"  input     {_name(item)}: {name}: {now}")
    for layer in reproduction.layers:
        print(f"  pixels    {f'{layer.name}: ' if layer.name else ''}{_describe_layer(layer, reproduction.tolerance)}")
    for path in reproduction.written:
        note(f"{path}  the rebuilt picture")


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


def _name(item: LocatedFile) -> str:
    return item.used.owner.removeprefix("inputs.")


def _input_facts(item: LocatedFile) -> dict[str, Any]:
    used = item.used
    return {
        "name": _name(item),
        "file": used.pattern or used.name,
        "layer": used.layer,
        "state": item.state,
        "path": item.path,
        "then": used.together or used.digest,
        "now": item.digest,
    }


def _as_json(recipe: Recipe, files: tuple[LocatedFile, ...], reproduction: Reproduction, saved: str) -> dict[str, Any]:
    return {
        "picture": str(recipe.path),
        "same": reproduction.same,
        "tolerance": reproduction.tolerance,
        "frame": recipe.frame,
        "version": recipe.version,
        "renderer": recipe.renderer,
        "differences": [{"what": item.what, "then": item.then, "now": item.now} for item in reproduction.differences],
        "inputs": [_input_facts(item) for item in files],
        "pixels": [
            {
                "layer": layer.name,
                "equal": layer.compared.equal,
                "farthest": _number(layer.farthest),
                "max_abs": _number(layer.compared.max_abs),
                "rms": _number(layer.compared.rms),
                "failing": layer.compared.failing,
                "fault": layer.compared.fault,
            }
            for layer in reproduction.layers
        ],
        "graph": saved,
        "written": [str(path) for path in reproduction.written],
    }


def _number(measure: float) -> float | None:
    """JSON has no infinity."""
    return measure if measure < float("inf") else None
