"""`halation fmt`: rewrites graphs in one canonical format, so that diffs show only what changed."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from ..resources.sandbox import Sandbox
from .options import AsJson, read_standard_input
from .outcome import print_json, print_note, write_count


def fmt(
    graphs: Annotated[
        list[Path],
        typer.Argument(help="Graph files, folders, or patterns such as 'shots/**/*.json'; - for standard input."),
    ],
    check: Annotated[
        bool, typer.Option("--check", help="Write nothing, and exit with 1 if a file is not formatted.")
    ] = False,
    name: Annotated[
        str,
        typer.Option(
            "--stdin-name",
            metavar="FILE",
            help="The file whose text comes from standard input: its folder is where relative paths start.",
        ),
    ] = "",
    as_json: AsJson = False,
    *,
    sandbox: Sandbox,
) -> int:
    """Rewrite graph files in the canonical format.

    The text of standard input (-) is written to standard output. In folders, virtual environments and installed
    packages (site-packages, node_modules) are left out.
    """
    from .. import document
    from ..errors import UsageError
    from ..lint.files import find_graphs
    from ..resources.atomic_write import write_text_atomically
    from ..resources.input_files import read_bytes

    if any(str(path) == "-" for path in graphs):
        if len(graphs) > 1 or as_json:
            raise UsageError("- cannot be combined with files or --json: it is formatted to standard output")
        return _format_input(name, check, sandbox=sandbox)
    # All files are read before the first is written: an invalid file leaves all of them as they are.
    formatted = {
        path: document.dump_readable(document.load(path, sandbox=sandbox), str(path))
        for path in find_graphs(graphs, sandbox=sandbox)
    }
    changed = [path for path, text in formatted.items() if read_bytes(path, sandbox) != text.encode()]
    for path in changed if not check else ():
        write_text_atomically(path, formatted[path], sandbox=sandbox)
    if as_json:
        print_json({"changed": [str(path) for path in changed], "checked": len(formatted), "written": not check})
    else:
        for path in changed:
            print_note(f"{path}: {'would be rewritten' if check else 'rewritten'}")
        outcome = f"{len(changed)} {'to rewrite' if check else 'rewritten'}" if changed else "nothing to rewrite"
        print_note(f"{write_count(len(formatted), 'file')}: {outcome}")
    return 1 if check and changed else 0


def _format_input(name: str, check: bool, sandbox: Sandbox) -> int:
    """Format standard input to standard output, as text editors do when they save the file `name`."""
    from .. import document

    text = read_standard_input()
    graph = document.loads(text, name or "-", str(Path(name).parent) if name else "", sandbox=sandbox)
    formatted = document.dump_readable(graph, name or "-")
    if not check:
        sys.stdout.buffer.write(formatted.encode())
    return 1 if check and text != formatted else 0
