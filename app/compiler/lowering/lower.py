"""First stage: a graph becomes operations.

Only what the wanted outputs need is lowered. Groups are expanded, muted and neutral nodes vanish, sizes become known,
pictures of the wrong size get a fit, and values arrive in working units.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from itertools import chain
from types import MappingProxyType

from halation.nodes import (
    Camera,
    Filter,
    Image,
    Kind,
    Missing,
    Node,
    Pointwise,
    Reader,
    Size,
    Socket,
    Temporal,
    Value,
    curve_knots,
    ramp_knots,
    working_factor,
)
from msgspec.structs import replace

from ...errors import GraphError, HalationError, ShaderError
from ...graph import INPUTS, OUTPUTS, Graph, Port, did_you_mean
from ...resources.provider import ResourceProvider
from ..ir import Builder, Call, Choice, Constant, Memory, Operand, Parameter, Program, Ref, Shape
from ..library import Library
from ..request import Request
from . import constants
from .draws import Fed, Made, Recorder, choices
from .expand import nothing, stand_in
from .moments import Moments
from .pictures import Pictures
from .steps import Lowered, Place, Shown, Step, Watched


def lower(graph: Graph, request: Request, library: Library, outside: ResourceProvider) -> Lowered:
    """Lower what `request` wants of `graph`. Raises GraphError where the graph is not fit to render."""
    return Lowering(graph, request, library, outside, Moments(graph), Builder()).run()


class Lowering:
    """The work in progress: `results` says what every port visited so far stands for, so many frames from now."""

    def __init__(
        self,
        graph: Graph,
        request: Request,
        library: Library,
        outside: ResourceProvider,
        moments: Moments,
        builder: Builder,
    ) -> None:
        self.graph, self.request, self.library, self.outside = graph, request, library, Watched(outside)
        self.now = request.frame
        self.moments, self.builder = moments, builder
        self.flat = self.moments.flat(self.now)
        self.pictures = Pictures(graph, self.flat, request, self.outside, self.builder)
        self.results: dict[Shown, Operand] = {}
        self.memories: dict[Port, Ref] = {}
        self.cameras: dict[Port, Camera] = {}
        self.outputs: dict[str, Ref] = {}

    def run(self) -> Lowered:
        sources = self.sources()
        order = [(path, frame - self.now) for path, frame in self.moments.order(sources.values(), self.now)]
        steps: dict[Place, Step] = {place: self.step(place) for place in (*order, None)}
        program = Program(
            tuple(self.builder.ops),
            MappingProxyType(self.outputs),
            MappingProxyType(self.memories),
            MappingProxyType(self._materialized()),
            MappingProxyType(self.cameras),
            self.request.scale,
            self.request.frame,
        )
        counts = Counter(chain.from_iterable(step.added for step in steps.values()))
        return Lowered(
            program,
            self.library,
            self.moments,
            self.now,
            self.builder,
            steps,
            self.results,
            counts,
            self.pictures.canvas if self.pictures.measured else None,
        )

    def step(self, place: Place) -> Step:
        """Lower a node at a frame, or at last the outputs."""
        self.builder.added, self.builder.looked, self.outside.asked = [], [], False
        self.at = Step(len(self.builder.ops), self.builder.added, self.builder.looked)
        if place is None:
            self._finish()
        else:
            path, away = place
            try:
                self._node(path, self.now + away)
            except HalationError as error:
                error.node = error.node or path
                raise
        self.at.asked |= self.outside.asked
        self.results |= self.at.shown
        self.memories |= self.at.memories
        self.cameras |= self.at.cameras
        return self.at

    def sources(self) -> dict[str, Port]:
        """What is behind everything wanted, by name."""
        if not self._targets():
            raise GraphError("the graph has no outputs: link something to an output, or name a node to render")
        return {name: self._target(name, port) for name, port in self._targets().items()}

    def _targets(self) -> dict[str, Port]:
        return dict(self.request.targets) or {name: Port(OUTPUTS, name) for name in self.graph.outputs}

    def _materialized(self) -> dict[Port, Ref]:
        """What is not a constant, also by the outputs of groups and the inputs of their bodies."""
        now = ((port, operand) for (port, away), operand in self.results.items() if not away)
        found = {port: operand for port, operand in now if isinstance(operand, Ref)}
        for end in self.flat.links:
            group, slash, side = end.node.rpartition("/")
            if slash and side in (INPUTS, OUTPUTS) and (ref := found.get(self.flat.behind(end))):
                found[Port(group, end.socket) if side == OUTPUTS else end] = ref
        return found

    # --- what feeds what -------------------------------------------------------------------------------------------

    def _target(self, name: str, port: Port) -> Port:
        """The node output or graph input behind something wanted."""
        if port.node == OUTPUTS and port.socket not in self.graph.outputs:
            raise GraphError(f"the graph has no output '{port.socket}'{did_you_mean(port.socket, self.graph.outputs)}")
        if f"{port.node}/" in self.flat.folders:
            port = Port(f"{port.node}/{OUTPUTS}", port.socket)
        side = port.node.rpartition("/")[2]
        source = self.flat.source(port) if side in (INPUTS, OUTPUTS) else None
        if source is None and side == OUTPUTS and port not in self.flat.inputs:
            raise GraphError(f"output '{name}' is not linked to anything: link a node to it", node=f"{port}")
        return source or port

    def _shown(self, target: Port, source: Port) -> Socket | None:
        """What a wanted output is to look like; None for whatever comes."""
        if target.node == OUTPUTS:
            return self.graph.outputs[target.socket].socket()
        if source in self.flat.inputs:
            return self.flat.inputs[source].socket()
        node = self.flat.nodes.get(source.node)
        output = node.outputs.get(source.socket) if node else None
        return output.socket if output else None

    # --- nodes -----------------------------------------------------------------------------------------------------

    def _operand(self, port: Port, frame: int) -> Operand | None:
        """What a source port stands for; None for a graph input that has neither a picture nor a default."""
        known = (port, frame - self.now)
        if known in self.results:
            return self.results[known]
        if known in self.at.shown:
            return self.at.shown[known]
        socket = self.flat.inputs.get(port)
        if socket is None and port.node.endswith("/" + OUTPUTS):
            group = port.node.removesuffix("/" + OUTPUTS)
            fault = f"group '{group}': nothing inside it is linked to its output '{port.socket}'"
            raise GraphError(fault, node=group)
        node = self.flat.nodes.get(port.node)
        if node is not None and port.socket in node.outputs:
            fault = f"node '{port.node}': its file holds nothing for its output '{port.socket}'"
            raise GraphError(fault, node=port.node)
        if socket is None:
            raise GraphError(
                f"'{port}' does not exist: link to an output of a node or to an input of the graph", node=port.node
            )
        picture = self.pictures.named.bound(port, socket)
        if picture is not None:
            made = self.pictures.read(picture, f"{port}", frame, self._missing(socket.missing, frame))
        elif socket.default is not None:
            made = constants.of_input(port, socket)
        else:
            return None
        self.at.shown[known] = made
        return made

    def _finish(self) -> None:
        """Every output that is wanted, as its pixels."""
        targets = self._targets()
        self.outputs = {
            name: self._finished(port, name, self._shown(targets[name], port)) for name, port in self.sources().items()
        }

    def _finished(self, port: Port, name: str, shown: Socket | None) -> Ref:
        """What an output shows, as pixels of its type; a constant fills the canvas unless one value is wanted."""
        operand = self._operand(port, self.now)
        if operand is None:
            raise GraphError(
                f"output '{name}' shows the graph input '{port.socket}', which is not bound to a picture: "
                "give it a file, or bind it by name",
                node=f"{port}",
            )
        shown = shown or Image()
        if shown.kind is Kind.CAMERA:
            raise GraphError(f"output '{name}' is a camera, which is no picture: choose another one", node=f"{port}")
        if isinstance(operand, Constant):
            size = (1, 1) if shown.single else self.pictures.canvas
            return self.pictures.converted(operand, shown, size, name)
        return self._as_type(operand, shown, name)

    def _node(self, path: str, frame: int) -> None:
        node = self.moments.node(path, frame)
        constants.check_values(path, node)
        fed = self._fed(path, frame, node)
        if frame == self.now:
            cameras = {name: fed.inputs[name] for name in fed.linked if node.inputs[name].kind is Kind.CAMERA}
            self.at.cameras = {
                Port(path, name): Camera(rows)
                for name, given in cameras.items()
                if isinstance(given, Constant) and isinstance(rows := given.value, tuple) and any(rows)
            }
        size = self._size(fed)
        through = self._through(fed)
        if through is not None:
            for name, passed in through.items():
                fitted = self.pictures.fit(passed, size, path) if isinstance(passed, Ref) else passed
                self.at.shown[Port(path, name), frame - self.now] = fitted
            return
        self._fit_all(fed, size)
        working = node.working(self.request.scale, size[1])
        if isinstance(working, Pointwise):
            self._pointwise(replace(fed, node=working), working, size)
        elif isinstance(working, Filter):
            self._filter(replace(fed, node=working), working, size)

    def _fed(self, path: str, frame: int, node: Node) -> Fed:
        """A node and all that it reads."""
        fed = Fed(path, frame, node)
        feeding = self.moments.feeding((path, frame))
        for name, socket in node.inputs.items():
            source, frames = feeding.get(name, (None, ()))
            found = {at: made for at in frames if source and (made := self._operand(source, at)) is not None}
            if found:
                fed.inputs[name] = found[frame] if frame in found else next(iter(found.values()))
                fed.others.update({(name, at): made for at, made in found.items()})
                fed.linked.add(name)
            elif socket.optional:
                fed.inputs[name] = Constant(constants.of_socket(socket))
            elif source is not None:
                raise GraphError(
                    f"node '{path}': input '{name}' comes from the graph input '{source.socket}', which is not bound "
                    "to a picture: give it a file, or bind it by name"
                )
            else:
                wanted = "camera" if socket.kind is Kind.CAMERA else "picture"
                raise GraphError(f"node '{path}': input '{name}' is not linked: link a {wanted} to it")
        for name in node.values:
            source, _ = feeding.get(name, (None, ()))
            operand = self._operand(source, frame) if source is not None else None
            if operand is not None:
                fed.wires[name] = operand
        return fed

    def _fit_all(self, fed: Fed, size: Size) -> None:
        """Bring every picture to one size: that of the result, or for a filter, which may resize, of the first one."""
        as_it_is = {name for name, socket in fed.node.inputs.items() if socket.own_size}
        named = (*fed.inputs.items(), *fed.wires.items())
        refs = [operand for name, operand in named if isinstance(operand, Ref) and name not in as_it_is]
        sizes = [found for found in (self.builder.shape(ref).size for ref in refs) if found != (1, 1)]
        wanted = sizes[0] if sizes and isinstance(fed.node, Filter) else size
        if all(found == wanted for found in sizes) and all(frame == fed.frame for _, frame in fed.others):
            return

        def fitted(name: str, operand: Operand) -> Operand:
            if isinstance(operand, Constant) or name in as_it_is:
                return operand
            return self.pictures.fit(operand, wanted, fed.path)

        for group in (fed.inputs, fed.wires):
            group.update({name: fitted(name, operand) for name, operand in group.items()})
        fed.others.update({key: fitted(key[0], operand) for key, operand in fed.others.items()})

    def _through(self, fed: Fed) -> dict[str, Operand] | None:
        """What the outputs of a muted or neutral node show; None if it has something to do."""
        node = fed.node
        if fed.path in self.flat.muted:
            found = {name: stand_in(output.socket, node.inputs) for name, output in node.outputs.items()}
            return {
                name: fed.inputs[by] if by else Constant(nothing(node.outputs[name].socket))
                for name, by in found.items()
            }
        neutral = None if fed.wires or len(node.outputs) != 1 else node.identity()
        return dict.fromkeys(node.outputs, fed.inputs[neutral]) if neutral else None

    def _size(self, fed: Fed) -> Size:
        """The size of a node's outputs. What is made of single values alone is one, unless it is a pattern."""
        inputs = {name: fed.inputs[name] for name in fed.node.inputs if name in fed.linked}
        found = {
            name: self.builder.shape(operand).size
            for name, operand in (*inputs.items(), *fed.wires.items())
            if isinstance(operand, Ref)
        }
        pictures = {name: size for name, size in found.items() if size != (1, 1)}
        if found and not pictures and (found.keys() & inputs.keys() or not self._is_pattern(fed.path, fed.node)):
            return (1, 1)
        return fed.node.output_size(pictures, self.pictures.canvas)

    def _is_pattern(self, path: str, node: Node) -> bool:
        """True for a node whose pixels differ even if all that it reads is the same everywhere."""
        return not node.inputs or self.library.uses(node.shader, frozenset({"pixel", "extent"}), path)

    def _pointwise(self, fed: Fed, node: Pointwise, size: Size) -> None:
        parameters: list[Parameter] = []
        for name in node.order:
            if name in node.inputs:
                parameters.append(Parameter(node.inputs[name].glsl, fed.inputs[name]))
            elif node.values[name].glsl is not None:
                parameters.append(self._value(node, node.values[name], fed.wires.get(name), size))
        sockets = [output.socket for output in node.outputs.values()]
        shapes = tuple(
            Shape((1, 1) if socket.single else size, socket.channels, socket.kind is not Kind.IMAGE)
            for socket in sockets
        )
        self._check_function(fed.path, node, [item.glsl for item in parameters], [item.glsl for item in sockets])
        ref = self.builder.add(Call(shapes, fed.path, node.shader, node.function, tuple(parameters), choices(node)))
        for index, name in enumerate(node.outputs):
            self.at.shown[Port(fed.path, name), fed.frame - self.now] = Ref(ref.op, index)

    def _check_function(self, path: str, node: Node, taken: list[str], made: list[str]) -> None:
        """Raise ShaderError unless the node's GLSL function takes and makes what the node declares."""
        found = self.library.function(node.shader, node.function, path)
        outputs = [glsl for glsl, _ in found.outputs] or [found.result]
        if [glsl for glsl, _ in found.parameters] != taken or outputs != made:
            said, wanted = (
                f"({', '.join(a)}) to ({', '.join(b)})"
                for a, b in (
                    ([glsl for glsl, _ in found.parameters], outputs),
                    (taken, made),
                )
            )
            fault = f"'{node.function}' takes {said}, but the node declares {wanted}"
            raise ShaderError(path, self.library.file(node.shader), found.line, fault)

    def _value(self, node: Node, value: Value, wire: Operand | None, size: Size) -> Parameter:
        glsl = value.glsl or "float"
        if wire is not None:
            factor = working_factor(value.unit, self.request.scale, size[1])
            if isinstance(wire, Constant):
                return Parameter(glsl, constants.limited(wire, value, factor))
            return Parameter(glsl, wire, factor, value.minimum, value.maximum)
        now = getattr(node, value.name)
        if value.type == "choice":
            return Parameter(glsl, Choice(value.choices.index(now)))
        knots = {"curve": curve_knots, "ramp": ramp_knots}.get(value.type)
        return Parameter(glsl, Constant(knots(now) if knots else now))

    def _filter(self, fed: Fed, node: Filter, size: Size) -> None:
        path, remembers = fed.path, isinstance(node, Temporal)
        if remembers and fed.frame != self.now:
            raise GraphError(
                f"node '{path}' makes every frame of the one before, so it cannot be seen at frame {fed.frame} while "
                f"frame {self.now} is rendered: put what changes the time before '{path}'"
            )
        for name in fed.linked:
            fed.inputs[name] = self._as_pixels(path, node.inputs[name], fed.inputs[name], size)
        for (name, frame), operand in fed.others.items():
            fed.others[name, frame] = self._as_pixels(path, node.inputs[name], operand, size)
        settings = self.graph.settings
        missing = fed.node.missing if isinstance(fed.node, Reader) else "error"
        recorder = Recorder(
            fed,
            node,
            size,
            self.builder,
            self.library,
            self.pictures.files(fed, self._missing(missing, fed.frame)),
            self._remembered(path) if remembers else {},
            settings.rate,
            (settings.frames or (1, 1))[0],
        )
        drawn = node.passes(recorder)
        self.at.memories = {Port(path, name): ref for name, ref in recorder.remembered.items()}
        self.at.timed = recorder.timed
        made = drawn if isinstance(drawn, Mapping) else {next(iter(node.outputs)): drawn}
        for name, item in made.items():
            assert isinstance(item, Made | Camera)
            result = Constant(item.rows) if isinstance(item, Camera) else item.ref
            self.at.shown[Port(path, name), fed.frame - self.now] = result

    def _remembered(self, path: str) -> dict[str, Memory]:
        """What a node remembered of the frame before, by name."""
        self.at.asked = True
        return {port.socket: memory for port, memory in self.request.memories.items() if port.node == path}

    def _as_pixels(self, path: str, socket: Socket, operand: Operand, size: Size) -> Operand:
        """A filter looks around in its input: give it real pixels with the channels that it declares."""
        if socket.single or socket.kind is Kind.CAMERA:
            return operand
        if isinstance(operand, Constant):
            return self.pictures.converted(operand, socket, size, path)
        return self._as_type(operand, socket, path)

    def _as_type(self, ref: Ref, socket: Socket, owner: str) -> Ref:
        """The same pixels with the channels that a socket declares."""
        made = self.builder.shape(ref)
        return ref if made.channels == socket.channels else self.pictures.converted(ref, socket, made.size, owner)

    def _missing(self, wanted: Missing, frame: int) -> Missing:
        """What stands for a missing file. Nodes may look beyond the ends of a shot: those stay as they are."""
        return "hold" if wanted == "error" and frame != self.now else wanted
