"""Runs git, and reads versions of graphs from it."""

from __future__ import annotations

import subprocess
from pathlib import Path

from ..errors import DocumentError, UsageError


def git(*words: str, folder: Path | None = None) -> str:
    """Run git and return its output. Raises UsageError with the message of git."""
    return _run_git(words, folder).decode(errors="surrogateescape")


def repository_root(folder: Path | None = None) -> Path:
    """The root of the repository of a folder, by default the current one. Raises UsageError."""
    return Path(git("rev-parse", "--show-toplevel", folder=folder).rstrip("\n"))


def read_revision(source: str) -> tuple[str, str]:
    """The text of `REV:path`, and the folder where its relative paths start.

    The path is relative to the root of the repository, or to the current folder. Raises DocumentError, UsageError.
    """
    from ..document.limits import size_fault

    before, path = source[: source.rindex(":")], source[source.rindex(":") + 1 :]
    try:
        name, folder = source, repository_root()
    except UsageError as fault:
        raise DocumentError(source, "", f"there is no such file ({str(fault).removeprefix('git: ')})") from None
    try:
        size = int(_run_git(("cat-file", "-s", name)))
    except UsageError as fault:
        name, folder = f"{before}:./{path}", Path()
        try:
            size = int(_run_git(("cat-file", "-s", name)))
        except UsageError:
            reason = str(fault).removeprefix("git: ")
            raise DocumentError(source, "", f"there is no such file, nor such a version in git ({reason})") from None
    if fault := size_fault(max(size, 1)):
        raise DocumentError(source, "", fault)
    try:
        text = _run_git(("cat-file", "blob", name)).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise DocumentError(source, "", f"the text is not UTF-8 (byte {error.start})") from None
    except UsageError:
        raise DocumentError(source, "", "this is a folder, not a graph file") from None
    return text, str((folder / path).parent)


def _run_git(words: tuple[str, ...], folder: Path | None = None) -> bytes:
    try:
        process = subprocess.run(["git", *words], cwd=folder, capture_output=True, check=False)
    except OSError:
        raise UsageError("git is not installed, or cannot be run") from None
    if process.returncode:
        lines = process.stderr.decode(errors="replace").strip().splitlines() or [f"it ended with {process.returncode}"]
        raise UsageError(f"git: {lines[0].removeprefix('fatal: ').rstrip('.')}")
    return process.stdout
