"""For a region of an output nothing is read beyond what the compiler says is needed for it, whatever the node.

All that it says is not needed is poisoned: the pixels of the region stay, to the bit. So a node that declares too
small an overlap fails here, with every edge mode and any values.
"""

from __future__ import annotations

from random import Random

import numpy as np
import pytest
from conftest import graph_of
from halation.compiler import Region
from halation.nodes import Kind, Node, Source, Temporal, catalogue, look_at
from halation.regression.read_areas import cut_out, find_read_areas, poison
from halation.renderer import Renderer, RenderRequest
from random_graphs import random_node

SIZE = (251, 131)
"""Wide and high enough that most regions leave something out."""

CLASSES = {id: node for id, node in catalogue().items() if not issubclass(node, Source | Temporal) and node.inputs}
CAMERA = look_at((1.0, -5.0, 2.0), (0.0, 0.0, 0.5), (1.2, 1.9))

REGIONS = (Region(0, 0, 20, 13), Region(120, 60, 21, 9), Region(240, 0, 11, 131))

CORNERS = (Region(240, 0, 11, 7), Region(230, 120, 21, 11))
"""Where a picture ends on two sides, far from a center at a fifth of its width."""

FAR_ROOMS = ("blur", "distort", "glow", "lens")
"""Folders of nodes whose reach grows with their values, or toward the corners."""

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


def prove(renderer: Renderer, node: Node, some: bool, regions: tuple[Region, ...]) -> int:
    """How many regions leave out something of what the node itself reads, all of which stay as they are.

    The mask that many nodes have is mixed in afterwards, pixel by pixel, and says nothing about the node.
    """
    given = inputs_of(node, some)
    arrays = {name: item for name, item in given.items() if isinstance(item, np.ndarray)}
    graph = graph_of(node, given)
    whole = renderer.render(graph, RenderRequest(arrays, precision="float"))
    proven = 0
    for region in regions:
        for name, areas in find_read_areas(renderer, graph, arrays, region).items():
            smaller = {input for input, area in areas.items() if area.size != arrays[input].shape[1::-1]}
            if not smaller and len(areas) == len(arrays):
                continue
            proven += bool(smaller - ({"mask"} if node.has_mask else set()))
            pixels = renderer.render(graph, RenderRequest(poison(arrays, areas), precision="float"))[name]
            cut = cut_out(region)
            np.testing.assert_array_equal(
                pixels[cut].view(np.uint8),
                whole[name][cut].view(np.uint8),
                f"'{node.id}' reads farther than an overlap in its passes() says: {name} {region}",
            )
    return proven


@pytest.mark.parametrize("id", CLASSES)
def test_nothing_else_is_read(renderer, id):
    proven = prove(renderer, CLASSES[id](), some=False, regions=REGIONS)
    assert bool(proven) or id in ANYWHERE, (
        f"'{id}' needs all pixels for each pixel: give its draws an overlap, or list it in ANYWHERE, in {__file__}"
    )
    assert not proven or id not in ANYWHERE, f"'{id}' has an overlap: remove it from ANYWHERE, in {__file__}"
    prove(renderer, random_node(Random(id), CLASSES[id]), some=True, regions=REGIONS[1:2])


def room_of(kind: type[Node]) -> str:
    """The folder of a node."""
    return kind.__module__.split(".")[-2]


def choose_ends(rng: Random, kind: type[Node], turn: int) -> Node:
    """A node with each number at an end of its soft range: what reaches far, reaches as far as it may.

    Choices come in turn, and places lie off the middle.
    """
    values = {}
    for value in kind.values.values():
        if value.type == "choice":
            values[value.name] = value.choices[turn % len(value.choices)]
        elif value.type == "bool":
            values[value.name] = rng.random() < 0.5
        elif value.type == "vector" and value.default == (0.5, 0.5):
            values[value.name] = (0.2, 0.7)
        elif value.unit is not None and value.type in ("float", "int"):
            low, high = max(value.low, value.minimum), min(value.high, value.maximum)
            values[value.name] = type(value.default)(low if low < 0.0 and rng.random() < 0.5 else high)
    return kind(**values)


@pytest.mark.parametrize("id", sorted(id for id in {*CLASSES} - ANYWHERE if room_of(CLASSES[id]) in FAR_ROOMS))
def test_nothing_else_is_read_with_values_at_their_ends(renderer, id):
    """In the corners that are the farthest from the center."""
    rng = Random(f"{id} at its ends")
    for turn in range(2):
        prove(renderer, choose_ends(rng, CLASSES[id], turn), some=False, regions=CORNERS)
