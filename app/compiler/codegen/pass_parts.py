"""The pieces of a pass's text: one writer for each kind of operation that a pass can end in."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import singledispatch

from halation.nodes import Size, glsl_type
from msgspec import Struct, structs

from ...glsl import GlslText
from ..fusion.fuse import PassGroup
from ..ir import EDGES, Accessor, Call, Convolve, FunctionOp, Gather, LoweredProgram, Op, Reduce, Ref
from ..library import Library
from . import bodies
from .names import ShaderNames, convert, glsl_channels

ACCESSORS = ("raw", "at", "near", "size", "has")
"""The endings of the functions that read a picture anywhere: `image_at` and so on."""

NO_SEAM = (0, 0, 0, 0)
"""The uniform of a seam between fused functions, which changes no bit: see primitive/settled.glsl."""


class PassContext(Struct, frozen=True):
    """A pass whose text is being written."""

    program: LoweredProgram
    group: PassGroup
    names: ShaderNames
    library: Library

    @property
    def root(self) -> Op:
        return self.program.ops[self.group.root]

    @property
    def members(self) -> list[Op]:
        """Its operations in order, the root last."""
        return [self.program.ops[index] for index in self.group.members]

    @property
    def is_small(self) -> bool:
        """Whether its pictures have so few pixels that a form is better that compiles fast."""
        return _are_small(map(self.program.size_on_device, (*self.group.reads, *self.group.writes)))

    def is_small_decimation(self, op: Convolve) -> bool:
        """Whether a decimation has so few pixels, and the first of its kind, which has compiled the program of all."""
        first = self.program.find_first_convolution(op)
        return _are_small((first.size, self.program.size_on_device(first.image)))

    @property
    def functions(self) -> list[FunctionOp]:
        """The members that call functions of files."""
        return [op for op in self.members if isinstance(op, FunctionOp)]


def _are_small(sizes: Iterable[Size]) -> bool:
    return all(width * height <= bodies.SMALL_PIXELS for width, height in sizes)


class InlinedGather(Struct, frozen=True):
    """A gather inside a pass of pointwise operations: the part of its file that it needs, with a prefix for names."""

    op: Gather
    text: GlslText
    prefix: str

    @property
    def accessors(self) -> list[Accessor]:
        """Its pictures with the names that they have in the pass."""
        return [structs.replace(item, name=self.prefix + item.name) for item in self.op.accessors]

    @property
    def renamed_words(self) -> list[str]:
        """The words of its file that get the prefix."""
        reads = [f"{item.name}_{suffix}" for item in self.op.accessors for suffix in ACCESSORS]
        return [word for word in (*self.text.functions, *reads) if word in self.text.words]


class PassParts(Struct, frozen=True):
    """Text of a pass: shader files; functions, of which `accessors` read pictures; statements of main; results.

    `convolution` is set where a pass convolves, and `is_strip` where its invocations make several pixels of that.
    """

    shaders: list[str]
    functions: list[str]
    body: list[str]
    results: list[str]
    accessors: frozenset[str] = frozenset()
    inlined: tuple[InlinedGather, ...] = ()
    convolution: Convolve | None = None
    is_strip: bool = False


@singledispatch
def write_pass_parts(root: Op, context: PassContext) -> PassParts:
    """The pieces of a pass's text, by the operation in which the pass ends."""
    raise NotImplementedError(f"no pass ends in {type(root).__name__}")


@write_pass_parts.register
def _(root: Call, context: PassContext) -> PassParts:
    inlined = tuple(_find_inlined(context))
    functions = [
        line
        for gather in inlined
        for item in gather.accessors
        for line in bodies.write_accessor(context.names, gather.op, item, gather.text.words)
    ]
    body, values = _write_calls(context)
    shaders = [*([EDGES] if inlined else []), *_pointwise_files(context)]
    return PassParts(shaders, functions, body, [values[ref] for ref in context.group.writes], inlined=inlined)


@write_pass_parts.register
def _(root: Reduce, context: PassContext) -> PassParts:
    body, values = _write_calls(context)
    functions = bodies.write_source(context.names, root, body, values[root.image]) + bodies.write_reduction(
        context.names, root
    )
    return PassParts(_pointwise_files(context), functions, [], ["reduced(pixel)"])


