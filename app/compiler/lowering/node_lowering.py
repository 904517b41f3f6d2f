"""One node becomes operations: what it reads is fitted, and its function or its draws are added."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from halation.nodes import (
    MASKED,
    Field,
    Filter,
    Missing,
    Node,
    Pointwise,
    Reader,
    Size,
    Socket,
    Temporal,
    Trait,
    Value,
    curve_knots,
    ramp_knots,
    unit_factor,
)
from msgspec.structs import replace

from ...errors import GraphError, ShaderError
from ...graph import Port
from ..ir import Call, Choice, Memory, Operand, Parameter, PlannedObject, Ref, UniformConstant
from . import constants, masks
from .context import LoweringContext, PointwiseForm, find_pointwise_form, find_settings
from .draws import Recorder
from .expand import find_stand_in
from .node_code import PassNode, run_passes
from .node_inputs import DrawnPicture, NodeInputs, find_cameras, takes_field
from .pixel_shapes import follow_pixel_aspect
from .steps import LoweringStep, field_port

OperandFinder = Callable[[Port, int, bool], Operand | None]
"""What a source port stands for at a frame; None for a graph input without a picture. With True its Field, if the port
carries one besides its Image."""

READS_PLACE = frozenset({"pixel", "extent"})
"""The GLSL variables from which a function knows the position of its pixel."""


class NodeLowering:
    """Lowers nodes. What lowering a node added is entered into a step."""

    def __init__(self, context: LoweringContext) -> None:
        self._context = context
        self._builder, self._pictures = context.builder, context.pictures
        self._checked = set[type[Node]]()

    def lower(self, path: str, frame: int, step: LoweringStep, operand_at: OperandFinder) -> None:
        """Lower a node at a frame.

        Sizes come first: the size of a node follows from those of its inputs, which are then fitted to it. Values are
        brought to working units only after that, because units such as a fraction of the height need the size.
        """
        context = self._context
        node = context.frames.node_at(path, frame)
        constants.check_values(path, node)
        inputs = self._collect_inputs(path, frame, node, operand_at)
        if frame == context.frame:
            step.cameras = find_cameras(inputs)
        offset = frame - context.frame
        for name, operand in self._lower_outputs(inputs, step).items():
            step.results[Port(path, name), offset] = operand
        for name, output in node.outputs.items():
            if output.follows and self._carries_field(path, frame, output.follows, operand_at):
                field_inputs = self._collect_inputs(path, frame, node, operand_at, output.follows)
                operand = self._lower_outputs(field_inputs, step)[name]
                if isinstance(operand, Ref):
                    operand = self.convert_type(operand, Field(), path)
                step.results[field_port(Port(path, name)), offset] = operand

    def _carries_field(self, path: str, frame: int, name: str, operand_at: OperandFinder) -> bool:
        """True if an input of a node is fed the pixels of a Field."""
        source, frames = self._context.frames.find_feeds((path, frame)).get(name, (None, ()))
        operand = operand_at(source, frames[0], True) if source and frames else None
        if not isinstance(operand, Ref):
            return False
        shape = self._builder.shape(operand)
        return shape.channels == 1 and shape.size != (1, 1)

    def _lower_outputs(self, inputs: NodeInputs, step: LoweringStep) -> dict[str, Operand]:
        """The operands of a node's outputs by name.

        A neutral node is replaced by its input. `identity` compares lengths in pixels: so it is asked with working
        units where units are stated. Graphs that state none are asked as ever, with the values in the file. A mask
        mixes with the input as it is before the node works on it, so that input is remembered first.
        """
        inputs = follow_pixel_aspect(self._builder, inputs)
        node, path = inputs.node, inputs.path
        size = self._find_size(inputs)
        step.whole_height = self._find_whole_height(inputs, size)
        reference = self._context.flat.find_reference_height(path)
        step.length_height = self._choose_height(node, reference, size, step)
        scaled_node = node.to_working_units(self._context.request.scale, step.length_height, reference)
        says_units = reference is not None or node.length_units
        passed_through = self._pass_through(inputs, scaled_node if says_units else node)
        if passed_through is not None:
            return {
                name: self._pictures.fit(operand, size, path) if isinstance(operand, Ref) else operand
                for name, operand in passed_through.items()
            }
        self._fit_all(inputs, size)
        before = inputs.inputs.get(MASKED)
        if scaled_node is not node:
            inputs = replace(inputs, node=scaled_node)
        if isinstance(scaled_node, Pointwise) and not scaled_node.takes_passes():
            outputs = self._lower_pointwise(inputs, scaled_node, size, step)
        else:
            assert isinstance(scaled_node, Filter | Pointwise)
            outputs = self._lower_filter(inputs, self._set_wired(inputs, scaled_node, step), size, step)
        if before is not None and masks.is_masked(inputs.node, {*inputs.linked, *inputs.wires}):
            first = next(iter(outputs))
            outputs[first] = masks.add_mask(self._builder, self._pictures, inputs, before, outputs[first])
        return outputs

    # --- what a node reads -----------------------------------------------------------------------------------------

    def _collect_inputs(
        self, path: str, frame: int, node: Node, operand_at: OperandFinder, narrow: str = ""
    ) -> NodeInputs:
        """A node and all that it reads. Raises GraphError for an input that must be linked and is not.

        `narrow` is an Image input whose Field is read.
        """
        inputs = NodeInputs(path, frame, node, narrow=narrow)
        feeds = self._context.frames.find_feeds((path, frame))
        for name, socket in node.inputs.items():
            if name not in feeds and socket.optional:  # most masks
                inputs.inputs[name] = constants.make_default(socket)
                continue
            source, frames = feeds.get(name, (None, ()))
            by_frame: dict[int, Operand] = {}
            if source is not None:
                as_field = takes_field(socket) or name == narrow
                by_frame = {at: item for at in frames if (item := operand_at(source, at, as_field)) is not None}
            if by_frame:
                inputs.inputs[name] = by_frame[frame] if frame in by_frame else next(iter(by_frame.values()))
                inputs.at_frames.update({(name, at): operand for at, operand in by_frame.items()})
                inputs.linked.append(name)
            elif socket.optional:
                inputs.inputs[name] = constants.make_default(socket)
            elif source is not None:
                raise GraphError(
                    f"node '{path}': input '{name}' comes from the graph input '{source.socket}', which is not bound "
                    "to a picture: give it a file, or bind it by name"
                )
            else:
                noun = socket.kind.facts.noun
                raise GraphError(f"node '{path}': input '{name}' is not linked: link a {noun} to it")
        if not feeds.keys() <= node.inputs.keys():
            for name, value in node.values.items():
                source, _ = feeds.get(name, (None, ()))
                operand = operand_at(source, frame, value.type != "color") if source is not None else None
                if operand is not None:
                    inputs.wires[name] = operand
        return inputs

    def _fit_all(self, inputs: NodeInputs, size: Size) -> None:
        """Bring every picture to one size: that of the result, or for a filter, which may resize, of the first one."""
        if self._are_fitted(inputs, size):
            return
        unfitted = {name for name, socket in inputs.node.inputs.items() if socket.own_size}
        operands = (*inputs.inputs.items(), *inputs.wires.items())
        refs = [operand for name, operand in operands if isinstance(operand, Ref) and name not in unfitted]
        sizes = [size_ for size_ in (self._builder.shape(ref).size for ref in refs) if size_ != (1, 1)]
        common = sizes[0] if sizes and isinstance(inputs.node, Filter) else size
        one_frame = all(frame == inputs.frame for _, frame in inputs.at_frames)
        if one_frame and all(size_ == common for size_ in sizes):
            return

        def fit(name: str, operand: Operand) -> Operand:
            if isinstance(operand, UniformConstant) or name in unfitted:
                return operand
            return self._pictures.fit(operand, common, inputs.path)

        for group in (inputs.inputs, inputs.wires):
            group.update({name: fit(name, operand) for name, operand in group.items()})
        inputs.at_frames.update({key: fit(key[0], operand) for key, operand in inputs.at_frames.items()})

    def _are_fitted(self, inputs: NodeInputs, size: Size) -> bool:
        """True if a node reads one frame, and all its pictures have the size of its result. This is the usual case."""
        operands = (*inputs.inputs.values(), *inputs.wires.values())
        sizes = {self._builder.shape(operand).size for operand in operands if isinstance(operand, Ref)}
        return sizes <= {size, (1, 1)} and all(frame == inputs.frame for _, frame in inputs.at_frames)

    def _pass_through(self, inputs: NodeInputs, node: Node) -> dict[str, Operand] | None:
        """What the outputs of a muted or neutral node show; None if it has something to do."""
        if inputs.path in self._context.flat.muted:
            sources = {name: find_stand_in(output.socket, node.inputs) for name, output in node.outputs.items()}
            return {
                name: inputs.inputs[source] if source else constants.make_empty_constant(node.outputs[name].socket)
                for name, source in sources.items()
            }
        has_work = bool(inputs.wires) or len(node.outputs) != 1
        neutral_input = None if has_work else MASKED if masks.hides_node(node) else node.identity()
        return dict.fromkeys(node.outputs, inputs.inputs[neutral_input]) if neutral_input else None

    def _find_size(self, inputs: NodeInputs) -> Size:
        """The size of a node's outputs: 1x1 if all its inputs are single values, unless it draws a pattern."""
        node = inputs.node
        linked_inputs = {name: inputs.inputs[name] for name in inputs.linked}
        sizes = {
            name: self._builder.shape(operand).size
            for name, operand in (*linked_inputs.items(), *inputs.wires.items())
            if isinstance(operand, Ref)
        }
        pictures = {name: size for name, size in sizes.items() if size != (1, 1)}
        if sizes and not pictures and (sizes.keys() & linked_inputs.keys() or not self._is_pattern(inputs.path, node)):
            return (1, 1)
        return node.output_size(pictures, self._pictures.canvas)

    def _find_whole_height(self, inputs: NodeInputs, size: Size) -> float:
        """The height of the picture that the result is a part of, in pixels of the result; 0 if it is whole.

        It follows the first input that has the size of the result, else the first picture. Resizing a part resizes the
        whole as well.
        """
        cuts_out = Trait.CUTS_OUT in inputs.node.traits
        if not cuts_out and not self._context.whole_heights:
            return 0.0  # the usual case
        feeds, offset = self._context.frames.find_feeds((inputs.path, inputs.frame)), inputs.frame - self._context.frame
        candidates: list[tuple[bool, float]] = []
        for name in inputs.linked:
            operand = inputs.inputs[name]
            if isinstance(operand, Ref) and (input_size := self._builder.shape(operand).size) != (1, 1):
                whole = self._context.whole_heights.get((feeds[name][0].node, offset), float(input_size[1]))
                candidates.append((input_size == size, whole if cuts_out else whole * size[1] / input_size[1]))
        height = max(candidates, key=lambda candidate: candidate[0])[1] if candidates else 0.0
        return 0.0 if height == size[1] else height

    def _choose_height(self, node: Node, reference_height: int | None, size: Size, step: LoweringStep) -> float:
        """The height that lengths of a node are fractions of: that of the whole picture where units are stated, so
        that a cut-out part looks the same. Graphs that state nothing keep to the picture that the node works on."""
        says_units = reference_height is not None or node.length_units
        return step.whole_height if says_units and step.whole_height else size[1]

    def _is_pattern(self, path: str, node: Node) -> bool:
        """True for a node whose pixels differ although all its inputs are constant."""
        return not node.inputs or self._context.library.uses(node.shader, READS_PLACE, path)

    # --- pointwise nodes -------------------------------------------------------------------------------------------

    def _lower_pointwise(
        self, inputs: NodeInputs, node: Pointwise, size: Size, step: LoweringStep
    ) -> dict[str, Operand]:
        form = self._find_form(inputs.path, node, size)
        parameters = tuple(
            Parameter(glsl, inputs.inputs[name])
            if value is None
            else self._make_value_parameter(inputs, node, value, glsl, step)
            for name, glsl, value in form.arguments
        )
        shapes = tuple(replace(shape, data=True) for shape in form.shapes) if inputs.narrow else form.shapes
        ref = self._builder.add(Call(shapes, inputs.path, node.shader, node.function, parameters, form.choices))
        return {name: Ref(ref.op, index) for index, name in enumerate(node.outputs)}

    def _find_form(self, path: str, node: Pointwise, size: Size) -> PointwiseForm:
        """What all nodes of a class have in common. Its function is looked at once for each graph."""
        form = find_pointwise_form(type(node), size)
        if type(node) not in self._checked:
            self._check_function(path, node, form)
            self._checked.add(type(node))
        return form

    def _check_function(self, path: str, node: Node, form: PointwiseForm) -> None:
        """Raise ShaderError unless the node's GLSL function takes and makes what the node declares."""
        library = self._context.library
        function = library.function(node.shader, node.function, path)
        parameters = [glsl for glsl, _ in function.parameters]
        outputs = [glsl for glsl, _ in function.outputs] or [function.result]
        takes, makes = [glsl for _, glsl, _ in form.arguments], [*form.outputs]
        if parameters != takes or outputs != makes:
            actual = f"({', '.join(parameters)}) to ({', '.join(outputs)})"
            declared = f"({', '.join(takes)}) to ({', '.join(makes)})"
            fault = f"'{node.function}' takes {actual}, but the node declares {declared}"
            raise ShaderError(path, library.file_name(node.shader), function.line, fault)

    def _make_value_parameter(
        self, inputs: NodeInputs, node: Node, value: Value, glsl: str, step: LoweringStep
    ) -> Parameter:
        wire = inputs.wires.get(value.name)
        if wire is not None:
            value = node.declaration(value.name, self._context.flat.find_reference_height(inputs.path))
            factor = unit_factor(value.unit, self._context.request.scale, step.length_height)
            if isinstance(wire, UniformConstant):
                return Parameter(glsl, constants.limit_wire(wire, value, factor))
            return Parameter(glsl, wire, factor, value.minimum, value.maximum)
        setting = node.setting(value.name)
        if value.type == "choice":
            return Parameter(glsl, Choice(value.choices.index(setting)))
        knots = {"curve": curve_knots, "ramp": ramp_knots}.get(value.type)
        return Parameter(glsl, UniformConstant(knots(setting) if knots else setting))

    # --- filters ---------------------------------------------------------------------------------------------------

    def _set_wired(self, inputs: NodeInputs, node: PassNode, step: LoweringStep) -> PassNode:
        """The node with the numbers that drive its values. Raises GraphError for a picture: passes need numbers."""
        numbers: dict[str, Any] = {}
        for name, wire in inputs.wires.items():
            if not isinstance(wire, UniformConstant):
                raise GraphError(
                    f"node '{inputs.path}': a picture is linked to '{name}', but at these values the node is not drawn "
                    "pixel by pixel: unlink it",
                    node=inputs.path,
                )
            value = node.declaration(name, self._context.flat.find_reference_height(inputs.path))
            factor = unit_factor(value.unit, self._context.request.scale, step.length_height)
            number = constants.limit_wire(wire, value, factor).value
            if value.type in ("bool", "int") and not isinstance(number, tuple):
                number = bool(number) if value.type == "bool" else round(number)
            numbers[name] = number
        return node.with_values(**numbers) if numbers else node

    def _lower_filter(self, inputs: NodeInputs, node: PassNode, size: Size, step: LoweringStep) -> dict[str, Operand]:
        """Record the draws of a filter, on pictures that have the channels that it declares.

        An Image input that is fed a Field (`narrow`) keeps its one channel: the result is then a Field too.
        """
        context, path, remembers = self._context, inputs.path, isinstance(node, Temporal)
        if remembers and inputs.frame != context.frame:
            raise GraphError(
                f"node '{path}' remembers the frame before, so it cannot be seen at frame {inputs.frame} "
                f"while frame {context.frame} is rendered: put what changes the time before '{path}'"
            )
        for name in inputs.linked:
            if name == inputs.narrow:
                continue
            inputs.inputs[name] = self._convert_to_pixels(path, node.inputs[name], inputs.inputs[name], size)
        for (name, frame), operand in inputs.at_frames.items():
            if name == inputs.narrow:
                continue
            inputs.at_frames[name, frame] = self._convert_to_pixels(path, node.inputs[name], operand, size)
        missing = self.choose_missing(inputs.node.missing if isinstance(inputs.node, Reader) else "error", inputs.frame)
        recorder = Recorder(
            inputs,
            node,
            size,
            self._builder,
            context.library,
            self._pictures.collect_resources(inputs, missing, partial(find_settings, context, path, step)),
            self._find_memories(path, step) if remembers else {},
            context.graph.settings,
        )
        pictures = run_passes(node, recorder, path)
        step.memories = {Port(path, name): ref for name, ref in recorder.remembered.items()}
        step.reads_frame, step.reads_other_times = recorder.reads_frame, recorder.reads_other_times
        results = pictures if isinstance(pictures, Mapping) else {next(iter(node.outputs)): pictures}
        return {
            name: item.ref if isinstance(item, DrawnPicture) else PlannedObject(content=item)
            for name, item in results.items()
        }

    def _find_memories(self, path: str, step: LoweringStep) -> dict[str, Memory]:
        """What a node remembered of the frame before, by name."""
        step.reads_resources = True
        memories = self._context.request.memories
        return {port.socket: memory for port, memory in memories.items() if port.node == path}

    def _convert_to_pixels(self, path: str, socket: Socket, operand: Operand, size: Size) -> Operand:
        """Pixels with the channels that a filter's input declares: it reads neighbors, so a number is not enough."""
        if socket.single:
            return operand
        if isinstance(operand, UniformConstant):
            return self._pictures.convert(operand, socket, size, path)
        return self.convert_type(operand, socket, path)

    def convert_type(self, ref: Ref, socket: Socket, owner: str) -> Ref:
        """The same pixels with the channels that a socket declares."""
        shape = self._builder.shape(ref)
        if shape.channels == socket.channels:
            return ref
        return self._pictures.convert(ref, socket, shape.size, owner)

    def choose_missing(self, policy: Missing, frame: int) -> Missing:
        """What replaces a missing file. A node may read frames before the first or after the last: these are held."""
        return "hold" if policy == "error" and frame != self._context.frame else policy
