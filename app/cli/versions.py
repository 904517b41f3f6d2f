"""Reads versions of graphs from files, standard input and git, and prints differences."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from ..resources.sandbox import Sandbox
from .options import locate_graph, read_standard_input

if TYPE_CHECKING:
    from ..document.diff_merge import DifferenceLine
    from ..graph import Graph

_COLORS = {"+": "32", "-": "31", "~": "36", "@": "35"}


def read_version(source: str, sandbox: Sandbox) -> tuple[str, str]:
    """The text of a file or preset, of `REV:path` in git or of standard input (`-`), and where relative paths start.

    Raises DocumentError, UsageError.
    """
    from ..document.disk import read_text
    from .git import read_revision

    if source == "-":
        return read_standard_input(), ""
    path = Path(source)
    if ":" in source and not path.drive and not os.path.lexists(path):
        return read_revision(source)
    path = locate_graph(source)
    return read_text(path, sandbox=sandbox), str(path.parent)


def load_version(source: str, *, follow: bool = False, name: str = "", sandbox: Sandbox) -> Graph:
    """Load a version of a graph, with `follow` also the groups in other files. Raises DocumentError, UsageError."""
    from .. import document

    text, folder = read_version(source, sandbox=sandbox)
    return document.loads(text, name or source, folder, sandbox=sandbox if follow else None)


def is_colored() -> bool:
    """True if a user reads standard output and has not asked for plain text (https://no-color.org)."""
    reaches_user = sys.stdout.isatty() or os.environ.get("GIT_PAGER_IN_USE") == "true"
    return reaches_user and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"


def print_lines(lines: Iterable[DifferenceLine], colored: bool) -> None:
    """Print differences: a sign and a sentence each, with changed lines of code below."""
    for line in lines:
        print(paint(f"{line.sign} {line.words}", line.sign, colored))
        for below in line.below:
            print("    " + paint(below, below[:1], colored))


def paint(text: str, sign: str, colored: bool) -> str:
    """A line in the color of its sign, with control characters escaped."""
    plain = "".join(letter if letter.isprintable() or letter == "\t" else ascii(letter)[1:-1] for letter in text)
    return f"\x1b[{_COLORS[sign]}m{plain}\x1b[0m" if colored and sign in _COLORS else plain
