"""Writes the passes of a program as functions of one shader, and finds what a shader cannot do."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping

from halation.nodes import Uniform
from msgspec import field

from ...glsl import GlslText, words
from ..codegen.includes import find_macros, select_texts, split_by_accessors
from ..codegen.names import ShaderNames, convert
from ..codegen.pass_parts import PassContext, PassParts, write_pass_parts
from ..fusion.fuse import PassGroup
from ..ir import ExternalProgram, HostCall, LoweredProgram, Op, Raster, Ref, UniformConstant
from ..library import Library
from .affine import write_literal

_DEFINED = re.compile(r"\bstruct\s+(\w+)|^[ \t]*#[ \t]*define[ \t]+(\w+)", re.MULTILINE)
_CONSTANTS = re.compile(r"^const\s+\w+\s+([^;]*);", re.MULTILINE)
_CONSTANT = re.compile(r"(?:^|,)\s*(\w+)(?:\[[^\]]*\])?\s*=")
_FUNCTION = re.compile(r"^[ \t]*(?:float|int|bool|[iu]?vec[234]|mat3|void)[ \t]+(\w+)[ \t]*\(", re.MULTILINE)
_BITS = re.compile(r"bool (is_hole|is_too_large|is_finite)\(float (\w)\) \{[^}]*\}")
_SIZES = {
    "is_hole": "!(abs({}) <= 3.4e38)",
    "is_too_large": "!(abs({}) < 1.7014118e38)",
    "is_finite": "abs({}) <= 3.4e38",
}
"""The same functions without bits."""
_FINITE = re.compile(r"float finite\(float x\) \{.*?\n\}", re.DOTALL)
_GLOBALS = ("pixel", "extent", "grid", "frame", "proxy")


class IsfNames(ShaderNames):
    """Names in a shader of the format: pictures are read by functions, uniforms are set at the start of the pass."""

    write_constant: Callable[[UniformConstant], tuple[str, ...] | None] = lambda item: None
    write_size: Callable[[Uniform], tuple[str, str] | None] = lambda size: None
    first: int = 1
    """The frame that FRAMEINDEX counts from."""
    readers: Mapping[Ref, str] = field(default_factory=dict[Ref, str])
    settings: list[tuple[str, str, str]] = field(default_factory=list[tuple[str, str, str]])
    """Type, name and GLSL of each number that is set at the start of the pass."""

    def uniform(self, glsl: str, value: Uniform, name: str = "") -> str:
        name = name or f"u{len(self.settings)}"
        sizes = self.write_size(value) if glsl == "ivec2" and name.endswith("_size") else None
        if sizes:
            text = f"ivec2({sizes[0]}, {sizes[1]})"
        elif glsl.endswith("]") and isinstance(value, tuple):
            each = ", ".join(_write_plain("vec4", value[at : at + 4]) for at in range(0, len(value), 4))
            text = f"{glsl}({each})"
        else:
            text = _write_plain(glsl, value)
        self.settings.append(("int" if glsl == "bool" else glsl, name, text))
        return f"({name} != 0)" if glsl == "bool" else name

    def load(self, ref: Ref, where: str) -> str:
        where = "ivec2(0)" if self.program.shape(ref).size == (1, 1) else where
        return f"@{self.readers[ref]}({where})" + ("", ".r", ".rg", ".rgb", "")[self.program.shape(ref).channels]

    def constant(self, item: UniformConstant, glsl: str) -> str:
        texts = self.write_constant(item)
        if texts is None or glsl.endswith("]") or item.channels > 4:
            return super().constant(item, glsl)
        if glsl in ("int", "bool"):
            number = "".join(texts)
            return f"int(floor({number} + 0.5))" if glsl == "int" else f"({number} > 0.5)"
        whole = f"vec{len(texts)}({', '.join(texts)})" if len(texts) > 1 else f"({''.join(texts)})"
        return convert(whole, len(texts), glsl)


def find_obstacles(
    program: LoweredProgram, passes: tuple[PassGroup, ...], pictures: Mapping[Ref, str]
) -> Iterator[tuple[str, str]]:
    """Why a graph cannot be written as one shader: a node and a sentence about it for each reason."""
    for fused in passes:
        for index in fused.members:
            yield from (
                (owner, why) for owner in program.ops[index].owners if (why := _find_obstacle(program.ops[index]))
            )
        for ref in fused.reads:
            op = program.ops[ref.op]
            picture = op.find_upload(ref.output)
            if picture and ref not in pictures and not op.owner.startswith("inputs."):
                obstacle = "a table of numbers" if picture.path == "numbers" else f"the file '{picture.path}'"
                yield op.owner, f"reads {obstacle}, which no shader can hold"
    for port in program.memories:
        yield port.node, "remembers the frame before"


_OBSTACLES: Mapping[type[Op], str] = {
    Raster: "draws meshes",
    HostCall: "runs on the processor",
    ExternalProgram: "is a shader of this format already: use its file",
}
"""Kinds of operations that a shader of this format cannot do."""


def _find_obstacle(op: Op) -> str:
    return _OBSTACLES.get(type(op)) or ("changes color by tables of a color library" if op.tables else "")


def write_function(
    program: LoweredProgram, fused: PassGroup, output: int, prefix: str, names: IsfNames, library: Library
) -> tuple[list[str], str]:
    """The functions of a pass, and the name of the one that makes its pixel: a vec4.

    What differs from a pass of our own: uniforms are globals that the function sets first, because their numbers are
    formulas of controls; weights are a function, because the format has no uniform blocks; and all names get a prefix,
    because all passes share one text.
    """
    context = PassContext(program, fused, names, library)
    parts = write_pass_parts(context.root, context)
    functions = list(parts.functions)
    if parts.convolution:
        functions[0] = f"float weight(int j) {{ {_write_weight(parts.convolution.weights, 0)} }}"
        functions = [line.replace("weights[j >> 2][j & 3]", "weight(j)") for line in functions]
    texts = select_texts(context, parts)
    lines = list(_write_functions(context, texts, parts, functions))
    result = parts.results[output]
    whole = convert(result, names.program.shape(fused.writes[output]).channels, "vec4")
    used_words = words(*lines, *parts.body, result)
    optional_globals = {
        "frame": ("int", f"@FRAMEINDEX + {names.first}"),
        "proxy": ("float", write_literal(program.scale)),
    }
    assignments = [
        "pixel = ivec2(int(gl_FragCoord.x), int(RENDERSIZE.y - gl_FragCoord.y));",
        "grid = ivec2(RENDERSIZE);",
        "extent = grid;",
    ]
    declarations = ["ivec2 pixel;", "ivec2 grid;", "ivec2 extent;"]
    for name, (glsl, text) in optional_globals.items():
        if name in used_words:
            declarations.append(f"{glsl} {name};")
            assignments.append(f"{name} = {text};")
    for glsl, name, text in names.settings:
        if glsl.endswith("]"):
            declarations.append(f"const {glsl[:4]} {name}{glsl[4:]} = {text};")
        else:
            declarations.append(f"{glsl} {name};")
            assignments.append(f"{name} = {text};")
    body = [*declarations, *lines, "vec4 made() {", *assignments, *parts.body, f"return {whole};", "}"]
    text = "\n".join(line.rstrip() for line in "\n".join(body).split("\n") if line.strip())
    return _prefix_names(text, prefix, names, texts).split("\n"), f"{prefix}made"


def _write_functions(
    context: PassContext, texts: tuple[GlslText, ...], parts: PassParts, functions: list[str]
) -> Iterator[str]:
    early, late = split_by_accessors(texts, parts)
    for group in (early, None, late):
        if group is None:
            yield from functions
            continue
        for text in group:
            macros = find_macros(text, context)
            yield from (f"#define {name} {number}" for name, number in macros)
            yield _make_portable(text.body)
            yield from (f"#undef {name}" for name, _ in macros)


def _make_portable(body: str) -> str:
    """The text without the bits of floats, and a word, that older GLSL does not know."""
    body = re.sub(r"\bprecise\s+", "", body)
    body = _BITS.sub(
        lambda match: f"bool {match[1]}(float {match[2]}) {{ return {_SIZES[match[1]].format(match[2])}; }}", body
    )
    return _FINITE.sub(
        "float finite(float x) { return abs(x) <= 3.4e38 ? x : x > 0.0 ? 65504.0 : x < 0.0 ? -65504.0 : 0.0; }", body
    )


def _prefix_names(text: str, prefix: str, names: IsfNames, texts: tuple[GlslText, ...]) -> str:
    """Every global name gets the prefix of the pass: two passes may define the same. What is marked with @ stays."""
    own = {name for match in _DEFINED.finditer(text) for name in match.groups() if name}
    own |= {name for match in _CONSTANTS.finditer(text) for name in _CONSTANT.findall(match[1])}
    own |= set(_FUNCTION.findall(text)) | {function.name for file in texts for function in file.all_functions}
    own |= {name for _, name, _ in names.settings} | {"made", *_GLOBALS}
    own_words = re.compile(rf"(?<![\w.@])({'|'.join(sorted(map(re.escape, own), key=len, reverse=True))})\b")
    return own_words.sub(lambda match: prefix + match[1], text).replace("@", "")


def _write_weight(weights: tuple[float, ...], first: int) -> str:
    """Statements that return weight `j`: arrays of constants take drivers four times as long to compile."""
    if len(weights) == 1:
        return f"return {write_literal(weights[0])};"
    half = len(weights) // 2
    low, high = _write_weight(weights[:half], first), _write_weight(weights[half:], first + half)
    return f"if (j < {first + half}) {{ {low} }} else {{ {high} }}"


def _write_plain(glsl: str, value: Uniform) -> str:
    if isinstance(value, tuple):
        if glsl.startswith("ivec"):
            return f"{glsl}({', '.join(str(int(part)) for part in value)})"
        if glsl.startswith("uvec"):
            return f"{glsl}({', '.join(f'{int(part)}u' for part in value)})"
        return f"{glsl}({', '.join(write_literal(part) for part in value)})"
    return str(int(value)) if glsl in ("int", "bool") else write_literal(value)
