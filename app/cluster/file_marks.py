"""The files that frames of a graph read, with their sizes and hashes: workers check that they have the same ones."""

from __future__ import annotations

import base64
import os
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from ..compiler import find_named_files
from ..compiler.lowering.references import find_path_texts
from ..errors import HalationError
from ..graph import Graph, Port
from ..graph.frames import Pattern
from ..graph.names import INPUTS
from ..inputs.provider import MediaProvider
from ..resources.input_files import content_hash, read_bytes
from ..resources.sandbox import Sandbox
from .chunk import FileMark

TRAVELLING_SUFFIXES = frozenset({".cube", ".csp", ".3dl", ".spi1d", ".spi3d", ".spimtx", ".cc", ".ccc", ".cdl", ".clf"})
"""Files that travel with the graph: tables and color corrections, which name no other files."""

MAX_TRAVELLING_BYTES = 4 << 20
"""Bytes of a file that travels: a table of 64 x 64 x 64 colors as text has 7 MB in its longest spelling, mostly 4."""

_THREADS = 4
"""Files that are hashed side by side: a choice; one thread reads 1.5 GB a second, measured on a warm file."""


class FileHashing:
    """Sizes and hashes of files; each is read once."""

    def __init__(self, sandbox: Sandbox) -> None:
        self._sandbox = sandbox
        self._marks: dict[str, FileMark | None] = {}

    def mark_paths(self, paths: Sequence[str]) -> dict[str, FileMark]:
        """The marks of files by their absolute paths. What is missing is left out."""
        if new_paths := [path for path in dict.fromkeys(paths) if path not in self._marks]:
            with ThreadPoolExecutor(_THREADS, thread_name_prefix="mark") as threads:
                self._marks |= dict(zip(new_paths, threads.map(self._mark, new_paths), strict=True))
        return {path: mark for path in paths if (mark := self._marks[path]) is not None}

    def _mark(self, path: str) -> FileMark | None:
        try:
            return FileMark(Path(path).stat().st_size, content_hash(path, self._sandbox))
        except (OSError, HalationError):
            return None


class FileMarker:
    """Describes the files of frames, ahead of the chunks that need them. Several may share one `hashing`."""

    def __init__(
        self, graph: Graph, inputs: Mapping[str, str], sandbox: Sandbox, hashing: FileHashing | None = None
    ) -> None:
        self._graph, self._sandbox = graph, sandbox
        self._hashing = hashing or FileHashing(sandbox)
        self._pictures = MediaProvider(sandbox=sandbox)
        bound = self._pictures.bind(graph, inputs)
        self._named_files = find_named_files(graph, bound)
        picture_paths = {path for path, _, _ in self._named_files}
        replaced = {str(Port(INPUTS, name)) for name in bound}  # nobody reads the files that these inputs name
        self._others = [
            os.path.abspath(path)  # noqa: PTH100 - links stay
            for name, (_, path) in find_path_texts(graph).items()
            if path not in picture_paths and name not in replaced
        ]

    @property
    def names_sequences(self) -> bool:
        """True if some frames read other files than others."""
        return any(Pattern.parse(path) for path, _, _ in self._named_files)

    def mark_files(self, frames: Sequence[int], history: range) -> dict[str, FileMark]:
        """The files that frames read, and those of their history, by absolute path. What is missing is left out."""
        return self._hashing.mark_paths(self.list_files(frames, history))

    def list_files(self, frames: Sequence[int], history: range) -> list[str]:
        """The absolute paths of the files that frames read, and those of their history."""
        return list(dict.fromkeys([*self._others, *self._list_pictures(frames, history)]))

    def read_contents(self) -> dict[str, str]:
        """The small files that travel with the graph, as base64 by absolute path."""
        contents: dict[str, str] = {}
        for path in self._others:
            is_table = Path(path).suffix.casefold() in TRAVELLING_SUFFIXES
            if is_table and Path(path).is_file() and Path(path).stat().st_size <= MAX_TRAVELLING_BYTES:
                contents[path] = base64.b64encode(read_bytes(path, self._sandbox)).decode("ascii")
        return contents

    def _list_pictures(self, frames: Sequence[int], history: range) -> Iterator[str]:
        for path, _, missing in self._named_files:
            for frame in (*history, *frames) if Pattern.parse(path) else frames[:1]:
                try:
                    file = self._pictures.find_frame_file(path, frame, missing).path
                except HalationError:  # the render says so
                    continue
                yield os.path.abspath(file)  # noqa: PTH100
