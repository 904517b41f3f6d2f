"""What every node with a memory promises: pictures that depend on nothing but the graph and the frame."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from halation.graph import Graph
from halation.nodes import Kind, Node, Temporal, catalogue
from halation.renderer import RenderRequest
from sequences import Array, Shot, render_frames, shot_graph

NODES = [node for node in catalogue().values() if issubclass(node, Temporal)]
by_id = pytest.mark.parametrize("node", NODES, ids=lambda node: node.id)

SIZE, FRAMES = (11, 7), (1, 8)
WHOLE = range(FRAMES[0], FRAMES[1] + 1)


def pixels(frame: int, channels: int, spoiled: bool = False) -> Array:
    random = np.random.default_rng(10 * frame + channels)
    picture = random.gamma(0.7, 1.0, (SIZE[1], SIZE[0], channels)).astype(np.float32)
    if spoiled:
        picture[1, 2], picture[3, 4], picture[5, 6], picture[2, 8] = np.nan, np.inf, -np.inf, 3e38
    return picture


def shot_of(node: type[Node], spoiled: frozenset[int] = frozenset()) -> Shot:
    """Noise that is new in every frame for every picture it takes."""
    return {
        name: lambda frame, channels=socket.channels: pixels(frame, channels, frame in spoiled)
        for name, socket in node.inputs.items()
        if not socket.single
    }


def output(node: type[Node]) -> str:
    return next(name for name, made in node.outputs.items() if made.socket.kind is Kind.IMAGE)


def replace_frames(graph: Graph, frames: tuple[int, int], **settings: object) -> Graph:
    return replace(graph, settings=replace(graph.settings, frames=frames, **settings))  # type: ignore[arg-type]


@by_id
def test_frames_in_any_order_are_the_same(renderer, node):
    shot = shot_of(node)
    graph = shot_graph(node(), shot, FRAMES)
    whole = render_frames(renderer, graph, shot, WHOLE, output(node))
    order = (8, 2, 3, 7, 1, 5, 4)
    for frame, made in zip(order, render_frames(renderer, graph, shot, order, output(node)), strict=True):
        assert np.array_equal(made, whole[frame - 1]), frame
    assert not np.array_equal(
        whole[7], render_frames(renderer, replace_frames(graph, (8, 8)), shot, [8], output(node))[0]
    )


@by_id
def test_parts_of_a_shot_are_one_run(renderer, node):
    """Without a pre-roll to the bit; with one, as if the shot began there."""
    shot = shot_of(node)
    graph = shot_graph(node(), shot, FRAMES)
    whole = render_frames(renderer, graph, shot, WHOLE, output(node))
    second = render_frames(renderer, graph, shot, range(5, 9), output(node))
    assert all(np.array_equal(made, whole[frame - 1]) for frame, made in zip(range(5, 9), second, strict=True))
    rolled = replace_frames(graph, FRAMES, preroll=3)
    whole = render_frames(renderer, rolled, shot, WHOLE, output(node))
    second = render_frames(renderer, rolled, shot, range(5, 9), output(node))
    assert all(np.array_equal(made, whole[frame - 1]) for frame, made in zip(range(5, 9), second, strict=True))
    began = render_frames(renderer, replace_frames(graph, (4, 8)), shot, [7], output(node))[0]
    assert np.array_equal(whole[6], began)


@by_id
def test_what_is_no_number_is_never_remembered(renderer, node):
    shot = shot_of(node, frozenset((3,)))
    for made in render_frames(renderer, shot_graph(node(), shot, FRAMES), shot, (3, 4, 8), output(node)):
        assert np.isfinite(made).all()


@by_id
def test_memory_has_32_bits(renderer, node):
    shot = shot_of(node)
    plan = renderer.compile(shot_graph(node(), shot, FRAMES), RenderRequest(dict(shot), precision="half"))
    assert plan.memories and not any(memory.half for memory in plan.memories.values())


@by_id
def test_it_is_never_taken_for_a_wire(node):
    """Values may be keyed: a frame that changes nothing is still to be remembered."""
    assert node().identity() is None
