"""The videos that a job writes: all its frames go into one file each, in their order."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ... import media
from ...resources.sandbox import Sandbox
from ..execution.decoding import Array
from .destinations import Destination, OutputSettings

if TYPE_CHECKING:
    from fractions import Fraction


class VideoWriters:
    """Opened when their first frame comes; what is not finished leaves nothing behind."""

    def __init__(self, settings: OutputSettings, find_rate: Callable[[], float | Fraction], sandbox: Sandbox) -> None:
        self._settings, self._find_rate, self._sandbox = settings, find_rate, sandbox
        self._open: dict[Path, media.VideoWriter] = {}

    def add_frame(self, file: Destination, layers: Mapping[str, Array], metadata: Mapping[str, Any]) -> None:
        """Write one more frame; what the first one says of itself is said of all. Raises OutputError."""
        if file.path not in self._open:
            height, width = next(iter(layers.values())).shape[:2]
            self._open[file.path] = media.VideoWriter(
                file.path,
                (width, height),
                self._find_rate(),
                codec=self._settings.codec,
                deep=self._settings.precision == "float",
                encoding=file.encoding,
                metadata=metadata,
                sandbox=self._sandbox,
            )
        self._open[file.path].add(layers, file.kinds)

    def finish(self) -> tuple[Path, ...]:
        """Give all of them their names. Raises OutputError."""
        for video in self._open.values():
            video.close()
        paths = tuple(self._open)
        self._open.clear()
        return paths

    def abort(self) -> None:
        """Remove what is not finished."""
        for video in self._open.values():
            video.abort()
        self._open.clear()
