"""Pictures from outside and their sizes: reading, fitting, converting."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from pathlib import PurePath

from ...nodes import Kind, Size, Socket, Source
from ..errors import HalationError
from ..graph import INPUTS, Graph, Input, Port
from .expand import Flat
from .ir import Accessor, Builder, Call, Constant, Gather, Operand, Parameter, Picture, Read, Ref, Shape
from .outside import Outside, Probed
from .request import Request

DEFAULT_CANVAS: Size = (1920, 1080)


class Pictures:
    """Adds what is read from outside, and changes of size and type, to the operations in `builder`."""

    def __init__(self, graph: Graph, flat: Flat, request: Request, outside: Outside, builder: Builder) -> None:
        self._settled = graph.settings.size
        self._flat, self._request, self._outside, self._builder = flat, request, outside, builder

    @cached_property
    def canvas(self) -> Size:
        """The size of what is made from nothing: asked for, the graph's own, or that of the first picture."""
        size = self._request.size or self._settled
        if size is None:
            first = next(self._named(), None)
            size = self._probed(*first).size if first else DEFAULT_CANVAS
        return self._scaled(size)

    def _probed(self, picture: Picture, owner: str) -> Probed:
        try:
            return self._outside.probe(picture)
        except HalationError as error:
            error.node = owner
            raise

    def _named(self) -> Iterator[tuple[Picture, str]]:
        """Pictures that the graph itself names, and who reads them: inputs first, then sources."""
        for port, socket in self._flat.inputs.items():
            named = port.node == INPUTS and not socket.socket().single
            picture = self.bound(port, socket) if named else None
            if picture is not None:
                yield picture, f"{port}"
        for path, node in self._flat.nodes.items():
            for value in node.values.values() if isinstance(node, Source) else ():
                if value.holds == "picture" and value.type == "path" and getattr(node, value.name):
                    yield Picture(self.located(getattr(node, value.name), path), "", Kind.IMAGE, 4), path

    def _scaled(self, size: Size) -> Size:
        scale = self._request.scale
        return (max(1, round(size[0] * scale)), max(1, round(size[1] * scale)))

    def bound(self, port: Port, socket: Input) -> Picture | None:
        """The picture bound to a graph input, else its default file. A camera is none."""
        if socket.kind is Kind.CAMERA:
            return None
        kind, width = socket.kind, socket.socket().channels
        bound = self._request.bindings.get(port.socket) if port.node == INPUTS else None
        if bound is not None:
            return replace(bound, kind=kind, width=width)
        if not socket.file:
            return None
        folder = self._flat.folders[port.node.removesuffix(INPUTS)]
        return Picture(str(PurePath(folder, socket.file)), socket.layer, kind, width)

    def read(self, picture: Picture, owner: str) -> Ref:
        """Upload a picture, at the size wanted."""
        probed = self._probed(picture, owner)
        data = picture.kind is not Kind.IMAGE
        shape = Shape(probed.size, picture.width, data)
        ref = self._builder.add(Read((shape,), owner, picture, probed.fingerprint, probed.half))
        wanted = self._request.size if self._request.size and probed.size != (1, 1) else probed.size
        return self.fit(ref, self._scaled(wanted), owner)

    def fit(self, ref: Ref, size: Size, owner: str) -> Ref:
        """The picture at another size. Equal up to rounding: stretched; otherwise scaled to cover and cropped."""
        shape = self._builder.shape(ref)
        if shape.size in (size, (1, 1)):
            return ref
        across, down = shape.size[0] / size[0], shape.size[1] / size[1]
        if abs(across / down - 1.0) > max(1.0 / side for side in (*size, *shape.size)):
            across = down = min(across, down)
        fitted = Shape(size, shape.channels, shape.data)
        function = "fit_nearest" if shape.data else "fit"
        accessor, scale = Accessor("image", "vec4", ref), Parameter("vec2", Constant((across, down)))
        return self._builder.add(Gather((fitted,), owner, "primitive/fit", function, (accessor,), (scale,)))

    def converted(self, operand: Operand, socket: Socket, size: Size, owner: str) -> Ref:
        """The same as the pixels that `socket` stands for."""
        glsl = socket.glsl
        shape = Shape(size, socket.channels, socket.kind is not Kind.IMAGE)
        parameters = (Parameter(glsl, operand),)
        return self._builder.add(Call((shape,), owner, "primitive/convert", f"as_{glsl}", parameters))

    def located(self, file: str, node: str) -> str:
        """Relative paths start at the folder of the graph file that the node came from."""
        return str(PurePath(self._flat.folders[node], file))
