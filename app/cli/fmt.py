"""`halation fmt`: one canonical form, so that diffs show what changed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .options import AsJson
from .outcome import note, print_json


def fmt(
    graphs: Annotated[list[Path], typer.Argument(help="Graphs, as JSON.")],
    check: Annotated[
        bool, typer.Option("--check", help="Write nothing; exit with 1 if a file is not formatted.")
    ] = False,
    as_json: AsJson = False,
) -> int:
    """Rewrite graphs in the canonical format."""
    from .. import document

    # All are read before one is written: a fault in the last file leaves the first as it is.
    loaded = {path: document.load(path) for path in graphs}
    changed = [path for path, graph in loaded.items() if path.read_bytes() != document.dumps(graph).encode()]
    for path in changed if not check else ():
        document.save(loaded[path], path)
    if as_json:
        print_json({"changed": [str(path) for path in changed], "checked": len(loaded), "written": not check})
    else:
        for path in changed:
            note(f"{path}: {'would be formatted' if check else 'formatted'}")
        note(f"{len(loaded) - len(changed)} of {len(loaded)} were formatted already")
    return 1 if check and changed else 0
