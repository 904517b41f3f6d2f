"""Files that are written while their pictures are being made, because no memory holds them."""

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
    """The outputs that every file can take by rows: those of EXRs of one layer."""
    found, rest = set[str](), set[str]()
    for file in files:
        alone = len(file.layers) == 1 and file.path.suffix.casefold() == ".exr"
        (found if alone else rest).update(file.layers.values())
    return frozenset(found - rest)


class ScanlineWriters:
    """The files of a frame that are written by rows. Each is opened when its first rows come; what is not finished
    leaves nothing behind. `said` is the header of a file."""

    def __init__(
        self,
        plan: Plan,
        files: Sequence[Destination],
        writing: OutputSettings,
        said: Callable[[Destination], Mapping[str, Any]],
        sandbox: Sandbox,
    ) -> None:
        names = plan.tiling.by_rows if plan.tiling else frozenset[str]()
        self._plan, self._writing, self._said, self._sandbox = plan, writing, said, sandbox
        self._files = [file for file in files if names.issuperset(file.layers.values())]
        self._open: dict[Path, ScanlineWriter] = {}

    def take(self, name: str, row: int, pixels: Array) -> None:
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
                    precision=self._writing.precision,
                    compression=self._writing.compression,
                    encoding=file.encoding,
                    metadata=self._said(file),
                    sandbox=self._sandbox,
                )
            self._open[file.path].add(pixels)

    def finish(self) -> frozenset[Path]:
        """Give all of them their names, which are returned. Raises OutputError."""
        done = frozenset(self._open)
        for file in self._open.values():
            file.close()
        self._open.clear()
        return done

    def abort(self) -> None:
        """Remove what is not finished."""
        for file in self._open.values():
            file.abort()
        self._open.clear()
