"""`halation fmt`: one canonical form, so that diffs show what changed."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from .options import AsJson, standard_input
from .outcome import note, print_json


def fmt(
    graphs: Annotated[
        list[Path],
        typer.Argument(help="Graphs, folders of them, or patterns such as 'shots/**/*.json'; - for standard input."),
    ],
    check: Annotated[
        bool, typer.Option("--check", help="Write nothing; exit with 1 if a file is not formatted.")
    ] = False,
    name: Annotated[
        str, typer.Option("--stdin-name", metavar="FILE", help="The file that standard input is the text of.")
    ] = "",
    as_json: AsJson = False,
) -> int:
    """Rewrite graphs in the canonical format; - writes to standard output."""
    from .. import document
    from ..errors import UsageError
    from ..lint.files import find_graphs
    from ..resources.atomic_write import write_text_atomically

    if any(str(path) == "-" for path in graphs):
        if len(graphs) > 1 or as_json:
            raise UsageError("- formats standard input alone, to standard output: name no files, and leave out --json")
        return _format_input(name, check)
    # All are read before one is written: a fault in the last file leaves the first as it is.
    formatted = {path: document.dumps(document.load(path)) for path in find_graphs(graphs)}
    changed = [path for path, text in formatted.items() if path.read_bytes() != text.encode()]
    for path in changed if not check else ():
        write_text_atomically(path, formatted[path])
    if as_json:
        print_json({"changed": [str(path) for path in changed], "checked": len(formatted), "written": not check})
    else:
        for path in changed:
            note(f"{path}: {'would be formatted' if check else 'formatted'}")
        note(f"{len(formatted) - len(changed)} of {len(formatted)} were formatted already")
    return 1 if check and changed else 0


def _format_input(name: str, check: bool) -> int:
    """Format standard input: what an editor of text does when it saves `name`."""
    from .. import document

    text = standard_input()
    formatted = document.dumps(document.loads(text, name or "-", str(Path(name).parent) if name else ""))
    if not check:
        sys.stdout.buffer.write(formatted.encode())
    return 1 if check and text != formatted else 0
