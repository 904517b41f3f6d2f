"""`halation fmt`: one canonical form, so that diffs show what changed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .options import AsJson
from .outcome import guarded, note, print_json


@guarded
def fmt(
    graphs: Annotated[list[Path], typer.Argument(help="Graphs, as JSON.")],
    check: Annotated[
        bool, typer.Option("--check", help="Write nothing; exit with 1 if a file is not formatted.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Rewrite graphs in the canonical format."""
    from .. import document

    changed: list[str] = []
    for path in graphs:
        graph = document.load(path)
        if path.read_text(encoding="utf-8") != document.dumps(graph):
            changed.append(str(path))
            if not check:
                document.save(graph, path)
    if as_json:
        print_json({"changed": changed, "checked": len(graphs), "written": not check})
    else:
        for name in changed:
            note(f"{name}: {'would be formatted' if check else 'formatted'}")
        note(f"{len(graphs) - len(changed)} of {len(graphs)} were formatted already")
    if check and changed:
        raise typer.Exit(1)
