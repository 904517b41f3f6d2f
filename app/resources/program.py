"""The commands that run Halation again: for processes of its own, and for other programs that call it later."""

from __future__ import annotations

import os
import sys

PROGRAM_VARIABLE = "HALATION_PROGRAM"
"""The environment variable by which the single file tells its own path: what it unpacks has another one."""


def module_command(module: str) -> list[str]:
    """The command of a process that runs a module of Halation. With `-P`, modules in its folder are not imported.

    The program of the application for Linux, which is no Python, understands exactly these words.
    """
    return [sys.executable, "-P", "-m", module]


def permanent_command() -> list[str]:
    """The command that other programs keep: it runs Halation also after the single file has unpacked a newer one."""
    own = os.environ.get(PROGRAM_VARIABLE)
    return [own] if own else module_command("halation.cli")
