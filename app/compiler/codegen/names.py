"""Names textures and uniforms of a pass, and writes the expressions that read them."""

from __future__ import annotations

import math

from halation.nodes import Uniform, glsl_type
from msgspec import Struct, field

from ..areas import Region
from ..ir import Choice, LoweredProgram, Parameter, Ref, UniformConstant
from ..target import Form

_FLOAT32 = 3.4e38
_INT32 = 2**31
"""The limits of numbers in GLSL: just below the largest float (3.403e38), and one above the largest int."""


class ShaderNames(Struct):
    """Declares uniforms as the text of a pass asks for them, and writes expressions that read pictures."""

    program: LoweredProgram
    textures: dict[Ref, int]
    form: Form
    by_image: bool
    uniforms: list[tuple[str, str, Uniform]] = field(default_factory=list[tuple[str, str, Uniform]])
    seams: bool = True
    """Whether fused functions are kept apart: see primitive/settled.glsl."""

    written: Region | None = None
    """The pixels that are written, where they are not those of a frame."""
    start: str = ""
    """The uniform with the first pixel that is written, if only a window of the picture is."""
    room: str = "grid"
    """The uniform with the size of what is written."""

    def declare_window(self, region: Region) -> None:
        """Write a region: a part of the picture, or more than its frame."""
        self.written = region
        self.start = self.uniform("ivec2", region.start, "window_start")
        self.room = self.uniform("ivec2", region.size, "window_size")

    def uniform(self, glsl: str, value: Uniform, name: str = "") -> str:
        """A uniform of this type set to `value`; booleans travel as integers."""
        name = name or f"u{len(self.uniforms)}"
        self.uniforms.append((name, "int" if glsl == "bool" else glsl, value))
        return f"({name} != 0)" if glsl == "bool" else name

    def load(self, ref: Ref, where: str) -> str:
        """The expression that reads one pixel; a 1x1 picture has the same pixel everywhere."""
        shape = self.program.shape(ref)
        where = "ivec2(0)" if shape.size == (1, 1) else where
        name = f"t{self.textures[ref]}"
        if self.program.window(ref):
            where = f"{where} - {name}_start"
        call = f"imageLoad({name}, {where})" if self.by_image else f"texelFetch({name}, {where}, 0)"
        return call + ("", ".r", ".rg", ".rgb", "")[shape.channels]

    def load_own(self, ref: Ref) -> str:
        """The expression that reads the pixel that is made: 0 where a picture ends before the one that is written."""
        window = self.program.window(ref) or Region.whole(self.program.shape(ref).size)
        text = self.load(ref, "pixel")
        if self.written is None or window.size == (1, 1) or window.contains(self.written):
            return text
        corners = self.uniform("ivec4", (*window.start, window.across[1], window.down[1]))
        guard = f"all(greaterThanEqual(pixel, {corners}.xy)) && all(lessThan(pixel, {corners}.zw))"
        return f"({guard} ? {text} : {glsl_type(self.program.shape(ref).channels)}(0.0))"

    def load_as(self, ref: Ref, where: str, glsl: str) -> str:
        """The expression that reads one pixel as another type."""
        return convert(self.load(ref, where), self.program.shape(ref).channels, glsl)

    def constant(self, item: UniformConstant, glsl: str) -> str:
        """A uniform with a constant, limited to the range of its type, and converted like a picture's channels."""
        if isinstance(item.value, tuple):
            value = tuple(_float32(part) for part in item.value)
            if glsl.endswith("]"):
                return self.uniform(glsl, value)
            if item.channels == 9:  # a mat3
                return self.uniform("mat3", value)
            return convert(self.uniform(glsl_type(item.channels), value), item.channels, glsl)
        if glsl == "bool":
            return self.uniform(glsl, item.value > 0.5)
        if glsl == "int":
            return self.uniform(glsl, math.floor(_int32(item.value) + 0.5))
        return convert(self.uniform("float", _float32(item.value)), 1, glsl)

    def argument(self, item: Parameter, values: dict[Ref, str]) -> str:
        """A parameter as an expression; `values` names what the pass has computed or loaded already."""
        if isinstance(item.operand, Choice):
            return str(item.operand.index)
        if isinstance(item.operand, UniformConstant):
            return self.constant(item.operand, item.glsl)
        text = values[item.operand]
        channels = self.program.shape(item.operand).channels
        if item.low != float("-inf") or item.high != float("inf"):
            text = f"clamp({text}, {_write_bound(item.low)}, {_write_bound(item.high)})"
        if item.factor != 1.0:
            text = f"{text} * {self.uniform('float', item.factor)}"
        return convert(text, channels, item.glsl)


def uniform_value(item: UniformConstant) -> Uniform:
    """The value of a constant within the range of its own type."""
    if isinstance(item.value, tuple):
        return tuple(_float32(part) for part in item.value)
    return _float32(item.value) if isinstance(item.value, float) else int(_int32(item.value))


def convert(text: str, channels: int, glsl: str) -> str:
    """Convert an expression with this many channels to another GLSL type, as sockets are converted."""
    if glsl == glsl_type(channels):
        return text
    if channels == 1:
        return {
            "int": f"int(floor({text} + 0.5))",
            "bool": f"({text} > 0.5)",
            "vec4": f"vec4(vec3({text}), 1.0)",
        }.get(glsl, f"{glsl}({text})")
    target_channels = glsl_channels(glsl)
    if channels > target_channels:
        return f"({text}).{'rgba'[:target_channels]}"
    return f"{glsl}({text}, {', '.join(['0.0'] * (target_channels - channels))})"


def glsl_channels(glsl: str) -> int:
    """How many floats a GLSL type holds."""
    return {"vec2": 2, "vec3": 3, "vec4": 4}.get(glsl, 1)


def _write_bound(limit: float) -> str:
    return repr(_float32(limit))


def _int32(value: float) -> float:
    return min(max(value, -_INT32), _INT32 - 1)


def _float32(value: float) -> float:
    return float(min(max(value, -_FLOAT32), _FLOAT32))
