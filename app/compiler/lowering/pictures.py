"""Reads pictures from files and bindings, and changes their size and type."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

from halation.nodes import (
    ColorChange,
    Kind,
    LookupFile,
    Missing,
    Render,
    Scene,
    SceneFile,
    Size,
    Socket,
    TextBlock,
    TypesetText,
)
from msgspec.structs import replace

from ...errors import GraphError, HalationError, NoFileError, describe_owner
from ...graph import Graph, color_settings, make_socket
from ...resources.color_program import ColorProgram
from ...resources.mesh import Mesh
from ...resources.picture import LARGE_PICTURE, Picture
from ...resources.provider import FrameFile, PictureProbe, ResourceProvider
from ...resources.today import read_date
from ..areas import Neighborhood, Region, scale_size
from ..ir import Accessor, Builder, Call, Gather, Operand, Parameter, PictureShape, Read, Ref, UniformConstant
from ..request import Request
from .expand import FlatGraph, make_zero
from .node_inputs import NodeInputs, NodeResources
from .references import ReferencedPictures

if TYPE_CHECKING:
    from .text_tokens import TextClock

DEFAULT_CANVAS: Size = (1920, 1080)
"""The size of a graph that neither sets a size nor reads a picture: HDTV (ITU-R BT.709)."""


class PictureBuilder:
    """Adds reads of pictures, and changes of their size and type, to the operations in `builder`."""

    def __init__(
        self, graph: Graph, flat: FlatGraph, request: Request, provider: ResourceProvider, builder: Builder
    ) -> None:
        self.named, self._flat = ReferencedPictures(flat, request.bindings), flat
        self._graph_size = graph.settings.size
        self._color = color_settings(graph)
        self._overscan = graph.settings.overscan > 0.0
        self._request, self._provider, self._builder = request, provider, builder
        self.canvas_is_read = False
        """Whether the canvas has been asked for."""

    @cached_property
    def canvas(self) -> Size:
        """The size of generated pictures: the requested one, else that of the graph, else that of its first picture."""
        size = self._request.size or self._graph_size
        if size is None:
            first = next(iter(self.named), None)
            size = self._find_first_size(*first) if first else DEFAULT_CANVAS
        self.canvas_is_read = True
        return scale_size(size, self._request.scale)

    def _find_first_size(self, picture: Picture, owner: str) -> Size:
        """The size of a picture; of a sequence, whether or not this frame has a file."""
        path = "" if picture.in_memory else self._find_file(picture, owner, self._request.frame, "nearest").path
        return self._probe(replace(picture, path=path) if path else picture, owner).size

    def _probe(self, picture: Picture, owner: str) -> PictureProbe:
        try:
            return self._provider.probe_picture(replace(picture, color=self._color))
        except HalationError as error:
            error.node = owner
            raise

    def _find_file(self, picture: Picture, owner: str, frame: int, missing: Missing) -> FrameFile:
        try:
            return self._provider.find_frame_file(picture.path, frame, missing)
        except HalationError as error:
            error.node = error.node or owner
            raise

    def read(self, picture: Picture, owner: str, frame: int, missing: Missing) -> Ref:
        """Upload a picture, or that frame of a sequence, at the size of the request."""
        picture, is_black = replace(picture, color=self._color), False
        if not picture.in_memory:
            frame_file = self._find_file(picture, owner, frame, missing)
            picture, is_black = replace(picture, path=frame_file.path, frame=frame_file.number), frame_file.black
        probed = self._probe(picture, owner)
        whole = self._request.size if self._request.size and probed.size != (1, 1) else probed.size
        size = scale_size(whole, self._request.scale)
        if is_black:
            socket = make_socket(picture.kind, picture.width)
            return self.convert(UniformConstant(make_zero(socket)), socket, size, owner)
        # A bound array is identified by its fingerprint. Only the request refers to the array, so that plans that are
        # kept for later do not keep it in memory.
        window = Region(*probed.overscan) if self._overscan and probed.overscan else None
        is_whole = window is not None or self._request.scale >= 1.0
        reduction = 1 if is_whole else _choose_reduction(probed, size)
        by_rows = probed.by_rows and reduction == 1
        picture = replace(picture, pixels=None, by_rows=by_rows, overscan=window is not None, reduction=reduction)
        shape = PictureShape(scale_size(probed.size, 1 / reduction), picture.width, picture.kind is not Kind.IMAGE)
        finite = probed.finite and reduction == 1  # the sum of large neighbors may be infinite
        ref = self._builder.add(
            Read((shape,), owner, picture, probed.fingerprint, probed.half, window, probed.pixel_aspect, finite)
        )
        return self.fit(ref, size, owner)

    def read_asset(self, picture: Picture, owner: str) -> Ref:
        """Upload a picture that belongs to a node, at its own size."""
        picture = replace(picture, color=self._color)
        probed = self._probe(picture, owner)
        shape = PictureShape(probed.size, picture.width, picture.kind is not Kind.IMAGE)
        return self._builder.add(Read((shape,), owner, picture, probed.fingerprint, probed.half, finite=probed.finite))

    def collect_resources(
        self, inputs: NodeInputs, missing: Missing, find_settings: Callable[[float], Mapping[str, Any]]
    ) -> NodeResources:
        """The files that a node names, which lie beside the graph file that it came from, and its values over time."""

        def locate(file: str) -> str:
            if not file:
                raise NoFileError(f"{describe_owner(inputs.path)}: no file is chosen: name one", node=inputs.path)
            return self.named.locate(file, inputs.path)

        def recolor(change: ColorChange) -> ColorProgram:
            if isinstance(change, LookupFile):
                change = replace(change, path=locate(change.path))
            else:
                change = replace(change, color=self._color)
            return self._provider.write_color_program(change)

        def read(picture: Picture) -> Ref:
            return self.read(replace(picture, path=locate(picture.path)), inputs.path, inputs.frame, missing)

        def mesh(scene: Scene) -> Mesh:
            if isinstance(scene, SceneFile):
                scene = replace(scene, path=locate(scene.path))
            return self._provider.load_mesh(scene)

        def render(file: str, named: Mapping[str, str]) -> Render:
            return self._provider.describe_render(
                self._provider.find_frame_file(locate(file), inputs.frame, missing).path, named
            )

        def asset(picture: Picture) -> Ref:
            whole = replace(picture, path=locate(picture.path), within=self.named.locate(picture.within, inputs.path))
            return self.read_asset(whole, inputs.path)

        def typeset(block: TextBlock) -> TypesetText:
            if block.typeface.path:
                block = replace(block, typeface=replace(block.typeface, path=locate(block.typeface.path)))
            return self._provider.typeset(block)

        def expand_text(clock: TextClock, text: str, picture: Socket) -> str:
            return self._expand_text(inputs, clock, text, picture)

        return NodeResources(read, recolor, mesh, render, asset, typeset, expand_text, find_settings)

    def _expand_text(self, inputs: NodeInputs, clock: TextClock, text: str, picture: Socket) -> str:
        """A text of a node with words in place of its tokens, some of which are about a picture that it reads."""
        from .text_tokens import TokenSources, expand_tokens, find_source_picture  # few graphs draw text

        def find_file() -> str:
            """The file of the first picture that the input is made of; "" if none comes from a file."""
            try:
                source, owner = find_source_picture(self._flat, self.named, inputs.path, picture.name)
            except LookupError:
                return ""
            return "" if source.in_memory else self._find_file(source, owner, inputs.frame, "nearest").path

        try:
            return expand_tokens(text, clock, TokenSources(find_file, self._provider.read_attributes, read_date))
        except GraphError as fault:
            raise GraphError(f"{describe_owner(inputs.path)}: {fault}", node=inputs.path) from fault

    def fit(self, ref: Ref, size: Size, owner: str) -> Ref:
        """The picture at another size. Equal up to rounding: stretched; otherwise scaled to cover and cropped."""
        shape = self._builder.shape(ref)
        if shape.size in (size, (1, 1)):
            return ref
        across, down = shape.size[0] / size[0], shape.size[1] / size[1]
        if abs(across / down - 1.0) > max(1.0 / side for side in (*size, *shape.size)):
            across = down = min(across, down)
        fitted_shape = PictureShape(size, shape.channels, shape.data)
        function = "fit_nearest" if shape.data else "fit"
        # The centers of both pictures coincide. One more pixel of reach covers rounding in 32-bit floats.
        matrix = (
            across,
            0.0,
            (shape.size[0] - across * size[0]) / 2.0,
            0.0,
            down,
            (shape.size[1] - down * size[1]) / 2.0,
        )
        around = Neighborhood(matrix, (max(across, 1.0) + 1.0, max(down, 1.0) + 1.0))
        accessor, scale = Accessor("image", "vec4", ref, around), Parameter("vec2", UniformConstant((across, down)))
        return self._builder.add(
            Gather((fitted_shape,), owner, "primitive/fit", function, (scale,), accessors=(accessor,))
        )

    def convert(self, operand: Operand, socket: Socket, size: Size, owner: str) -> Ref:
        """The same as the pixels that `socket` stands for."""
        glsl = socket.glsl
        shape = PictureShape(size, socket.channels, socket.kind is not Kind.IMAGE)
        parameters = (Parameter(glsl, operand),)
        return self._builder.add(Call((shape,), owner, "primitive/convert", f"as_{glsl}", parameters))


def _choose_reduction(probed: PictureProbe, size: Size) -> int:
    """How many pixels of a large file are read as one, across and down, where `size` is wanted: a power of two."""
    width, height = probed.size
    factor = 1
    if probed.by_rows and width * height >= LARGE_PICTURE:
        while all(side >= 2 * factor * goal - factor for side, goal in zip(probed.size, size, strict=True)):
            factor *= 2
    return factor
