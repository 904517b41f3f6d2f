"""Turns the draws that a filter records in `passes` into operations."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import partial
from types import MappingProxyType
from typing import Any, Literal

from halation.nodes import (
    Affine,
    Argument,
    CameraModel,
    CameraSocket,
    ColorChange,
    Drawn,
    Edge,
    HostProgram,
    Image,
    Kernel,
    Kind,
    Motion,
    Overlap,
    Pixels,
    Reach,
    Render,
    Scene,
    ShaderText,
    Size,
    Socket,
    Trait,
    Uniform,
    Vector,
    glsl_type,
)
from msgspec.structs import replace

from ...errors import ShaderError
from ...glsl import GlslFunction
from ...graph import Settings
from ...resources.picture import Picture
from ..areas import Neighborhood
from ..ir import (
    BLOCK,
    MAX_TAPS,
    Accessor,
    Builder,
    Call,
    Choice,
    ColorCall,
    ExternalProgram,
    FormulaCall,
    Gather,
    HistoryRead,
    HostCall,
    Memory,
    Op,
    Operand,
    Parameter,
    PictureShape,
    PlannedObject,
    Reduce,
    Ref,
    UniformConstant,
)
from ..library import Library
from . import constants, fourier, gaussian, padding, transforms
from .blurs import BlurBuilder
from .node_code import PassNode, check_options
from .node_inputs import DrawnPicture, NodeInputs, NodeResources
from .outline_drawing import OutlineDraw
from .rasters import add_raster
from .tables import make_table


class Recorder(OutlineDraw):
    """Implements `Draw` for one node with its inputs."""

    def __init__(
        self,
        inputs: NodeInputs,
        node: PassNode,
        size: Size,
        builder: Builder,
        library: Library,
        resources: NodeResources,
        memories: Mapping[str, Memory],
        settings: Settings,
    ) -> None:
        self.size, self.rate, self.start = size, settings.rate, (settings.frames or (1, 1))[0]
        self.overscan = math.ceil(settings.overscan * size[1])
        self.reads_frame = self.reads_other_times = False
        """Whether the node asked for the frame, and for its values at another time."""
        self.typeset, self.expand_text = resources.typeset, partial(resources.expand_text, self)
        self._owner, self._inputs, self._node, self._shader = inputs.path, inputs, node, node.shader
        self._builder, self._library, self._resources = builder, library, resources
        self._blurs, self._memories = BlurBuilder(builder, library, inputs.path), memories
        self.remembered: dict[str, Ref] = {}

    @property
    def frame(self) -> int:
        self.reads_frame = True
        return self._inputs.frame

    def size_of(self, pixels: Pixels) -> Size:
        operand = self._find_operand(pixels)
        return self._builder.shape(operand).size if isinstance(operand, Ref) else (1, 1)

    def is_linked(self, socket: Socket) -> bool:
        return socket.name in self._inputs.linked

    def camera(self, socket: CameraSocket, frame: int | None = None) -> CameraModel | None:
        operand = self._find_operand(socket) if frame is None else self._find_operand_at(socket, frame)
        content = operand.content if isinstance(operand, PlannedObject) else None
        return content if isinstance(content, CameraModel) else None

    def settings_at(self, time: float) -> Mapping[str, Any]:
        self.reads_frame = self.reads_other_times = True
        return self._resources.find_settings(time)

    def at(self, socket: Socket, frame: int) -> Drawn:
        operand = self._find_operand_at(socket, frame)
        if isinstance(operand, Ref):
            return self._wrap(operand, socket.name == self._inputs.narrow)
        shape, parameters = self._make_shape(socket, self.size), (Parameter(socket.glsl, operand),)
        return self._add_op(Call((shape,), self._owner, "primitive/convert", f"as_{socket.glsl}", parameters))

    def __call__(
        self,
        function: str,
        /,
        *inputs: Socket,
        size: Size | None = None,
        edge: Edge = "clamp",
        result: Socket | None = None,
        overlap: Overlap | Mapping[str, Overlap] | None = None,
        **arguments: Argument,
    ) -> Drawn:
        check_options(size, edge, result, overlap)
        light = self._library.is_light(self._find_file(function), function, self._owner)
        shapes = (self._make_shape(result, size or self.size),)
        op = self._make_gather(function, {item.name: item for item in inputs} | arguments, shapes, edge, overlap, light)
        return self._add_op(op)

    def several(
        self,
        function: str,
        results: tuple[Socket, ...],
        /,
        *inputs: Socket,
        size: Size | None = None,
        edge: Edge = "clamp",
        overlap: Overlap | Mapping[str, Overlap] | None = None,
        **arguments: Argument,
    ) -> tuple[Drawn, ...]:
        shapes = tuple(self._make_shape(result, size or self.size) for result in results)
        made_types = [glsl for glsl, _ in self._find_function(function).outputs]
        drawn_types = [result.glsl for result in results]
        if made_types != drawn_types:
            fault = f"'{function}' makes ({', '.join(made_types)}) but is drawn for ({', '.join(drawn_types)})"
            raise ShaderError(self._owner, self._library.file_name(self._shader), 1, fault)
        op = self._make_gather(function, {item.name: item for item in inputs} | arguments, shapes, edge, overlap, False)
        first = self._builder.add(op)
        return tuple(DrawnPicture(Ref(first.op, number), shape) for number, shape in enumerate(shapes))

    def _make_gather(
        self,
        function: str,
        arguments: Mapping[str, Argument],
        shapes: tuple[PictureShape, ...],
        edge: Edge,
        overlap: Overlap | Mapping[str, Overlap] | None,
        light: bool,
    ) -> Gather:
        # A picture with one channel that stands for an Image has a vec4 accessor: shaders are written for Images.
        overlaps = overlap if isinstance(overlap, Mapping) else dict.fromkeys(arguments, overlap)
        accessors, plain_arguments = list[Accessor](), dict[str, Argument]()
        for name, item in arguments.items():
            if isinstance(item, (Socket, DrawnPicture)):
                operand = self._find_operand(item)
                is_wide = isinstance(item, DrawnPicture) and item.is_narrow
                channels = 4 if is_wide else item.channels if isinstance(item, Socket) else item.shape.channels
                around = self._find_neighborhood(operand, shapes[0].size, overlaps.get(name))
                accessors.append(Accessor(name, glsl_type(channels), operand, around))
            else:
                plain_arguments[name] = item
        return Gather(
            shapes,
            self._owner,
            self._find_file(function),
            function,
            self._make_parameters(self._find_function(function), plain_arguments),
            self._find_choices(function),
            accessors=tuple(accessors),
            edge=edge,
            light=light,
            warps=Trait.WARPS in self._node.traits,
            stretches=Trait.STRETCHES in self._node.traits,
        )

    def point(self, function: str, /, *inputs: Socket, result: Socket | None = None, **arguments: Argument) -> Drawn:
        signature = self._find_function(function)
        named: dict[str, Argument] = {item.name: item for item in inputs} | arguments
        sizes = [self.size_of(item) for item in named.values() if isinstance(item, (Socket, DrawnPicture))]
        size = next((input_size for input_size in sizes if input_size != (1, 1)), (1, 1) if sizes else self.size)
        return self._add_op(
            Call(
                (self._make_shape(result, size),),
                self._owner,
                self._find_file(function),
                function,
                self._make_parameters(signature, named),
                self._find_choices(function),
            )
        )

    def formula(self, text: str, **names: Argument) -> Drawn:
        from . import formulas  # few graphs have any

        program, clock = formulas.write_formula(text, tuple(names), self._owner), (0.0, 0.0, 0.0)
        if formulas.reads_time(text):
            clock = (float(self.frame), (self.frame - self.start) / self.rate, self.rate)
        parameters = self._make_parameters(program.text.functions[program.function], {"clock": clock, **names})
        shape = self._make_shape(Vector(width=4), self.size)
        return self._add_op(
            FormulaCall((shape,), self._owner, self._shader, program.function, parameters, program=program)
        )

    def program(
        self,
        text: ShaderText,
        pictures: Mapping[str, Drawn],
        uniforms: Mapping[str, Uniform],
        *,
        size: Size | None = None,
        result: Socket | None = None,
    ) -> Drawn:
        samplers = tuple((name, self._find_pixels(item).ref) for name, item in pictures.items())
        values = tuple((name, UniformConstant(value)) for name, value in uniforms.items())
        return self._add_op(
            ExternalProgram((self._make_shape(result, size or self.size),), self._owner, text, samplers, values)
        )

    def blur(
        self, image: Pixels, sigma: float | tuple[float, float], edge: Edge = "clamp", *, precise: bool = False
    ) -> Drawn:
        sigmas = sigma if isinstance(sigma, tuple) else (sigma, sigma)
        return self._blur(image, [gaussian.plan_axis(max(0.0, one), precise=precise) for one in sigmas], edge)

    def spread(self, image: Pixels, weights: tuple[float, ...], edge: Edge = "clamp") -> Drawn:
        return self._blur(image, [gaussian.plan_weights(weights)] * 2, edge)

    def convolve(
        self, image: Pixels, weights: tuple[float, ...], axis: Literal["x", "y"], edge: Edge = "clamp"
    ) -> Drawn:
        picture = self._find_pixels(image)
        if len(weights) % 2 == 0 or len(weights) > MAX_TAPS:
            fault = f"a convolution takes an odd number of weights up to {MAX_TAPS}, not {len(weights)}"
            raise ShaderError(self._owner, f"nodes/{self._shader}.py", 1, fault)
        index, origin = 0 if axis == "x" else 1, -(len(weights) // 2)
        blurred = self._blurs.convolve(picture.ref, index, weights, 1, origin, edge, picture.size[index])
        return self._wrap(blurred, picture.is_narrow)

    def convolve_2d(self, image: Pixels, kernel: Pixels) -> Drawn:
        picture, kernel_picture = self._find_pixels(image), self._find_pixels(kernel)
        return self._wrap(fourier.add_convolution(self._builder, picture.ref, kernel_picture.ref, self._owner))

    def recolor(self, image: Pixels, change: ColorChange) -> Drawn:
        picture, program = self._find_pixels(image), self._resources.write_color_program(change)
        parts = program.text.name, program.function, (Parameter("vec4", picture.ref),)
        return self._add_op(ColorCall((picture.shape,), self._owner, *parts, program=program))

    def pad(self, image: Pixels, margin: tuple[int, int], edge: Edge = "clamp") -> Drawn:
        picture = self._find_pixels(image)
        padded = padding.pad(self._builder, self._library, self._owner, picture.ref, margin, edge)
        return self._wrap(padded, picture.is_narrow)

    def place(self, image: Pixels, matrix: Affine, kernel: Kernel, edge: Edge = "black") -> Drawn:
        picture = self._find_pixels(image)
        shape = replace(picture.shape, size=self.size) if picture.is_narrow else self._make_shape(None, self.size)
        placed = transforms.place(self._builder, picture.ref, self._owner, shape, matrix, kernel, edge)
        return self._wrap(placed, picture.is_narrow)

    def raster(
        self,
        scene: Scene,
        motions: tuple[Motion, Motion, Motion],
        cameras: tuple[CameraModel, CameraModel, CameraModel],
        near: float,
    ) -> Mapping[str, Drawn]:
        mesh = self._resources.load_mesh(scene)
        return add_raster(self._builder, self._owner, self.size, mesh, motions, cameras, near)

    def reduce(self, image: Pixels, operation: Literal["sum", "max"]) -> Drawn:
        picture = self._find_pixels(image)
        while picture.size != (1, 1):
            size = (math.ceil(picture.size[0] / BLOCK), math.ceil(picture.size[1] / BLOCK))
            shape = PictureShape(size, picture.shape.channels, data=True)
            picture = self._add_op(Reduce((shape,), self._owner, picture.ref, operation))
        return picture

    def history(self, first: Pixels, name: str = "") -> Drawn:
        picture, memory = self._find_pixels(first), self._memories.get(name)
        # A memory of another size belongs to another picture, from before the node or the proxy changed.
        if memory is None or memory.shape != picture.shape:
            return picture
        return self._add_op(HistoryRead((picture.shape,), self._owner, memory.key, memory.half, memory.data_window))

    def remember(self, pixels: Drawn, name: str = "") -> None:
        assert isinstance(pixels, DrawnPicture)
        self.remembered[name] = pixels.ref

    def table(self, numbers: Sequence[float], width: int) -> Drawn:
        return self._add_op(make_table(self._owner, numbers, width))

    def host(self, program: HostProgram, /, result: Socket | None = None, **pictures: Pixels) -> Drawn:
        refs = tuple((name, self._find_pixels(item).ref) for name, item in pictures.items())
        return self._add_op(HostCall((self._make_shape(result, self.size),), self._owner, program, refs))

    def render(self, path: str, named: Mapping[str, str] = MappingProxyType({})) -> Render:
        return self._resources.describe_render(path, named)

    def read(self, path: str, layer: str, result: Socket, space: str = "") -> Drawn:
        return self._wrap(self._resources.read_picture(Picture(path, layer, result.kind, result.channels, space=space)))

    def asset(self, path: str, folder: str) -> Drawn:
        return self._wrap(self._resources.read_asset(Picture(path, "", Kind.IMAGE, 4, within=folder)))

    # --- parts ---------------------------------------------------------------------------------------------------

    def _find_file(self, function: str) -> str:
        return self._library.defining_file(self._shader, function, self._owner)

    def _find_choices(self, function: str) -> tuple[tuple[str, tuple[str, ...]], ...]:
        """The choices that the file of a function knows: those of the node in its own file, none in libraries."""
        return constants.find_choices(self._node) if self._find_file(function) == self._shader else ()

    def _find_function(self, function: str) -> GlslFunction:
        return self._library.function(self._find_file(function), function, self._owner)

    def _add_op(self, op: Op) -> DrawnPicture:
        return DrawnPicture(self._builder.add(op), op.shapes[0])

    def _wrap(self, ref: Ref, is_narrow: bool = False) -> DrawnPicture:
        return DrawnPicture(ref, self._builder.shape(ref), is_narrow)

    def _blur(self, image: Pixels, axes: Sequence[gaussian.BlurAxis], edge: Edge) -> DrawnPicture:
        picture = self._find_pixels(image)
        return self._wrap(self._blurs.blur(picture.ref, axes, edge), picture.is_narrow)

    def _make_shape(self, result: Socket | None, size: Size) -> PictureShape:
        socket = result or Image()
        is_data = socket.kind is not Kind.IMAGE or self._inputs.narrow != ""
        return PictureShape((1, 1) if socket.single else size, socket.channels, is_data)

    def _find_neighborhood(self, operand: Operand, own: Size, overlap: Overlap | None) -> Neighborhood | None:
        """The neighborhood in which a function reads a picture, as its overlap says."""
        if overlap is None or isinstance(operand, UniformConstant):
            return None
        if isinstance(overlap, Reach):
            return Neighborhood(overlap.matrix, overlap.radius, overlap.shows)
        radius = overlap if isinstance(overlap, tuple) else (overlap, overlap)
        return Neighborhood.pixel(own, self._builder.shape(operand).size, radius)

    def _find_operand(self, item: Pixels) -> Ref | UniformConstant:
        if isinstance(item, Socket):
            return self._inputs.inputs[item.name]
        assert isinstance(item, DrawnPicture)
        return item.ref

    def _find_operand_at(self, socket: Socket, frame: int) -> Operand:
        return self._inputs.at_frames.get((socket.name, frame)) or self._inputs.inputs[socket.name]

    def _find_pixels(self, item: Pixels) -> DrawnPicture:
        operand = self._find_operand(item)
        if isinstance(operand, UniformConstant):
            raise ShaderError(
                self._owner, f"nodes/{self._shader}.py", 1, "a filter cannot read a constant: link a picture"
            )
        if isinstance(item, Socket):
            return self._wrap(operand, item.name == self._inputs.narrow)
        return self._wrap(operand, isinstance(item, DrawnPicture) and item.is_narrow)

    def _make_parameters(self, signature: GlslFunction, arguments: Mapping[str, Argument]) -> tuple[Parameter, ...]:
        names = tuple(name for _, name in signature.parameters)
        if names != tuple(arguments):
            fault = f"'{signature.name}' takes ({', '.join(names)}) but is drawn with ({', '.join(arguments)})"
            raise ShaderError(self._owner, self._library.file_name(self._shader), 1, fault)
        parameters: list[Parameter] = []
        for (glsl, name), item in zip(signature.parameters, arguments.values(), strict=True):
            if isinstance(item, str):
                operand = Choice(self._node.values[name].choices.index(item))
            elif isinstance(item, (Socket, DrawnPicture)):
                operand = self._find_operand(item)
            else:
                assert isinstance(item, (float, int, tuple))
                operand = UniformConstant(item)
            parameters.append(Parameter(glsl, operand))
        return tuple(parameters)
