"""One rendering from graph to files: what `halation render` does once its arguments are understood."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import metadata
from pathlib import Path
from typing import Any

from ...nodes import Kind
from .. import document, media
from ..compiler import Pass, Plan, Precision
from ..errors import UsageError
from ..graph import Graph, Port
from .engine import Renderer, Wanted
from .runner import Array

Progress = Callable[[int, int, Pass], None]
"""Called after each pass with how many are done, how many there are, and which it was."""


@dataclass(frozen=True)
class Writing:
    """Where and how results are written. `paths` are by output name; an empty name stands for all that fit in one."""

    paths: Mapping[str, Path]
    view: str = ""
    compression: str = "zip"
    precision: Precision = "half"


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
    """Render what `wanted` says and write it. Raises the errors of `app.errors`; no partial file is left behind."""
    files = _assign(graph, wanted, writing)
    started = time.perf_counter()
    counters, programs = renderer.runner.counters.passes, renderer.runner.programs.compiled
    plan = renderer.compile(graph, wanted)
    compiled = time.perf_counter()
    outputs: dict[str, Array] = {}
    for done, one in enumerate(renderer.runner.steps(plan, outputs), 1):
        if progress is not None:
            progress(done, len(plan.passes), one)
    rendered = time.perf_counter()
    header = _header(renderer, plan, graph, wanted)
    for path, names in files.items():
        kinds = {name: _kind(graph, wanted, name) for name in names}
        layers = {_layer(graph, name): outputs[name] for name in names}
        media.write(
            path, layers, kinds={_layer(graph, name): kind for name, kind in kinds.items()},
            precision=writing.precision, compression=writing.compression,
            view=writing.view or _view(graph, wanted, names), metadata=header,
        )
    finished = time.perf_counter()
    return Report(
        tuple(files), plan, renderer.runner.counters.passes - counters,
        renderer.runner.programs.compiled - programs, renderer.runner.textures.peak, dict(renderer.pictures.repaired),
        {"compile": compiled - started, "render": rendered - compiled, "write": finished - rendered},
    )


def _assign(graph: Graph, wanted: Wanted, writing: Writing) -> dict[Path, tuple[str, ...]]:
    """Which outputs go into which file."""
    names = tuple(wanted.targets or graph.outputs)
    files: dict[Path, tuple[str, ...]] = {}
    for name, path in writing.paths.items():
        if name and name not in names:
            raise UsageError(f"the graph has no output '{name}': its outputs are {', '.join(names) or 'none'}")
        if name:
            files[path] = (*files.get(path, ()), name)
        elif path.suffix.lower() == ".exr" or len(names) <= 1:
            files[path] = names
        else:
            raise UsageError(
                f"{path}: {path.suffix} holds one picture, but the graph has the outputs {', '.join(names)}; "
                f"choose one with -o {names[0]}={path}"
            )
    return files


def _kind(graph: Graph, wanted: Wanted, name: str) -> Kind:
    if name in graph.outputs and name not in wanted.targets:
        return graph.outputs[name].kind
    port = wanted.targets.get(name, Port("outputs", name))
    if port.node == "outputs":
        return graph.outputs[port.socket].kind
    socket = graph.source(port)
    return socket.kind if socket is not None else Kind.IMAGE


def _layer(graph: Graph, name: str) -> str:
    output = graph.outputs.get(name)
    return output.layer if output is not None and output.layer else name


def _view(graph: Graph, wanted: Wanted, names: tuple[str, ...]) -> str:
    """The view that the first of the outputs asks for; a node alone asks for none."""
    ports = [wanted.targets.get(name, Port("outputs", name)) for name in names[:1]]
    return "".join(graph.outputs[port.socket].view for port in ports if port.node == "outputs")


def _header(renderer: Renderer, plan: Plan, graph: Graph, wanted: Wanted) -> dict[str, Any]:
    """What a result says of itself: input metadata passes through, and how to make it again is added."""
    used = {item.node: item.picture for item in plan.uploads if not item.picture.in_memory}
    header: dict[str, Any] = {}
    for picture in used.values():
        header = media.read_metadata(picture.path) | header
    header["halation:graph"] = document.dumps(graph)
    header["halation:version"] = metadata.version("halation")
    header["halation:renderer"] = renderer.device.target.renderer
    header["halation:settings"] = _settings(wanted)
    for node, picture in used.items():
        layer = f":{picture.layer}" if picture.layer else ""
        digest = media.content_hash(picture.path)
        header[f"halation:input:{node}"] = f"{Path(picture.path).name}{layer} sha256:{digest}"
    return header


def _settings(wanted: Wanted) -> str:
    parts = {"scale": wanted.scale, "frame": wanted.frame, "size": wanted.size, "precision": wanted.precision}
    return " ".join(f"{name}={value}" for name, value in parts.items() if value is not None)

