"""The folder below which everything must lie that a command reads and writes, where `--root` names one.

A `Sandbox` is made once, where options are understood, and handed to whoever opens files. What a graph names is opened
only by functions that take one, so a function that forgets it does not pass the type checker. It is a value: threads
and helper processes have the same, and a render job that goes to another machine carries it.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

from halation import presets
from msgspec import Struct

from ..errors import InputError, UsageError

ROOT_VARIABLE = "HALATION_ROOT"
"""The environment variable that does what `--root` does, for every command and for Python."""


class Sandbox(Struct, frozen=True):
    """Which files may be read and written: those below the folder `root`, all of them where it is ""."""

    root: str

    def find_read_fault(self, path: str | Path) -> str:
        """Why a file may not be read, as the rest of a sentence that starts with its path; "" if it may be.

        The presets of Halation itself, and their samples, may be read wherever they are installed.
        """
        fault = self.find_write_fault(path)
        return "" if fault and _is_of_presets(path) else fault

    def find_write_fault(self, path: str | Path) -> str:
        """Why a file may not be written, as the rest of a sentence that starts with its path; "" if it may be.

        Links are followed: what counts is where a file really lies. What is not there yet counts by its folder.
        """
        if not self.root:
            return ""
        try:
            if Path(path).resolve().is_relative_to(Path(self.root).resolve()):
                return ""
        except (OSError, RuntimeError, ValueError):
            return (
                f"cannot be found: its links lead nowhere, and nothing outside of {self.root} may be read or written "
                "(--root)"
            )
        return f"lies outside of {self.root}: nothing else may be read or written (--root)"

    def check(self, path: str | Path) -> None:
        """Raise InputError for a file that may not be read."""
        if fault := self.find_read_fault(path):
            raise InputError(f"{make_path_printable(path)}: {fault}")

    def narrow(self, folder: str | Path) -> Sandbox:
        """The sandbox of a folder inside this one. Raises UsageError for a folder outside, and for what is none."""
        if fault := self.find_write_fault(folder):
            raise UsageError(f"--root {folder}: {fault}")
        if not Path(folder).is_dir():
            raise UsageError(f"--root {folder}: there is no such folder")
        return Sandbox(str(Path(folder).resolve()))


UNRESTRICTED = Sandbox("")
"""All files: for those that the user chose, and not a graph."""


def read_process_sandbox() -> Sandbox:
    """The sandbox that the environment of this process asks for. Only commands and the Python interface call this."""
    root = os.environ.get(ROOT_VARIABLE, "")
    return Sandbox(str(Path(root).resolve())) if root else UNRESTRICTED


def _is_of_presets(path: str | Path) -> bool:
    """True for a file in the folder of presets of this installation, also behind links."""
    try:
        return Path(path).resolve().is_relative_to(Path(presets.__file__).resolve().parent)
    except (OSError, RuntimeError, ValueError):
        return False


def make_path_printable(path: str | Path) -> str:
    """A path as a sentence can hold it: NUL and what no name of a file is made of are spelled out.

    Bytes of another encoding stay as Python keeps them, as surrogates from DC80 to DCFF.
    """
    text = str(path).replace("\0", "\\0")
    return re.sub("[\ud800-\udc7f\udd00-\udfff]", lambda match: f"\\u{ord(match[0]):04x}", text)
