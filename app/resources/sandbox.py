"""The folder below which everything must lie that a command reads and writes, where `--root` names one.

Whoever opens a file asks here first. The folder is in the environment, so that processes which share the work, and the
libraries' threads, are inside of the same fence.
"""

from __future__ import annotations

import os
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

from ..errors import UsageError

ROOT = "HALATION_ROOT"
"""The environment variable that names the folder; empty for no fence."""


def outside(path: str | Path) -> str:
    """Why a file may not be read or written, as the rest of a sentence that starts with its path; "" if it may be.

    Links are followed: what counts is where a file really lies. What is not there yet counts by its folder.
    """
    root = os.environ.get(ROOT, "")
    if not root:
        return ""
    try:
        if Path(path).resolve().is_relative_to(Path(root).resolve()):
            return ""
    except (OSError, RuntimeError, ValueError):
        return f"cannot be found: its links lead nowhere, and nothing outside of {root} may be read or written (--root)"
    return f"lies outside of {root}: nothing else may be read or written (--root)"


def sandbox_root() -> str:
    """The folder that `--root` names, "" without one: a render job that is sent to another machine carries it."""
    return os.environ.get(ROOT, "")


@contextmanager
def fenced(root: str | Path | None) -> Generator[None]:
    """Nothing outside of that folder is read or written meanwhile. Raises UsageError for what is no folder."""
    if root is None:
        yield
        return
    if fault := outside(root):
        raise UsageError(f"--root {root}: {fault}")
    if not Path(root).is_dir():
        raise UsageError(f"--root {root}: there is no such folder")
    before = os.environ.get(ROOT)
    os.environ[ROOT] = str(Path(root).resolve())
    try:
        yield
    finally:
        if before is None:
            del os.environ[ROOT]
        else:
            os.environ[ROOT] = before
