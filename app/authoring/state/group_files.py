"""Graph files that can be added as groups."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ...document import load
from ...graph import Group, Port
from ..edits.wiring import fits
from .open_document import OpenDocument


class GroupFiles:
    """Graph files as groups, each read once: the presets, of which the search offers those that fit a port."""

    def __init__(self) -> None:
        self._groups: dict[Path, Group] = {}

    def list_fitting(
        self, files: Sequence[Path], document: OpenDocument, port: Port, is_output: bool
    ) -> tuple[Path, ...]:
        """Those of the files that could, as groups, be linked with `port`, a source if `is_output`."""
        for file in files:
            if file not in self._groups:
                self._groups[file] = Group(load(file, document.types, sandbox=document.sandbox))
        return tuple(file for file in files if fits(document.graph, port, is_output, self._groups[file]))
