"""`halation git-driver`: git calls it for graphs after `halation git-setup`. Other JSON files are treated as text."""

from __future__ import annotations

import difflib
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..resources.input_files import read_bytes
from ..resources.sandbox import read_process_sandbox
from .outcome import print_note
from .versions import is_colored, paint, print_lines

if TYPE_CHECKING:
    from ..graph import Graph

CONFLICTS = 1
"""The exit code for a merge with conflicts, as git expects it."""


def git_driver(
    task: Annotated[str, typer.Argument(metavar="diff|text|merge", help="What git asks for.")],
    words: Annotated[list[str], typer.Argument(help="The arguments of git.")],
) -> int:
    """Compare, print or merge graphs for git; see git-setup."""
    from ..errors import UsageError

    if task == "diff" and len(words) in (1, 7, 8, 9):
        return _diff(words)
    if task == "text" and len(words) == 1:
        return _text(words[0])
    if task == "merge" and len(words) == 4:
        return _merge(*words)
    raise UsageError(f"git-driver {task}: only git calls this command; see halation git-setup --help")


def _diff(words: Sequence[str]) -> int:
    """`git diff`: the arguments are a path, then file, hash and mode of both sides, and the new path of a renamed file.

    The exit code is 0, because git takes any other for a failure.
    """
    from ..document.diff_merge import compare_graphs, describe_difference
    from ..graph import Graph

    path, colored = words[7] if len(words) > 7 else words[0], is_colored()
    if len(words) == 1:
        print(paint(f"graph {path}: the merge is unfinished", "@", colored))
        return 0
    before, after = _read_text(words[1]), _read_text(words[4])
    graphs = [_parse_graph(text, path) if text else Graph() for text in (before, after)]
    moved = f"{words[0]} -> {path}" if path != words[0] else path
    state = ", new" if words[2] == "." else ", deleted" if words[5] == "." else ""
    graph_before, graph_after = graphs
    if graph_before is None or graph_after is None:
        for line in difflib.unified_diff(
            before.splitlines(), after.splitlines(), f"a/{words[0]}", f"b/{path}", lineterm=""
        ):
            print(paint(line, line[:1], colored))
        return 0
    lines = describe_difference(compare_graphs(graph_before, graph_after), graph_before, graph_after)
    print(paint(f"graph {moved}{state}", "@", colored))
    if not lines:
        print("  only the layout or the formatting of the file")
    print_lines(lines, colored)
    return 0


def _text(file: str) -> int:
    """`git log -p` and `git show`: prints the graph with one fact per line, which git compares."""
    from ..document.diff_merge import describe_graph

    text = _read_text(file)
    graph = _parse_graph(text, file)
    sys.stdout.write(text if graph is None else "".join(f"{line}\n" for line in describe_graph(graph)))
    return 0


def _merge(base: str, ours: str, theirs: str, path: str) -> int:
    """`git merge`, `git rebase` and so on: merges into the file of our side."""
    from ..errors import DocumentError
    from ..resources.atomic_write import write_text_atomically
    from .merge import merge_versions, report_conflicts

    if not any('"halation"' in _read_text(file) for file in (ours, theirs)):
        return subprocess.run(
            ["git", "merge-file", "-L", "ours", "-L", "base", "-L", "theirs", ours, base, theirs], check=False
        ).returncode
    try:
        merge_result = merge_versions(base, ours, theirs, read_process_sandbox())
    except DocumentError as fault:
        print_note(f"halation: {path}: it cannot be merged, and our side stays as it is: {fault}")
        return CONFLICTS
    write_text_atomically(Path(ours), merge_result.text, sandbox=read_process_sandbox())
    report_conflicts(merge_result, path)
    return CONFLICTS if merge_result.conflicts else 0


def _parse_graph(text: str, name: str) -> Graph | None:
    """The graph in a text, or None if the text is no valid graph."""
    from .. import document
    from ..errors import DocumentError

    try:
        return document.loads(text, name, sandbox=None)
    except DocumentError:
        return None


def _read_text(file: str) -> str:
    """The text of a file that git hands over; git names the null device for one that is not there."""
    if file == os.devnull:
        return ""
    return read_bytes(file, read_process_sandbox()).decode("utf-8-sig", errors="replace")
