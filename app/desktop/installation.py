"""Puts the desktop's files where it looks for them, and takes them away."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterable, Mapping
from pathlib import Path

from ..errors import OutputError
from ..resources.atomic_write import write_bytes_atomically
from ..resources.sandbox import UNRESTRICTED

_UPDATES = (
    ("update-desktop-database", "applications"),
    ("update-mime-database", "mime"),
    ("gtk-update-icon-cache", "icons/hicolor"),
)
"""Programs that read the files anew, if the desktop has them, each with the folder that it is told."""


def install(folder: Path, files: Mapping[str, bytes]) -> list[Path]:
    """Write files into a folder of shared data, and return their paths. Raises OutputError."""
    paths: list[Path] = []
    for name, content in files.items():
        path = folder / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise OutputError(f"{path.parent}: the folder cannot be made: {error.strerror}") from error
        write_bytes_atomically(path, content, sandbox=UNRESTRICTED)
        paths.append(path)
    _update(folder)
    return paths


def remove(folder: Path, names: Iterable[str]) -> list[Path]:
    """Delete the files that `install` wrote, and return the paths of those that were there. Raises OutputError."""
    paths = [folder / name for name in names if (folder / name).is_file()]
    for path in paths:
        try:
            path.unlink()
        except OSError as error:
            raise OutputError(f"{path}: cannot be deleted: {error.strerror}") from error
    _update(folder)
    return paths


def _update(folder: Path) -> None:
    for program, part in _UPDATES:
        command = shutil.which(program)
        if command and (folder / part).is_dir():
            subprocess.run([command, folder / part], capture_output=True, check=False)
