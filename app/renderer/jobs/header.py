"""What a finished picture says of itself: what it was made of, and how to make it again.

Nothing in it depends on when or where it was made: the same graph and the same files give the same bytes.
"""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from hashlib import blake2b
from typing import Any

from ... import document, media
from ...color.management import color_digest
from ...compiler import Pass, Plan, Target
from ...errors import HalationError
from ...graph import Graph
from ...graph.paths import inlined
from ...version import VERSION
from ..engine import RenderRequest
from .destinations import Destination, Writing
from .sources import Hashes, Source, said

PREFIX = "halation:"
_KEY = "halation:key"


def whole(graph: Graph) -> str:
    """A graph and its groups as one text."""
    return document.dumps(inlined(graph))


def header(
    graph: str,
    target: Target,
    wanted: RenderRequest,
    frames: tuple[int, int],
    writing: Writing,
    file: Destination,
    plan: Plan,
    sources: Sequence[Source],
    hashes: Hashes,
) -> dict[str, Any]:
    """What a file says: metadata of what was read passes through, and how to make it again is added.

    The graph is the text of `whole`.
    """
    found: dict[str, Any] = {}
    for path in dict.fromkeys(item.path for item in sources if item.is_picture):
        found = media.read_metadata(path) | found
    found = {name: item for name, item in found.items() if not name.startswith(PREFIX)}
    found["halation:graph"] = graph
    found["halation:version"] = VERSION
    found["halation:renderer"] = target.renderer
    found["halation:settings"] = settings(wanted, target, writing, file, frames if plan.memories else None)
    if color := color_digest(file.encoding.color):
        found["halation:color"] = color
    for source in sources:
        found |= said(source, hashes)
    found[_KEY] = frame_key(graph, wanted, plan, file, writing, sources, hashes)
    return found


def settings(
    wanted: RenderRequest, target: Target, writing: Writing, file: Destination, frames: tuple[int, int] | None
) -> str:
    """How a file was rendered and written, as `name=value` words that a shell would take apart.

    `frames` are the first and last of the graph, where history matters.
    """
    parts = [("scale", wanted.scale), ("frame", wanted.frame)]
    words = [f"{name}={value}" for name, value in parts]
    if frames:
        words.append(f"frames={frames[0]}..{frames[1]}")
    if wanted.size:
        words.append(f"size={wanted.size[0]}x{wanted.size[1]}")
    words += [f"node={name}" for name in wanted.targets]
    words += [f"output={name}" for name in file.layers.values() if name not in wanted.targets]
    words += [f"precision={writing.precision}", f"intermediates={wanted.precision or target.precision}"]
    words += [f"form={target.form}", f"view={file.view}", f"display={writing.display}", f"look={writing.look}"]
    words += [f"colorspace={writing.space}", f"compression={writing.compression}"]
    return " ".join(shlex.quote(word) for word in words if not word.endswith("="))


def frame_key(
    graph: str,
    wanted: RenderRequest,
    plan: Plan,
    file: Destination,
    writing: Writing,
    sources: Sequence[Source],
    hashes: Hashes,
) -> str:
    """What tells whether a file is still what would be written: it is equal only where all bytes of pixels are.

    It covers shaders, values and the content of all that is read; where history matters, the whole graph.
    """
    contents = {item.picture.path: hashes.of(item.picture.path) for item in plan.uploads if not item.picture.in_memory}
    before = ""
    if plan.memories:
        led = [(item.owner, hashes.of_all(item.files.values())) for item in sources if item.files]
        before = _digest(graph, led, wanted.scale, wanted.size, plan.target.form)
    keys = _content_keys(plan, contents, before)
    pixels = {layer: keys[plan.outputs[name]] for layer, name in file.layers.items()}
    seen = (file.view, writing.display, writing.look, writing.space, color_digest(file.encoding.color))
    how = (file.path.suffix, *seen, writing.compression, writing.precision)
    return _digest(VERSION, sorted(pixels.items()), sorted(file.kinds.items()), how)


def is_marked(file: Destination) -> bool:
    """True if that file is there and says what it was made of."""
    return bool(_mark(file))


def is_written(file: Destination, key: str) -> bool:
    """True if that file is there and says that it was made with that key."""
    return _mark(file) == key


def _mark(file: Destination) -> object:
    try:
        return media.read_metadata(file.path).get(_KEY) if file.path.is_file() else None
    except HalationError:  # whatever it is, it is not what would be written
        return None


def _content_keys(plan: Plan, contents: Mapping[str, str], before: str) -> dict[int, str]:
    """Keys of surfaces as a plan has them, but of what is in files instead of where these are and how old.

    What was remembered of the frame before is known by `before`.
    """
    keys: dict[int, str] = {}
    for item in plan.uploads:
        picture, surface = item.picture, plan.surfaces[item.surface]
        content = surface.key if picture.in_memory else contents[picture.path]
        keys[item.surface] = _digest(
            content,
            picture.frame,
            picture.layer,
            picture.kind,
            picture.width,
            picture.space,
            surface.texel,
            surface.size,
        )
    for one in plan.passes:
        made = _digest(*_work(one), [keys.get(number, before) for number in one.textures])
        for place, number in enumerate(one.targets):
            surface = plan.surfaces[number]
            keys[number] = f"{made}.{place}.{surface.size}.{surface.texel}"
    return {number: keys.get(number, before) for number in range(len(plan.surfaces))}


def _work(one: Pass) -> tuple[object, ...]:
    mesh = one.mesh.digest if one.mesh is not None else ""
    return one.shader.source, one.shader.vertex, one.uniforms, one.weights, mesh


def _digest(*parts: object) -> str:
    return blake2b("\0".join(map(str, parts)).encode(), digest_size=16).hexdigest()
