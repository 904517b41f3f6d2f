"""What a game gives to the inputs of a graph that draws over it: its picture, the depth and normals."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec
import numpy as np
from halation.nodes import Kind

from ..color.management import get_color_manager
from ..errors import GraphError
from ..graph import INPUTS, OUTPUTS, Graph, Port, color_settings
from .order import ExportOrder
from .package import Package, assemble_package
from .package.curves import Record

PICTURE, DEPTH, NORMAL = "picture", "depth", "normal"

USUAL_SIZE = (1920, 1080)
"""The pixels of a game if nobody says: those of most screens (Steam hardware survey, 2025)."""

_PICTURES = ("beauty", "image", "picture")
"""Names by which inputs are the picture itself, where there are several inputs with color."""


def find_roles(graph: Graph) -> dict[str, str]:
    """What a game gives for inputs of a graph by name: the picture, its depth, or normals."""
    colors = [name for name, end in graph.inputs.items() if end.kind is Kind.IMAGE]
    chosen = next((name for name in _PICTURES if name in colors), colors[0] if len(colors) == 1 else "")
    roles: dict[str, str] = {}
    for name, end in graph.inputs.items():
        if name == chosen:
            roles[name] = PICTURE
        elif end.kind is Kind.FIELD and name == DEPTH:
            roles[name] = DEPTH
        elif end.kind is Kind.VECTOR and name == NORMAL:
            roles[name] = NORMAL
    return roles


def assemble_for_game(order: ExportOrder, host: str, light: str) -> Package:
    """The package of a graph that `host` draws, whose light is linear Rec.709: `light` says so in words.

    Raises GraphError for other working spaces, for layers that no game gives and for meshes; the errors of compiling.
    """
    if not get_color_manager(color_settings(order.graph), order.sandbox).is_plain:
        raise GraphError(f"its working space is not linear Rec.709, which {light}")
    _refuse_layers(order.graph, order.target, host)
    size = order.size or USUAL_SIZE
    inputs = {**order.inputs, **_bind_blank(order.graph, size)}
    return assemble_package(msgspec.structs.replace(order, size=size, inputs=inputs), host)


def _bind_blank(graph: Graph, size: tuple[int, int]) -> dict[str, np.ndarray]:
    """Pictures of a size for what the game gives. Nobody reads their pixels, but passes are planned for their size."""
    width, height = size
    channels = {PICTURE: 4, DEPTH: 1, NORMAL: 3}
    return {name: np.zeros((height, width, channels[role]), np.float32) for name, role in find_roles(graph).items()}


def _refuse_layers(graph: Graph, target: Port, host: str) -> None:
    """Raise GraphError for a layer that a picture of the graph needs and no game gives. `host` is what reads it."""
    shown = graph.links.get(target) if target.node == OUTPUTS else target
    needed = {shown.node, *graph.upstream(shown.node)} if shown else set[str]()
    read = [start.socket for end, start in graph.links.items() if start.node == INPUTS and end.node in needed]
    for name in sorted({*read, *([shown.socket] if shown and shown.node == INPUTS else ())} - find_roles(graph).keys()):
        if graph.inputs[name].file or graph.inputs[name].kind is Kind.IMAGE:
            raise GraphError(
                f"it reads the input '{name}', and {host} has the picture, its depth and normals alone: "
                "link a node in place of the layer",
                node=f"{INPUTS}.{name}",
            )


def choose_roles(graph: Graph, sources: list[Record], used: set[int]) -> dict[int, str]:
    """What a game gives for each used source that is an input of the graph, by number."""
    known = find_roles(graph)
    inputs = {at: sources[at]["name"] for at in sorted(used) if sources[at]["is_end"]}
    return {at: known[name] for at, name in inputs.items() if name in known}


def list_plans(document: Record) -> Iterator[Record]:
    """The passes of all variants, for the first frame and those after it."""
    return (plan for variants in document["plans"] for plan in variants)


def choose_used_roles(graph: Graph, document: Record) -> dict[int, str]:
    """What a game gives for each source that any plan reads, by number."""
    surfaces = (surface for plan in list_plans(document) for surface in plan["surfaces"])
    return choose_roles(graph, document["sources"], {each["source"] for each in surfaces if "source" in each})
