"""A graph as one shader in the Interactive Shader Format."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ....nodes import ColorChange, ColorSettings, Kind, Missing, Render, Scene, Size
from .. import graph_library
from ...errors import GraphError, HalationError
from ...graph import Graph, Port
from ..fuse import Fused, fuse
from ..ir import Constant, Picture, Program, Read, Ref
from ..library import Library
from ..lower import lower
from ..outside import Frame, Outside, Probed
from ..raster import Mesh
from ..recolor import ColorProgram
from ..request import Request
from ..target import NULL
from ..working import Working
from .affine import Anatomy, Knob, Model, Point, alike, anatomy, fitted, length_text
from .controls import Controlled, Section, controlled, identifier, pinned
from .passes import PassNames, function, reasons

MAX_PASSES = 64
WIDTH, HEIGHT, FRAME = "width", "height", "frame"


@dataclass(frozen=True)
class Exported:
    """The text of a shader, what it cannot do that the graph can, and why there is none: nodes and reasons."""

    text: str
    notes: tuple[str, ...]
    reasons: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class _Bound:
    """The world beyond the graph, where every input is a picture of the size that is wanted."""

    outside: Outside
    size: Size

    def at(self, path: str, frame: int, missing: Missing) -> Frame:
        return self.outside.at(path, frame, missing)

    def probe(self, picture: Picture) -> Probed:
        return Probed(self.size, False, picture.path) if picture.in_memory else self.outside.probe(picture)

    def recolor(self, change: ColorChange) -> ColorProgram:
        return self.outside.recolor(change)

    def working(self, color: ColorSettings) -> Working | None:
        return self.outside.working(color)

    def render(self, path: str, named: Mapping[str, str]) -> Render:
        return self.outside.render(path, named)

    def mesh(self, scene: Scene) -> Mesh:
        return self.outside.mesh(scene)


def export_isf(
    graph: Graph, target: Port, outside: Outside, *, size: Size = (1280, 720), doc: str = "", categories: tuple[str, ...] = ()
) -> Exported:
    """Write what `target` shows of a graph as one shader. Raises the errors of compiling a graph.

    Its pictures become those of the shader, its controls inputs where they change nothing but numbers. `size` is that
    of the picture where something holds for one size only.
    """
    return _Export(graph, target, outside, size).whole(doc, categories)


class _Export:
    """The work in progress."""

    def __init__(self, graph: Graph, target: Port, outside: Outside, size: Size) -> None:
        self.graph, self.target, self.outside = graph, target, outside
        self.size: Size = graph.settings.size or size
        self.library: Library = graph_library(graph, outside)
        self.notes: list[str] = []
        self.first = (graph.settings.frames or (1, 1))[0]
        self.pictures = [name for name, end in graph.inputs.items() if end.kind is Kind.IMAGE]
        self.named = self._picture_names()
        self.controls, notes = controlled(graph, self.named.values())
        self.notes += notes
        self.rests = {knob.name: knob.base - knob.step for one in self.controls for knob in one.knobs}
        self.rests |= {one.knobs[0].name: one.knobs[0].base for one in self.controls if one.value.type == "bool"}

    def whole(self, doc: str, categories: tuple[str, ...]) -> Exported:
        wrong = list(self._data_inputs())
        program = self._lowered({knob: rest for knob, rest in self.rests.items()})
        passes = fuse(program, NULL)
        wrong += reasons(program, passes, self._sources(program))
        if sum(len(fused.writes) for fused in passes) > MAX_PASSES:
            wrong.append((str(self.target), f"takes {len(passes)} passes; {MAX_PASSES} are the most"))
        if wrong:
            return Exported("", (), tuple(dict.fromkeys(wrong)))
        model, program, sizes = self._modelled()
        used = {knob for control in self.controls for knob in control.knobs if knob.name in model.slopes}
        for control in self.controls:
            if not used & set(control.knobs):
                self.notes.append(f"control '{control.name}' keeps its value: it changes more than numbers")
        controls = [control for control in self.controls if used & set(control.knobs)]
        text, targets = self._shader(program, fuse(program, NULL), model, sizes)
        head: Section = {
            "ISFVSN": "2", "DESCRIPTION": doc or "Made by Halation.", "CATEGORIES": list(categories) or ["Halation"],
            "INPUTS": [
                *({"NAME": name, "TYPE": "image"} for name in self.named.values()), *(one.entry for one in controls),
            ],
        }
        if len(targets) > 1:
            head["PASSES"] = targets
        return Exported(f"/*{_comment(head)}*/\n\n{text}", tuple(self.notes), ())

    # --- what the numbers depend on ----------------------------------------------------------------------------------

    def _lowered(self, point: Point) -> Program:
        graph = self.graph
        for control in self.controls:
            graph = graph.set_control(control.name, control.plain(point))
        size = (round(point.get(WIDTH, self.size[0])), round(point.get(HEIGHT, self.size[1])))
        bindings = {name: Picture(name, "", Kind.IMAGE, 4, in_memory=True) for name in self.pictures}
        frame = round(point.get(FRAME, self.first))
        request = Request({"made": self.target}, bindings, size, frame=frame)
        return lower(graph, request, self.library, _Bound(self.outside, size))

    def _modelled(self) -> tuple[Model, Program, dict[Size, tuple[str, str]] | None]:
        """How numbers depend on controls, the frame and the size, as far as that is simple."""
        rests = dict(self.rests)
        knobs = {knob.name: knob for control in self.controls for knob in control.knobs}
        knobs |= {
            WIDTH: Knob(WIDTH, "float(canvas.x)", self.size[0], 96.0), HEIGHT: Knob(HEIGHT, "float(canvas.y)", self.size[1], 96.0),
            FRAME: Knob(FRAME, "float(FRAMEINDEX)", self.first, 1.0, 3),
        }
        while True:
            base = {name: knob.base for name, knob in knobs.items()}

            def tried(point: Point, base: Point = base) -> Program | None:
                try:
                    return self._lowered({**base, **point})
                except HalationError:
                    return None

            program = self._lowered(base)
            model = Model(anatomy(program), dict(knobs))
            failed = ""
            for name, knob in knobs.items():
                slopes = fitted(tried, model.base, knob) if knob.step else None
                if slopes is None:
                    failed = name
                    break
                model.slopes[name] = slopes
            sizes = self._sizes(tried, model.base) if not failed and WIDTH in knobs else None
            if not failed and WIDTH in knobs and sizes is None:
                failed = WIDTH
            failed = failed or self._multiplied(tried, model)
            if not failed:
                model.slopes = {name: slopes for name, slopes in model.slopes.items() if self._matters(model, name)}
                return model, program, sizes
            self._drop(failed, knobs, rests)

    def _drop(self, name: str, knobs: dict[str, Knob], rests: Mapping[str, float]) -> None:
        """Hold a knob at what it has."""
        if name in (WIDTH, HEIGHT):
            gone = knobs.pop(WIDTH), knobs.pop(HEIGHT)
            assert gone
            width, height = self.size
            self.notes.append(f"it is made for {width}x{height} pixels: other sizes look different (--size chooses)")
        elif name == FRAME:
            knobs.pop(FRAME)
            self.notes.append(f"it shows frame {self.first}: what changes over time in it stands still")
        elif knobs[name].base != rests[name]:
            knobs[name] = replace(pinned(knobs[name], rests[name]), step=0.0)
        else:
            knobs.pop(name)
        if name in knobs and not knobs[name].step:
            self._hold(name, knobs)

    def _hold(self, name: str, knobs: dict[str, Knob]) -> None:
        """The controls that the lowering sets follow."""
        held = knobs.pop(name)
        self.controls = [
            replace(one, knobs=tuple(held if knob.name == name else knob for knob in one.knobs)) for one in self.controls
        ]

    def _multiplied(self, tried: Any, model: Model) -> str:
        """Find products of knobs; the name of a knob that does not fit in, if there is one."""
        names = [name for name in model.slopes if self._matters(model, name)]
        for at, one in enumerate(names):
            for other in names[at + 1 :]:
                a, b = model.knobs[one], model.knobs[other]
                program = tried({one: a.base + a.step, other: b.base + b.step})
                taken = anatomy(program) if program else None
                if taken is None or taken.skeleton != model.base.skeleton:
                    return self._worse(one, other)
                apart = model.predicted({one: a.base + a.step, other: b.base + b.step})
                if not alike(taken.numbers, apart):
                    scale = a.step * b.step
                    model.products[one, other] = [
                        (x - y) / scale for x, y in zip(taken.numbers, apart, strict=True)
                    ]
        far = {name: model.knobs[name].base + 1.6 * _whole(name, model.knobs[name].step) for name in names}
        far = {name: float(round(value)) if name in (WIDTH, HEIGHT, FRAME) else value for name, value in far.items()}
        far |= {one.knobs[0].name: 1.0 - one.knobs[0].base for one in self.controls if one.value.type == "bool"
                and one.knobs[0].name in names}
        far |= {knob.name: knob.base + 2.0 * knob.step for one in self.controls if one.value.type == "int"
                for knob in one.knobs if knob.name in names}
        program = tried(far)
        taken = anatomy(program) if program else None
        good = taken is not None and taken.skeleton == model.base.skeleton and alike(
            taken.numbers, model.predicted(far)
        )
        return "" if good or not names else names[-1]

    def _worse(self, one: str, other: str) -> str:
        """Which of two knobs to give up: sizes before controls, later ones before earlier ones."""
        return next((name for name in (one, other) if name in (WIDTH, HEIGHT, FRAME)), other)

    def _matters(self, model: Model, name: str) -> bool:
        knob = model.knobs[name]
        size = [max(abs(number), 1e-3) for number in model.base.numbers]
        return any(abs(slope * knob.step) > 1e-7 * most for slope, most in zip(model.slopes[name], size, strict=True))

    def _sizes(self, tried: Any, base: Anatomy) -> dict[Size, tuple[str, str]] | None:
        """The sizes of all pictures as formulas of the whole one's; None where there are none."""
        width, height = self.size
        samples = [(width + step, height + step) for step in (0, 37, 91, 192)]
        found: list[Anatomy] = []
        for across, down in samples:
            program = tried({WIDTH: across, HEIGHT: down})
            found.append(anatomy(program) if program else Anatomy(None))
            if found[-1].skeleton != base.skeleton:
                return None
        texts: dict[Size, tuple[str, str]] = {}
        for at, size in enumerate(base.sizes):
            formulas = [
                length_text([sample[axis] for sample in samples], [one.sizes[at][axis] for one in found])
                for axis in (0, 1)
            ]
            if formulas[0] is None or formulas[1] is None or texts.get(size, tuple(formulas)) != tuple(formulas):
                return None
            texts[size] = formulas[0], formulas[1]
        return texts

    # --- text --------------------------------------------------------------------------------------------------------

    def _shader(
        self, program: Program, passes: tuple[Fused, ...], model: Model, sizes: dict[Size, tuple[str, str]] | None
    ) -> tuple[str, list[Section]]:
        sources = self._sources(program)
        buffers: dict[Ref, str] = {}
        blocks: list[str] = []
        calls: list[str] = []
        targets: list[Section] = []
        last = program.outputs["made"]
        for fused in passes:
            for output, ref in enumerate(fused.writes):
                prefix = f"p{len(calls)}_"
                names = PassNames(
                    program, {one: number for number, one in enumerate(fused.reads)}, "fragment", False, seams=False,
                    texts=lambda item: self._texts(model, item), sized=lambda size: self._sized(sizes, size),
                    readers={one: f"read_{sources.get(one) or buffers.get(one, '')}" for one in fused.reads},
                )
                lines, made = function(program, fused, output, prefix, names, self.library)
                whole = self._size_of(program, ref) == self.size
                blocks += [*lines, ""]
                calls.append(f"{'canvas = RENDERSIZE; ' if whole else ''}gl_FragColor = {made}();")
                buffers[ref] = f"buffer{len(calls)}"
                targets.append(self._target(buffers[ref], program, ref, sizes))
        if last in sources or targets and buffers[last] != targets[-1]["TARGET"] or not targets:
            name = buffers.get(last) or sources[last]
            calls.append(f"canvas = RENDERSIZE; pixel = ivec2(int(gl_FragCoord.x), int(RENDERSIZE.y - gl_FragCoord.y)); "
                         f"gl_FragColor = read_{name}(pixel);")
            targets.append({})
        calls[-1] += " gl_FragColor = halation_shown(gl_FragColor);"
        shown = targets.pop()
        targets.append({key: shown[key] for key in ("WIDTH", "HEIGHT") if key in shown} and {})
        readers = [line for name in self.named.values() for line in _reader(name, True)]
        readers += [line for one in targets[:-1] for line in _reader(str(one["TARGET"]), False)]
        canvas = self._canvas(targets)
        switch = [f"{'else ' if at else ''}if (PASSINDEX == {at}) {{ {call} }}" for at, call in enumerate(calls)]
        main = ["void main() {", f"canvas = {canvas};", *(switch if len(calls) > 1 else calls), "}"]
        lines = ["vec2 canvas;", "ivec2 pixel;", *self._display(), *readers, "", *blocks, *main]
        return "\n".join(lines) + "\n", targets

    def _texts(self, model: Model, item: Constant) -> tuple[str, ...] | None:
        """What a constant is in the shader; None for what is always the same."""
        place = model.base.places.get(id(item))
        if place is None:
            return None
        count = len(item.value) if isinstance(item.value, tuple) else 1
        numbers = range(place, place + count)
        if not any(slopes[at] for slopes in (*model.slopes.values(), *model.products.values()) for at in numbers):
            return None
        return tuple(model.text(at) for at in numbers)

    def _sized(self, sizes: dict[Size, tuple[str, str]] | None, size: tuple[float, ...]) -> tuple[str, str] | None:
        found = (sizes or {}).get((int(size[0]), int(size[1])))
        return (f"int({found[0].format('canvas.x')})", f"int({found[1].format('canvas.y')})") if found else None

    def _target(
        self, name: str, program: Program, ref: Ref, sizes: dict[Size, tuple[str, str]] | None
    ) -> Section:
        size = self._size_of(program, ref)
        found: Section = {"TARGET": name, "FLOAT": True}
        if size != self.size:
            texts = (sizes or {}).get(size) or (str(size[0]), str(size[1]))
            found |= {"WIDTH": texts[0].format("$WIDTH"), "HEIGHT": texts[1].format("$HEIGHT")}
        return found

    def _canvas(self, targets: list[Section]) -> str:
        """The size of the whole picture in passes that are smaller."""
        if self.named:
            return f"IMG_SIZE({next(iter(self.named.values()))})"
        whole = next((one["TARGET"] for one in targets[:-1] if "WIDTH" not in one), None)
        return f"IMG_SIZE({whole})" if whole else f"vec2({float(self.size[0])}, {float(self.size[1])})"

    def _display(self) -> list[str]:
        """Between light and the display values of the format."""
        files = self.library.closure(("lib/isf",), "export")
        needed = frozenset({"display_straight", "from_display"})
        lines: list[str] = []
        for text in reversed(files):
            kept = text.only(needed)
            needed |= kept.words
            lines = [line.rstrip() for line in kept.body.split("\n") if line.strip()] + lines
        return [
            *lines, "float halation_light(float code) { return srgb_decode(code); }",
            "vec4 halation_shown(vec4 c) { return display_straight(c); }",
        ]

    # --- parts -------------------------------------------------------------------------------------------------------

    def _size_of(self, program: Program, ref: Ref) -> Size:
        return program.ops[ref.op].shapes[ref.output].size

    def _sources(self, program: Program) -> dict[Ref, str]:
        """The pictures of the graph's inputs."""
        return {
            Ref(at): self.named[op.picture.path] for at, op in enumerate(program.ops)
            if isinstance(op, Read) and op.picture.in_memory and op.picture.path in self.named
        }

    def _picture_names(self) -> dict[str, str]:
        if len(self.pictures) == 1:
            return {self.pictures[0]: "inputImage"}
        found: dict[str, str] = {}
        for name in self.pictures:
            found[name] = identifier(name, found.values())
        return found

    def _data_inputs(self) -> list[tuple[str, str]]:
        return [
            (f"inputs.{name}", f"is a {end.kind}: the format has pictures of display values only")
            for name, end in self.graph.inputs.items()
            if end.kind is not Kind.IMAGE and not (end.default is not None and not end.file) and self._reads(name)
        ]

    def _reads(self, name: str) -> bool:
        return any(source == Port("inputs", name) for source in self.graph.links.values())


def _reader(name: str, shown: bool) -> list[str]:
    """A function that reads one pixel of a picture; rows of ours run from the top."""
    at = f"vec2(float(at.x) + 0.5, IMG_SIZE({name}).y - float(at.y) - 0.5)"
    read = f"IMG_PIXEL({name}, {at})"
    return [f"vec4 read_{name}(ivec2 at) {{ return {f'from_display({read})' if shown else read}; }}"]


def _whole(name: str, step: float) -> float:
    return step


def _comment(head: Section) -> str:
    """JSON that does not end the comment that it stands in."""
    return json.dumps(head, indent=2).replace("*/", "*\\/")


def refused(exported: Exported) -> GraphError:
    """Why there is no shader, in one error."""
    lines = [f"{f"node '{node}'" if not node.startswith('inputs.') else f"input '{node[7:]}'"} {why}"
             for node, why in exported.reasons]
    return GraphError("; ".join(lines), node=exported.reasons[0][0])
