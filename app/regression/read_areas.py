"""Checks that a node reads no farther than the `overlap` of its draws says.

What it need not read for a part of its output is poisoned: then that part must stay, to the bit. A node that reads
farther than it says would show seams where a large picture is rendered in tiles.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from halation.nodes import Node, Source, Temporal

from ..compiler import Region, Request, graph_library
from ..compiler.fusion.fuse import fuse
from ..compiler.fusion.rewrites import rewrite_passes
from ..compiler.ir import Read
from ..compiler.lowering.lower import lower
from ..compiler.tiling.regions import find_regions
from ..graph import Graph
from .node_promises import Pictures, find_changing_values, make_node_request, make_pictures

if TYPE_CHECKING:
    from ..renderer import Renderer

_SIZE = (151, 83)
"""Larger than what most nodes reach at their defaults, so that something is left out; small enough for a second."""

_PARTS = (Region(0, 0, 20, 13), Region(70, 40, 11, 9), Region(140, 0, 11, 83))
"""A corner, the middle and a border."""

_LENGTH = 4.6
"""Pixels: more than an `overlap` that was written for one length, and between two pixels, as most lengths are. Half of
it is hardly more than what `near` interpolates, twice as much leaves less out. Chosen by judgement."""


def find_read_areas(
    renderer: Renderer, graph: Graph, pictures: Pictures, part: Region
) -> Mapping[str, Mapping[str, Region]]:
    """For each output of the size of the pictures, what of each picture is needed for a part of it.

    A picture that is not needed at all is left out.
    """
    provider = renderer.pictures
    library, target = graph_library(graph, provider), renderer.device.target
    program = lower(graph, Request(bindings=provider.bind(graph, pictures)), library, provider).program
    passes = rewrite_passes(program, fuse(program, target), target, library)
    size = max((picture.shape[1::-1] for picture in pictures.values()), default=None)
    return {
        name: {
            op.picture.path: region
            for read, region in find_regions(program, passes, {ref: part}).items()
            if isinstance(op := program.ops[read.op], Read) and op.picture.path in pictures
        }
        for name, ref in program.outputs.items()
        if program.shape(ref).size == size
    }


def poison(pictures: Pictures, areas: Mapping[str, Region]) -> Pictures:
    """The pictures with other numbers outside of these areas: large ones, and some that are NaN."""
    rng = np.random.default_rng(11)  # numbers that no filter with weights of usual size hides
    poisoned: Pictures = {}
    for name, picture in pictures.items():
        poisoned[name] = rng.normal(0.0, 1e4, picture.shape).astype(np.float32)
        poisoned[name][rng.random(picture.shape) < 0.1] = np.nan
        if name in areas:
            cut = cut_out(areas[name])
            poisoned[name][cut] = picture[cut]
    return poisoned


def cut_out(region: Region) -> tuple[slice, slice]:
    """The rows and columns of a region."""
    return slice(*region.down), slice(*region.across)


def find_overlap_faults(renderer: Renderer, node: type[Node]) -> Iterator[str]:
    """Outputs that read farther than the draws of the node say."""
    pictures = make_pictures(node, _SIZE, np.random.default_rng(9))
    if not pictures or issubclass(node, Source | Temporal):
        return
    values = find_changing_values(node)
    longer_values = _lengthen(node)
    subjects = [node(**values), node(**(values | longer_values))] if longer_values else [node(**values)]
    too_far = {name for subject in subjects for name in _find_far_outputs(renderer, subject, pictures)}
    yield from (f"the output '{name}' reads farther than an `overlap` in passes() says" for name in sorted(too_far))


def _find_far_outputs(renderer: Renderer, subject: Node, pictures: Pictures) -> Iterator[str]:
    """The outputs with another part where the pictures are poisoned outside of what the node says that it reads."""
    graph, request = make_node_request(subject, pictures)
    whole = renderer.render(graph, request)
    for part in _PARTS:
        for name, areas in find_read_areas(renderer, graph, pictures, part).items():
            poisoned = renderer.render(*make_node_request(subject, poison(pictures, areas)))
            if poisoned[name][cut_out(part)].tobytes() != whole[name][cut_out(part)].tobytes():
                yield name


def _lengthen(node: type[Node]) -> dict[str, Any]:
    """The numbers that are lengths, so long that a node whose `overlap` does not follow them reads too far.

    At their defaults, fractions of the height are often less than a pixel of a picture as small as these.
    """
    longer: dict[str, float] = {}
    for value in node.values.values():
        pixel = {"px": 1.0, "height": 1.0 / _SIZE[1]}.get(value.unit or "")
        if pixel and isinstance(value.default, float):
            length = min(max(_LENGTH * pixel, value.minimum), value.maximum)
            longer |= {value.name: length} if length > value.default else {}
    return longer
