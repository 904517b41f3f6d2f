"""Writes the videos of a job: all frames in order into one file each."""

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
    """Opens a video with its first frame. Incomplete videos are removed."""

    def __init__(self, settings: OutputSettings, find_rate: Callable[[], float | Fraction], sandbox: Sandbox) -> None:
        self._settings, self._find_rate, self._sandbox = settings, find_rate, sandbox
        self._open: dict[Path, media.VideoWriter] = {}

    def add_frame(
        self, file: Destination, layers: Mapping[str, Array], frame: int, metadata: Mapping[str, Any]
    ) -> None:
        """Write one more frame. The metadata of the first frame is that of the video. Raises OutputError."""
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
        self._open[file.path].add(layers, file.kinds, frame)

    def finish(self) -> tuple[Path, ...]:
        """Complete all videos; their paths. Raises OutputError."""
        for video in self._open.values():
            video.close()
        paths = tuple(self._open)
        self._open.clear()
        return paths

    def abort(self) -> None:
        """Remove incomplete videos."""
        for video in self._open.values():
            video.abort()
        self._open.clear()
