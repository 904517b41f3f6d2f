"""Third stage: one GLSL program per pass, as a fragment or as a compute shader.

The text depends on what is computed, never on values: those are uniforms, so that dragging a slider compiles nothing.
Names are counted from zero in every pass, so that equal passes of different graphs share a program.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from halation.nodes import Camera, Uniform, glsl_type
from msgspec import Struct, structs

from ...glsl import Text, words
from ..fusion.fuse import PassGroup
from ..ir import Accessor, Call, Convolve, ExternalProgram, Gather, Program, Raster, Reduce, Ref, Shape
from ..library import ASKED, Library, Lines
from ..plan import LINES_PER_FILE, Shader
from ..raster import CHANNELS, fragment_lines, vertex_text
from ..target import Target
from . import bodies, forms
from .foreign import foreign
from .names import Names, convert, glsl_channels

EDGES = "primitive/edges"
"""The file that all passes include that look around."""

ACCESSORS = ("raw", "at", "near", "size")
"""What there is for a picture that is read anywhere: `image_at` and so on."""

NO_SEAM = (0, 0, 0, 0)
"""What a seam between fused functions does to the bits: nothing. See primitive/settled.glsl."""


class Emitted(Struct, frozen=True):
    """A program, what its uniforms and weights are set to, and how many work groups run."""

    shader: Shader
    uniforms: tuple[tuple[str, Uniform], ...]
    weights: tuple[float, ...]
    groups: tuple[int, int, int]


def emit(program: Program, fused: PassGroup, library: Library, target: Target, texels: Mapping[Ref, str]) -> Emitted:
    """Write the program of one pass. `texels` are the formats of what it reads and writes."""
    root = program.ops[fused.root]
    if isinstance(root, Raster):
        return _drawn(program, root, fused, library)
    if isinstance(root, ExternalProgram):
        rounding = _half_rounding(target, [texels[ref].endswith("16f") for ref in fused.writes])
        return Emitted(*foreign(root, fused, rounding), (), (0, 0, 0))
    by_image = target.loads_images and len(fused.reads) + len(fused.writes) <= target.max_images
    names = Names(program, {ref: number for number, ref in enumerate(fused.reads)}, target.form, by_image)
    _look_through(names, fused)
    halves = [texels[ref].endswith("16f") for ref in fused.writes]
    count, convolve = forms.count_of(program, fused, library), root if isinstance(root, Convolve) else None
    parts = parts_of(program, fused, names, library)
    early, late, files, asked = _included_texts(program, fused, parts, library)
    names.uniform("ivec2", root.size, "grid")
    if "proxy" in asked:
        names.uniform("float", program.scale, "proxy")
    if "frame" in asked:
        names.uniform("int", program.frame, "frame")
    stored = [
        _texel(names.shape(ref), result, half)
        for ref, result, half in zip(fused.writes, parts.results, halves, strict=True)
    ]
    compute = target.form == "compute"
    main = forms.main(names, count, convolve, parts.body, stored) if compute else _fragment(names, parts.body, stored)
    lines = [
        *_preamble(target),
        *(f"uniform {glsl} {name};" for name, glsl, _ in names.uniforms),
        *_textures(names, fused, target, texels),
        *_targets(names, fused, target, texels),
        "ivec2 pixel = ivec2(0), extent = ivec2(0);",
        *_half_rounding(target, halves),
        *early,
        *parts.functions,
        *late,
        *main,
    ]
    return Emitted(
        Shader("\n".join(lines) + "\n", target.form, files, by_image),
        tuple((name, value) for name, _, value in names.uniforms),
        bodies.padded_weights(convolve, target.form) if convolve else (),
        forms.groups(convolve, count, program.held(fused.writes[0])),
    )


def _look_through(names: Names, fused: PassGroup) -> None:
    """Where of pictures only a part is on the device, say which."""
    windows = names.program.windows
    for number, ref in enumerate(fused.reads):
        if ref in windows:
            names.uniform("ivec2", windows[ref].start, f"t{number}_start")
    if fused.writes[0] in windows:
        names.window(windows[fused.writes[0]])


def _drawn(program: Program, root: Raster, fused: PassGroup, library: Library) -> Emitted:
    """The program that draws meshes."""
    text = library.closure(("primitive/raster",), root.owner)[0]
    wanted = [tuple(CHANNELS)[ref.output] for ref in fused.writes]
    lines = fragment_lines(text.body, wanted)
    shader = Shader("\n".join(lines) + "\n", "fragment", ("generated",), False, vertex_text(text.body))
    uniforms: tuple[tuple[str, Uniform], ...] = (
        ("cameras", root.cameras),
        ("motions", root.motions),
        ("near", root.near),
        ("eye", Camera(root.cameras[:12]).eye),
        ("grid", root.size),
        ("proxy", program.scale),
    )
    return Emitted(shader, uniforms, (), (0, 0, 0))


def _preamble(target: Target) -> list[str]:
    """Fragment passes keep to what macOS has; Mesa lends them the functions that round to half floats.

    Compute passes may be dispatched in bands: `first_row` is the row of work groups that a band starts with.
    """
    if target.form == "compute":
        return ["#version 430 core", f"layout(local_size_x = {forms.LOCAL_SIZE}) in;", "uniform uint first_row;"]
    return ["#version 410 core", "#extension GL_ARB_shading_language_packing : enable"]


class Guest(Struct, frozen=True):
    """An operation that looks around within a pass of pointwise ones: what its file needs, under names of its own."""

    op: Gather
    text: Text
    prefix: str

    @property
    def accessors(self) -> list[Accessor]:
        """Its pictures, by the names that they have in the pass."""
        return [structs.replace(item, name=self.prefix + item.name) for item in self.op.accessors]

    @property
    def renamed(self) -> list[str]:
        """The words of its file that mean something else in the pass."""
        reads = [f"{item.name}_{way}" for item in self.op.accessors for way in ACCESSORS]
        return [word for word in (*self.text.functions, *reads) if word in self.text.words]


class Parts(Struct, frozen=True):
    """Text of a pass: shader files; functions, of which `accessors` read pictures; statements of main; results."""

    shaders: list[str]
    functions: list[str]
    body: list[str]
    results: list[str]
    accessors: frozenset[str] = frozenset()
    guests: tuple[Guest, ...] = ()


def parts_of(program: Program, fused: PassGroup, names: Names, library: Library) -> Parts:
    """What a pass does, in pieces."""
    root = program.ops[fused.root]
    ops = [program.ops[index] for index in fused.members]
    shaders = [op.shader for op in ops if isinstance(op, Call) and not op.program]
    if len(fused.members) > 1 and names.seams:
        shaders.insert(0, "primitive/settled")
    if isinstance(root, Call):
        guests = tuple(_guests(program, fused, library))
        functions = [
            line for guest in guests for item in guest.accessors for line in bodies.accessor(names, item, guest.op.edge)
        ]
        body, values = _calls(program, fused, names, library)
        shaders = [*([EDGES] if guests else []), *shaders]
        return Parts(shaders, functions, body, [values[ref] for ref in fused.writes], guests=guests)
    if isinstance(root, Reduce):
        body, values = _calls(program, fused, names, library)
        functions = bodies.source(names, root, body, values[root.image]) + bodies.reduction(names, root)
        return Parts(shaders, functions, [], ["reduced(pixel)"])
    if isinstance(root, Convolve):
        functions, body = _convolved(names, root)
        return Parts([EDGES], functions, body, ["convolved"])
    assert isinstance(root, Gather)
    functions = [line for item in root.accessors for line in bodies.accessor(names, item, root.edge)]
    arguments = [names.argument(item, {}) for item in root.parameters]
    accessors = frozenset(f"{item.name}_{way}" for item in root.accessors for way in ACCESSORS)
    body, results = list[str](), [f"r{ref.output}" for ref in fused.writes]
    if len(root.shapes) == 1:
        results = [_gathered(root, arguments, library)]
    else:
        outputs = {f"r{number}": glsl_type(shape.channels) for number, shape in enumerate(root.shapes)}
        body = [f"{glsl} {name};" for name, glsl in outputs.items()]
        body.append(f"{root.function}({', '.join([*arguments, *outputs])});")
    return Parts([EDGES, root.shader], functions, body, results, accessors)


def _convolved(names: Names, op: Convolve) -> tuple[list[str], list[str]]:
    """What a convolution needs around it, and the statement that makes its value of a pixel.

    Compute passes make those of several pixels at once.
    """
    functions = bodies.convolution_accessor(names, op)
    if names.form == "compute":
        return functions, []
    glsl = glsl_type(names.shape(op.image).channels)
    return functions + bodies.convolution(names, op), [f"{glsl} convolved = convolution();"]


def _guests(program: Program, fused: PassGroup, library: Library) -> Iterator[Guest]:
    """The members of a pass that look around."""
    for number, index in enumerate(fused.members):
        op = program.ops[index]
        if isinstance(op, Gather):
            text = library.closure((op.shader,), op.owner)[-1].only(frozenset({op.function}))
            yield Guest(op, text, f"g{number}_")


def _included_texts(program: Program, fused: PassGroup, parts: Parts, library: Library) -> Lines:
    """The shader files that a pass includes: many passes of a large graph differ in numbers alone."""
    ops = [op for op in (program.ops[index] for index in fused.members) if isinstance(op, (Call, Gather))]
    if any(isinstance(op, Call) and op.program for op in ops):
        return _find_texts(program, fused, parts, library)
    key = (
        *parts.shaders,
        None,
        *parts.functions,
        None,
        *parts.body,
        None,
        *parts.results,
        parts.accessors,
        *((op.shader, op.function, op.choices) for op in ops),
        *(guest.prefix for guest in parts.guests),
    )
    return library.kept(key, lambda: _find_texts(program, fused, parts, library))


def _find_texts(program: Program, fused: PassGroup, parts: Parts, library: Library) -> Lines:
    texts, files = texts_of(program, fused, parts, library), ["generated"]
    early, late = (
        [line for text in some for line in _included(text, files, program, fused)] for some in around(texts, parts)
    )
    late += [line for guest in parts.guests for line in _as_guest(guest, files, program, fused)]
    asked = frozenset[str]().union(*(text.words for text in texts)) & ASKED
    return (*early,), (*late,), (*files,), asked


def texts_of(program: Program, fused: PassGroup, parts: Parts, library: Library) -> tuple[Text, ...]:
    """The shader files of a pass, includes first, with only the functions that it needs."""
    found: list[Text] = []
    needed = words(*parts.functions, *parts.body, *parts.results)
    lent = frozenset[str]().union(*(guest.text.words for guest in parts.guests))
    own = {guest.text.name for guest in parts.guests}
    included = (name for guest in parts.guests for name in guest.text.includes)
    files = library.closure(tuple(dict.fromkeys((*parts.shaders, *included))), program.ops[fused.root].owner)
    calls = (op for op in (program.ops[index] for index in fused.members) if isinstance(op, Call))
    made = dict.fromkeys(op.program for op in calls if op.program)
    for text in reversed((*files, *(one.text for one in made))):
        # What a guest needs of its own file comes with the guest.
        kept = text.only(needed if text.name in own else needed | lent)
        needed |= kept.words
        found.append(kept)
    return tuple(reversed(found))


def around(texts: tuple[Text, ...], parts: Parts) -> tuple[list[Text], list[Text]]:
    """The files that come before the functions of a pass, and those that read through its accessors and follow them."""
    early, late = list[Text](), list[Text]()
    for text in texts:
        reads = text.words & parts.accessors.union(*(item.functions for item in late))
        (late if reads else early).append(text)
    return early, late


def _calls(program: Program, fused: PassGroup, names: Names, library: Library) -> tuple[list[str], dict[Ref, str]]:
    """Statements that evaluate the members of a pass at one pixel, and the names of all they computed."""
    lines: list[str] = []
    values: dict[Ref, str] = {}
    members = [program.ops[index] for index in fused.members]
    # A root that reduces wants its picture at every pixel; what looks around reads through its accessors.
    wanted = {ref for op in members if not isinstance(op, Gather) for ref in op.reads()}
    for number, ref in enumerate(fused.reads):
        if ref not in wanted:
            continue
        values[ref] = f"a{number}"
        lines.append(f"{glsl_type(names.shape(ref).channels)} a{number} = {names.load(ref, 'pixel')};")
    for number, index in enumerate(fused.members):
        op = program.ops[index]
        if not isinstance(op, (Call, Gather)):
            continue
        outputs = [f"v{number}_{output}" for output in range(len(op.shapes))]
        types = [glsl_type(shape.channels) for shape in op.shapes]
        arguments = [names.argument(item, values) for item in op.parameters]
        if isinstance(op, Gather):
            lines.append(f"{types[0]} {outputs[0]} = {_gathered(op, arguments, library, f'g{number}_')};")
        elif len(outputs) == 1:
            lines.append(f"{types[0]} {outputs[0]} = {op.function}({', '.join(arguments)});")
        else:
            lines += [f"{glsl} {name};" for glsl, name in zip(types, outputs, strict=True)]
            lines.append(f"{op.function}({', '.join([*arguments, *outputs])});")
        if index != fused.root and names.seams:
            lines += [f"{name} = settled({name}, {names.uniform('uvec4', NO_SEAM)});" for name in outputs]
        values |= {Ref(index, output): name for output, name in enumerate(outputs)}
    return lines, values


def _gathered(op: Gather, arguments: list[str], library: Library, prefix: str = "") -> str:
    """What an operation that looks around makes of a pixel."""
    returned = library.function(op.shader, op.function, op.owner).result
    call = f"{prefix}{op.function}({', '.join(arguments)})"
    return convert(call, glsl_channels(returned), glsl_type(op.shapes[0].channels))


def _as_guest(guest: Guest, files: list[str], program: Program, fused: PassGroup) -> list[str]:
    """The file of a member that looks around, under names of its own."""
    return [
        *(f"#define {word} {guest.prefix}{word}" for word in guest.renamed),
        *_included(guest.text, files, program, fused),
        *(f"#undef {word}" for word in guest.renamed),
    ]


def _included(text: Text, files: list[str], program: Program, fused: PassGroup) -> list[str]:
    """A shader file, with the macros of its node's choices around it and its own line numbers."""
    macros = macros_of(text, program, fused)
    files.append(text.file)
    return [
        *(f"#define {name} {number}" for name, number in macros),
        f"#line {LINES_PER_FILE * (len(files) - 1) + 1}",
        text.body.rstrip("\n"),
        "#line 1",
        *(f"#undef {name}" for name, _ in macros),
    ]


