"""A node made of a shader in the Interactive Shader Format."""

from __future__ import annotations

from functools import lru_cache
from hashlib import blake2b
from pathlib import PurePath
from typing import Any

from halation.nodes import Draw, Drawn, Filter, OutputSocket, Scalar, ShaderText, Size, Temporal, Uniform, Value, Vector
from msgspec import Struct

from ...errors import GraphError
from ...glsl import parse, words
from ..code import Code, CustomNode, make_class
from ..securing import check_length
from .glsl import UNIFORMS, list_samplers, list_values, rename_word, write_program
from .header import PICTURES, Buffer, Header, read_header
from .inputs import (
    LIGHT,
    choose_input_names,
    make_isf_socket,
    make_isf_value,
    make_uniform,
    uniform_as_number,
    write_isf_doc,
)
from .sizes import SizeError

_DAY = 86400.0
"""Seconds of a day, in which DATE counts."""

MAX_ISF_CLASSES = 512
"""Classes that are kept, the newest: each version of a text that is being edited makes one. Chosen by judgement."""
_BYTES = (0.0, 1.0)
_FLOATS = (-3.4e38, 3.4e38)
"""What buffers hold: bytes as fractions, and floats just below the largest (3.403e38)."""

_LIGHTS = ("display", "linear")
_LIGHT = Value(
    LIGHT,
    "choice",
    "display",
    choices=_LIGHTS,
    doc="What the shader computes with: display values (sRGB), as hosts of the format give it, or linear light.",
)
_AROUND = """#include "lib/isf.glsl"
vec4 isf_read(vec4 image, int light) { return light == LIGHT_DISPLAY ? display_straight(image) : straight(image); }
vec4 isf_made(vec4 image, int light) { return light == LIGHT_DISPLAY ? from_codes(image) : from_straight(image); }
vec4 isf_sound(float sound) { return vec4(vec3(sound), 1.0); }
vec4 isf_nothing() { return vec4(0.0); }
"""


class IsfShader(Struct, frozen=True):
    """What a class draws with: its head, its program, and what the program reads, by the head's names."""

    header: Header
    text: ShaderText
    folder: str
    names: dict[str, str]
    """The node's names of inputs."""
    samplers: tuple[str, ...]
    values: tuple[str, ...]
    builtin: tuple[str, ...]


@lru_cache(MAX_ISF_CLASSES)
def make_isf_class(code: Code) -> type[CustomNode]:
    """The class of the nodes that this shader describes. Raises CodeFault.

    Its shader is named by a digest of the text and the file: two texts must never share a compiled program.
    """
    for part in (code.text, code.vertex):
        check_length(part)
    header = read_header(code.text)
    text = write_program(code, header)
    used = words(*(stage.text for stage in (text.fragment, text.vertex) if stage))
    names = choose_input_names(header.inputs)
    shader = IsfShader(
        header,
        text,
        PurePath(code.file).parent.as_posix() if code.file else "",
        names,
        list_samplers(header, used),
        list_values(header, used),
        tuple(name for name in UNIFORMS if name in used or name == "RENDERSIZE"),
    )
    sockets = {names[entry.name]: make_isf_socket(entry) for entry in header.inputs if entry.type in PICTURES}
    node_values = {
        name: make_isf_value(entry, name)
        for entry in header.inputs
        if (name := names[entry.name]) and entry.type not in PICTURES
    }
    node_values[LIGHT] = _LIGHT

    def passes(self: Filter, draw: Draw) -> Drawn:
        return _ShaderDrawing(self, draw, shader).draw_passes()

    base = Temporal if any(buffer.persistent for buffer in header.buffers.values()) else Filter
    title = PurePath(code.file).stem or "shader"
    methods: dict[str, Any] = {"__doc__": write_isf_doc(header.doc, names), "passes": passes}
    order = (*names.values(), LIGHT)
    outputs = {"out": OutputSocket()}
    node_class = make_class(code, "Shader", base, sockets, node_values, outputs, order, methods)
    digest = blake2b(repr((code.text, code.vertex, code.file)).encode(), digest_size=8).hexdigest()
    node_class.function, node_class.shader = "isf_read", f"written/isf{digest}"
    node_class.title = title
    node_class.text = parse(node_class.shader, _AROUND, "what stands around shaders")
    return node_class


