"""One rendering from graph to files: what `halation render` does once its arguments are understood."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from importlib import metadata
from pathlib import Path
from typing import Any

from .. import document, media
from ..compiler import Pass, Picture, Plan
from ..graph import Graph, Group
from .decoding import Array
from .destinations import Writing, check, destinations
from .engine import Renderer, Wanted

__all__ = ["Progress", "Report", "Writing", "run_job"]

Progress = Callable[[int, int, Pass], None]
"""Called after each pass with how many are done, how many there are, and which it was."""


@dataclass(frozen=True)
class Report:
    """What a job did. `seconds` are by stage."""

    written: tuple[Path, ...]
    plan: Plan
    passes: int
    programs: int
    peak_bytes: int
    repaired: Mapping[str, int]
    seconds: Mapping[str, float] = field(default_factory=dict[str, float])


def run_job(
    renderer: Renderer, graph: Graph, wanted: Wanted, writing: Writing, progress: Progress | None = None
) -> Report:
    """Render what `wanted` says and write it.

    Whatever can be known to be wrong with a destination is known before anything is rendered. Raises the errors of
    `app.errors`; no partial file is left behind.
    """
    started = time.perf_counter()
    counters, programs = renderer.runner.counters.passes, renderer.runner.programs.compiled
    files = destinations(graph, wanted, writing)
    plan = renderer.compile(graph, wanted)
    sources = {item.node: item.picture for item in plan.uploads if not item.picture.in_memory}
    check(files, plan, sources, writing.compression)
    hashes = _hashes({picture.path for picture in sources.values()})
    compiled = time.perf_counter()
    outputs = _rendered(renderer, plan, progress)
    rendered = time.perf_counter()
    header = _header(renderer, graph, wanted, sources, hashes)
    for file in files:
        layers = {layer: outputs[name] for layer, name in file.layers.items()}
        media.write(
            file.path, layers, kinds=file.kinds, precision=writing.precision, compression=writing.compression,
            view=file.view, metadata=header,
        )
    finished = time.perf_counter()
    return Report(
        tuple(file.path for file in files), plan, renderer.runner.counters.passes - counters,
        renderer.runner.programs.compiled - programs, renderer.runner.textures.peak, dict(renderer.pictures.repaired),
        {"compile": compiled - started, "render": rendered - compiled, "write": finished - rendered},
    )


def _rendered(renderer: Renderer, plan: Plan, progress: Progress | None) -> dict[str, Array]:
    """The outputs of the plan by name."""
    kept = renderer.runner.lease()
    try:
        with renderer.runner.steps(plan, kept) as steps:
            for done, one in enumerate(steps, 1):
                if progress is not None:
                    progress(done, len(plan.passes), one)
        return renderer.runner.download(plan)
    finally:
        kept.close()


def _hashes(paths: Iterable[str]) -> dict[str, Future[str]]:
    """SHA-256 of files by path; computed on another thread, while the pictures are decoded and rendered."""
    pool = ThreadPoolExecutor(1, thread_name_prefix="hash")
    found = {path: pool.submit(media.content_hash, path) for path in paths}
    pool.shutdown(wait=False)
    return found


def _header(
    renderer: Renderer, graph: Graph, wanted: Wanted, sources: Mapping[str, Picture],
    hashes: Mapping[str, Future[str]],
) -> dict[str, Any]:
    """What a result says of itself: input metadata passes through, and how to make it again is added."""
    header: dict[str, Any] = {}
    for path in hashes:
        header = media.read_metadata(path) | header
    header["halation:graph"] = document.dumps(_whole(graph))
    header["halation:version"] = metadata.version("halation")
    header["halation:renderer"] = renderer.device.target.renderer
    header["halation:settings"] = _settings(wanted)
    for node, picture in sources.items():
        layer = f":{picture.layer}" if picture.layer else ""
        digest = hashes[picture.path].result()
        header[f"halation:input:{node}"] = f"{Path(picture.path).name}{layer} sha256:{digest}"
    return header


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