def macros_of(text: Text, program: Program, fused: PassGroup) -> list[tuple[str, int]]:
    """The macros of a node's choices that its file asks for."""
    ops = [op for op in (program.ops[index] for index in fused.members) if isinstance(op, (Call, Gather))]
    choices = next((op.choices for op in ops if op.shader == text.name), ())
    named = ((macro(name, one), number) for name, all_ in choices for number, one in enumerate(all_))
    return [(name, number) for name, number in named if name in text.words]


def macro(value: str, choice: str) -> str:
    """The macro that stands for a choice in GLSL: `MODE_SOFT_LIGHT`."""
    return "".join(letter if letter.isalnum() else "_" for letter in f"{value}_{choice}").upper()


def _textures(names: Names, fused: PassGroup, target: Target, texels: Mapping[Ref, str]) -> Iterator[str]:
    for number, ref in enumerate(fused.reads):
        if names.by_image:
            yield f"layout(binding = {number}, {texels[ref]}) readonly uniform image2D t{number};"
        elif target.form == "compute":
            yield f"layout(binding = {number}) uniform sampler2D t{number};"
        else:
            yield f"uniform sampler2D t{number};"


def _targets(names: Names, fused: PassGroup, target: Target, texels: Mapping[Ref, str]) -> Iterator[str]:
    first = len(fused.reads) if names.by_image else 0
    for number, ref in enumerate(fused.writes):
        if target.form == "compute":
            yield f"layout(binding = {first + number}, {texels[ref]}) writeonly uniform image2D o{number};"
        else:
            yield f"layout(location = {number}) out vec4 o{number};"


