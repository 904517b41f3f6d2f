"""What a frame is made of: the files that it reads, those of the frames before it too, and what is in them."""

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

    `owner` is who reads it: an input of the graph as `inputs.beauty`, a node for its pixels as `read`, another value
    that is a file as `camera.path`. Of a sequence that is read at several frames `path` is one file, `pattern` the name
    of all, and `files` are those that are read, by frame and in order.
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
        """Begin with what will be asked for."""
        for path in {path for item in sources for path in (item.path, *item.files.values())}:
            self._start_hash(path)

    def hash_file(self, path: str) -> str:
        """That of a file, sooner or later."""
        return self._start_hash(path).result()

    def hash_files(self, files: Iterable[str]) -> str:
        """That of the hashes of several files, in their order. A list that goes on takes no longer than what is new."""
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
        """Stop."""
        self._pool.shutdown(wait=False, cancel_futures=True)

    def _start_hash(self, path: str) -> Future[str]:
        key = (path, fingerprint(path, self.sandbox))
        if key not in self._futures:
            self._futures[key] = self._pool.submit(content_hash, path, self.sandbox)
        return self._futures[key]


class SourceFinder:
    """Finds what the frames of a graph read."""

    def __init__(self, pictures: MediaProvider, graph: Graph, bound: Mapping[str, Picture]) -> None:
        self._pictures, self._graph, self._bound = pictures, graph, bound
        self._history_files: dict[str, dict[int, str]] = {}

    def find_sources(self, plan: Plan, frame: int, begin: int) -> tuple[SourceFile, ...]:
        """What a frame reads whose history begins at another one."""
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
        """The path of every picture, and what shows where a frame has no file, by who reads it."""
        return {owner: (path, missing) for path, owner, missing in find_named_files(self._graph, self._bound)}

    @cached_property
    def _other_files(self) -> dict[str, str]:
        """Files of nodes, which may be no pictures, or of which only the header is read, by who names them."""
        needed_nodes = self._graph.upstream(OUTPUTS)
        paths = {owner: path for owner, (_, path) in find_path_texts(self._graph).items()}
        return {
            owner: path
            for owner, path in paths.items()
            if owner == CONFIG
            or (not owner.rpartition(".")[0].endswith(INPUTS) and owner.split(".")[0].split("/")[0] in needed_nodes)
        }


def describe_source(source: SourceFile, hashes: FileHashes) -> dict[str, str]:
    """What a header says of a source."""
    layer = f":{source.layer}" if source.layer else ""
    entries = {
        f"halation:input:{source.owner}": f"{Path(source.path).name}{layer} sha256:{hashes.hash_file(source.path)}"
    }
    if source.files:
        frames, digest = format_frames(tuple(source.files)), hashes.hash_files(source.files.values())
        entries[f"halation:frames:{source.owner}"] = f"{source.pattern} {frames} sha256:{digest}"
    return entries
