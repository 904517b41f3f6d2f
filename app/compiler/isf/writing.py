"""Writes the text of a shader: the functions of all passes, their buffers, and `main`."""

from __future__ import annotations

from collections.abc import Mapping

from halation.nodes import Size, Uniform
from msgspec import Struct, field

from ..fusion.fuse import PassGroup, fuse
from ..ir import Ref
from ..library import Library
from ..target import NULL
from .affine import write_literal
from .controls import Section
from .model import IsfModel
from .passes import IsfNames, write_function

_PIXEL = "ivec2(int(gl_FragCoord.x), int(RENDERSIZE.y - gl_FragCoord.y))"


class IsfWriter(Struct):
    """Writes one shader: the passes so far, and the buffers that they fill."""

    model: IsfModel
    library: Library
    sources: Mapping[Ref, str]
    pictures: tuple[str, ...]
    size: Size
    buffers: dict[Ref, str] = field(default_factory=dict[Ref, str])
    targets: list[Section] = field(default_factory=list[Section])
    calls: list[str] = field(default_factory=list[str])
    blocks: list[str] = field(default_factory=list[str])
    last_readers: dict[Ref, int] = field(default_factory=dict[Ref, int])
    """The pass that reads a picture last."""

    def write(self, first: int) -> tuple[str, list[Section]]:
        """The GLSL, and the entry PASSES of the head. `first` is the frame that FRAMEINDEX counts from."""
        program = self.model.program
        passes_alone = fuse(program, NULL, gathers=False)
        passes = [(fused, output) for fused in passes_alone for output in range(len(fused.writes))]
        self.last_readers = {ref: index for index, (fused, _) in enumerate(passes) for ref in fused.reads}
        self.last_readers[program.outputs["made"]] = len(passes)
        for fused, output in passes:
            self._write_pass(fused, output, first)
        self._write_display(program.outputs["made"])
        targets = self.targets
        lines = ["vec2 halation_canvas;", "", *self._write_display_functions()]
        lines += [line for name in self.pictures for line in _write_reader(name, "from_codes({})")]
        buffer_names = dict.fromkeys(str(target["TARGET"]) for target in targets if target)
        lines += [line for name in buffer_names for line in _write_reader(name, "{}")]
        calls = [f"{'else ' if at else ''}if (PASSINDEX == {at}) {{ {call} }}" for at, call in enumerate(self.calls)]
        lines += ["", *self.blocks, "void main() {", *(calls if len(calls) > 1 else self.calls), "}"]
        return "\n".join(lines) + "\n", targets

    def _write_pass(self, fused: PassGroup, output: int, first: int) -> None:
        """Write one output of a pass as a function, a buffer and a call.

        Each output is a pass of its own, since a pass of this format has one target. The call first sets the size of
        the whole picture, from which other sizes are computed: RENDERSIZE is the size of the pass's own buffer.
        """
        ref = fused.writes[output]
        names = IsfNames(
            self.model.program,
            {read_ref: number for number, read_ref in enumerate(fused.reads)},
            "fragment",
            False,
            seams=False,
            write_constant=self.model.write_constant,
            write_size=self._find_size_text,
            first=first,
            readers={read_ref: f"read_{self._find_name(read_ref)}" for read_ref in fused.reads},
        )
        lines, function_name = write_function(
            self.model.program, fused, output, f"p{len(self.calls)}_", names, self.library
        )
        self.blocks += [*lines, ""]
        size = self._find_size(ref)
        self.calls.append(f"halation_canvas = {self._write_canvas(size)}; gl_FragColor = {function_name}();")
        lengths: Section = {}
        if size != self.size:
            across, down = self.model.sizes.get(size) or (write_literal(size[0]), write_literal(size[1]))
            lengths = {"WIDTH": across.format("$WIDTH"), "HEIGHT": down.format("$HEIGHT")}
        self.buffers[ref] = self._choose_buffer(lengths)
        self.targets.append({"TARGET": self.buffers[ref], "FLOAT": True, **lengths})

    def _choose_buffer(self, lengths: Section) -> str:
        """A buffer of this size that no later pass reads, or a new one: a shader reads `MAX_PICTURES` at most."""
        pass_number = len(self.targets)
        used_buffers = {name for ref, name in self.buffers.items() if self.last_readers.get(ref, -1) >= pass_number}
        buffer_sizes = {
            str(target["TARGET"]): {key: target[key] for key in ("WIDTH", "HEIGHT") if key in target}
            for target in self.targets
        }
        free = (name for name, size in buffer_sizes.items() if size == lengths and name not in used_buffers)
        return next(free, f"buffer{len(buffer_sizes) + 1}")

    def _write_display(self, last: Ref) -> None:
        """Make the last pass write the picture, in display values and with straight alpha."""
        newest = next(reversed(self.buffers), None)
        if newest != last:
            self.calls.append(f"gl_FragColor = read_{self._find_name(last)}({_PIXEL});")
            self.targets.append({})
        elif self._find_size(last) == self.size:
            self.targets[-1] = {}
        self.calls[-1] += " gl_FragColor = display_straight(gl_FragColor);"

    def _write_canvas(self, size: Size) -> str:
        """The size of the exported picture, as GLSL in a pass whose buffer has this size."""
        if size == self.size:
            return "RENDERSIZE"
        whole = next((str(target["TARGET"]) for target in self.targets if "WIDTH" not in target), "")
        if whole or self.pictures:
            return f"IMG_SIZE({whole or self.pictures[0]})"
        return f"vec2({write_literal(self.size[0])}, {write_literal(self.size[1])})"

    def _find_size_text(self, size: Uniform) -> tuple[str, str] | None:
        assert isinstance(size, tuple)
        formulas = self.model.sizes.get((int(size[0]), int(size[1])))
        if formulas is None:
            return None
        across, down = formulas
        return f"int({across.format('@halation_canvas.x')})", f"int({down.format('@halation_canvas.y')})"

    def _write_display_functions(self) -> list[str]:
        """The functions that convert between light and the display values of the format."""
        needed, lines = frozenset({"display_straight", "from_codes"}), list[str]()
        for text in reversed(self.library.closure(("lib/isf",), "export")):
            used = text.keep_needed(needed)
            needed |= used.words
            lines = [line.rstrip() for line in used.body.split("\n") if line.strip()] + lines
        return [*lines, "float halation_light(float code) { return srgb_decode(code); }"]

    def _find_name(self, ref: Ref) -> str:
        return self.sources.get(ref) or self.buffers[ref]

    def _find_size(self, ref: Ref) -> Size:
        return self.model.program.ops[ref.op].shapes[ref.output].size


def _write_reader(name: str, template: str) -> list[str]:
    """A function that reads one pixel of a picture. Rows count from the top in Halation, from the bottom in ISF."""
    read = f"IMG_PIXEL({name}, vec2(float(at.x) + 0.5, IMG_SIZE({name}).y - float(at.y) - 0.5))"
    return [f"vec4 read_{name}(ivec2 at) {{ return {template.format(read)}; }}"]