@write_pass_parts.register
def _(root: Convolve, context: PassContext) -> PassParts:
    names = context.names
    is_strip = names.form == "compute" and not (root.stride > 1 and context.is_small_decimation(root))
    functions, body = bodies.write_convolution_accessor(names, root, is_strip), list[str]()
    if not is_strip:
        write = bodies.write_convolution if names.form == "fragment" else bodies.write_small_decimation
        functions += write(names, root)
        glsl = glsl_type(names.program.shape(root.image).channels)
        body.append(f"{glsl} convolved = convolution();")
    return PassParts([EDGES], functions, body, ["convolved"], convolution=root, is_strip=is_strip)


@write_pass_parts.register
def _(root: Gather, context: PassContext) -> PassParts:
    names = context.names
    words = context.library.find_words(root.shader, root.function, root.owner)
    functions = [line for item in root.accessors for line in bodies.write_accessor(names, root, item, words)]
    arguments = [names.argument(item, {}) for item in root.parameters]
    accessors = frozenset(f"{item.name}_{suffix}" for item in root.accessors for suffix in ACCESSORS)
    body, results = list[str](), [f"r{ref.output}" for ref in context.group.writes]
    if root.outputs == 1:
        results = [_write_gather(root, arguments, context.library)]
    else:
        outputs = {f"r{number}": glsl_type(shape.channels) for number, shape in enumerate(root.shapes)}
        body = [f"{glsl} {name};" for name, glsl in outputs.items()]
        body.append(f"{root.function}({', '.join([*arguments, *outputs])});")
    return PassParts([EDGES, root.shader], functions, body, results, accessors)


def _pointwise_files(context: PassContext) -> list[str]:
    """The files of the pointwise members. Where several are fused, seams between them keep the bits of each."""
    files = [file for op in context.members if op.is_pointwise for file in op.files]
    has_seams = len(context.group.members) > 1 and context.names.seams
    return ["primitive/settled", *files] if has_seams else files


def _find_inlined(context: PassContext) -> Iterator[InlinedGather]:
    for number, op in enumerate(context.members):
        if isinstance(op, Gather):
            text = context.library.closure((op.shader,), op.owner)[-1].keep_needed(frozenset({op.function}))
            yield InlinedGather(op, text, f"g{number}_")


def _write_calls(context: PassContext) -> tuple[list[str], dict[Ref, str]]:
    """Statements that evaluate the members of a pass at one pixel, and the names of all they computed.

    Between two functions lies a seam, `settled`: without it a driver could round across both, and a fused pass would
    differ from single ones in the last bit.
    """
    names, group = context.names, context.group
    lines: list[str] = []
    values: dict[Ref, str] = {}
    # Only pointwise operations and reductions load their own pixel; gathers read through their accessors.
    loaded = {ref for op in context.members if op.takes_producers for ref in op.reads()}
    for number, ref in enumerate(group.reads):
        if ref not in loaded:
            continue
        values[ref] = f"a{number}"
        loaded_pixel = names.load_own(ref) if context.root.is_pointwise else names.load(ref, "pixel")
        lines.append(f"{glsl_type(names.program.shape(ref).channels)} a{number} = {loaded_pixel};")
    for number, index in enumerate(group.members):
        op = context.program.ops[index]
        if not isinstance(op, FunctionOp):
            continue
        outputs = [f"v{number}_{output}" for output in range(op.outputs)]
        types = [glsl_type(shape.channels) for shape in op.shapes]
        arguments = [names.argument(item, values) for item in op.parameters]
        if not op.is_pointwise:
            lines.append(f"{types[0]} {outputs[0]} = {_write_gather(op, arguments, context.library, f'g{number}_')};")
        elif len(outputs) == 1:
            lines.append(f"{types[0]} {outputs[0]} = {op.function}({', '.join(arguments)});")
        else:
            lines += [f"{glsl} {name};" for glsl, name in zip(types, outputs, strict=True)]
            lines.append(f"{op.function}({', '.join([*arguments, *outputs])});")
        if index != group.root and names.seams:
            lines += [f"{name} = settled({name}, {names.uniform('uvec4', NO_SEAM)});" for name in outputs]
        values |= {Ref(index, output): name for output, name in enumerate(outputs)}
    return lines, values


def _write_gather(op: FunctionOp, arguments: list[str], library: Library, prefix: str = "") -> str:
    """The expression that calls the function of a gather for one pixel."""
    returned = library.function(op.shader, op.function, op.owner).result
    call = f"{prefix}{op.function}({', '.join(arguments)})"
    return convert(call, glsl_channels(returned), glsl_type(op.shapes[0].channels))
