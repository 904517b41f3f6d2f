"""Nodes as calls of functions."""

from __future__ import annotations

from typing import Any

from halation.nodes import INVERT_MASK, MASK, MASKED, MIX, CameraModel, Filter, Kind, Node, Size, Socket, Value

from ...compiler import Ref
from ...compiler.ir import Operand, PlannedObject, UniformConstant
from ...compiler.lowering.expand import find_stand_in, make_zero
from ...compiler.lowering.masks import hides_node, is_masked
from ...compiler.lowering.node_inputs import takes_field
from ...compiler.lowering.steps import field_port
from ...errors import GraphError
from ...graph import Port
from ..order import ExportOrder
from .formulas import FunctionText
from .library import Definition, FunctionParameter, load_library
from .numbers import DERIVED, Plain, find_unit, list_settings, write_exactly, write_plain, write_quantity
from .outline import LoweredGraph, NameTable, PictureInput, ScriptCall, ScriptOutline


class CallWriter:
    """Writes the calls of one output of a graph."""

    def __init__(self, order: ExportOrder) -> None:
        self.lowered = LoweredGraph(order)
        self.outline = ScriptOutline(self.lowered.size_of(self.lowered.output), self.lowered.frames, self.lowered.frame)
        self._names, self._variables = NameTable(), dict[Port, str]()

    def write(self) -> ScriptOutline:
        """The outline of the picture. Raises GraphError for what no function can do."""
        for path in self.lowered.paths:
            self._write_node(path)
        text, operand = self._read(self.lowered.source, as_field=self.lowered.channels_of(self.lowered.output) != 4)
        channels = self.lowered.channels_of(self.lowered.output)
        self.outline.result = self._convert(text, operand, channels)
        return self.outline

    # --- what is read -----------------------------------------------------------------------------------------------

    def _read(self, port: Port, as_field: bool) -> tuple[str, Operand]:
        """The text of a port, and what the compiler makes of it."""
        results = self.lowered.results
        if as_field and (operand := results.get((field_port(port), 0))) is not None:
            return f"{self._variables[port]}[..., :1]", operand
        operand = results[port, 0]
        if port in self._variables:
            return self._variables[port], operand
        return self._declare_input(port, operand), operand

    def _declare_input(self, port: Port, operand: Operand) -> str:
        """The variable of an input of the graph; the text of a number."""
        if isinstance(operand, PlannedObject):
            return self._declare_camera(port, operand.content)
        if isinstance(operand, UniformConstant):
            return self._write_constant(operand.value)
        assert isinstance(operand, Ref)
        picture = self.lowered.find_picture(port)
        name = self._names.choose(port.socket if "/" not in port.node else f"{port.node}_{port.socket}")
        self._variables[port] = name
        self.outline.inputs[name] = PictureInput(
            picture.path, picture.layer, self.lowered.channels_of(operand), self.lowered.size_of(operand)
        )
        return name

    def _declare_camera(self, port: Port, camera: object) -> str:
        """The variable of a camera that comes from a file."""
        assert isinstance(camera, CameraModel)
        name = self._variables[port] = self._names.choose(port.node)
        rows = tuple(camera.rows[at : at + 4] for at in (0, 4, 8))
        self.outline.calls.append(ScriptCall((name,), "np.array", (write_exactly(rows),)))
        return name

    def _write_constant(self, value: Any) -> str:
        if isinstance(value, tuple):
            return f"np.array({write_plain(value)})[None, None]"
        return write_plain(value)

    def _convert(self, text: str, operand: Operand, channels: int) -> str:
        """The text of pixels with other channels, as links convert them."""
        if isinstance(operand, UniformConstant):
            is_tuple = isinstance(operand.value, tuple)
            return f"np.full((1, 1, {channels}), {text})" if not is_tuple and channels > 1 else text
        assert isinstance(operand, Ref)
        have = self.lowered.channels_of(operand)
        if text.endswith("[..., :1]"):
            have = 1
        if have == channels:
            return text
        if have == 1 and channels == 4:
            self.outline.helpers.add("as_image")
            return f"as_image({text})"
        return f"np.repeat({text}, {channels}, axis=-1)" if have == 1 else f"{text}[..., :{channels}]"

    def _fit(self, text: str, operand: Operand, size: Size) -> str:
        if not isinstance(operand, Ref) or self.lowered.size_of(operand) in (size, (1, 1)):
            return text
        self.outline.helpers.add("fit")
        nearest = ", nearest=True" if self.lowered.is_data(operand) else ""
        return f"fit({text}, {self._write_size(size)}{nearest})"

    def _write_size(self, size: Size) -> str:
        return "WIDTH, HEIGHT" if size == self.outline.size else f"{size[0]}, {size[1]}"

    # --- one node ---------------------------------------------------------------------------------------------------

    def _write_node(self, path: str) -> None:
        node, lowered = self.lowered.flat.nodes[path], self.lowered
        if lowered.gives_camera_of_file(path):
            return
        feeds = {name: source for name, (source, _) in lowered.at_frames.find_feeds((path, lowered.frame)).items()}
        if (passed := self._find_passed(path, node, feeds)) is not None:
            self._pass_through(path, node, feeds, passed)
            return
        size = next(
            (
                lowered.size_of(ref)
                for name in node.outputs
                if isinstance(ref := lowered.results[Port(path, name), 0], Ref)
            ),
            lowered.canvas or self.outline.size,
        )
        common = self._find_common_size(node, feeds, size)
        function = load_library().definitions[node.id]
        self.outline.functions[node.id] = None
        arguments = self._write_arguments(path, node, feeds, function, size, common)
        targets = self._name_outputs(path, node)
        self.outline.calls.append(ScriptCall(targets, node.id, arguments))
        if is_masked(node, feeds):
            self._write_mask(node, feeds, targets[0], size)

    def _find_passed(self, path: str, node: Node, feeds: dict[str, Port]) -> dict[str, str | None] | None:
        """The input that each output shows, for a node that is muted or changes nothing; else None."""
        if path in self.lowered.flat.muted:
            return {name: find_stand_in(output.socket, node.inputs) for name, output in node.outputs.items()}
        if len(node.outputs) != 1 or feeds.keys() & node.values.keys():
            return None
        shown = {
            "image" if hides_node(each) else self._scale_node(path, each).identity()
            for each in self.lowered.nodes_at_frames(path)
        }
        passed = shown.pop() if len(shown) == 1 else None
        return dict.fromkeys(node.outputs, passed) if passed else None

    def _scale_node(self, path: str, node: Node) -> Node:
        """The node as the compiler asks it whether it changes anything."""
        reference = self.lowered.flat.find_reference_height(path)
        if reference is None and not node.length_units:
            return node
        return node.to_working_units(1.0, self.lowered.step(path).length_height, reference)

    def _pass_through(self, path: str, node: Node, feeds: dict[str, Port], passed: dict[str, str | None]) -> None:
        for name, source in passed.items():
            port = Port(path, name)
            operand = self.lowered.results[port, 0]
            if source is None or source not in feeds:
                default = node.inputs[source].default if source else make_zero(node.outputs[name].socket)
                self._variables[port] = self._write_constant(default if default is not None else 0.0)
                continue
            text, before = self._read(feeds[source], takes_field(node.inputs[source]))
            size = self.lowered.size_of(operand) if isinstance(operand, Ref) else self.outline.size
            self._variables[port] = self._fit(text, before, size)

    def _find_common_size(self, node: Node, feeds: dict[str, Port], size: Size) -> Size:
        """The size to which a node's pictures are fitted: that of its result, or for a filter of the first one."""
        if not isinstance(node, Filter):
            return size
        for name, source in feeds.items():
            if name in node.inputs and node.inputs[name].own_size:
                continue
            operand = self.lowered.results.get((source, 0))
            if isinstance(operand, Ref) and self.lowered.size_of(operand) != (1, 1):
                return self.lowered.size_of(operand)
        return size

    def _name_outputs(self, path: str, node: Node) -> tuple[str, ...]:
        """Variables of the outputs that something reads; `_` for the others."""
        read = {self.lowered.source} | {
            source
            for other in self.lowered.paths
            for source, _ in self.lowered.at_frames.find_feeds((other, self.lowered.frame)).values()
        }
        targets: list[str] = []
        for at, name in enumerate(node.outputs):
            port = Port(path, name)
            if port not in read:
                targets.append("_")
                continue
            targets.append(self._names.choose(path if at == 0 else f"{path}_{name}"))
            self._variables[port] = targets[-1]
        return tuple(targets)

    # --- arguments --------------------------------------------------------------------------------------------------

    def _write_arguments(
        self, path: str, node: Node, feeds: dict[str, Port], function: Definition, size: Size, common: Size
    ) -> tuple[str, ...]:
        settings = [list_settings(each, path) for each in self.lowered.nodes_at_frames(path)]
        names = [parameter.name for parameter in function.parameters]
        self._refuse_settings(path, node, settings, feeds, names)
        arguments: list[str] = []
        for parameter in function.parameters:
            name = parameter.name
            if name in node.inputs:
                text = self._write_input(node.inputs[name], feeds.get(name), parameter, common)
                if text is not None:
                    arguments.append(text if not parameter.has_default else f"{name}={text}")
            elif name in feeds:
                arguments.append(f"{name}={self._write_wire(path, node, parameter, feeds[name], common)}")
            elif name in settings[0]:
                values = tuple(setting[name] for setting in settings)
                arguments.append(f"{name}={self._write_value(path, node, parameter, values)}")
            elif name in _SIDES:
                at = _SIDES.index(name) % 2
                own = ("WIDTH", "HEIGHT")[at]
                arguments.append(f"{name}={own if size[at] == self.outline.size[at] else size[at]}")
            else:
                assert name == "frame", f"{function.name}: nothing is known about its parameter '{name}'"
                self.outline.uses_frame = True
                arguments.append("frame=frame")
        return tuple(arguments)

    def _refuse_settings(
        self, path: str, node: Node, settings: list[dict[str, Plain]], feeds: dict[str, Port], names: list[str]
    ) -> None:
        """Raise GraphError for a value or an input that the function does not know."""
        for name in feeds:
            if name in node.inputs and name not in names and not (name == MASK and node.has_mask):
                raise _refuse(path, f"the numpy text for '{node.id}' has no input '{name}': unlink it")
        for name in feeds.keys() & DERIVED.get(node.id, ((),))[0]:
            raise _refuse(path, f"its value '{name}' is linked, and numpy text takes only a number there")
        mask_values = {MIX, INVERT_MASK} if node.has_mask else {MIX} if node.has_mix else set[str]()
        for name in settings[0].keys() - set(names) - mask_values:
            changed = any(setting[name] != node.values[name].default for setting in settings if name in node.values)
            if changed or name in feeds:
                raise _refuse(path, f"the numpy text for '{node.id}' has no value '{name}': set it to its default")

    def _write_input(
        self, socket: Socket, source: Port | None, parameter: FunctionParameter, common: Size
    ) -> str | None:
        """The text of an input; None where nothing is linked and the function has a default."""
        if source is None:
            if parameter.has_default:
                return None
            default = socket.default if socket.default is not None else 0.0
            if socket.channels > 1 and not isinstance(default, tuple):
                default = (default,) * socket.channels
            return self._write_constant(default)
        text, operand = self._read(source, takes_field(socket))
        if socket.kind is Kind.CAMERA:
            return text
        text = self._convert(text, operand, socket.channels)
        return text if socket.own_size else self._fit(text, operand, common)

    def _write_wire(self, path: str, node: Node, parameter: FunctionParameter, source: Port, common: Size) -> str:
        """The text of a value that something is linked to, within its hard range."""
        value = node.declaration(parameter.name, self.lowered.flat.find_reference_height(path))
        if not parameter.takes_array:
            raise _refuse(path, f"its value '{parameter.name}' is linked, and numpy text takes only a number there")
        text, operand = self._read(source, value.type != "color")
        text = self._fit(self._convert(text, operand, _count_channels(value)), operand, common)
        if value.minimum != float("-inf") or value.maximum != float("inf"):
            text = f"np.clip({text}, {_write_bound(value.minimum)}, {_write_bound(value.maximum)})"
        unit = find_unit(node, parameter.name, self.lowered.flat.find_reference_height(path))
        return write_quantity(text, 1.0, unit, self._write_height(path))

    def _write_value(self, path: str, node: Node, parameter: FunctionParameter, values: tuple[Plain, ...]) -> str:
        name = parameter.name
        for value in values:
            if parameter.choices and value not in parameter.choices:
                raise _refuse(path, f"the numpy text for '{node.id}' does not know '{name}': {value!r}: choose another")
        if isinstance(values[0], FunctionText):
            self.outline.helpers.update(values[0].helpers)
        self._note_choices(node, name, values)
        unit = find_unit(node, name, self.lowered.flat.find_reference_height(path))
        text = write_plain(values[0])
        if len(set(values)) > 1:
            table = self._names.choose(f"{path}_{name}").upper()
            self.outline.tables[table], self.outline.uses_frame = values, True
            text = f"{table}[frame - FRAMES[0]]"
            return write_quantity(
                text, values[0] if isinstance(values[0], tuple) else 1.0, unit, self._write_height(path)
            )
        return write_quantity(text, values[0], unit, self._write_height(path))

    def _note_choices(self, node: Node, name: str, values: tuple[Plain, ...]) -> None:
        """Enter what is chosen, so that functions need not hold the rest."""
        outline = self.outline
        texts = {value for value in values if isinstance(value, str)}
        if texts:
            outline.choices.setdefault((node.id, name), set()).update(texts)
            outline.options.setdefault((node.id, name), set()).update(map(str, node.values[name].choices))
        outline.switches.setdefault((node.id, name), set()).update(each for each in values if isinstance(each, bool))

    def _write_height(self, path: str) -> str:
        """The height that lengths of a node are parts of."""
        height = self.lowered.step(path).length_height
        return "HEIGHT" if height == self.outline.size[1] else write_plain(float(height))

    # --- the mask ---------------------------------------------------------------------------------------------------

    def _write_mask(self, node: Node, feeds: dict[str, Port], target: str, size: Size) -> None:
        """A second line, which keeps the picture where the mask is 0."""
        if target == "_":
            return
        for name in (MIX, INVERT_MASK):
            if name in feeds:
                raise GraphError(f"a link to '{name}' has no numpy text: set a number")
        before = self._write_input(node.inputs[MASKED], feeds[MASKED], _PLAIN, size)
        mask, inverted = "1.0", False
        if node.has_mask and MASK in feeds:
            mask = str(self._write_input(node.inputs[MASK], feeds[MASK], _PLAIN, size))
            inverted = bool(node.setting(INVERT_MASK))
        arguments = [str(before), target, mask, f"mix={write_plain(float(node.setting(MIX)))}"]
        self.outline.helpers.add("mix_by_mask")
        self.outline.calls.append(
            ScriptCall((target,), "mix_by_mask", (*arguments, *(["inverted=True"] if inverted else [])))
        )


_SIDES = ("width", "height", "columns", "rows")
"""Parameters that get the size of the picture: the last two for nodes with a width and a height of their own."""

_PLAIN = FunctionParameter("", True, False)
"""A parameter that takes any picture."""


def _refuse(path: str, fault: str) -> GraphError:
    return GraphError(f"node '{path}': {fault}, or write it with --to glsl", node=path)


def _count_channels(value: Value) -> int:
    return 4 if value.type == "color" else value.length if value.type == "vector" else 1


def _write_bound(bound: float) -> str:
    return "None" if bound in (float("inf"), float("-inf")) else write_plain(bound)
