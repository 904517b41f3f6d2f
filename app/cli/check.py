"""`halation check`: everything that `render` would refuse, without rendering."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer

from ..errors import HalationError
from .options import AsJson
from .outcome import guarded, print_json


@guarded
def check(
    graphs: Annotated[list[Path], typer.Argument(help="Graphs, as JSON.")],
    as_json: AsJson = False,
) -> None:
    """Look for faults in graphs: schema, types, links, loops, ranges, missing files and layers."""
    worst = 0
    found: list[dict[str, Any]] = []
    for path in graphs:
        code, faults = _check(path)
        worst = max(worst, code)
        found.append({"graph": str(path), "ok": code == 0, "problems": faults})
        if not as_json:
            for fault in faults:
                print(f"{path}: {fault['severity']}: {fault['sentence']}")
            if code == 0:
                print(f"{path}: ok")
    if as_json:
        print_json({"graphs": found})
    raise typer.Exit(worst)


def _check(path: Path) -> tuple[int, list[dict[str, Any]]]:
    """The exit code that rendering would have, and what there is to say."""
    from .. import compiler, document
    from ..errors import GraphError
    from ..graph import problems
    from ..media.pictures import Pictures

    faults: list[dict[str, Any]] = []
    try:
        graph = document.load(path)
        faults = [asdict(problem) for problem in problems(graph)]
        if any(fault["severity"] == "error" for fault in faults):
            return GraphError.exit_code, faults
        if not graph.outputs:
            return 0, faults
        unbound = [name for name, item in graph.inputs.items() if not item.file and item.default is None]
        for name in unbound:
            faults.append(_fault(f"input '{name}' has no default file: rendering needs -i {name}=FILE", "warning"))
        if not unbound:
            compiler.compile_graph(graph, compiler.Request(), Pictures().probe)
    except HalationError as fault:
        return fault.exit_code, [*faults, _fault(str(fault).removeprefix(f"{path}: "), "error")]
    return 0, faults


def _fault(sentence: str, severity: str) -> dict[str, Any]:
    return {"node": "", "socket": "", "sentence": sentence, "severity": severity}
