"""`halation git-setup`: makes git compare and merge graphs by node and value."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Annotated

import typer

from ..resources.program import permanent_command
from ..resources.sandbox import read_process_sandbox
from .options import AsJson
from .outcome import print_json

ATTRIBUTES = "diff=halation merge=halation"
"""The attributes of graphs in .gitattributes."""


def git_setup(
    patterns: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[PATTERN]...",
            help="Patterns of .gitattributes for graph files, such as '*.graph.json'; by default the JSON files in "
            "every folder where git knows a graph.",
        ),
    ] = None,
    everywhere: Annotated[
        bool, typer.Option("--global", help="Change the configuration of the user, for all repositories.")
    ] = False,
    remove: Annotated[bool, typer.Option("--remove", help="Remove what this command wrote.")] = False,
    as_json: AsJson = False,
) -> int:
    """Make git compare and merge graphs by node.

    Afterwards `git diff`, `git log -p` and `git merge` understand graphs. The command prints what it changes, and can
    run again. It writes two things: .gitattributes, which names the graph files and is committed; and the configuration
    of git, which names the Halation of this machine and is needed in each clone. Other JSON files stay text.
    """
    from ..errors import UsageError
    from .git import repository_root

    try:
        root = repository_root()
    except UsageError:
        if not everywhere:
            raise UsageError("this folder is not in a git repository: change to one, or add --global") from None
        root = None
    changes = _configure("--global" if everywhere else "--local", remove)
    if root:
        changes += _change_attributes(
            root / ".gitattributes", list(patterns or ()) or _find_patterns(root), bool(patterns), remove
        )
    elif patterns:
        raise UsageError("this folder is not in a git repository: patterns are written to its .gitattributes")
    if as_json:
        print_json({"changed": changes})
    else:
        print("\n".join(changes) if changes else "nothing needs to change")
    return 0


def git_settings() -> dict[str, str]:
    """The configuration of git that runs this installation of Halation, by name."""
    program, *words = permanent_command()
    call = shlex.join([Path(program).as_posix(), *words, "git-driver"])
    return {
        "diff.halation.command": f"{call} diff --",
        "diff.halation.textconv": f"{call} text --",
        "merge.halation.name": "Halation graphs, by node and value",
        "merge.halation.driver": f"{call} merge -- %O %A %B %P",
    }


def _configure(scope: str, remove: bool) -> list[str]:
    """Write or remove the configuration; a line per change."""
    from ..errors import UsageError
    from .git import git

    changes: list[str] = []
    for name, text in git_settings().items():
        try:
            current = git("config", scope, "--get", name).rstrip("\n")
        except UsageError:  # there is none
            current = None
        if remove and current is not None:
            git("config", scope, "--unset-all", name)
            changes.append(f"git config {scope}: removed {name}")
        elif not remove and current != text:
            git("config", scope, "--replace-all", name, text)
            changes.append(f"git config {scope}: {name} = {text}")
    return changes


def _change_attributes(file: Path, patterns: Sequence[str], only_these: bool, remove: bool) -> list[str]:
    """Add or remove lines of .gitattributes; a line per change.

    With `only_these` only the lines of these patterns are removed, else all lines that this command wrote.
    """
    from ..resources.atomic_write import write_text_atomically

    old = file.read_text(encoding="utf-8") if file.exists() else ""
    lines, own_lines = old.splitlines(), {f"{_quote_pattern(pattern)} {ATTRIBUTES}" for pattern in patterns}
    if remove:
        removed = [line for line in lines if line.endswith(f" {ATTRIBUTES}") and (line in own_lines or not only_these)]
        remaining = [line for line in lines if line not in removed]
        if removed and not remaining:
            file.unlink()
        elif removed:
            write_text_atomically(file, "".join(f"{line}\n" for line in remaining), sandbox=read_process_sandbox())
        return [f"{file}: removed {line}" for line in removed]
    new = sorted(own_lines.difference(lines))
    if new:
        write_text_atomically(file, "".join(f"{line}\n" for line in (*lines, *new)), sandbox=read_process_sandbox())
    return [f"{file}: {line}" for line in new]


def _find_patterns(root: Path) -> list[str]:
    """A pattern for each folder with a graph among the files that git tracks or could track."""
    from .git import git

    names = git("ls-files", "-z", "--cached", "--others", "--exclude-standard", "--", "*.json", folder=root)
    files = (root / name for name in names.split("\0") if name)
    return list(dict.fromkeys(_folder_pattern(path, root) for path in _select_graphs(files)))


def _select_graphs(files: Iterable[Path]) -> list[Path]:
    from ..lint.files import is_graph

    return [path for path in files if path.is_file() and is_graph(path, sandbox=read_process_sandbox())]


def _folder_pattern(path: Path, root: Path) -> str:
    """The pattern of all JSON files in the folder of a graph."""
    folder = path.relative_to(root).parent.as_posix()
    escaped = "".join(f"\\{letter}" if letter in "*?[\\" else letter for letter in folder)
    return "/*.json" if folder == "." else f"/{escaped}/*.json"


def _quote_pattern(pattern: str) -> str:
    """A pattern as .gitattributes needs it: in quotes if it has white space."""
    if not any(letter.isspace() or letter == '"' for letter in pattern):
        return pattern
    return '"' + pattern.replace("\\", "\\\\").replace('"', '\\"') + '"'
