"""Nodes as calls of functions."""

from __future__ import annotations

import re
from functools import cached_property
from typing import Any

from halation.nodes import INVERT_MASK, MASK, MASKED, MIX, CameraModel, Filter, Kind, Node, Size, Socket

from ...compiler import Ref
from ...compiler.ir import Operand, PlannedObject, UniformConstant
from ...compiler.lowering.expand import find_stand_in, make_zero
from ...compiler.lowering.masks import hides_node, is_masked
from ...compiler.lowering.node_inputs import takes_field
from ...errors import GraphError
from ...graph import Port
from ..order import ExportOrder
from .formulas import FunctionText
from .library import Definition, FunctionParameter, load_library
from .numbers import (
    DERIVED,
    Plain,
    count_channels,
    find_unit,
    list_settings,
    write_bound,
    write_exactly,
    write_plain,
    write_quantity,
)
from .outline import LoweredGraph, NameTable, ScriptCall, ScriptClip, ScriptOutline
from .parts import MAIN, find_key, has_memory, plan_parts


class CallWriter:
    """Writes the calls of one output of a graph."""

    def __init__(self, order: ExportOrder) -> None:
        lowered = self.lowered = LoweredGraph(order)
        self.outline = ScriptOutline(lowered.size_of(lowered.output), lowered.frames, lowered.frame)
        self._names = NameTable()
        self._plan = plan_parts(
            lowered.flat,
            lowered.paths,
            lowered.source,
            lowered.feeds_of,
            lowered.list_clips,
            lowered.is_written_anywhere,
        )
        self._clips = {
            key: ScriptClip(self._names.choose(f"{key.removeprefix('inputs.')}_at"), lowered.spans.get(key, 1))
            for key in self._plan.clips
        }
        self._variables = {part: dict[Port, str]() for part in (MAIN, *self._clips)}
        self._input_names = dict[Port, str]()
        self._part, self._calls = MAIN, self.outline.calls

    def write(self) -> ScriptOutline:
        """The outline of the picture. Raises GraphError for what no function can do."""
        outline, plan, lowered = self.outline, self._plan, self.lowered
        outline.rate, outline.preroll = lowered.rate, lowered.graph.settings.preroll
        outline.read_frames, outline.clips = lowered.read_frames, list(self._clips.values())
        outline.reads_inputs = bool(self._clips or plan.looped)
        outline.uses_frame = outline.reads_inputs
        for path in sorted(lowered.paths, key=lambda path: path not in plan.looped):
            if path in plan.parts:
                self._enter(plan.parts[path], path in plan.looped)
                self._write_node(path)
        for key, clip in self._clips.items():
            self._enter(key)
            clip.results = tuple(self._read(port, as_field=False)[0] for port in self._list_results(key))
        self._enter(MAIN)
        channels = lowered.channels_of(lowered.output)
        text, operand = self._read(lowered.source, as_field=channels != 4)
        outline.result = self._convert(text, operand, channels)
        return outline

    def _enter(self, part: str, is_looped: bool = False) -> None:
        """Write into a part from now on."""
        outline = self.outline
        self._part = part
        self._calls = self._clips[part].calls if part else outline.loop if is_looped else outline.calls

    # --- what is read -----------------------------------------------------------------------------------------------

    @cached_property
    def _read_ports(self) -> set[Port]:
        """The ports that something reads."""
        lowered = self.lowered
        return {lowered.source} | {source for path in lowered.paths for source in lowered.feeds_of(path).values()}

    def _list_results(self, key: str) -> list[Port]:
        """What a function of the frame returns."""
        return sorted(port for port in self._read_ports if find_key(self.lowered.flat, port) == key)

    def _read(self, port: Port, as_field: bool, at: str = "frame") -> tuple[str, Operand]:
        """The text of a port, and what the compiler makes of it. `at` is the frame at which a function is called."""
        field = self.lowered.field_of(port) if as_field else None
        operand = field if field is not None else self.lowered.result_of(port)
        key = find_key(self.lowered.flat, port)
        if self._plan.parts.get(key, self._part) != self._part:
            results = self._list_results(key)
            text = f"{self._clips[key].name}({at})" + (f"[{results.index(port)}]" if len(results) > 1 else "")
        else:
            text = self._variables[self._part].get(port) or self._declare_input(port, operand)
        return (f"{text}[..., :1]" if field is not None else text), operand

    def _declare_input(self, port: Port, operand: Operand) -> str:
        """The variable of an input of the graph; the text of a number."""
        if isinstance(operand, PlannedObject):
            return self._declare_camera(port, operand.content)
        if isinstance(operand, UniformConstant):
            return self._write_constant(operand.value)
        outline = self.outline
        if port not in self._input_names:
            name = self._names.choose(port.socket if "/" not in port.node else f"{port.node}_{port.socket}")
            self._input_names[port] = name
            outline.inputs[name] = self.lowered.find_input(port)
            outline.uses_frame |= outline.inputs[name].is_numbered
        name = self._variables[self._part][port] = self._input_names[port]
        if outline.reads_inputs:
            self._calls.append(ScriptCall((name,), "read_input", (write_plain(name), "frame")))
        return name

    def _declare_camera(self, port: Port, camera: object) -> str:
        """The variable of a camera that comes from a file."""
        assert isinstance(camera, CameraModel)
        name = self._variables[self._part][port] = self._names.choose(port.node)
        rows = tuple(camera.rows[at : at + 4] for at in (0, 4, 8))
        self._calls.append(ScriptCall((name,), "np.array", (write_exactly(rows),)))
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
        feeds = lowered.feeds_of(path)
        if (passed := self._find_passed(path, node, feeds)) is not None:
            self._pass_through(path, node, feeds, passed)
            return
        size = next(
            (
                lowered.size_of(ref)
                for name in node.outputs
                if isinstance(ref := lowered.result_of(Port(path, name)), Ref)
            ),
            lowered.canvas or self.outline.size,
        )
        common = self._find_common_size(node, feeds, size)
        function = load_library().definitions[node.id]
        self.outline.functions[node.id] = None
        arguments = self._write_arguments(path, node, feeds, function, size, common)
        targets = self._name_outputs(path, node)
        memory = self.outline.memories[-1:] if has_memory(lowered.flat, path) else []
        self._calls.append(ScriptCall((*targets, *memory), node.id, arguments))
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
            operand = self.lowered.result_of(port)
            if source is None or source not in feeds:
                default = node.inputs[source].default if source else make_zero(node.outputs[name].socket)
                self._variables[self._part][port] = self._write_constant(default if default is not None else 0.0)
                continue
            text, before = self._read(feeds[source], takes_field(node.inputs[source]))
            size = self.lowered.size_of(operand) if isinstance(operand, Ref) else self.outline.size
            self._variables[self._part][port] = self._fit(text, before, size)

    def _find_common_size(self, node: Node, feeds: dict[str, Port], size: Size) -> Size:
        """The size to which a node's pictures are fitted: that of its result, or for a filter of the first one."""
        if not isinstance(node, Filter):
            return size
        for name, source in feeds.items():
            if name in node.inputs and node.inputs[name].own_size:
                continue
            operand = self.lowered.result_of(source)
            if isinstance(operand, Ref) and self.lowered.size_of(operand) != (1, 1):
                return self.lowered.size_of(operand)
        return size

    def _name_outputs(self, path: str, node: Node) -> tuple[str, ...]:
        """Variables of the outputs that something reads; `_` for the others."""
        targets: list[str] = []
        for at, name in enumerate(node.outputs):
            port = Port(path, name)
            if port not in self._read_ports:
                targets.append("_")
                continue
            targets.append(self._names.choose(path if at == 0 else f"{path}_{name}"))
            self._variables[self._part][port] = targets[-1]
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
                if text is None and name in _NEIGHBORS and "before" not in feeds and self.lowered.list_clips(path):
                    text, _ = self._read(feeds["camera"], False, f"frame{_NEIGHBORS[name]}")
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
                arguments.append(self._write_moment(path, name))
        return tuple(arguments)

    def _write_moment(self, path: str, name: str) -> str:
        """The frame, the frames per second, or what a node remembers of the frame before."""
        if name == "frame":
            self.outline.uses_frame = True
            return "frame=frame"
        if name == "rate":
            self.outline.uses_rate = True
            return "rate=RATE"
        assert name == "memory", f"nothing is known about the parameter '{name}' of '{path}'"
        self.outline.memories.append(self._names.choose(f"{path}_memory"))
        return f"memory={self.outline.memories[-1]}"

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
        text, operand = self._read(source, takes_field(socket), "at" if parameter.takes_clip else "frame")
        if socket.kind is Kind.CAMERA:
            return text
        text = self._convert(text, operand, socket.channels)
        text = text if socket.own_size else self._fit(text, operand, common)
        if not parameter.takes_clip:
            return text
        if isinstance(operand, UniformConstant) and not isinstance(operand.value, tuple) and socket.channels == 1:
            text = f"np.full((1, 1, 1), {text})"
        return text.removesuffix("(at)") if re.fullmatch(r"\w+\(at\)", text) else f"lambda at: {text}"

    def _write_wire(self, path: str, node: Node, parameter: FunctionParameter, source: Port, common: Size) -> str:
        """The text of a value that something is linked to, within its hard range."""
        value = node.declaration(parameter.name, self.lowered.flat.find_reference_height(path))
        if not parameter.takes_array:
            raise _refuse(path, f"its value '{parameter.name}' is linked, and numpy text takes only a number there")
        text, operand = self._read(source, value.type != "color")
        text = self._fit(self._convert(text, operand, count_channels(value)), operand, common)
        if value.minimum != float("-inf") or value.maximum != float("inf"):
            text = f"np.clip({text}, {write_bound(value.minimum)}, {write_bound(value.maximum)})"
        unit = find_unit(node, parameter.name, self.lowered.flat.find_reference_height(path))
        return write_quantity(text, 1.0, unit, self._write_height(path))

    def _write_value(self, path: str, node: Node, parameter: FunctionParameter, values: tuple[Plain, ...]) -> str:
        name = parameter.name
        for value in values:
            if parameter.choices and value not in parameter.choices:
                raise _refuse(path, f"the numpy text for '{node.id}' does not know '{name}': {value!r}: choose another")
        if isinstance(values[0], FunctionText):
            self.outline.helpers.update(values[0].helpers)
        self.outline.note_choices(node, name, values)
        unit = find_unit(node, name, self.lowered.flat.find_reference_height(path))
        text = write_plain(values[0])
        if len(set(values)) > 1:
            table = self._names.choose(f"{path}_{name}").upper()
            self.outline.tables[table], self.outline.uses_frame = values, True
            start = "FRAMES" if self.lowered.read_frames == self.lowered.frames else "READ_FRAMES"
            text = f"{table}[frame - {start}[0]]"
            return write_quantity(
                text, values[0] if isinstance(values[0], tuple) else 1.0, unit, self._write_height(path)
            )
        return write_quantity(text, values[0], unit, self._write_height(path))

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
        self._calls.append(ScriptCall((target,), "mix_by_mask", (*arguments, *(["inverted=True"] if inverted else []))))


_NEIGHBORS = {"before": " - 1", "after": " + 1"}
"""The frames at which `camera_velocity` reads a camera that moves, where no other cameras are linked."""

_SIDES = ("width", "height", "columns", "rows")
"""Parameters that get the size of the picture: the last two for nodes with a width and a height of their own."""

_PLAIN = FunctionParameter("", True, False)
"""A parameter that takes any picture."""


def _refuse(path: str, fault: str) -> GraphError:
    return GraphError(f"node '{path}': {fault}, or write it with --to glsl", node=path)
