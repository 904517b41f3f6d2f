"""`halation merge`: what two people made of a graph, in one graph; and what they left to be decided."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .options import AsJson
from .outcome import note, print_json
from .versions import text_of

if TYPE_CHECKING:
    from ..document.diff_merge import MergedGraph, Side
    from ..graph import Graph

TROUBLE = 2
"""What `merge` makes of exit code 1, which says that something is to be decided."""


def merge(
    graphs: Annotated[
        list[str],
        typer.Argument(metavar="BASE OURS THEIRS", help="Three versions: files, REV:FILE in git, or - once."),
    ],
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FILE", help="Where to write; by default standard output.")
    ] = None,
    resolve: Annotated[
        list[str] | None,
        typer.Option(
            "--resolve",
            metavar="[PATH=]SIDE",
            help="Decide conflicts in the graphs named: ours, theirs or base, for all or what is at PATH.",
        ),
    ] = None,
    as_json: AsJson = False,
) -> int:
    """Merge what two sides made of a graph, node by node and value by value: 1 if something is left to be decided.

    Conflicts stand in the graph, where ours stays in place; `check` and `render` name them until they are resolved.
    """
    from ..errors import OutputError, UsageError

    try:
        if resolve:
            if output:
                raise UsageError("--resolve changes the graphs that it is given: leave out -o")
            return _resolve(graphs, resolve, as_json)
        if len(graphs) != 3:
            raise UsageError("three versions are merged: name BASE, OURS and THEIRS; see halation merge --help")
        if graphs.count("-") > 1:
            raise UsageError("- is there once: name files for the others")
        merge_result = merge_versions(*graphs)
        if output:
            from ..resources.atomic_write import write_text_atomically

            write_text_atomically(output, merge_result.text)
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


def merge_versions(base: str, ours: str, theirs: str) -> MergedGraph:
    """The merge of three versions; a base without text is an empty graph. Raises DocumentError that names the side."""
    from ..document.diff_merge import merge_graphs

    return merge_graphs(_side(base, "base"), _side(ours, "ours"), _side(theirs, "theirs"))


def _side(source: str, side: str) -> Graph:
    from .. import document
    from ..graph import Graph

    text, folder = text_of(source)
    if side == "base" and not text.strip():
        return Graph()
    return document.loads(text, f"{source} ({side})", folder, follow=False)


def report_conflicts(merge_result: MergedGraph, name: str) -> None:
    """Name the conflicts on standard error."""
    from ..document import loads
    from ..graph import problems

    for problem in problems(loads(merge_result.text, follow=False)) if merge_result.conflicts else ():
        if problem.rule.name == "unmerged":
            note(f"{name}: {problem.sentence}")


def _resolve(graphs: Sequence[str], choices: Sequence[str], as_json: bool) -> int:
    """Decide conflicts; the exit code is 1 if some are left."""
    from .. import document
    from ..document.canonical import pretty
    from ..document.diff_merge import read_conflicts, resolve_conflicts
    from ..document.disk import read_text
    from ..document.syntax import parse
    from ..errors import UsageError
    from ..resources.atomic_write import write_text_atomically

    chosen = dict(map(_choice, choices))
    texts: dict[Path, str] = {}
    for path in map(Path, graphs):
        try:
            tree = resolve_conflicts(parse(read_text(path), str(path)), chosen)
        except UsageError as fault:
            raise UsageError(f"{path}: {fault}") from None
        texts[path] = document.dumps(document.loads(pretty(tree), str(path), str(path.parent), follow=False))
    open_conflicts: dict[str, list[str]] = {}
    for path, text in texts.items():
        write_text_atomically(path, text)
        open_conflicts[str(path)] = [conflict.path for conflict in read_conflicts(parse(text, str(path)))]
    if as_json:
        print_json({"graphs": [{"graph": path, "conflicts": open} for path, open in open_conflicts.items()]})
    for path, open in open_conflicts.items() if not as_json else ():
        note(f"{path}: {'to be decided: ' + ', '.join(open) if open else 'nothing is left to be decided'}")
    return 1 if any(open_conflicts.values()) else 0


def _choice(text: str) -> tuple[str, Side]:
    from ..document.diff_merge import SIDES
    from ..errors import UsageError

    path, _, word = text.rpartition("=")
    for side in SIDES:
        if side == word:
            return path, side
    raise UsageError(f"--resolve {text}: choose ours, theirs or base, or PATH=ours and so on")
