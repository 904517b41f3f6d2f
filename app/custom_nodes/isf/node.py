"""A node made of a shader in the Interactive Shader Format."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from hashlib import blake2b
from pathlib import PurePath
from types import new_class
from typing import Any, Literal, cast

from halation.nodes import Draw, Drawn, Filter, Plain, ShaderText, Size, Temporal, Uniform, Value, Vector

from ...errors import GraphError
from ...glsl import parse, words
from ..code import Code, CustomNode
from ..securing import check_length
from .glsl import UNIFORMS, rename_word, samplers, shader_text, values
from .header import PICTURES, Buffer, Header, read_header
from .inputs import LIGHT, attributes, doc_of, number_of, socket_of, uniform_of, value_of
from .sizes import SizeError

KEPT = 512
_BYTES = (0.0, 1.0)
_FLOATS = (-3.4e38, 3.4e38)
"""What buffers hold."""

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


@dataclass(frozen=True)
class IsfShader:
    """What a class draws with: its head, its program, and what the program reads, by the head's names."""

    header: Header
    text: ShaderText
    folder: str
    called: dict[str, str]
    """The node's names of inputs."""
    samplers: tuple[str, ...]
    values: tuple[str, ...]
    builtin: tuple[str, ...]


@lru_cache(KEPT)
def isf_node(code: Code) -> type[CustomNode]:
    """The class of the nodes that this shader describes. Raises CodeFault."""
    for part in (code.text, code.vertex):
        check_length(part)
    header = read_header(code.text)
    text = shader_text(code, header)
    used = words(*(stage.text for stage in (text.fragment, text.vertex) if stage))
    called = attributes(header.inputs)
    shader = IsfShader(
        header,
        text,
        PurePath(code.file).parent.as_posix() if code.file else "",
        called,
        samplers(header, used),
        values(header, used),
        tuple(name for name in UNIFORMS if name in used or name == "RENDERSIZE"),
    )
    body: dict[str, Any] = {"__module__": __name__, "__doc__": doc_of(header.doc, called), "__annotations__": {}}
    values_: dict[str, Value] = {}
    for entry in header.inputs:
        name = called[entry.name]
        if entry.type in PICTURES:
            body[name] = socket_of(entry)
        else:
            values_[name], body["__annotations__"][name] = value_of(entry, name)
            body[name] = values_[name].default
    body[LIGHT], body["__annotations__"][LIGHT] = _LIGHT.default, Literal[_LIGHTS]

    def passes(self: Filter, draw: Draw) -> Drawn:
        return _Drawing(self, draw, shader).whole()

    body["passes"] = passes
    base = Temporal if any(buffer.persistent for buffer in header.buffers.values()) else Filter
    title = PurePath(code.file).stem or "shader"
    node_class = cast("type[CustomNode]", new_class("Shader", (CustomNode, base), {}, lambda space: space.update(body)))
    digest = blake2b(repr((code.text, code.vertex, code.file)).encode(), digest_size=8).hexdigest()
    node_class.id, node_class.category = "isf", "code"
    node_class.values = {**values_, LIGHT: _LIGHT}
    node_class.function, node_class.shader = "isf_read", f"written/isf{digest}"
    node_class.code, node_class.title = code, title
    node_class.text = parse(node_class.shader, _AROUND, "what stands around shaders")
    return node_class


class _Drawing:
    """One node at work."""

    def __init__(self, node: Filter, draw: Draw, shader: IsfShader) -> None:
        self.node, self.draw, self.shader, self.header = node, draw, shader, shader.header
        self.light = cast("str", getattr(node, LIGHT))
        entries = {entry.name: entry for entry in self.header.inputs}
        self.uniforms: dict[str, Uniform] = {
            name: uniform_of(entry, self._plain(name), self.light == "display")
            for name, entry in entries.items()
            if entry.type not in PICTURES
        }
        lengths = {name: number_of(uniform) for name, uniform in self.uniforms.items()}
        self.lengths = lengths | {"WIDTH": float(draw.size[0]), "HEIGHT": float(draw.size[1])}

    def whole(self) -> Drawn:
        """Draw every pass, remember what is persistent; the last pass is the picture."""
        sizes = {name: self._size(buffer) for name, buffer in self.header.buffers.items()}
        pictures = self._pictures(sizes)
        made, drawn = None, set[str]()
        for index, target in enumerate(self.header.passes):
            buffer = self.header.buffers.get(target)
            size = sizes.get(target, self.draw.size)
            held = _BYTES if buffer and not buffer.floating else _FLOATS
            known = self._find_uniforms(index, size) | {
                rename_word(name): self.uniforms[name] for name in self.shader.values
            }
            made = self.draw.program(
                self.shader.text,
                {rename_word(name): pictures[name] for name in self.shader.samplers},
                known | {"isf_range": held},
                size=size,
                result=_result(buffer),
            )
            if buffer:
                drawn.add(target)
                if target in pictures:
                    pictures[target] = made
                if buffer.persistent:
                    self.draw.remember(made, target)
        assert made is not None
        return self.draw.point("isf_made", image=made, light=self.light)

    def _pictures(self, sizes: dict[str, Size]) -> dict[str, Drawn]:
        """What every sampler reads before the first pass."""
        pictures: dict[str, Drawn] = {}
        for name in self.shader.samplers:
            if buffer := self.header.buffers.get(name):
                # What is not drawn yet is black; what it is as large as matters only where it comes back.
                size = sizes[name] if buffer.persistent else (1, 1)
                pictures[name] = self.draw("isf_nothing", size=size, result=_result(buffer))
                if buffer.persistent:
                    pictures[name] = self.draw.history(pictures[name], name)
            elif path := self.header.imported.get(name):
                picture = self.draw.asset((PurePath(self.shader.folder) / path).as_posix(), self.shader.folder)
                pictures[name] = self.draw.point("isf_read", image=picture, light="display")
            else:
                socket = self.node.inputs[self.shader.called[name]]
                if socket.channels == 1:
                    pictures[name] = self.draw.point("isf_sound", sound=socket)
                else:
                    pictures[name] = self.draw.point("isf_read", image=socket, light=self.light)
        return pictures

    def _find_uniforms(self, index: int, size: Size) -> dict[str, Uniform]:
        """What the format itself tells a shader: time counts frames, never a clock."""
        frame, rate = self.draw.frame - self.draw.start, self.draw.rate
        found: dict[str, Uniform] = {
            "PASSINDEX": index,
            "RENDERSIZE": (float(size[0]), float(size[1])),
            "TIME": frame / rate,
            "TIMEDELTA": 1.0 / rate if frame else 0.0,
            "FRAMEINDEX": frame,
            "DATE": (2000.0, 1.0, 1.0, (frame / rate) % 86400.0),
        }
        return {name: found[name] for name in self.shader.builtin}

    def _size(self, buffer: Buffer) -> Size:
        sizes: list[int] = []
        for formula, plain, what in zip(
            (buffer.width, buffer.height), self.draw.size, ("WIDTH", "HEIGHT"), strict=True
        ):
            try:
                sizes.append(formula.pixels(self.lengths) if formula else plain)
            except SizeError as fault:
                text = formula.text if formula else ""
                raise GraphError(f"the {what} of the buffer '{buffer.name}', '{text}': {fault}") from None
        return sizes[0], sizes[1]

    def _plain(self, name: str) -> Plain:
        return getattr(self.node, self.shader.called[name])


def _result(buffer: Buffer | None) -> Vector | None:
    """Buffers that ask for it always have 32 bits; others are as precise as pictures are."""
    return Vector(width=4) if buffer and buffer.floating else None
