"""A graph to preview, and how a test waits for its picture."""

from __future__ import annotations

import time
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from device_textures import read_texture
from halation.authoring.preview import Preview
from halation.graph import Graph, Input, Output, Port
from halation.nodes import Kind, Size
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.nodes.color.saturation import Saturation
from halation.renderer import Renderer, RenderRequest

if TYPE_CHECKING:
    from halation.inputs.provider import Binding

PICTURE = np.random.default_rng(8).random((23, 37, 4), np.float32)
IMAGE = Port("outputs", "image")
OUT = MappingProxyType({"A": IMAGE})
INPUTS: Mapping[str, Binding] = MappingProxyType({"image": PICTURE})


def chain(stops: float = 1.0, sigma: float = 2.0, saturation: float = 0.5) -> Graph:
    graph = Graph(inputs={"image": Input(Kind.IMAGE)}, outputs={"image": Output()})
    last = Port("inputs", "image")
    nodes = {"light": Exposure(stops=stops), "blur": GaussianBlur(sigma=sigma)}
    for name, node in (nodes | {"color": Saturation(saturation=saturation)}).items():
        graph = graph.add(name, node).connect(last, Port(name, "image"))
        last = Port(name, "out")
    return graph.connect(last, Port("outputs", "image"))


def request_preview(
    preview: Preview,
    graph: Graph,
    ports: Mapping[str, Port] = OUT,
    *,
    bindings: Mapping[str, Binding] = INPUTS,
    scale: float = 1.0,
    frame: int = 1,
    size: Size | None = None,
) -> None:
    """Ask for pictures of a graph whose input is PICTURE unless `bindings` say otherwise."""
    preview.want(graph, ports, bindings=bindings, scale=scale, frame=frame, size=size)


def settle(preview: Preview) -> int:
    """Work to the end; how many calls that took."""
    for count in range(1, 100_000):
        if not preview.work(0.0):
            return count
        time.sleep(0.0005)
    raise AssertionError("it never ends")


def pixels(preview: Preview, engine: Renderer, name: str = "A") -> np.ndarray:
    shown = preview.find_whole_image(name)
    assert shown is not None
    return read_texture(engine.device, shown.texture)[..., : shown.channels]


def render_port(engine: Renderer, graph: Graph, port: Port = IMAGE, **rest) -> np.ndarray:
    return engine.render(graph, RenderRequest({"image": PICTURE}, {"x": port}, **rest))["x"]


def count_passes(engine: Renderer) -> int:
    return engine.runner.counters.passes
