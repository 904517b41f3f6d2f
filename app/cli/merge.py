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
    from ..document.diff_merge import Merged, Side
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
        made = merged_versions(*graphs)
        if output:
            from ..resources.atomic_write import write_text_atomically

            write_text_atomically(output, made.text)
    except OutputError as fault:
        fault.exit_code = TROUBLE
        raise
    if as_json:
        told = [{"path": conflict.path, **conflict.entry()} for conflict in made.conflicts]
        print_json({"conflicts": told, **({"written": str(output)} if output else {"merged": made.text})})
    else:
        if not output:
            sys.stdout.write(made.text)
        tell(made, str(output or graphs[1]))
    return 1 if made.conflicts else 0


def merged_versions(base: str, ours: str, theirs: str) -> Merged:
    """The merge of three versions; a base without text is an empty graph. Raises DocumentError that names the side."""
    from ..document.diff_merge import merged

    return merged(_side(base, "base"), _side(ours, "ours"), _side(theirs, "theirs"))


def _side(source: str, side: str) -> Graph:
    from .. import document
    from ..graph import Graph

    text, folder = text_of(source)
    if side == "base" and not text.strip():
        return Graph()
    return document.loads(text, f"{source} ({side})", folder, follow=False)


def tell(made: Merged, name: str) -> None:
    """Name the conflicts on standard error."""
    from ..document import loads
    from ..graph import problems

    for problem in problems(loads(made.text, follow=False)) if made.conflicts else ():
        if problem.rule.name == "unmerged":
            note(f"{name}: {problem.sentence}")


def _resolve(graphs: Sequence[str], choices: Sequence[str], as_json: bool) -> int:
    """Decide conflicts; the exit code is 1 if some are left."""
    from .. import document
    from ..document.canonical import pretty
    from ..document.diff_merge import conflicts_of, resolved
    from ..document.disk import read_text
    from ..document.syntax import parse
    from ..errors import UsageError
    from ..resources.atomic_write import write_text_atomically

    chosen = dict(map(_choice, choices))
    done: dict[Path, str] = {}
    for path in map(Path, graphs):
        try:
            tree = resolved(parse(read_text(path), str(path)), chosen)
        except UsageError as fault:
            raise UsageError(f"{path}: {fault}") from None
        done[path] = document.dumps(document.loads(pretty(tree), str(path), str(path.parent), follow=False))
    left: dict[str, list[str]] = {}
    for path, text in done.items():
        write_text_atomically(path, text)
        left[str(path)] = [conflict.path for conflict in conflicts_of(parse(text, str(path)))]
    if as_json:
        print_json({"graphs": [{"graph": path, "conflicts": open} for path, open in left.items()]})
    for path, open in left.items() if not as_json else ():
        note(f"{path}: {'to be decided: ' + ', '.join(open) if open else 'nothing is left to be decided'}")
    return 1 if any(left.values()) else 0


def _choice(text: str) -> tuple[str, Side]:
    from ..document.diff_merge import SIDES
    from ..errors import UsageError

    path, _, word = text.rpartition("=")
    for side in SIDES:
        if side == word:
            return path, side
    raise UsageError(f"--resolve {text}: choose ours, theirs or base, or PATH=ours and so on")
