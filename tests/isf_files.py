"""Small shaders in the Interactive Shader Format for tests, and nodes made of them."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
from halation.custom_nodes import Code, CustomNode, node_type
from halation.graph import Graph, Input, Output, Port, Settings
from halation.nodes import Kind

Array = np.ndarray
IMAGE = {"NAME": "inputImage", "TYPE": "image"}


def isf(body: str, *inputs: dict[str, Any], **head: Any) -> str:
    """The text of a shader; `body` is its GLSL, or what is in `main`."""
    code = body if "void main" in body else f"void main() {{\n{body}\n}}"
    return f"/*{json.dumps({'ISFVSN': '2', 'INPUTS': list(inputs), **head})}*/\n{code}\n"


def shader(text: str, vertex: str = "", file: str = "") -> type[CustomNode]:
    """The class of its nodes."""
    return node_type(Code("isf", text, file, vertex))


def node(body: str, *inputs: dict[str, Any], values: dict[str, Any] | None = None, **head: Any) -> CustomNode:
    """A node that computes with linear light, straight."""
    return shader(isf(body, *inputs, **head))(**{"light": "linear", **(values or {})})


def graph_of_node(
    item: CustomNode, size: tuple[int, int], frames: tuple[int, int] = (1, 9), rate: float = 24.0
) -> Graph:
    """A graph of one node; its pictures are inputs by their own names."""
    graph = Graph(settings=Settings(size, frames, rate)).add("shader", item).add_output("out", Output(Kind.IMAGE, 4))
    for name, socket in item.inputs.items():
        graph = graph.add_input(name, Input(socket.kind, socket.channels)).connect(
            Port("inputs", name), Port("shader", name)
        )
    return graph.connect(Port("shader", "out"), Port("outputs", "out"))


def opaque(height: int, width: int, seed: int = 1) -> Array:
    """Random light that covers."""
    pixels = np.random.default_rng(seed).random((height, width, 4)).astype(np.float32)
    pixels[..., 3] = 1.0
    return pixels


def decode_srgb(code: Array) -> Array:
    """sRGB display values as light (IEC 61966-2-1)."""
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def encode_srgb(light: Array) -> Array:
    """The inverse."""
    return np.where(light <= 0.0031308, light * 12.92, 1.055 * np.maximum(light, 0) ** (1 / 2.4) - 0.055)
