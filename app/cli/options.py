"""Flags and steps that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from . import parsing
from .outcome import note

if TYPE_CHECKING:
    from ..graph import Graph

Inputs = Annotated[
    list[str],
    typer.Option("-i", "--input", metavar="NAME=FILE[:LAYER]", help="Bind an input of the graph to a picture."),
]
Sets = Annotated[
    list[str],
    typer.Option("--set", metavar="NODE.VALUE=X", help="Set a value, or a control by its name; colors as r,g,b,a."),
]
SizeText = Annotated[
    str | None, typer.Option("--size", metavar="WxH", help="Size of canvas and pictures, instead of their own.")
]
Scale = Annotated[float, typer.Option(help="Render a proxy: 0.5 is half size, lengths in pixels included.")]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON object on standard output, for machines.")]


def opened(path: Path, sets: list[str]) -> Graph:
    """A graph with the values from the command line."""
    from .. import document

    graph = document.load(path)
    for name, text in parsing.assignments(list(sets), "--set").items():
        graph = graph.override(name, parsing.value(text))
    return graph


def bound(graph: Graph, inputs: list[str]) -> dict[str, str]:
    """Pictures by input name; a bare path goes to the only input."""
    from ..errors import UsageError

    named: list[str] = []
    for item in inputs:
        if "=" in item:
            named.append(item)
        elif len(graph.inputs) == 1:
            named.append(f"{next(iter(graph.inputs))}={item}")
        else:
            known = ", ".join(graph.inputs) or "none"
            raise UsageError(f"-i {item}: write -i NAME=FILE; the inputs of this graph are {known}")
    return parsing.assignments(named, "-i")


def report_problems(path: Path, graph: Graph) -> None:
    """Stop at errors, mention warnings. Raises GraphError that names the first error and counts the others."""
    from ..errors import GraphError
    from ..graph import problems

    found = problems(graph)
    errors = [problem for problem in found if problem.severity == "error"]
    if errors:
        more = f" (and {len(errors) - 1} more: halation check {path})" if len(errors) > 1 else ""
        raise GraphError(f"{path}: {errors[0].sentence}{more}")
    for problem in found:
        note(f"{path}: {problem.sentence}")
