"""Lowers a graph only to find its faults: of nodes that lower alike, the first one is lowered.

What lowering a node can refuse depends on its class, its values, and the shapes of what it reads; of a pointwise node
valid numbers decide nothing. A node that agrees in all of these with one that was lowered before stands for the same
operands. So a chain of 100,000 equal nodes takes one operation, and all later stages see few. The pixels of such a
program have no meaning.

A node is no sample if a file, a memory of an earlier frame or the content of other operations decided what it added.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping

from halation.nodes import Node, Pointwise
from msgspec import Struct

from ...errors import GraphError
from ...graph import Graph, Port
from ...resources.provider import ResourceProvider
from ..ir import Builder, LoweredProgram, Operand, PictureShape, Ref
from ..library import Library
from ..request import Request
from . import constants, masks
from .graph_at_frames import Feed, GraphAtFrames
from .lower import Lowering
from .steps import LoweringStep, PortAtOffset, field_port, is_field_port


def lower_samples(graph: Graph, request: Request, library: Library, provider: ResourceProvider) -> LoweredProgram:
    """A program of one node of each sort. Raises the errors of `lower`."""
    lowering = Lowering(graph, request, library, provider, GraphAtFrames(graph), Builder())
    SampleLowering(lowering).lower_nodes()
    return lowering.make_program({})


class LoweredSample(Struct, frozen=True):
    """What a node stands for, and all that agree with it."""

    operands: Mapping[str, Operand]
    """By output; that of a Field by the name that `field_port` gives it."""
    whole_height: float


class SampleLowering:
    """Runs the steps of a lowering, except those of nodes that agree with an earlier one."""

    def __init__(self, lowering: Lowering) -> None:
        self._lowering = lowering
        self._samples: dict[Hashable, LoweredSample] = {}
        self._pointwise: dict[int, Hashable] = {}
        self._has_fields = False

    def lower_nodes(self) -> None:
        """Lower every node that is needed or its sample, then the outputs."""
        for key in self._lowering.list_steps():
            likeness = self._describe(*key)
            sample = self._samples.get(likeness) if likeness is not None else None
            if sample is None:
                step = self._lowering.run_step(key)
                self._has_fields |= any(is_field_port(port) for port, _ in step.results)
                if likeness is not None and _is_sample(step):
                    operands = {
                        port.socket: operand for (port, _), operand in step.results.items() if port.node == key[0]
                    }
                    self._samples[likeness] = LoweredSample(operands, step.whole_height)
            else:
                self._repeat(key, sample)
        self._lowering.run_step(None)

    def _describe(self, path: str, offset: int) -> Hashable | None:
        """All that decides whether a node can be lowered; None where that is not known without lowering it."""
        lowering = self._lowering
        moment = path, lowering.frame + offset
        feeds = tuple([self._describe_feed(name, feed) for name, feed in lowering.frames.find_feeds(moment).items()])
        if None in feeds:
            return None
        flat = lowering.flat
        try:
            node = self._describe_node(path, lowering.frames.node_at(*moment))
        except GraphError:
            return None  # lowering it will raise the error, with the path of the node
        return node, offset, path in flat.muted, flat.find_reference_height(path), feeds

    def _describe_node(self, path: str, node: Node) -> Hashable:
        """What of a node decides whether it can be lowered.

        Valid numbers of a pointwise node decide nothing, except that it may be neutral. Others must be the same object,
        as those are that a file writes alike.
        """
        if not isinstance(node, Pointwise) or node.takes_passes():
            return id(node)
        if id(node) not in self._pointwise:
            constants.check_values(path, node)
            choices = tuple(node.setting(name) for name, value in node.values.items() if value.choices)
            neutral = node.identity(), masks.hides_node(node)
            self._pointwise[id(node)] = type(node), choices, neutral, node.length_units
        return self._pointwise[id(node)]

    def _describe_feed(self, name: str, feed: Feed) -> Hashable | None:
        """What a node sees of a link before it is lowered; None for a link from an input of the graph."""
        source, frames = feed
        seen: list[Hashable] = [name]
        for frame in frames:
            place = source, frame - self._lowering.frame
            operand = self._lowering.results.get(place)
            if operand is None:
                return None
            seen.append(self._describe_operand(operand))
            if self._has_fields:
                seen.append(self._find_field_shape(place))
            if self._lowering.whole_heights:
                seen.append(self._lowering.whole_heights.get((source.node, place[1])))
        return tuple(seen)

    def _describe_operand(self, operand: Operand) -> PictureShape | Operand:
        return self._lowering.builder.shape(operand) if isinstance(operand, Ref) else operand

    def _find_field_shape(self, place: PortAtOffset) -> PictureShape | Operand | None:
        operand = self._lowering.results.get((field_port(place[0]), place[1]))
        return None if operand is None else self._describe_operand(operand)

    def _repeat(self, key: tuple[str, int], sample: LoweredSample) -> None:
        path, offset = key
        for socket, operand in sample.operands.items():
            self._lowering.results[Port(path, socket), offset] = operand
        if sample.whole_height:
            self._lowering.whole_heights[key] = sample.whole_height


def _is_sample(step: LoweringStep) -> bool:
    return not (step.reads_resources or step.inspected or step.memories)
