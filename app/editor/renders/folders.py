"""Folders shown by the system's own file manager, where there is one."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path


def command(folder: Path) -> list[str] | None:
    """The program that shows a folder, None if this system has none that is known."""
    name = {"darwin": "open", "win32": "explorer"}.get(sys.platform, "xdg-open")
    program = shutil.which(name)
    display = sys.platform in ("darwin", "win32") or os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    return [program, str(folder)] if program and display else None


def show_folder(folder: Path) -> bool:
    """Show a folder; False if there is no program for it."""
    words = command(folder)
    if words is None:
        return False
    try:
        quiet = subprocess.DEVNULL
        subprocess.Popen(words, stdin=quiet, stdout=quiet, stderr=quiet, start_new_session=True)
    except OSError:
        return False
    return True
