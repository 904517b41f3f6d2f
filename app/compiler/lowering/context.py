"""What nodes are lowered with, and what they have in common."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any

from halation.nodes import Kind, Pointwise, Size, Value
from msgspec import Struct

from ...graph import Graph
from ..ir import Builder, PictureShape
from ..library import Library
from ..request import Request
from . import constants
from .expand import FlatGraph
from .graph_at_frames import GraphAtFrames
from .pictures import PictureBuilder
from .steps import LoweringStep, StepKey


class LoweringContext(Struct, frozen=True):
    """What all nodes of a graph are lowered with. `frame` is the one that is rendered."""

    graph: Graph
    request: Request
    library: Library
    frame: int
    frames: GraphAtFrames
    builder: Builder
    flat: FlatGraph
    pictures: PictureBuilder
    whole_heights: Mapping[StepKey, float]
    """Heights of the pictures that results were cut out of."""


class PointwiseForm(Struct, frozen=True):
    """What all pointwise nodes of a class have in common whose outputs have one size.

    `arguments` are those of the GLSL function: the name, the GLSL type, and the value, or None for an input.
    """

    arguments: tuple[tuple[str, str, Value | None], ...]
    shapes: tuple[PictureShape, ...]
    choices: tuple[tuple[str, tuple[str, ...]], ...]
    outputs: tuple[str, ...]
    """The GLSL types of the outputs."""


@lru_cache(1024)
def find_pointwise_form(kind: type[Pointwise], size: Size) -> PointwiseForm:
    """What the pointwise nodes of a class have in common: a graph may have 100,000 nodes of one class."""
    declared = [(name, kind.inputs.get(name) or kind.values[name]) for name in kind.order]
    sockets = [output.socket for output in kind.outputs.values()]
    return PointwiseForm(
        tuple(
            (name, item.glsl, item if isinstance(item, Value) else None)
            for name, item in declared
            if item.glsl is not None
        ),
        tuple(
            PictureShape((1, 1) if socket.single else size, socket.channels, socket.kind is not Kind.IMAGE)
            for socket in sockets
        ),
        constants.find_choices(kind),
        tuple(socket.glsl for socket in sockets),
    )


def find_settings(context: LoweringContext, path: str, step: LoweringStep, time: float) -> Mapping[str, Any]:
    """The values of a node at a time in frames, in working units."""
    node = context.frames.node_between(path, time)
    constants.check_values(path, node)
    reference = context.flat.find_reference_height(path)
    return node.to_working_units(context.request.scale, step.length_height, reference).settings
