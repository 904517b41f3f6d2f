"""Writes the GLSL program of a pass, as a fragment or as a compute shader."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import singledispatch

from halation.nodes import Uniform
from msgspec import Struct

from ..fusion.fuse import PassGroup
from ..ir import ExternalProgram, HostCall, LoweredProgram, Op, PictureShape, Raster, Ref
from ..library import Library
from ..plan import Shader
from ..target import Target
from . import bodies, forms
from .external import write_external
from .includes import include_files
from .names import ShaderNames
from .pass_parts import PassContext, write_pass_parts
from .rasterize import write_raster


class EmittedProgram(Struct, frozen=True):
    """A program, the values of its uniforms and weights, and its work groups."""

    shader: Shader
    uniforms: tuple[tuple[str, Uniform], ...]
    weights: tuple[float, ...] = ()
    groups: tuple[int, int, int] = (0, 0, 0)


class _PassRequest(Struct, frozen=True):
    """A pass to write, for a target. `formats` are those of the pictures that it reads and writes."""

    program: LoweredProgram
    group: PassGroup
    library: Library
    target: Target
    formats: Mapping[Ref, str]

    @property
    def halves(self) -> list[bool]:
        """For each picture that it writes, whether it is stored as half floats."""
        return [self.formats[ref].endswith("16f") for ref in self.group.writes]


def emit(
    program: LoweredProgram, group: PassGroup, library: Library, target: Target, formats: Mapping[Ref, str]
) -> EmittedProgram:
    """Write the program of one pass. `formats` are those of the pictures that it reads and writes."""
    return _emit_root(program.ops[group.root], _PassRequest(program, group, library, target, formats))


@singledispatch
def _emit_root(root: Op, request: _PassRequest) -> EmittedProgram:
    """A program that evaluates functions at each pixel.

    Uniforms are named as the text asks for them, so the parts are written before the declarations that precede them.
    """
    program, group, target, formats = request.program, request.group, request.target, request.formats
    by_image = target.has_images_for(len(group.reads) + len(group.writes))
    names = ShaderNames(program, {ref: number for number, ref in enumerate(group.reads)}, target.form, by_image)
    _name_windows(names, group)
    context = PassContext(program, group, names, request.library)
    parts = write_pass_parts(context.root, context)
    early, late, files, uniforms = include_files(context, parts)
    names.uniform("ivec2", root.size, "grid")
    if "proxy" in uniforms:
        names.uniform("float", program.scale, "proxy")
    if "frame" in uniforms:
        names.uniform("int", program.frame, "frame")
    texels = [
        _write_texel(names.program.shape(ref), result, half)
        for ref, result, half in zip(group.writes, parts.results, request.halves, strict=True)
    ]
    strip = parts.convolution if parts.is_strip else None
    count = bodies.count_pixels(strip) if strip else forms.count_rows(context)
    if target.form == "compute":
        main = forms.write_main(names, count, strip, parts.body, texels)
    else:
        main = _write_fragment_main(names, parts.body, texels)
    lines = [
        *_write_preamble(target),
        *(f"uniform {glsl} {name};" for name, glsl, _ in names.uniforms),
        *_declare_textures(names, group, target, formats),
        *_declare_targets(names, group, target, formats),
        "ivec2 pixel = ivec2(0), extent = ivec2(0);",
        *_write_half_rounding(target, request.halves),
        *early,
        *parts.functions,
        *late,
        *main,
    ]
    return EmittedProgram(
        Shader("\n".join(lines) + "\n", target.form, files, by_image),
        tuple((name, value) for name, _, value in names.uniforms),
        bodies.pad_weights(parts.convolution, target.form) if parts.convolution else (),
        forms.count_groups(strip, count, program.size_on_device(group.writes[0])),
    )


@_emit_root.register
def _(root: Raster, request: _PassRequest) -> EmittedProgram:
    return EmittedProgram(*write_raster(request.program, root, request.group, request.library))


@_emit_root.register
def _(root: ExternalProgram, request: _PassRequest) -> EmittedProgram:
    return EmittedProgram(*write_external(root, request.group, _write_half_rounding(request.target, request.halves)))


@_emit_root.register
def _(root: HostCall, request: _PassRequest) -> EmittedProgram:
    """No program for the device. The text stands for that of the processor wherever passes are told apart by theirs."""
    source = f"#version 410 core\n// {root.identity}\nvoid main() {{}}\n"
    return EmittedProgram(Shader(source, "fragment", ("generated",), reads_images=False), ())


def _name_windows(names: ShaderNames, group: PassGroup) -> None:
    """Declare the windows of pictures of which something else than the frame is on the device."""
    for number, ref in enumerate(group.reads):
        if window := names.program.window(ref):
            names.uniform("ivec2", window.start, f"t{number}_start")
    if window := names.program.window(group.writes[0]):
        names.declare_window(window)


def _write_preamble(target: Target) -> list[str]:
    """The head of a program. Fragment passes use the GLSL 4.10 of macOS, with an extension for half floats of Mesa.

    Compute passes may be dispatched in bands: `first_row` is the row of work groups that a band starts with.
    """
    if target.form == "compute":
        return ["#version 430 core", f"layout(local_size_x = {forms.LOCAL_SIZE}) in;", "uniform uint first_row;"]
    return ["#version 410 core", "#extension GL_ARB_shading_language_packing : enable"]


def _declare_textures(
    names: ShaderNames, group: PassGroup, target: Target, formats: Mapping[Ref, str]
) -> Iterator[str]:
    for number, ref in enumerate(group.reads):
        if names.by_image:
            yield f"layout(binding = {number}, {formats[ref]}) readonly uniform image2D t{number};"
        elif target.form == "compute":
            yield f"layout(binding = {number}) uniform sampler2D t{number};"
        else:
            yield f"uniform sampler2D t{number};"


def _declare_targets(names: ShaderNames, group: PassGroup, target: Target, formats: Mapping[Ref, str]) -> Iterator[str]:
    first = len(group.reads) if names.by_image else 0
    for number, ref in enumerate(group.writes):
        if target.form == "compute":
            yield f"layout(binding = {first + number}, {formats[ref]}) writeonly uniform image2D o{number};"
        else:
            yield f"layout(location = {number}) out vec4 o{number};"


def _write_half_rounding(target: Target, halves: list[bool]) -> list[str]:
    """Write `as_half`: half floats saturate in place of overflowing. The software rasterizer needs rounding, too.

    It would truncate stored halves and lose NaN.
    """
    if not any(halves):
        return []
    clamped, rounded = "clamp(c, -65504.0, 65504.0)", "c"
    if target.rounds_halves:
        clamped = f"mix({clamped}, c, isnan(c))"
        rounded = "vec4(unpackHalf2x16(packHalf2x16(c.xy)), unpackHalf2x16(packHalf2x16(c.zw)))"
    return [f"vec4 as_half(vec4 c) {{ c = {clamped}; return {rounded}; }}"]


def _write_fragment_main(names: ShaderNames, body: list[str], texels: list[str]) -> list[str]:
    """Write the entry point of a fragment pass, which makes one pixel."""
    start = f" + {names.start}" if names.start else ""
    results = forms.write_results(texels)
    stores = (f"o{number} = {name};" for number, name in enumerate(forms.name_results(texels)))
    return ["void main() {", f"pixel = ivec2(gl_FragCoord.xy){start}; extent = grid;", *body, *results, *stores, "}"]


def _write_texel(shape: PictureShape, result: str, half: bool) -> str:
    """The vec4 that is stored of a result; unused channels are zero."""
    texel = result if shape.channels == 4 else f"vec4({result}, {', '.join(['0.0'] * (4 - shape.channels))})"
    return f"as_half({texel})" if half else texel
