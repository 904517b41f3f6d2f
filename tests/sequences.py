"""Shots for nodes that look at time: pictures by frame, and noise that is new in every frame."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

import numpy as np
from conftest import graph_of
from halation.graph import Expression, Graph, Output, Port, Settings
from halation.nodes import Node
from halation.nodes.input.noise import Noise
from halation.renderer import FrameRenderer, Renderer, RenderRequest

Array = np.ndarray
Shot = Mapping[str, Callable[[int], Array]]


def shot_graph(node: Node, shot: Shot, frames: tuple[int, int] = (1, 8), **settings: object) -> Graph:
    """A graph of one node with an input for every picture of the shot. Seen at other frames, those are the same."""
    graph = graph_of(node, {name: made(frames[0]) for name, made in shot.items()})
    return replace(graph, settings=Settings(frames=frames, **settings))  # type: ignore[arg-type]


def noise_graph(node: Node, frames: tuple[int, int] = (1, 8), size: tuple[int, int] = (13, 7)) -> Graph:
    """Noise that is new in every frame, past the node's `image`, at the output `out`; as it is at `noise`."""
    graph = Graph(settings=Settings(size, frames)).add("noise", Noise(kind="white", octaves=1)).add("node", node)
    graph = graph.animate(Port("noise", "seed"), Expression("frame + 100"))
    graph = graph.connect(Port("noise", "out"), Port("node", "image"))
    graph = graph.add_output("out", Output()).connect(Port("node", "out"), Port("outputs", "out"))
    return graph.add_output("noise", Output()).connect(Port("noise", "out"), Port("outputs", "noise"))


def noise_at(renderer: Renderer, graph: Graph, frame: int) -> Array:
    """What the noise of such a graph is at a frame, in 64 bits."""
    outputs = renderer.render(
        graph, RenderRequest(frame=frame, precision="float", targets={"it": Port("outputs", "noise")})
    )
    return outputs["it"].astype(np.float64)


def node_at(renderer: Renderer, graph: Graph, frame: int, **wanted: object) -> Array:
    """What the node makes of it, in 64 bits."""
    options: dict[str, object] = {"precision": "float", "targets": {"it": Port("outputs", "out")}, **wanted}
    return renderer.render(graph, RenderRequest(frame=frame, **options))["it"].astype(np.float64)  # type: ignore[arg-type]


def render_frames(
    renderer: Renderer,
    graph: Graph,
    shot: Shot,
    frames: Iterable[int],
    output: str = "out",
    **request: object,
) -> list[Array]:
    """An output at frames, in the order in which they are asked for."""
    options: dict[str, object] = {"precision": "float", **request}
    frame_renderer = FrameRenderer(renderer, graph, RenderRequest(dict(shot), **options))  # type: ignore[arg-type]
    try:
        return [frame_renderer.render_frame(frame)[output].copy() for frame in frames]
    finally:
        frame_renderer.close()


def make_flat_frames(value: Callable[[int], float], size: tuple[int, int] = (3, 2)) -> Callable[[int], Array]:
    """Frames of one gray each, opaque."""

    def make_frame(frame: int) -> Array:
        picture = np.full((size[1], size[0], 4), value(frame), np.float32)
        picture[..., 3] = 1.0
        return picture

    return make_frame
