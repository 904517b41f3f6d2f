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

    def __init__(self, writing: OutputSettings, rate: Callable[[], float | Fraction], sandbox: Sandbox) -> None:
        self._writing, self._rate, self._sandbox = writing, rate, sandbox
        self._open: dict[Path, media.VideoWriter] = {}

    def add(self, file: Destination, layers: Mapping[str, Array], said: Mapping[str, Any]) -> None:
        """Write one more frame; what the first one says of itself is said of all. Raises OutputError."""
        if file.path not in self._open:
            height, width = next(iter(layers.values())).shape[:2]
            self._open[file.path] = media.VideoWriter(
                file.path,
                (width, height),
                self._rate(),
                codec=self._writing.codec,
                deep=self._writing.precision == "float",
                encoding=file.encoding,
                metadata=said,
                sandbox=self._sandbox,
            )
        self._open[file.path].add(layers, file.kinds)

    def finish(self) -> tuple[Path, ...]:
        """Give all of them their names. Raises OutputError."""
        for video in self._open.values():
            video.close()
        done = tuple(self._open)
        self._open.clear()
        return done

    def abort(self) -> None:
        """Remove what is not finished."""
        for video in self._open.values():
            video.abort()
        self._open.clear()
