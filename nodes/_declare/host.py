"""Programs that run on the processor, not on the device."""

from __future__ import annotations

from msgspec import Struct


class HostProgram(Struct, frozen=True):
    """A program that makes a whole picture on the processor, by its name and its settings.

    The renderer has these programs: see `app/renderer/execution/host_programs.py`. Equal programs make equal pixels of
    equal pictures. `version` counts the changes of what a program makes.
    """

    name: str
    settings: tuple[tuple[str, str | float | bool], ...] = ()
    version: int = 1