def _half_rounding(target: Target, halves: list[bool]) -> list[str]:
    """Halves saturate instead of overflowing; the software rasterizer would also truncate them, and lose NaN."""
    if not any(halves):
        return []
    clamped, rounded = "clamp(c, -65504.0, 65504.0)", "c"
    if target.rounds_halves:
        clamped = f"mix({clamped}, c, isnan(c))"
        rounded = "vec4(unpackHalf2x16(packHalf2x16(c.xy)), unpackHalf2x16(packHalf2x16(c.zw)))"
    return [f"vec4 as_half(vec4 c) {{ c = {clamped}; return {rounded}; }}"]


def _fragment(names: Names, body: list[str], texels: list[str]) -> list[str]:
    """The entry point of a fragment pass, which makes one pixel."""
    start = f" + {names.start}" if names.start else ""
    stores = (f"o{number} = {texel};" for number, texel in enumerate(texels))
    return ["void main() {", f"pixel = ivec2(gl_FragCoord.xy){start}; extent = grid;", *body, *stores, "}"]


def _texel(shape: Shape, result: str, half: bool) -> str:
    """What is stored of a result; unused channels are zero."""
    texel = result if shape.channels == 4 else f"vec4({result}, {', '.join(['0.0'] * (4 - shape.channels))})"
    return f"as_half({texel})" if half else texel
