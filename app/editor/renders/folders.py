"""Opens folders in the file manager of the system."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path


def command(folder: Path) -> list[str] | None:
    """The command that shows a folder, None if there is no known one."""
    name = {"darwin": "open", "win32": "explorer"}.get(sys.platform, "xdg-open")
    program = shutil.which(name)
    display = sys.platform in ("darwin", "win32") or os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    return [program, str(folder)] if program and display else None


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
