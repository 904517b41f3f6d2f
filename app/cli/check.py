"""`halation check`: everything that `render` would refuse, without rendering."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .options import AsJson, Lazy
from .outcome import print_json

if TYPE_CHECKING:
    from ...nodes import Missing
    from ..graph import Graph, Problem

_SIZE = (1920, 1080)
"""What stands for a picture that is not there."""


def check(
    graphs: Annotated[list[Path], typer.Argument(help="Graphs, as JSON.")],
    as_json: AsJson = False,
) -> int:
    """Look for faults in graphs: schema, types, links, loops, ranges, missing files and layers."""
    worst = 0
    reports: list[dict[str, Any]] = []
    for path in graphs:
        found = list(_faults(path))
        code = max((code for code, _ in found), default=0)
        worst = max(worst, code)
        reports.append({"graph": str(path), "exit_code": code, "problems": [asdict(problem) for _, problem in found]})
        if not as_json:
            for _, problem in found:
                print(f"{path}: {problem.severity}: {problem.sentence}")
            if code == 0:
                print(f"{path}: ok")
    if as_json:
        print_json({"graphs": reports})
    return worst


def _faults(path: Path) -> Iterator[tuple[int, Problem]]:
    """What there is to say of a graph file, each with the exit code that rendering would have."""
    from .. import document
    from ..errors import DocumentError, GraphError
    from ..graph import INPUTS, Problem, problems
    from ..graph.rules import Rule

    try:
        graph = document.load(path)
    except DocumentError as fault:
        yield fault.exit_code, Problem("", "", str(fault).removeprefix(f"{path}: "), Rule("schema", "error", "", ""))
        return
    found = problems(graph)
    for problem in found:
        yield (GraphError.exit_code if problem.severity == "error" else 0), problem
    for name, item in graph.inputs.items():
        if not item.file and item.default is None:
            sentence = f"input '{name}' has no file and no default: rendering needs -i {name}=FILE"
            yield 0, Problem(INPUTS, name, sentence, Rule("unbound-input", "warning", "", ""))
    if graph.outputs and all(problem.severity == "warning" for problem in found):
        yield from _compiled(graph)


def _compiled(graph: Graph) -> Iterator[tuple[int, Problem]]:
    """What only shows when the graph is compiled: pictures and their layers."""
    from .. import compiler
    from ..compiler import Frame, Picture, Probed
    from ..errors import HalationError, InputError
    from ..graph import Problem
    from ..graph.rules import Rule

    unread: dict[str, None] = {}

    class Forgiving(Lazy):
        """Goes on after a picture that cannot be read."""

        def at(self, path: str, frame: int, missing: Missing) -> Frame:
            try:
                return super().at(path, frame, missing)
            except InputError as fault:
                unread[str(fault)] = None
            return Frame(path)

        def probe(self, picture: Picture) -> Probed:
            if not picture.in_memory:
                try:
                    return super().probe(picture)
                except InputError as fault:
                    unread[str(fault)] = None
            return Probed(graph.settings.size or _SIZE, False, picture.path)

    lazy, first, last = Forgiving(), 1, 1
    try:
        first, last = lazy.frames(graph, ())
        lazy.check_frames(graph, range(first, last + 1))
    except InputError as fault:
        unread[str(fault)] = None
    bindings = {
        name: Picture(name, "", item.kind, item.socket().channels, in_memory=True)
        for name, item in graph.inputs.items() if not item.file and item.default is None
    }
    try:
        compiler.compile_graph(graph, compiler.Request(bindings=bindings, frame=first), lazy)
    except HalationError as fault:
        yield fault.exit_code, Problem("", "", str(fault), Rule("cannot-compile", "error", "", ""))
    for sentence in unread:
        yield InputError.exit_code, Problem("", "", sentence, Rule("missing-picture", "error", "", ""))
