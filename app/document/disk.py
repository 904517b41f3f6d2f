"""Texts of files, read with a limit."""

from __future__ import annotations

import os
from pathlib import Path

from halation import presets

from ..errors import DocumentError, InputError
from ..graph.names import did_you_mean
from ..resources.input_files import open_file
from ..resources.sandbox import Sandbox, make_path_printable
from .limits import MAX_BYTES, size_fault

_PICTURE_MARKS = (b"\x76\x2f\x31\x01", b"\x89PNG", b"\xff\xd8\xff", b"II*\x00", b"MM\x00*", b"RIFF", b"SDPX", b"XPDS")
"""The first bytes of EXR, PNG, JPEG, TIFF (both byte orders), WebP and DPX (both) files."""


def read_text(path: Path, sandbox: Sandbox) -> str:
    """The text of a graph file. Raises DocumentError; a file that is too large is not read."""
    try:
        with open_file(path, sandbox) as file:
            if fault := size_fault(max(os.fstat(file.fileno()).st_size, 1)):
                raise DocumentError(str(path), "", fault, rule="unreadable-graph")
            content = file.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise DocumentError(str(path), "", "there is no such file", rule="unreadable-graph") from None
    except IsADirectoryError:
        raise DocumentError(str(path), "", "this is a folder, not a graph file", rule="unreadable-graph") from None
    except InputError as refusal:
        reason = str(refusal).removeprefix(f"{make_path_printable(path)}: ")
        raise DocumentError(str(path), "", reason, rule="unreadable-graph") from None
    except (OSError, ValueError) as error:
        raise DocumentError(str(path), "", f"it cannot be read ({_reason(error)})", rule="unreadable-graph") from None
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        fault = f"the text is not UTF-8 (byte {error.start}); save it as UTF-8"
        if content.startswith(_PICTURE_MARKS):
            fault = f"this is a picture, not a graph: name a graph, and the picture after -i as NAME={path.name}"
        raise DocumentError(str(path), "", fault, rule="unreadable-graph") from None


def _reason(error: Exception) -> str:
    return (error.strerror if isinstance(error, OSError) else None) or str(error)


def resolve_file(path: Path) -> Path | None:
    """The file with links followed, or None if there is none. What is no regular file is refused when it is opened."""
    try:
        real = path.resolve()
        return real if real.exists() and not real.is_dir() else None
    except (OSError, ValueError, RuntimeError):
        return None


def suggest_group_file(file: Path, path: str) -> str:
    """What a group means whose `file` is not there, as the end of a sentence; `path` is how the graph names it."""
    if any(preset.stem == path for preset in presets.paths()):
        return "; it is a preset: halation demo --copy FOLDER writes the files of presets"
    return did_you_mean(file.name, list_graph_files(file.parent))


def list_graph_files(folder: Path) -> tuple[str, ...]:
    """The names of the graph files in a folder; none if it cannot be read."""
    try:
        return tuple(path.name for path in folder.glob("*.json"))
    except (OSError, ValueError):
        return ()
