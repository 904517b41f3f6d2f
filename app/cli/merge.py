"""`halation merge`: merges two versions of a graph and resolves conflicts."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..resources.sandbox import Sandbox
from .options import AsJson
from .outcome import print_json, print_note
from .versions import read_version

if TYPE_CHECKING:
    from ..document.diff_merge import MergedGraph, Side
    from ..graph import Graph

TROUBLE = 2
"""The exit code of errors that have 1 elsewhere, because 1 means here that there are conflicts."""


_Graphs = Annotated[
    list[str],
    typer.Argument(
        metavar="BASE OURS THEIRS",
        help="Three versions of a graph: files, REV:FILE in git, or - for standard input.",
    ),
]
_Output = Annotated[
    Path | None,
    typer.Option("-o", "--output", metavar="FILE", help="The file to write; by default standard output."),
]
_Resolve = Annotated[
    list[str] | None,
    typer.Option(
        "--resolve",
        metavar="[PATH=]SIDE",
        help="Resolve the conflicts in the named graphs: take ours, theirs or base, for all or only at PATH.",
    ),
]


def merge(
    graphs: _Graphs,
    output: _Output = None,
    resolve: _Resolve = None,
    as_json: AsJson = False,
    *,
    sandbox: Sandbox,
) -> int:
    """Merge two versions of a graph.

    Merges by node and value. Exits with 1 if there are conflicts: they are written into the graph, which keeps our side
    until they are resolved, and `check` and `render` report them.
    """
    from ..errors import OutputError, UsageError

    try:
        if resolve:
            if output:
                raise UsageError("--resolve changes the named graphs themselves: leave out -o")
            return _resolve(graphs, resolve, as_json, sandbox=sandbox)
        if len(graphs) != 3:
            raise UsageError("merging needs three versions: name BASE, OURS and THEIRS; see halation merge --help")
        if graphs.count("-") > 1:
            raise UsageError("- can be used only once: name files for the others")
        merge_result = merge_versions(*graphs, sandbox=sandbox)
        if output:
            from ..resources.atomic_write import write_text_atomically

            write_text_atomically(output, merge_result.text, sandbox=sandbox)
    except OutputError as fault:
        fault.exit_code = TROUBLE
        raise
    if as_json:
        conflicts = [{"path": conflict.path, **conflict.entry()} for conflict in merge_result.conflicts]
        print_json({"conflicts": conflicts, **({"written": str(output)} if output else {"merged": merge_result.text})})
    else:
        if not output:
            sys.stdout.write(merge_result.text)
        report_conflicts(merge_result, str(output or graphs[1]))
    return 1 if merge_result.conflicts else 0


def merge_versions(base: str, ours: str, theirs: str, sandbox: Sandbox) -> MergedGraph:
    """Merge three versions; an empty file as base is an empty graph. Raises DocumentError that names the side."""
    from ..document.diff_merge import merge_graphs

    return merge_graphs(
        _load_side(base, "base", sandbox=sandbox),
        _load_side(ours, "ours", sandbox=sandbox),
        _load_side(theirs, "theirs", sandbox=sandbox),
    )


def _load_side(source: str, side: str, sandbox: Sandbox) -> Graph:
    from .. import document
    from ..graph import Graph

    text, folder = read_version(source, sandbox=sandbox)
    if side == "base" and not text.strip():
        return Graph()
    return document.loads(text, f"{source} ({side})", folder, sandbox=None)


def report_conflicts(merge_result: MergedGraph, name: str) -> None:
    """Print the conflicts to standard error."""
    from ..document import loads
    from ..graph import problems

    for problem in problems(loads(merge_result.text, sandbox=None)) if merge_result.conflicts else ():
        if problem.rule.name == "unmerged":
            print_note(f"{name}: {problem.sentence}")


def _resolve(graphs: Sequence[str], choices: Sequence[str], as_json: bool, sandbox: Sandbox) -> int:
    """Resolve conflicts in files; the exit code is 1 if some are left."""
    from .. import document
    from ..document.canonical import pretty
    from ..document.diff_merge import read_conflicts, resolve_conflicts
    from ..document.disk import read_text
    from ..document.syntax import parse
    from ..errors import UsageError
    from ..resources.atomic_write import write_text_atomically

    chosen = dict(map(_parse_choice, choices))
    texts: dict[Path, str] = {}
    for path in map(Path, graphs):
        try:
            tree = resolve_conflicts(parse(read_text(path, sandbox=sandbox), str(path)), chosen)
        except UsageError as fault:
            raise UsageError(f"{path}: {fault}") from None
        texts[path] = document.dumps(document.loads(pretty(tree), str(path), str(path.parent), sandbox=None))
    open_conflicts: dict[str, list[str]] = {}
    for path, text in texts.items():
        write_text_atomically(path, text, sandbox=sandbox)
        open_conflicts[str(path)] = [conflict.path for conflict in read_conflicts(parse(text, str(path)))]
    if as_json:
        print_json({"graphs": [{"graph": path, "conflicts": open} for path, open in open_conflicts.items()]})
    for path, open in open_conflicts.items() if not as_json else ():
        print_note(f"{path}: {'conflicts left: ' + ', '.join(open) if open else 'no conflict is left'}")
    return 1 if any(open_conflicts.values()) else 0


def _parse_choice(text: str) -> tuple[str, Side]:
    from ..document.diff_merge import SIDES
    from ..errors import UsageError

    path, _, word = text.rpartition("=")
    for side in SIDES:
        if side == word:
            return path, side
    raise UsageError(f"--resolve {text}: choose ours, theirs or base, or PATH=ours and so on")
