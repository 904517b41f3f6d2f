"""The header of a rendered picture: the graph, the files that it read, and the settings to render it again.

Nothing in it depends on the time or place of rendering: the same graph and the same files give the same bytes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from ... import document, media
from ...compiler import Pass, Plan, Surface, Target
from ...compiler.ir.identity import hash_parts
from ...errors import HalationError
from ...graph import Graph
from ...graph.paths import inline_files
from ...resources.sandbox import Sandbox
from ...version import VERSION
from ..engine import RenderRequest
from .destinations import Destination, OutputSettings
from .picture_settings import RecordedSettings
from .source_files import FileHashes, SourceFile, describe_source

PREFIX = "halation:"
_KEY = "halation:key"


def dump_whole_graph(graph: Graph) -> str:
    """The text of a graph with its groups inside, so that it needs no other graph file."""
    return document.dumps(inline_files(graph))


def make_header(
    graph: str,
    target: Target,
    request: RenderRequest,
    frames: tuple[int, int],
    settings: OutputSettings,
    file: Destination,
    plan: Plan,
    sources: Sequence[SourceFile],
    hashes: FileHashes,
) -> dict[str, Any]:
    """The metadata of a file: that of the pictures that were read, and what is needed to render it again.

    `graph` is the text of `dump_whole_graph`. Where two pictures state the same thing, the first one counts. What an
    earlier render wrote into them is dropped, since it describes that render.
    """
    metadata: dict[str, Any] = {}
    for path in dict.fromkeys(item.path for item in sources if item.is_picture):
        metadata = media.read_metadata(path, sandbox=hashes.sandbox) | metadata
    metadata = {name: item for name, item in metadata.items() if not name.startswith(PREFIX)}
    first = plan.surfaces[plan.outputs[next(iter(file.layers.values()))]]
    metadata = media.set_pixel_aspect(metadata, first.pixel_aspect)
    metadata["halation:graph"] = graph
    metadata["halation:version"] = VERSION
    metadata["halation:renderer"] = target.renderer
    recorded = record_settings(request, target, settings, file, frames if plan.memories else None)
    metadata["halation:job"] = recorded.to_json()
    if color := file.encoding.manager.digest:
        metadata["halation:color"] = color
    for source in sources:
        metadata |= describe_source(source, hashes)
    metadata[_KEY] = compute_frame_key(graph, request, plan, file, settings, sources, hashes)
    return metadata


def record_settings(
    request: RenderRequest, target: Target, settings: OutputSettings, file: Destination, frames: tuple[int, int] | None
) -> RecordedSettings:
    """The settings that a file is rendered and written with.

    `frames` are the first and last frame of the graph if it has temporal nodes.
    """
    return RecordedSettings(
        node=next(iter(request.targets), ""),
        size=request.size,
        scale=request.scale,
        precision=settings.precision,
        form=target.form,
        view=file.view,
        display=settings.display,
        look=settings.look,
        colorspace=settings.space,
        compression=settings.compression,
        dither=file.encoding.dither,
        frame=request.frame,
        outputs=tuple(name for name in file.layers.values() if name not in request.targets),
        frames=frames,
        intermediates=request.precision or target.precision,
    )


def compute_frame_key(
    graph: str,
    request: RenderRequest,
    plan: Plan,
    file: Destination,
    settings: OutputSettings,
    sources: Sequence[SourceFile],
    hashes: FileHashes,
) -> str:
    """A key that is equal only if all bytes of the pixels are: it tells whether a file is still up to date.

    It covers shaders, values and the contents of all files that are read; with temporal nodes, the whole graph.
    """
    contents = {
        item.picture.path: hashes.hash_file(item.picture.path) for item in plan.uploads if not item.picture.in_memory
    }
    history = ""
    if plan.memories:
        history_files = [(item.owner, hashes.hash_files(item.files.values())) for item in sources if item.files]
        history = hash_parts(graph, history_files, request.scale, request.size, plan.target.form)
    keys = compute_content_keys(plan, contents, lambda _: history)
    pixels = {layer: keys[plan.outputs[name]] for layer, name in file.layers.items()}
    view_settings = (file.view, settings.display, settings.look, settings.space, file.encoding.manager.digest)
    encoding_settings = (file.path.suffix, *view_settings, settings.compression, settings.precision)
    if file.encoding.dither != "none":
        encoding_settings = (*encoding_settings, file.encoding.dither, request.frame)
    return hash_parts(VERSION, sorted(pixels.items()), sorted(file.kinds.items()), encoding_settings)


def has_key(file: Destination, sandbox: Sandbox) -> bool:
    """True if the file exists and its header has a key."""
    return bool(_read_key(file, sandbox=sandbox))


def matches_key(file: Destination, key: str, sandbox: Sandbox) -> bool:
    """True if the file exists and its header has this key."""
    return _read_key(file, sandbox=sandbox) == key


def _read_key(file: Destination, sandbox: Sandbox) -> object:
    try:
        return media.read_metadata(file.path, sandbox=sandbox).get(_KEY) if file.path.is_file() else None
    except HalationError:  # no picture of ours
        return None


def compute_content_keys(
    plan: Plan, contents: Mapping[str, str], find_history_key: Callable[[Surface], str]
) -> dict[int, str]:
    """Keys of surfaces like those of a plan, but from the contents of files instead of their paths and dates.

    `find_history_key` gives the key of what the frame before stored.
    """
    keys: dict[int, str] = {}
    for item in plan.uploads:
        picture, surface = item.picture, plan.surfaces[item.surface]
        content = surface.key if picture.in_memory else contents[picture.path]
        keys[item.surface] = hash_parts(
            content,
            picture.frame,
            picture.layer,
            picture.kind,
            picture.width,
            picture.space,
            surface.texel,
            surface.size,
        )
    known = {*keys, *(number for render_pass in plan.passes for number in render_pass.targets)}
    keys |= {number: find_history_key(item) for number, item in enumerate(plan.surfaces) if number not in known}
    for render_pass in plan.passes:
        pass_key = hash_parts(*_describe_pass(render_pass), [keys[number] for number in render_pass.textures])
        for place, number in enumerate(render_pass.targets):
            surface = plan.surfaces[number]
            keys[number] = f"{pass_key}.{place}.{surface.size}.{surface.texel}"
    return keys


def _describe_pass(render_pass: Pass) -> tuple[object, ...]:
    mesh = render_pass.mesh.digest if render_pass.mesh is not None else ""
    return render_pass.shader.source, render_pass.shader.vertex, render_pass.uniforms, render_pass.weights, mesh
