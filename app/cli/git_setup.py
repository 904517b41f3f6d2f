"""`halation git-setup`: git shows and merges graphs by what they mean."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Annotated

import typer

from .options import AsJson
from .outcome import print_json

ATTRIBUTES = "diff=halation merge=halation"
"""What a line of .gitattributes says of graphs."""


def git_setup(
    patterns: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[PATTERN]...",
            help="Which files are graphs, as .gitattributes has it, such as '*.graph.json'; by default the JSON files "
            "of every folder with graphs that git knows.",
        ),
    ] = None,
    everywhere: Annotated[
        bool, typer.Option("--global", help="Put the configuration into your own, for all repositories.")
    ] = False,
    remove: Annotated[bool, typer.Option("--remove", help="Take back what this command wrote.")] = False,
    as_json: AsJson = False,
) -> int:
    """Make `git diff`, `git log -p` and `git merge` understand graphs: says what it changes, and may run again.

    .gitattributes says which files are graphs, and belongs into the repository; the configuration says how to run
    Halation on this machine, and each clone needs it. Other JSON files stay text.
    """
    from ..errors import UsageError
    from .git import repository_root

    try:
        root = repository_root()
    except UsageError:
        if not everywhere:
            raise UsageError("this folder is in no git repository: go into one, or add --global") from None
        root = None
    changes = _configure("--global" if everywhere else "--local", remove)
    if root:
        changes += _attribute(
            root / ".gitattributes", list(patterns or ()) or _find_patterns(root), bool(patterns), remove
        )
    elif patterns:
        raise UsageError("this folder is in no git repository: patterns go into the .gitattributes of one")
    if as_json:
        print_json({"changed": changes})
    else:
        print("\n".join(changes) if changes else "nothing is to be changed")
    return 0


def settings() -> dict[str, str]:
    """What the configuration of git says, with this Halation, wherever it is installed."""
    call = f"{shlex.quote(Path(sys.executable).as_posix())} -P -m halation.cli git-driver"
    return {
        "diff.halation.command": f"{call} diff --",
        "diff.halation.textconv": f"{call} text --",
        "merge.halation.name": "Halation graphs, by node and value",
        "merge.halation.driver": f"{call} merge -- %O %A %B %P",
    }


def _configure(scope: str, remove: bool) -> list[str]:
    """Write or remove the configuration; what was changed."""
    from ..errors import UsageError
    from .git import git

    changes: list[str] = []
    for name, text in settings().items():
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


def _attribute(file: Path, patterns: Sequence[str], only_these: bool, remove: bool) -> list[str]:
    """Add or remove lines of .gitattributes; what was changed. With `given`, only the lines of these patterns go."""
    from ..resources.atomic_write import write_text_atomically

    old = file.read_text(encoding="utf-8") if file.exists() else ""
    lines, own_lines = old.splitlines(), {f"{_quote(pattern)} {ATTRIBUTES}" for pattern in patterns}
    if remove:
        removed = [line for line in lines if line.endswith(f" {ATTRIBUTES}") and (line in own_lines or not only_these)]
        remaining = [line for line in lines if line not in removed]
        if removed and not remaining:
            file.unlink()
        elif removed:
            write_text_atomically(file, "".join(f"{line}\n" for line in remaining))
        return [f"{file}: removed {line}" for line in removed]
    new = sorted(own_lines.difference(lines))
    if new:
        write_text_atomically(file, "".join(f"{line}\n" for line in (*lines, *new)))
    return [f"{file}: {line}" for line in new]


def _find_patterns(root: Path) -> list[str]:
    """Patterns for the folders that hold graphs, of all files that are tracked or may be."""
    from .git import git

    names = git("ls-files", "-z", "--cached", "--others", "--exclude-standard", "--", "*.json", folder=root)
    files = (root / name for name in names.split("\0") if name)
    return list(dict.fromkeys(_pattern(path, root) for path in _graphs(files)))


def _graphs(files: Iterable[Path]) -> list[Path]:
    from ..lint.files import is_graph

    return [path for path in files if path.is_file() and is_graph(path)]


def _pattern(path: Path, root: Path) -> str:
    """All JSON files beside a graph."""
    folder = path.relative_to(root).parent.as_posix()
    escaped = "".join(f"\\{letter}" if letter in "*?[\\" else letter for letter in folder)
    return "/*.json" if folder == "." else f"/{escaped}/*.json"


def _quote(pattern: str) -> str:
    """A pattern as .gitattributes has it: white space needs quotes."""
    if not any(letter.isspace() or letter == '"' for letter in pattern):
        return pattern
    return '"' + pattern.replace("\\", "\\\\").replace('"', '\\"') + '"'
