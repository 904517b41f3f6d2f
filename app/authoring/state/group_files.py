"""Graph files that can be added as groups."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ...document import load
from ...errors import HalationError
from ...graph import Group, Port
from ..edits.wiring import fits
from .open_document import OpenDocument


class GroupFiles:
    """Graph files as groups: the presets, of which the search offers those that fit a port.

    Each is read once, and again after it has changed.
    """

    def __init__(self) -> None:
        self._groups: dict[tuple[Path, int], Group | None] = {}

    def list_fitting(
        self, files: Sequence[Path], document: OpenDocument, port: Port, is_output: bool
    ) -> tuple[Path, ...]:
        """Those of the files that could, as groups, be linked with `port`, a source if `is_output`.

        Files that cannot be read are left out: the user of a socket did not ask for them.
        """
        groups = {file: self._find(file, document) for file in files}
        return tuple(
            file for file, group in groups.items() if group is not None and fits(document.graph, port, is_output, group)
        )

    def _find(self, file: Path, document: OpenDocument) -> Group | None:
        try:
            key = file, file.stat().st_mtime_ns
            if key not in self._groups:
                self._groups[key] = None
                self._groups[key] = Group(load(file, document.types, sandbox=document.sandbox))
        except (HalationError, OSError):
            return None
        return self._groups[key]
