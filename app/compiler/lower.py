"""First stage: a graph becomes operations.

Only what the wanted outputs need is lowered. Groups are expanded, muted and neutral nodes vanish, sizes become known,
pictures of the wrong size get a fit, and values arrive in working units.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

from ...nodes import (
    Camera,
    ColorChange,
    Filter,
    Image,
    Kind,
    LookupFile,
    Node,
    Pointwise,
    Scene,
    SceneFile,
    Size,
    Socket,
    Value,
    curve_knots,
    ramp_knots,
    working_factor,
)
from ..errors import GraphError, HalationError, ShaderError
from ..graph import INPUTS, OUTPUTS, Graph, Port, did_you_mean
from . import constants
from .draws import Files, Made, Recorder, choices, shader
from .expand import Flat, expand, nothing, stand_in
from .ir import Builder, Call, Choice, Constant, Operand, Parameter, Picture, Program, Ref, Shape
from .library import Library
from .outside import Outside
from .pictures import Pictures
from .raster import Mesh
from .recolor import ColorProgram
from .request import Request


def lower(graph: Graph, request: Request, library: Library, outside: Outside) -> Program:
    """Lower what `request` wants of `graph`. Raises GraphError where the graph is not fit to render."""
    return _Lowering(graph, request, library, outside).run()


class _Lowering:
    """The work in progress: `results` says what every port visited so far stands for."""

    def __init__(self, graph: Graph, request: Request, library: Library, outside: Outside) -> None:
        self.graph, self.request, self.library, self.outside = graph, request, library, outside
        self.flat: Flat = expand(graph)
        self.builder = Builder()
        self.pictures = Pictures(graph, self.flat, request, outside, self.builder)
        self.results: dict[Port, Operand] = {}
        self.memories: dict[str, Ref] = {}
        self.cameras: dict[Port, Camera] = {}

    def run(self) -> Program:
        targets = dict(self.request.targets) or {name: Port(OUTPUTS, name) for name in self.graph.outputs}
        if not targets:
            raise GraphError("the graph has no outputs: link something to an output, or name a node to render")
        sources = {name: self._target(name, port) for name, port in targets.items()}
        for node in self.flat.order(sources.values()):
            try:
                self._node(node)
            except HalationError as error:
                error.node = error.node or node
                raise
        outputs = {name: self._finished(port, name, self._shown(targets[name], port)) for name, port in sources.items()}
        return Program(
            tuple(self.builder.ops), MappingProxyType(outputs), MappingProxyType(self.memories),
            MappingProxyType(self._materialized()), MappingProxyType(self.cameras), self.request.scale,
            self.request.frame,
        )

    def _materialized(self) -> dict[Port, Ref]:
        """What is not a constant, also by the outputs of groups and the inputs of their bodies."""
        found = {port: operand for port, operand in self.results.items() if isinstance(operand, Ref)}
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

    def _operand(self, port: Port) -> Operand | None:
        """What a source port stands for; None for a graph input that has neither a picture nor a default."""
        if port in self.results:
            return self.results[port]
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
        picture = self.pictures.bound(port, socket)
        if picture is not None:
            self.results[port] = self.pictures.read(picture, f"{port}")
        elif socket.default is not None:
            self.results[port] = constants.of_input(port, socket)
        else:
            return None
        return self.results[port]

    def _finished(self, port: Port, name: str, shown: Socket | None) -> Ref:
        """What an output shows, as pixels of its type; a constant fills the canvas unless one value is wanted."""
        operand = self._operand(port)
        if operand is None:
            raise GraphError(
                f"output '{name}' shows the graph input '{port.socket}', which is not bound to a picture: "
                "give it a file, or bind it by name", node=f"{port}",
            )
        shown = shown or Image()
        if shown.kind is Kind.CAMERA:
            raise GraphError(f"output '{name}' is a camera, which is no picture: choose another one", node=f"{port}")
        if isinstance(operand, Constant):
            size = (1, 1) if shown.single else self.pictures.canvas
            return self.pictures.converted(operand, shown, size, name)
        return self._as_type(operand, shown, name)

    def _inputs(self, path: str, node: Node) -> tuple[dict[str, Operand], frozenset[str]]:
        """What every input reads, and which of them are linked."""
        found: dict[str, Operand] = {}
        linked: set[str] = set()
        for name, socket in node.inputs.items():
            source = self.flat.source(Port(path, name))
            operand = self._operand(source) if source is not None else None
            if operand is not None:
                found[name] = operand
                linked.add(name)
            elif socket.optional:
                found[name] = Constant(constants.of_socket(socket))
            elif source is not None:
                raise GraphError(
                    f"node '{path}': input '{name}' comes from the graph input '{source.socket}', which is not bound "
                    "to a picture: give it a file, or bind it by name"
                )
            else:
                wanted = "camera" if socket.kind is Kind.CAMERA else "picture"
                raise GraphError(f"node '{path}': input '{name}' is not linked: link a {wanted} to it")
        return found, frozenset(linked)

    def _node(self, path: str) -> None:
        node = self.flat.nodes[path]
        constants.check_values(path, node)
        operands, linked = self._inputs(path, node)
        self.cameras |= {
            Port(path, name): Camera(rows) for name in linked if node.inputs[name].kind is Kind.CAMERA
            and isinstance(given := operands[name], Constant) and isinstance(rows := given.value, tuple) and any(rows)
        }
        wires: dict[str, Operand] = {}
        for name in node.values:
            source = self.flat.source(Port(path, name))
            operand = self._operand(source) if source is not None else None
            if operand is not None:
                wires[name] = operand
        size = self._size(path, node, operands, wires, linked)
        through = self._through(path, node, operands, wires)
        if through is not None:
            for name, passed in through.items():
                fitted = self.pictures.fit(passed, size, path) if isinstance(passed, Ref) else passed
                self.results[Port(path, name)] = fitted
            return
        self._fit_all(path, node, operands, wires, size)
        working = node.working(self.request.scale, size[1])
        if isinstance(working, Pointwise):
            self._pointwise(path, working, operands, wires, size)
        elif isinstance(working, Filter):
            self._filter(path, working, operands, linked, size)

    def _fit_all(
        self, path: str, node: Node, operands: dict[str, Operand], wires: dict[str, Operand], size: Size
    ) -> None:
        """Bring every picture to one size: that of the result, or for a filter, which may resize, of the first one."""
        as_it_is = {name for name, socket in node.inputs.items() if socket.own_size}
        named = (*operands.items(), *wires.items())
        refs = [operand for name, operand in named if isinstance(operand, Ref) and name not in as_it_is]
        sizes = [found for found in (self.builder.shape(ref).size for ref in refs) if found != (1, 1)]
        wanted = sizes[0] if sizes and isinstance(node, Filter) else size
        for group in (operands, wires):
            for name, operand in group.items():
                if isinstance(operand, Ref) and name not in as_it_is:
                    group[name] = self.pictures.fit(operand, wanted, path)

    def _through(
        self, path: str, node: Node, operands: Mapping[str, Operand], wires: Mapping[str, Operand]
    ) -> dict[str, Operand] | None:
        """What the outputs of a muted or neutral node show; None if it has something to do."""
        if path in self.flat.muted:
            found = {name: stand_in(output.socket, node.inputs) for name, output in node.outputs.items()}
            return {
                name: operands[by] if by else Constant(nothing(node.outputs[name].socket)) for name, by in found.items()
            }
        neutral = None if wires or len(node.outputs) != 1 else node.identity()
        return dict.fromkeys(node.outputs, operands[neutral]) if neutral else None

    def _size(
        self, path: str, node: Node, operands: Mapping[str, Operand], wires: Mapping[str, Operand],
        linked: frozenset[str],
    ) -> Size:
        """The size of a node's outputs. What is made of single values alone is one, unless it is a pattern."""
        inputs = {name: operands[name] for name in node.inputs if name in linked}
        found = {
            name: self.builder.shape(operand).size
            for name, operand in (*inputs.items(), *wires.items()) if isinstance(operand, Ref)
        }
        pictures = {name: size for name, size in found.items() if size != (1, 1)}
        if found and not pictures and (found.keys() & inputs.keys() or not self._is_pattern(path, node)):
            return (1, 1)
        return node.output_size(pictures, self.pictures.canvas)

    def _is_pattern(self, path: str, node: Node) -> bool:
        """True for a node whose pixels differ even if all that it reads is the same everywhere."""
        return not node.inputs or self.library.uses(shader(node), frozenset({"pixel", "extent"}), path)

    def _pointwise(
        self, path: str, node: Pointwise, operands: Mapping[str, Operand], wires: Mapping[str, Operand], size: Size
    ) -> None:
        parameters: list[Parameter] = []
        for name in node.order:
            if name in node.inputs:
                parameters.append(Parameter(node.inputs[name].glsl, operands[name]))
            elif node.values[name].glsl is not None:
                parameters.append(self._value(node, node.values[name], wires.get(name), size))
        sockets = [output.socket for output in node.outputs.values()]
        shapes = tuple(
            Shape((1, 1) if socket.single else size, socket.channels, socket.kind is not Kind.IMAGE)
            for socket in sockets
        )
        self._check_function(path, node, [item.glsl for item in parameters], [item.glsl for item in sockets])
        ref = self.builder.add(Call(shapes, path, shader(node), node.id, tuple(parameters), choices(node)))
        for index, name in enumerate(node.outputs):
            self.results[Port(path, name)] = Ref(ref.op, index)

    def _check_function(self, path: str, node: Node, taken: list[str], made: list[str]) -> None:
        """Raise ShaderError unless the node's GLSL function takes and makes what the node declares."""
        found = self.library.function(shader(node), node.id, path)
        outputs = [glsl for glsl, _ in found.outputs] or [found.result]
        if [glsl for glsl, _ in found.parameters] != taken or outputs != made:
            said, wanted = (f"({', '.join(a)}) to ({', '.join(b)})" for a, b in (
                ([glsl for glsl, _ in found.parameters], outputs), (taken, made),
            ))
            fault = f"'{node.id}' takes {said}, but the node declares {wanted}"
            raise ShaderError(path, f"shaders/{shader(node)}.glsl", found.line, fault)

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

    def _filter(
        self, path: str, node: Filter, operands: Mapping[str, Operand], linked: frozenset[str], size: Size
    ) -> None:
        filled = dict(operands)
        for name in linked:
            filled[name] = self._as_pixels(path, node.inputs[name], operands[name], size)
        recorder = Recorder(
            path, node, size, self.request.frame, filled, linked, self.builder, self.library, self._files(path),
            self.request.memories.get(path),
        )
        drawn = node.passes(recorder)
        if recorder.remembered is not None:
            self.memories[path] = recorder.remembered
        made = drawn if isinstance(drawn, Mapping) else {next(iter(node.outputs)): drawn}
        for name, item in made.items():
            assert isinstance(item, Made | Camera)
            self.results[Port(path, name)] = Constant(item.rows) if isinstance(item, Camera) else item.ref

    def _as_pixels(self, path: str, socket: Socket, operand: Operand, size: Size) -> Operand:
        """A filter looks around in its input: give it real pixels with the channels that it declares."""
        if socket.single:
            return operand
        if isinstance(operand, Constant):
            return self.pictures.converted(operand, socket, size, path)
        return self._as_type(operand, socket, path)

    def _as_type(self, ref: Ref, socket: Socket, owner: str) -> Ref:
        """The same pixels with the channels that a socket declares."""
        made = self.builder.shape(ref)
        return ref if made.channels == socket.channels else self.pictures.converted(ref, socket, made.size, owner)

    def _files(self, path: str) -> Files:
        """The files that a node names, which lie beside the graph file that it came from."""

        def recolor(change: ColorChange) -> ColorProgram:
            if isinstance(change, LookupFile):
                change = replace(change, path=self.pictures.located(change.path, path))
            return self.outside.recolor(change)

        def read(picture: Picture) -> Ref:
            return self.pictures.read(replace(picture, path=self.pictures.located(picture.path, path)), path)

        def mesh(scene: Scene) -> Mesh:
            if isinstance(scene, SceneFile):
                scene = replace(scene, path=self.pictures.located(scene.path, path))
            return self.outside.mesh(scene)

        return Files(
            read, recolor, mesh, lambda file: self.outside.render(self.pictures.located(file, path))
        )