class _ShaderDrawing:
    """One node at work."""

    def __init__(self, node: Filter, draw: Draw, shader: IsfShader) -> None:
        self.node, self.draw, self.shader, self.header = node, draw, shader, shader.header
        self.light = str(node.setting(LIGHT))
        entries = {entry.name: entry for entry in self.header.inputs}
        self.uniforms: dict[str, Uniform] = {
            name: make_uniform(entry, self._find_setting(name), self.light == "display")
            for name, entry in entries.items()
            if entry.type not in PICTURES
        }
        lengths = {name: uniform_as_number(uniform) for name, uniform in self.uniforms.items()}
        self.lengths = lengths | {"WIDTH": float(draw.size[0]), "HEIGHT": float(draw.size[1])}

    def draw_passes(self) -> Drawn:
        """Draw every pass, remember what is persistent; the last pass is the picture.

        A pass reads a buffer as it is at that moment: from the previous frame until its own pass has drawn it.
        """
        sizes = {name: self._find_buffer_size(buffer) for name, buffer in self.header.buffers.items()}
        pictures = self._make_samplers(sizes)
        picture, drawn_buffers = None, set[str]()
        for index, target in enumerate(self.header.passes):
            buffer = self.header.buffers.get(target)
            size = sizes.get(target, self.draw.size)
            limits = _BYTES if buffer and not buffer.floating else _FLOATS
            uniforms = self._make_builtin_uniforms(index, size) | {
                rename_word(name): self.uniforms[name] for name in self.shader.values
            }
            picture = self.draw.program(
                self.shader.text,
                {rename_word(name): pictures[name] for name in self.shader.samplers},
                uniforms | {"isf_range": limits},
                size=size,
                result=_buffer_type(buffer),
            )
            if buffer:
                drawn_buffers.add(target)
                if target in pictures:
                    pictures[target] = picture
                if buffer.persistent:
                    self.draw.remember(picture, target)
        assert picture is not None
        return self.draw.point("isf_made", image=picture, light=self.light)

    def _make_samplers(self, sizes: dict[str, Size]) -> dict[str, Drawn]:
        """What every sampler reads before the first pass."""
        pictures: dict[str, Drawn] = {}
        for name in self.shader.samplers:
            if buffer := self.header.buffers.get(name):
                # What is not drawn yet is black; what it is as large as matters only where it comes back.
                size = sizes[name] if buffer.persistent else (1, 1)
                pictures[name] = self.draw("isf_nothing", size=size, result=_buffer_type(buffer))
                if buffer.persistent:
                    pictures[name] = self.draw.history(pictures[name], name)
            elif path := self.header.imported.get(name):
                picture = self.draw.asset((PurePath(self.shader.folder) / path).as_posix(), self.shader.folder)
                pictures[name] = self.draw.point("isf_read", image=picture, light="display")
            else:
                socket = self.node.inputs[self.shader.names[name]]
                if socket.channels == 1:
                    pictures[name] = self.draw.point("isf_sound", sound=socket)
                else:
                    pictures[name] = self.draw.point("isf_read", image=socket, light=self.light)
        return pictures

    def _make_builtin_uniforms(self, index: int, size: Size) -> dict[str, Uniform]:
        """What the format itself tells a shader: time counts frames, never a clock."""
        frame, rate = self.draw.frame - self.draw.start, self.draw.rate
        uniforms: dict[str, Uniform] = {
            "PASSINDEX": index,
            "RENDERSIZE": (float(size[0]), float(size[1])),
            "TIME": frame / rate,
            "TIMEDELTA": 1.0 / rate if frame else 0.0,
            "FRAMEINDEX": frame,
            "DATE": (2000.0, 1.0, 1.0, (frame / rate) % _DAY),
        }
        return {name: uniforms[name] for name in self.shader.builtin}

    def _find_buffer_size(self, buffer: Buffer) -> Size:
        sizes: list[int] = []
        for formula, plain, side in zip(
            (buffer.width, buffer.height), self.draw.size, ("WIDTH", "HEIGHT"), strict=True
        ):
            try:
                sizes.append(formula.pixels(self.lengths) if formula else plain)
            except SizeError as fault:
                text = formula.text if formula else ""
                raise GraphError(f"the {side} of the buffer '{buffer.name}', '{text}': {fault}") from None
        return sizes[0], sizes[1]

    def _find_setting(self, name: str) -> Scalar:
        return self.node.setting(self.shader.names[name])


def _buffer_type(buffer: Buffer | None) -> Vector | None:
    """Buffers that ask for it always have 32 bits; others are as precise as pictures are."""
    return Vector(width=4) if buffer and buffer.floating else None
