"""Writes files row by row while their pictures are rendered, because memory cannot hold the whole pictures."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...compiler import Plan
from ...resources.sandbox import Sandbox
from ..execution.decoding import Array
from .destinations import Destination, OutputSettings

if TYPE_CHECKING:
    from ...media.pictures.row_writer import ScanlineWriter


def select_row_outputs(files: Sequence[Destination]) -> frozenset[str]:
    """The outputs that all their files can take by rows: those of EXR files with one layer."""
    row_outputs, other_outputs = set[str](), set[str]()
    for file in files:
        has_one_layer = len(file.layers) == 1 and file.path.suffix.casefold() == ".exr"
        (row_outputs if has_one_layer else other_outputs).update(file.layers.values())
    return frozenset(row_outputs - other_outputs)


class ScanlineWriters:
    """The files of a frame that are written by rows. Each is opened with its first rows; incomplete files are removed.

    `make_metadata` makes the header of a file.
    """

    def __init__(
        self,
        plan: Plan,
        files: Sequence[Destination],
        settings: OutputSettings,
        make_metadata: Callable[[Destination], Mapping[str, Any]],
        sandbox: Sandbox,
    ) -> None:
        names = plan.tiling.by_rows if plan.tiling else frozenset[str]()
        self._plan, self._settings, self._make_metadata, self._sandbox = plan, settings, make_metadata, sandbox
        self._files = [file for file in files if names.issuperset(file.layers.values())]
        self._open: dict[Path, ScanlineWriter] = {}

    def write_rows(self, name: str, row: int, pixels: Array) -> None:
        """Write rows of an output. Raises OutputError."""
        from ...media.pictures.row_writer import ScanlineWriter

        size = self._plan.surfaces[self._plan.outputs[name]].size
        for file in self._files:
            ((layer, output),) = file.layers.items()
            if output != name:
                continue
            if row == 0:
                self._open[file.path] = ScanlineWriter(
                    file.path,
                    size,
                    layer,
                    file.kinds[layer],
                    precision=self._settings.precision,
                    compression=self._settings.compression,
                    encoding=file.encoding,
                    metadata=self._make_metadata(file),
                    sandbox=self._sandbox,
                )
            self._open[file.path].add(pixels)

    def finish(self) -> frozenset[Path]:
        """Complete all files; their paths. Raises OutputError."""
        paths = frozenset(self._open)
        for file in self._open.values():
            file.close()
        self._open.clear()
        return paths

    def abort(self) -> None:
        """Remove incomplete files."""
        for file in self._open.values():
            file.abort()
        self._open.clear()
