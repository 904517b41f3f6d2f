"""What a finished picture says of itself: what it was made of, and how to make it again."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from hashlib import blake2b
from importlib import metadata
from pathlib import Path
from typing import Any

from .. import document, media
from ..compiler import Picture, Plan
from ..errors import HalationError
from ..graph import Graph, Group
from .destinations import Destination, Writing
from .engine import Wanted

_KEY = "halation:key"


class Hashes:
    """SHA-256 of files, computed on another thread, once for every version of a file."""

    def __init__(self) -> None:
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="hash")
        self._found: dict[tuple[str, str], Future[str]] = {}

    def of(self, paths: Iterable[str]) -> dict[str, Future[str]]:
        """The hashes of files by path, sooner or later."""
        return {path: self._begun(path) for path in paths}

    def close(self) -> None:
        """Stop."""
        self._pool.shutdown(wait=False, cancel_futures=True)

    def _begun(self, path: str) -> Future[str]:
        key = (path, media.fingerprint(path))
        if key not in self._found:
            self._found[key] = self._pool.submit(media.content_hash, path)
        return self._found[key]


def frame_key(plan: Plan, file: Destination, writing: Writing) -> str:
    """What tells whether a file is still what would be written: it is equal only where all bytes of pixels are.

    The keys of a plan cover shaders, values, history and the versions of all pictures that are read.
    """
    pixels = {layer: plan.surfaces[plan.outputs[name]].key for layer, name in file.layers.items()}
    how = (file.path.suffix, file.view, writing.compression, writing.precision)
    said = (metadata.version("halation"), sorted(pixels.items()), sorted(file.kinds.items()), how)
    return blake2b(repr(said).encode(), digest_size=16).hexdigest()


def is_written(file: Destination, key: str) -> bool:
    """True if that file is there and says that it was made with that key."""
    try:
        return file.path.is_file() and media.read_metadata(file.path).get(_KEY) == key
    except HalationError:  # whatever it is, it is not what would be written
        return False


def header(
    graph: Graph, renderer: str, wanted: Wanted, sources: Mapping[str, Picture], hashes: Mapping[str, Future[str]],
    key: str,
) -> dict[str, Any]:
    """What a file says: metadata of what was read passes through, and how to make it again is added."""
    found: dict[str, Any] = {}
    for path in hashes:
        found = media.read_metadata(path) | found
    found = {name: item for name, item in found.items() if not name.startswith("halation:")}
    found["halation:graph"] = document.dumps(_whole(graph))
    found["halation:version"] = metadata.version("halation")
    found["halation:renderer"] = renderer
    found["halation:settings"] = _settings(wanted)
    found[_KEY] = key
    for node, picture in sources.items():
        layer = f":{picture.layer}" if picture.layer else ""
        digest = hashes[picture.path].result()
        found[f"halation:input:{node}"] = f"{Path(picture.path).name}{layer} sha256:{digest}"
    return found


def _whole(graph: Graph) -> Graph:
    """The graph with the bodies of its groups in it: their files may change, and their values may differ already."""
    nodes = {
        id: replace(item, graph=_whole(item.graph), path="") if isinstance(item, Group) else item
        for id, item in graph.nodes.items()
    }
    return replace(graph, nodes=nodes)


def _settings(wanted: Wanted) -> str:
    parts = {"scale": wanted.scale, "frame": wanted.frame, "size": wanted.size, "precision": wanted.precision}
    return " ".join(f"{name}={value}" for name, value in parts.items() if value is not None)
