"""For a region of an output nothing is read beyond what the compiler says is needed for it, whatever the node.

All that it says is not needed is poisoned: the pixels of the region stay, to the bit. So a node that declares too
small an overlap fails here, with every edge mode and any values.
"""

from __future__ import annotations

from random import Random

import numpy as np
import pytest
from conftest import graph_of
from halation.compiler import Request, graph_library
from halation.compiler.areas import Region
from halation.compiler.fusion.fuse import fuse
from halation.compiler.fusion.rewrites import rewrite_passes
from halation.compiler.ir import Read
from halation.compiler.lowering.lower import lower
from halation.compiler.tiling.regions import find_regions
from halation.inputs.provider import MediaProvider
from halation.nodes import Kind, Node, Source, Temporal, catalogue, look_at
from halation.renderer import Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED
from random_graphs import random_node

Array = np.ndarray

SIZE = (251, 131)
"""Wide and high enough that most regions leave something out."""

CLASSES = {id: node for id, node in catalogue().items() if not issubclass(node, Source | Temporal) and node.inputs}
CAMERA = look_at((1.0, -5.0, 2.0), (0.0, 0.0, 0.5), (1.2, 1.9))

REGIONS = (Region(0, 0, 20, 13), Region(120, 60, 21, 9), Region(240, 0, 11, 131))


ANYWHERE = frozenset(
    {
        "auto_exposure",
        "corner_pin",
        "denoise",
        "dilate_erode",
        "displace",
        "distance_field",
        "edge_extend",
        "eye_glare",
        "fill_holes",
        "histogram",
        "inpaint",
        "kaleidoscope",
        "kernel_glare",
        "luminance_statistics",
        "panorama",
        "photoreceptor_tone_map",
        "polar",
        "screen_clean_plate",
        "spline_warp",
        "st_map",
        "sun_beams",
        "upscale",
    }
)
"""Nodes that may read everything for a pixel, at their own values, or make a picture of another size."""


def inputs_of(node: Node, some: bool) -> dict[str, object]:
    """HDR noise for all inputs, or for those that must be linked."""
    rng = np.random.default_rng(7)
    found: dict[str, object] = {}
    for name, socket in type(node).inputs.items():
        if some and socket.optional:
            continue
        if socket.kind is Kind.CAMERA:
            found[name] = CAMERA
            continue
        height, width = (1, 1) if socket.single else SIZE[::-1]
        array = rng.gamma(0.6, 1.0, (height, width, socket.channels)).astype(np.float32)
        found[name] = array - (0.5 if socket.kind is Kind.VECTOR else 0.0)
    return found


def poisoned(array: Array, region: Region) -> Array:
    """Other numbers everywhere but in a region: large ones, and some that are none."""
    rng = np.random.default_rng(11)
    bad = rng.normal(0.0, 1e4, array.shape).astype(np.float32)
    bad[rng.random(array.shape) < 0.1] = np.nan
    rows, columns = (slice(*span) for span in (region.down, region.across))
    bad[rows, columns] = array[rows, columns]
    return bad


def prove(renderer: Renderer, node: Node, some: bool, regions: tuple[Region, ...]) -> int:
    """How many regions leave out something of what the node itself reads, all of which stay as they are.

    The mask that many nodes have is mixed in afterwards, pixel by pixel, and says nothing about the node.
    """
    given = inputs_of(node, some)
    arrays = {name: item for name, item in given.items() if isinstance(item, np.ndarray)}
    graph, outside = graph_of(node, given), MediaProvider(sandbox=UNRESTRICTED)
    request = Request(bindings=outside.bind(graph, arrays))
    library, target = graph_library(graph, outside), renderer.device.target
    program = lower(graph, request, library, outside).program
    passes = rewrite_passes(program, fuse(program, target), target, library)
    whole = renderer.render(graph, RenderRequest(arrays, precision="float"))
    proven = 0
    for name, ref in program.outputs.items():
        if program.shape(ref).size != SIZE:
            continue
        for region in regions:
            found = find_regions(program, passes, {ref: region})
            read = {
                op.picture.path: part
                for one, part in found.items()
                if isinstance(op := program.ops[one.op], Read) and op.picture.path in arrays
            }
            bad = {
                input: poisoned(array, read[input]) if input in read else np.full_like(array, np.nan)
                for input, array in arrays.items()
            }
            left_out = any(part.size != arrays[input].shape[1::-1] for input, part in read.items())
            if not left_out and len(read) == len(arrays):
                continue
            proven += any(
                part.size != arrays[input].shape[1::-1]
                for input, part in read.items()
                if not (node.has_mask and input == "mask")
            )
            pixels = renderer.render(graph, RenderRequest(bad, precision="float"))[name]
            rows, columns = (slice(*span) for span in (region.down, region.across))
            np.testing.assert_array_equal(
                pixels[rows, columns].view(np.uint8), whole[name][rows, columns].view(np.uint8), f"{name} {region}"
            )
    return proven


@pytest.mark.parametrize("id", CLASSES)
def test_nothing_else_is_read(renderer, id):
    proven = prove(renderer, CLASSES[id](), some=False, regions=REGIONS)
    assert bool(proven) != (id in ANYWHERE)
    prove(renderer, random_node(Random(id), CLASSES[id]), some=True, regions=REGIONS[1:2])
