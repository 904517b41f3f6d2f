"""Opens folders in the file manager of the system."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

from ...resources.machine import has_display


def command(folder: Path) -> list[str] | None:
    """The command that shows a folder, None if there is no known one."""
    name = {"darwin": "open", "win32": "explorer"}.get(sys.platform, "xdg-open")
    program = shutil.which(name)
    return [program, str(folder)] if program and has_display() else None


def show_folder(folder: Path) -> bool:
    """Open a folder in the file manager; False if there is none."""
    words = command(folder)
    if words is None:
        return False
    try:
        quiet = subprocess.DEVNULL
        subprocess.Popen(words, stdin=quiet, stdout=quiet, stderr=quiet, start_new_session=True)
    except OSError:
        return False
    return True
