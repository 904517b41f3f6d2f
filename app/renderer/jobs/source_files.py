"""Finds the files that a frame reads, with those of its history, and hashes their contents."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from functools import cached_property
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING

from msgspec import Struct, field

from ... import media
from ...compiler import Plan, find_named_files
from ...compiler.lowering.references import CONFIG, find_path_texts
from ...errors import HalationError
from ...graph import INPUTS, OUTPUTS, Graph
from ...graph.frames import format_frames
from ...resources.input_files import content_hash, fingerprint
from ...resources.picture import Picture
from ...resources.sandbox import Sandbox

if TYPE_CHECKING:
    from halation.nodes import Missing

    from ...inputs.provider import MediaProvider


class SourceFile(Struct, frozen=True):
    """A file that a frame reads.

    `owner` says what reads it: an input of the graph as `inputs.beauty`, a node for its pixels as `read`, another value
    that names a file as `camera.path`. Of a sequence that is read at several frames, `path` is one file, `pattern` the
    name of all, and `files` are those that are read, by frame and in order.
    """

    owner: str
    path: str
    layer: str = ""
    is_picture: bool = True
    pattern: str = ""
    files: Mapping[int, str] = field(default_factory=dict[int, str])


class FileHashes:
    """SHA-256 of files, computed on another thread, once for every version of a file."""

    def __init__(self, sandbox: Sandbox) -> None:
        self.sandbox = sandbox
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="hash")
        self._futures: dict[tuple[str, str], Future[str]] = {}
        self._chains: dict[str, tuple[tuple[str, ...], hashlib._Hash]] = {}
        self._lock = Lock()

    def start(self, sources: Sequence[SourceFile]) -> None:
        """Begin to hash files that will be asked for."""
        for path in {path for item in sources for path in (item.path, *item.files.values())}:
            self._start_hash(path)

    def hash_file(self, path: str) -> str:
        """The hash of a file; waits for it."""
        return self._start_hash(path).result()

    def hash_files(self, files: Iterable[str]) -> str:
        """The hash of the hashes of several files, in order. A list that grew is hashed from its first new file on."""
        paths = tuple(files)
        with self._lock:
            hashed, digest = self._chains.get(paths[0], ((), hashlib.sha256()))
            if hashed != paths[: len(hashed)]:
                hashed, digest = (), hashlib.sha256()
            digest = digest.copy()
            for path in paths[len(hashed) :]:
                digest.update(self.hash_file(path).encode())
            self._chains[paths[0]] = paths, digest
            return digest.hexdigest()

    def close(self) -> None:
        """Stop hashing."""
        self._pool.shutdown(wait=False, cancel_futures=True)

    def _start_hash(self, path: str) -> Future[str]:
        key = (path, fingerprint(path, self.sandbox))
        if key not in self._futures:
            self._futures[key] = self._pool.submit(content_hash, path, self.sandbox)
        return self._futures[key]


class SourceFinder:
    """Finds the files that the frames of a graph read."""

    def __init__(self, pictures: MediaProvider, graph: Graph, bound: Mapping[str, Picture]) -> None:
        self._pictures, self._graph, self._bound = pictures, graph, bound
        self._history_files: dict[str, dict[int, str]] = {}

    def find_sources(self, plan: Plan, frame: int, begin: int) -> tuple[SourceFile, ...]:
        """The files that a frame reads; `begin` is the frame where its history begins."""
        pictures_by_owner: dict[str, list[Picture]] = {}
        for item in plan.uploads:
            if not item.picture.in_memory:
                pictures_by_owner.setdefault(item.node, []).append(item.picture)
        history = range(begin, frame) if plan.memories else range(0)
        sources = {
            owner: self._describe_pictures(owner, pictures, history) for owner, pictures in pictures_by_owner.items()
        }
        for owner, path in self._other_files.items():
            if owner.rpartition(".")[0] not in sources and (file := self._find_file(path, frame)):
                sources[owner] = SourceFile(owner, file, is_picture=False)
        return tuple(sources.values())

    def _describe_pictures(self, owner: str, pictures: Sequence[Picture], history: range) -> SourceFile:
        layer = pictures[0].layer if owner.startswith(f"{INPUTS}.") else ""
        source = SourceFile(owner, pictures[0].path, layer)
        path, missing = self._picture_paths.get(owner, ("", "error"))
        sequence = media.find_sequence(path, sandbox=self._pictures.sandbox) if path else None
        if sequence is None or not (history or len({picture.path for picture in pictures}) > 1):
            return source
        history_files = self._history_files.setdefault(owner, {})
        for frame in history:
            if frame not in history_files:
                history_files[frame] = self._pictures.find_frame_file(path, frame, missing).path
        files = [*(history_files[frame] for frame in history), *(picture.path for picture in pictures)]
        files_by_frame = {sequence.pattern.frame(Path(file).name): file for file in files}
        ordered = {
            frame: files_by_frame[frame] for frame in sorted(frame for frame in files_by_frame if frame is not None)
        }
        return SourceFile(owner, source.path, layer, True, Path(sequence.pattern.text).name, ordered)

    def _find_file(self, path: str, frame: int) -> str:
        """The file of a frame, or "" if there is none."""
        try:
            file = self._pictures.find_frame_file(path, frame, "nearest").path
        except HalationError:
            return ""
        return file if Path(file).is_file() else ""

    @cached_property
    def _picture_paths(self) -> dict[str, tuple[str, Missing]]:
        """The path of every picture, and what replaces a missing file, by input or node."""
        return {owner: (path, missing) for path, owner, missing in find_named_files(self._graph, self._bound)}

    @cached_property
    def _other_files(self) -> dict[str, str]:
        """Files that nodes name but do not read as pictures, such as cameras and tables, by node and value."""
        needed_nodes = self._graph.upstream(OUTPUTS)
        paths = {owner: path for owner, (_, path) in find_path_texts(self._graph).items()}
        return {
            owner: path
            for owner, path in paths.items()
            if owner == CONFIG
            or (not owner.rpartition(".")[0].endswith(INPUTS) and owner.split(".")[0].split("/")[0] in needed_nodes)
        }


def describe_source(source: SourceFile, hashes: FileHashes) -> dict[str, str]:
    """The entries of a header for a file that was read."""
    layer = f":{source.layer}" if source.layer else ""
    entries = {
        f"halation:input:{source.owner}": f"{Path(source.path).name}{layer} sha256:{hashes.hash_file(source.path)}"
    }
    if source.files:
        frames, digest = format_frames(tuple(source.files)), hashes.hash_files(source.files.values())
        entries[f"halation:frames:{source.owner}"] = f"{source.pattern} {frames} sha256:{digest}"
    return entries
