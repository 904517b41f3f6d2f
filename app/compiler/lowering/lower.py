"""Lowers a graph: its nodes become operations.

Only nodes that the requested outputs need are lowered. Groups are expanded, muted and neutral nodes disappear, sizes
are determined, pictures of another size get a fit, and values are converted to working units. The docstring of this
package explains the steps.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from itertools import chain
from types import MappingProxyType

from halation.nodes import CameraModel, Field, Image, Socket

from ...errors import GraphError, HalationError
from ...graph import INPUTS, OUTPUTS, Graph, Port, did_you_mean
from ...resources.provider import ResourceProvider
from ..ir import Builder, LoweredProgram, Operand, Ref, UniformConstant
from ..library import Library
from ..request import Request
from . import constants
from .context import LoweringContext
from .graph_at_frames import GraphAtFrames
from .node_inputs import takes_field
from .node_lowering import NodeLowering
from .pictures import PictureBuilder
from .steps import LoweringRecord, LoweringStep, PortAtOffset, StepKey, WatchedProvider, field_port


def lower(graph: Graph, request: Request, library: Library, provider: ResourceProvider) -> LoweringRecord:
    """Lower the requested outputs of `graph`. Raises GraphError for a graph that cannot be rendered."""
    return Lowering(graph, request, library, provider, GraphAtFrames(graph), Builder()).run()


class Lowering:
    """The state of lowering one graph. `results` are the operands of all ports lowered so far, by port and frame.

    `find_sources` and `run_step` are public for `incremental`, which lowers single nodes again, and `samples`.
    """

    def __init__(
        self,
        graph: Graph,
        request: Request,
        library: Library,
        provider: ResourceProvider,
        frames: GraphAtFrames,
        builder: Builder,
    ) -> None:
        self.graph, self.request, self.library, self.provider = graph, request, library, WatchedProvider(provider)
        self.frame = request.frame
        self.frames, self.builder = frames, builder
        self.flat = self.frames.flat_at(self.frame)
        self.pictures = PictureBuilder(graph, self.flat, request, self.provider, self.builder)
        self.whole_heights: dict[StepKey, float] = {}
        self.nodes = NodeLowering(
            LoweringContext(
                graph,
                request,
                library,
                self.frame,
                frames,
                builder,
                self.flat,
                self.pictures,
                self.whole_heights,
            )
        )
        self.results: dict[PortAtOffset, Operand] = {}
        self.memories: dict[Port, Ref] = {}
        self.cameras: dict[Port, CameraModel] = {}
        self.outputs: dict[str, Ref] = {}

    def run(self) -> LoweringRecord:
        """Lower every node that is needed, each after those that it reads, then the outputs.

        A step is kept under its node and its distance from the frame, so that `incremental` finds it again at another
        frame. The step of the outputs has the key None.
        """
        steps: dict[StepKey, LoweringStep] = {key: self.run_step(key) for key in (*self.list_steps(), None)}
        return LoweringRecord(
            self.make_program(self._find_results()),
            self.library,
            self.frames,
            self.frame,
            self.builder,
            steps,
            self.results,
            Counter(chain.from_iterable(step.added for step in steps.values())),
            self.pictures.canvas if self.pictures.canvas_is_read else None,
        )

    def list_steps(self) -> list[tuple[str, int]]:
        """The nodes that are needed, with how many frames after the rendered one, each after those that it reads."""
        sources = self.find_sources().values()
        return [(path, frame - self.frame) for path, frame in self.frames.find_order(sources, self.frame)]

    def make_program(self, ports: Mapping[Port, Ref]) -> LoweredProgram:
        """The program of all that has been lowered; `ports` are the pictures that ports stand for."""
        return LoweredProgram(
            tuple(self.builder.ops),
            MappingProxyType(self.outputs),
            MappingProxyType(self.memories),
            MappingProxyType(ports),
            MappingProxyType(self.cameras),
            self.request.scale,
            self.request.frame,
        )

    def run_step(self, key: StepKey) -> LoweringStep:
        """Lower one node at a frame, or for None the outputs."""
        self.builder.added, self.builder.inspected, self.provider.is_read = [], [], False
        self.step = LoweringStep(len(self.builder.ops), self.builder.added, self.builder.inspected)
        if key is None:
            self._lower_outputs()
        else:
            path, offset = key
            try:
                self.nodes.lower(path, self.frame + offset, self.step, self._find_operand)
            except HalationError as error:
                error.node = error.node or path
                raise
        if self.step.whole_height:
            self.whole_heights[key] = self.step.whole_height
        self.step.reads_resources |= self.provider.is_read
        self.results |= self.step.results
        self.memories |= self.step.memories
        self.cameras |= self.step.cameras
        return self.step

    # --- sources -----------------------------------------------------------------------------------------------------

    def find_sources(self) -> dict[str, Port]:
        """The node output or graph input behind everything that is requested, by name."""
        targets = self._find_targets()
        if not targets:
            raise GraphError("the graph has no outputs: link something to an output, or name a node to render")
        return {name: self._find_source(name, port) for name, port in targets.items()}

    def _find_targets(self) -> dict[str, Port]:
        return dict(self.request.targets) or {name: Port(OUTPUTS, name) for name in self.graph.outputs}

    def _find_source(self, name: str, port: Port) -> Port:
        if port.node == OUTPUTS and port.socket not in self.graph.outputs:
            raise GraphError(f"the graph has no output '{port.socket}'{did_you_mean(port.socket, self.graph.outputs)}")
        if f"{port.node}/" in self.flat.folders:
            port = Port(f"{port.node}/{OUTPUTS}", port.socket)
        side = port.node.rpartition("/")[2]
        source = self.flat.find_source(port) if side in (INPUTS, OUTPUTS) else None
        if source is None and side == OUTPUTS and port not in self.flat.inputs:
            raise GraphError(f"output '{name}' is not linked to anything: link a node to it", node=f"{port}")
        return source or port

    def _find_operand(self, port: Port, frame: int, as_field: bool) -> Operand | None:
        """The operand of a source port; None for a graph input that has neither a picture nor a default.

        With `as_field` that of its Field, if the port carries one besides its Image. An input of the graph has no step
        of its own: the first step that reads it lowers it, and is replayed when its file changes.
        """
        if as_field and (operand := self._find_field(port, frame)) is not None:
            return operand
        key = (port, frame - self.frame)
        if key in self.results:
            return self.results[key]
        if key in self.step.results:
            return self.step.results[key]
        socket = self.flat.inputs.get(port)
        if socket is None and port.node.endswith("/" + OUTPUTS):
            group = port.node.removesuffix("/" + OUTPUTS)
            fault = f"group '{group}': nothing inside it is linked to its output '{port.socket}'"
            raise GraphError(fault, node=group)
        node = self.flat.nodes.get(port.node)
        if node is not None and port.socket in node.outputs:
            fault = (
                f"node '{port.node}': its file has no layer for its output '{port.socket}': choose one, or unlink "
                "the output"
            )
            raise GraphError(fault, node=port.node)
        if socket is None:
            raise GraphError(
                f"'{port}' does not exist: link to an output of a node or to an input of the graph", node=port.node
            )
        picture = self.pictures.named.find_bound(port, socket)
        if picture is not None:
            operand = self.pictures.read(picture, f"{port}", frame, self.nodes.choose_missing(socket.missing, frame))
        elif socket.default is not None:
            operand = constants.make_input_constant(port, socket)
        else:
            return None
        self.step.results[key] = operand
        return operand

    def _find_field(self, port: Port, frame: int) -> Operand | None:
        key = (field_port(port), frame - self.frame)
        return self.results.get(key) or self.step.results.get(key)

    # --- outputs -----------------------------------------------------------------------------------------------------

    def _lower_outputs(self) -> None:
        targets = self._find_targets()
        self.outputs = {
            name: self._lower_output(source, name, self._find_type(targets[name], source))
            for name, source in self.find_sources().items()
        }

    def _lower_output(self, source: Port, name: str, socket: Socket | None) -> Ref:
        """The pixels of an output in its type. A constant fills the canvas, except a single value."""
        operand = self._find_operand(source, self.frame, takes_field(socket or Image()))
        if operand is None:
            raise GraphError(
                f"output '{name}' shows the graph input '{source.socket}', which is not bound to a picture: "
                "give it a file, or bind it by name",
                node=f"{source}",
            )
        socket = socket or Image()
        if socket.kind.is_planned:
            fault = f"output '{name}' is a {socket.kind.facts.noun}, which is no picture: choose another one"
            raise GraphError(fault, node=f"{source}")
        if isinstance(operand, UniformConstant):
            size = (1, 1) if socket.single else self.pictures.canvas
            return self.pictures.convert(operand, socket, size, name)
        return self.nodes.convert_type(operand, socket, name)

    def _find_type(self, target: Port, source: Port) -> Socket | None:
        """The type that a requested output declares; None if it takes any."""
        if target.node == OUTPUTS:
            return self.graph.outputs[target.socket].socket()
        if source in self.flat.inputs:
            return self.flat.inputs[source].socket()
        if target == source and self._find_field(source, self.frame) is not None:
            return Field()
        node = self.flat.nodes.get(source.node)
        output = node.outputs.get(source.socket) if node else None
        return output.socket if output else None

    def _find_results(self) -> dict[Port, Ref]:
        """The pictures of all ports at the rendered frame, with those of the outputs of groups and inputs of bodies."""
        at_frame = ((port, operand) for (port, offset), operand in self.results.items() if not offset)
        refs = {port: operand for port, operand in at_frame if isinstance(operand, Ref)}
        for end in self.flat.links:
            group, slash, side = end.node.rpartition("/")
            if slash and side in (INPUTS, OUTPUTS) and (ref := refs.get(self.flat.follow(end))):
                refs[Port(group, end.socket) if side == OUTPUTS else end] = ref
        return refs
