"""Translates an ISF shader to GLSL 4.10.

ISF is written in GLSL for OpenGL 2: `varying`, `texture2D`, `gl_FragColor`, and names that are keywords today. Such
words are replaced one by one (`_translate`), so that line numbers stay and messages of drivers name the user's lines.
Functions of the format, such as IMG_PIXEL, are GLSL functions that are written before the text.

Row 0 is the bottom row in ISF and the top row here. No picture is flipped: positions are, where a function reads a
picture and where the shader asks for its own position (gl_FragCoord). That costs nothing and loses nothing.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from types import MappingProxyType

from halation.nodes import ShaderStage, ShaderText
from halation.shaders import folder

from ...glsl import words
from ...glsl.divisions import QUOTIENT, REMAINDER
from ...glsl.loops import COUNTER, MOST_ROUNDS, guard_loops
from ..code import Code, CodeFault
from ..securing import expand_code, guard_code
from .header import PICTURES, Header

_TOKEN = re.compile(r"\.?\d[\w.]*|(?P<word>[A-Za-z_]\w*)")
_QUALIFIED = re.compile(r"\s+(?:in|out|varying|uniform)\b")
_CALLED = re.compile(r"\s*\(")

RENAMED_WORDS: Mapping[str, str] = MappingProxyType(
    {
        "main": "isf_main",
        "gl_FragColor": "isf_FragColor",
        "gl_FragCoord": "isf_FragCoord",
        "vv_FragNormCoord": "isf_FragNormCoord",
        "vv_vertShaderInit": "isf_vertShaderInit",
    }
)
RENAMED_FUNCTIONS: Mapping[str, str] = MappingProxyType(
    {
        "texture": "isf_texture",
        "texture2D": "isf_texture",
        "texture2DRect": "IMG_PIXEL",
        "textureLod": "isf_textureLod",
        "texture2DLod": "isf_textureLod",
        "texelFetch": "isf_texelFetch",
        "dFdy": "isf_dFdy",
    }
)
"""Functions that depend on where row 0 is."""

LATER_KEYWORDS = frozenset(
    {
        "active",
        "asm",
        "buffer",
        "cast",
        "class",
        "coherent",
        "common",
        "enum",
        "extern",
        "external",
        "filter",
        "fixed",
        "goto",
        "half",
        "inline",
        "input",
        "interface",
        "long",
        "namespace",
        "noinline",
        "output",
        "partition",
        "patch",
        "precise",
        "public",
        "readonly",
        "resource",
        "restrict",
        "sample",
        "shared",
        "short",
        "sizeof",
        "static",
        "subroutine",
        "superp",
        "template",
        "this",
        "typedef",
        "union",
        "unsigned",
        "using",
        "writeonly",
    }
)
"""Keywords of GLSL 4.10 that were free in the GLSL of ISF."""

QUALIFIERS = frozenset({"smooth", "flat", "noperspective", "centroid"})
"""Keywords that ISF uses as names unless a declaration follows."""

_READING = """vec2 IMG_SIZE(sampler2D image) { return vec2(textureSize(image, 0)); }
vec4 IMG_NORM_PIXEL(sampler2D image, vec2 at) { return textureLod(image, vec2(at.x, 1.0 - at.y), 0.0); }
vec4 IMG_PIXEL(sampler2D image, vec2 at) {
    vec2 size = IMG_SIZE(image);
    return textureLod(image, vec2(at.x, size.y - at.y) / size, 0.0);
}
vec4 IMG_THIS_PIXEL(sampler2D image) { return IMG_NORM_PIXEL(image, isf_FragNormCoord); }
vec4 IMG_THIS_NORM_PIXEL(sampler2D image) { return IMG_NORM_PIXEL(image, isf_FragNormCoord); }
vec4 IMG_NORM_THIS_PIXEL(sampler2D image) { return IMG_NORM_PIXEL(image, isf_FragNormCoord); }
vec4 isf_texture(sampler2D image, vec2 at) { return IMG_NORM_PIXEL(image, at); }
vec4 isf_texture(sampler2D image, vec2 at, float bias) { return IMG_NORM_PIXEL(image, at); }
vec4 isf_textureLod(sampler2D image, vec2 at, float level) { return IMG_NORM_PIXEL(image, at); }
vec4 isf_texelFetch(sampler2D image, ivec2 at, int level) {
    return texelFetch(image, ivec2(at.x, textureSize(image, 0).y - 1 - at.y), 0);
}
"""
_DERIVATIVES = """float isf_dFdy(float x) { return -dFdy(x); }
vec2 isf_dFdy(vec2 x) { return -dFdy(x); }
vec3 isf_dFdy(vec3 x) { return -dFdy(x); }
vec4 isf_dFdy(vec4 x) { return -dFdy(x); }
"""
_FRAGMENT_END = """
bool isf_is_finite(float x) { return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u; }
float isf_held(float x) { return isf_is_finite(x) ? clamp(x, isf_range.x, isf_range.y) : 0.0; }
vec4 halation_pixel() {
    isf_main();
    vec4 c = isf_FragColor;
    return %s vec4(isf_held(c.r), isf_held(c.g), isf_held(c.b), isf_held(c.a));
}"""
_SPOILT = f"{COUNTER} > {MOST_ROUNDS} ? vec4(uintBitsToFloat(0x7fc00000u)) :"
"""What a pixel is whose loops had to be left: a wrong number would be taken for a right one."""

_VERTEX_START = """out vec2 isf_FragNormCoord;
void isf_vertShaderInit() {
    isf_FragNormCoord = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(isf_FragNormCoord * 2.0 - 1.0, 0.0, 1.0);
}
"""
_VERTEX_END = """
void main() {
    isf_vertShaderInit();
    isf_main();
    gl_Position.y = -gl_Position.y;
}"""

_READERS = ("IMG_SIZE", "IMG_NORM_PIXEL", "IMG_PIXEL", "IMG_THIS_PIXEL", "IMG_THIS_NORM_PIXEL", "IMG_NORM_THIS_PIXEL")
"""Functions of the format that return floats."""

UNIFORMS: Mapping[str, str] = MappingProxyType(
    {
        "PASSINDEX": "int",
        "RENDERSIZE": "vec2",
        "TIME": "float",
        "TIMEDELTA": "float",
        "DATE": "vec4",
        "FRAMEINDEX": "int",
    }
)
_TYPES: Mapping[str, str] = MappingProxyType(
    {
        "event": "bool",
        "bool": "bool",
        "long": "int",
        "float": "float",
        "point2D": "vec2",
        "color": "vec4",
    }
)


def write_program(code: Code, header: Header) -> ShaderText:
    """Write the program of a shader. Raises CodeFault.

    The format counts rows from below, Halation from above: so the fragment coordinate and what is derived along y are
    turned over. Library text is added only where the shader uses it: it costs compile time.
    """
    types = _list_types(header)
    fragment, vertex = (
        guard_code(guard_loops(_translate(expand_code(text, types=types), way)), types)
        for text, way in ((code.text, "in"), (code.vertex, "out"))
    )
    for text, file in ((fragment, code.name), (vertex, "its vertex shader")):
        if text.strip() and "isf_main" not in words(text):
            raise CodeFault(0, f"there is no void main() in {file}")
    if not fragment.strip():
        raise CodeFault(0, "there is no GLSL after the head: write a void main() that sets gl_FragColor")
    used = words(fragment, vertex)
    declared = [
        *_declare_uniforms(header, used),
        *(f"uniform sampler2D {rename_word(name)};" for name in list_samplers(header, used)),
    ]
    declared += [*_define_host_names(header, used), f"int {COUNTER} = 0;"]
    if used & {QUOTIENT, REMAINDER}:
        declared.append((folder() / "lib" / "whole.glsl").read_text("utf-8"))
    where = "#define isf_FragNormCoord (isf_FragCoord.xy / RENDERSIZE)"
    where = "in vec2 isf_FragNormCoord;" if vertex.strip() else where
    top = [
        *declared,
        "uniform vec2 isf_range;",
        "vec4 isf_FragColor = vec4(0.0);",
        "#define isf_FragCoord vec4(gl_FragCoord.x, RENDERSIZE.y - gl_FragCoord.y, gl_FragCoord.zw)",
        where,
        _READING + (_DERIVATIVES if "isf_dFdy" in used else ""),
    ]
    painted = ShaderStage(
        "\n".join(top), fragment, _FRAGMENT_END % (_SPOILT if COUNTER in used else ""), code.file or "its code"
    )
    if not vertex.strip():
        return ShaderText(painted)
    file = code.file.rpartition(".")[0] + ".vs"
    return ShaderText(painted, ShaderStage("\n".join([*declared, _VERTEX_START, _READING]), vertex, _VERTEX_END, file))


def list_samplers(header: Header, used: frozenset[str]) -> tuple[str, ...]:
    """The names in the header of the pictures that the text reads."""
    pictures = (header_input.name for header_input in header.inputs if header_input.type in PICTURES)
    return tuple(
        name
        for name in (*pictures, *header.buffers, *header.imported)
        if {rename_word(name), *_host_names(name)} & used
    )


def list_values(header: Header, used: frozenset[str]) -> tuple[str, ...]:
    """The names in the header of the other inputs that the text reads."""
    return tuple(
        header_input.name
        for header_input in header.inputs
        if header_input.type not in PICTURES and rename_word(header_input.name) in used
    )


def rename_word(name: str) -> str:
    """The name in the program of a name in the header."""
    return f"isf_{name}" if name in LATER_KEYWORDS or name in QUALIFIERS else name


def _translate(text: str, varying: str) -> str:
    """Replace words of old GLSL, so that each line stays in its place; macros are expanded already."""

    def word(match: re.Match[str]) -> str:
        name = match["word"]
        if name is None:
            return match[0]
        if name == "varying":
            return varying
        if name in RENAMED_WORDS:
            return RENAMED_WORDS[name]
        if name in RENAMED_FUNCTIONS and _CALLED.match(text, match.end()):
            return RENAMED_FUNCTIONS[name]
        if name in LATER_KEYWORDS or (name in QUALIFIERS and not _QUALIFIED.match(text, match.end())):
            return f"isf_{name}"
        return name

    return _TOKEN.sub(word, text)


def _list_types(header: Header) -> dict[str, str]:
    """The types of what shaders can use without declaring it; those of functions by their names and brackets."""
    types = {
        **UNIFORMS,
        **{
            header_input.name: _TYPES[header_input.type]
            for header_input in header.inputs
            if header_input.type not in PICTURES
        },
    }
    types |= {rename_word(name): glsl for name, glsl in types.items()}
    functions = {f"{name}()": "vec4" for name in _READERS}
    return types | functions | {"isf_FragCoord": "vec4", "isf_FragNormCoord": "vec2", "isf_FragColor": "vec4"}


def _declare_uniforms(header: Header, used: frozenset[str]) -> Iterator[str]:
    # The macros of the top read the size, whatever the text does.
    for name, glsl in UNIFORMS.items():
        if name in used or name == "RENDERSIZE":
            yield f"uniform {glsl} {name};"
    types = {
        header_input.name: _TYPES[header_input.type]
        for header_input in header.inputs
        if header_input.type not in PICTURES
    }
    for name in list_values(header, used):
        yield f"uniform {types[name]} {rename_word(name)};"


def _host_names(name: str) -> tuple[str, str, str]:
    return f"_{name}_imgRect", f"_{name}_imgSize", f"_{name}_flip"


def _define_host_names(header: Header, used: frozenset[str]) -> Iterator[str]:
    """Define names that ISF hosts provide for each picture; no document has them, but shaders use them."""
    for name in list_samplers(header, used):
        size = f"vec2(textureSize({rename_word(name)}, 0))"
        texts = (f"vec4(0.0, 0.0, {size})", size, "false")
        for word, text in zip(_host_names(name), texts, strict=True):
            if word in used:
                yield f"#define {word} {text}"
