"""Puts an effect together: its values, functions, textures, and the technique that runs all passes in order."""

from __future__ import annotations

from functools import cached_property

from msgspec import Struct, field

from ...errors import GraphError, describe_owner
from ..engine_text import quote_text, write_name
from ..game import DEPTH, NORMAL, choose_roles
from ..order import ExportOrder
from ..package import Package
from ..package.curves import Record
from ..shipped_files import read_shipped_text
from ..slang.hlsl import HlslProgram
from .controls import FRAME, write_controls, write_time
from .numbers import NumberPicture
from .parts import EffectParts, EffectPass
from .pictures import PackedPictures
from .programs import write_pass
from .sources import write_sources
from .translation import write_fx

_SCREEN = """sampler2D {texture}Smooth {{ Texture = {texture}; }};
float4 draw_screen(float4 position : SV_Position) : SV_Target {{
#if BUFFER_WIDTH == {width} && BUFFER_HEIGHT == {height}
    float4 light = FETCH({texture}Sampler, int(position.x), int(position.y));
#else
    float4 light = tex2Dlod({texture}Smooth, float4(position.xy / float2(BUFFER_WIDTH, BUFFER_HEIGHT), 0.0, 0.0));
#endif
    return float4(encode_srgb(light.{channels}), 1.0);
}}
"""


class Effect(Struct, frozen=True):
    """The text of an effect, the files beside it by name, notes on what it leaves out, and its number of passes."""

    text: str
    files: dict[str, bytes]
    notes: tuple[str, ...]
    passes: int


def write_effect(package: Package, order: ExportOrder, stem: str) -> Effect:
    """An effect with all passes at the settings of the graph. Raises GraphError for what ReShade cannot hold."""
    return _EffectWriter(package, order, stem).write()


MOST_NUMBERS = 4096
"""Numbers of a list that a control may change. Each four of them are a branch of one program; one with 17,000 branches
has 43 MB of text. A choice."""

_TOO_MANY = f"it changes lists of more than {MOST_NUMBERS} numbers, as letters that move do"


class _EffectWriter(Struct, dict=True):
    package: Package
    order: ExportOrder
    stem: str
    notes: list[str] = field(default_factory=list[str])
    _programs: dict[int, HlslProgram] = field(default_factory=dict[int, HlslProgram])

    def write(self) -> Effect:
        control_lines, knobs = self._write_values()
        document = self.package.document
        parts = EffectParts(self.package, NumberPicture(document["slots"], knobs), PackedPictures(self.stem))
        used = {surface["source"] for surface in self.plan["surfaces"] if "source" in surface}
        roles = choose_roles(self.order.graph, document["sources"], used)
        self._add_passes(parts, roles)
        number_lines = parts.numbers.write()
        if number_lines:
            parts.passes.insert(0, EffectPass("draw_numbers", ("Numbers",)))
        body = [
            *control_lines,
            read_shipped_text("reshade_functions.fx"),
            *number_lines,
            *parts.pictures.code,
            *write_sources(roles, self.size),
            *parts.textures.values(),
            *parts.lines,
            *self._write_technique(parts.passes),
        ]
        notes = (*self.package.notes, *self.notes)
        head = self._write_head(notes, parts.pictures, needs_depth=bool({DEPTH, NORMAL} & set(roles.values())))
        text = "\n".join([*head, f"namespace {write_name(self.stem, 'Halation')} {{", *body, "}", ""])
        return Effect(text, parts.pictures.files, notes, len(parts.passes))

    @cached_property
    def plan(self) -> Record:
        """The passes at the settings of the graph, of all frames but the first one."""
        index = 0
        for axis in self.package.document["axes"]:
            index = index * (len(axis["edges"]) + 1) + self._find_span(axis)
        return self.package.document["plans"][-1][index]

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture."""
        width, height = self.plan["surfaces"][self.plan["output"]]["size"]
        return width, height

    def _write_values(self) -> tuple[list[str], dict[str, str]]:
        """The lines of what a user changes, and the expression of each knob."""
        document, ranges, heavy = self.package.document, self._find_ranges(), self._find_heavy_knobs()
        light: list[Record] = []
        for control in document["controls"]:
            if heavy.isdisjoint(knob["name"] for knob in control["knobs"]):
                light.append(control)
            else:
                self.notes.append(f"control '{control['name']}' keeps its value: {_TOO_MANY}")
        lines, knobs = write_controls(light, ranges)
        first, last = document["frames"]
        if last > first and FRAME in heavy:
            self.notes.append(f"it shows one frame: time {_TOO_MANY.removeprefix('it ')}")
        elif last > first and FRAME not in ranges:
            lines += write_time(document)
            knobs[FRAME] = "frame()"
        return lines, knobs

    def _find_heavy_knobs(self) -> set[str]:
        """Knobs that change longer lists than a program can compute: a branch for each four numbers."""
        slots = self.package.document["slots"]
        lists = [slots[surface["numbers"]] for surface in self.plan["surfaces"] if "numbers" in surface]
        long_lists = [record for record in lists if len(record["base"]) > MOST_NUMBERS]
        curves = {curve["knob"] for record in long_lists for curve in record.get("curves", ())}
        return curves | {knob for record in long_lists for grid in record.get("grids", ()) for knob in grid["knobs"]}

    def _find_ranges(self) -> dict[str, tuple[float, float]]:
        """The span around the graph's value of each knob that changes passes: an effect has one list of passes."""
        document = self.package.document
        knobs = {knob["name"]: knob for control in document["controls"] for knob in control["knobs"]}
        ranges: dict[str, tuple[float, float]] = {}
        for axis in document["axes"]:
            knob = knobs.get(axis["knob"])
            low, high = (knob["low"], knob["high"]) if knob else map(float, document["frames"])
            edges, at = [low, *axis["edges"], high], self._find_span(axis)
            low, high = ranges[axis["knob"]] = edges[at], edges[at + 1]
            name = axis["knob"].partition(".")[0]
            self.notes.append(
                f"control '{name}' moves from {low:.4g} to {high:.4g} only: beyond, other passes are needed"
                if knob
                else "it shows one frame: other frames need other passes"
            )
        return ranges

    def _find_span(self, axis: Record) -> int:
        document = self.package.document
        rests = {knob["name"]: knob["rest"] for control in document["controls"] for knob in control["knobs"]}
        rest = rests.get(axis["knob"], float(document["frames"][0]))
        return sum(rest > edge for edge in axis["edges"])

    def _add_passes(self, parts: EffectParts, roles: dict[int, str]) -> None:
        """All passes of a frame, from what the game gives to the screen."""
        surfaces = self.plan["surfaces"]
        memories = {port: f"Memory{at}" for at, port in enumerate(self.plan["memories"])}
        names = [parts.add_texture(_name_surface(surface, memories), surface) for surface in surfaces]
        for surface, name in zip(surfaces, names, strict=True):
            parts.fill_surface(surface, name, roles)
        for number, record in enumerate(self.plan["passes"]):
            self._add_pass(parts, number, record, names)
        for port, surface in self.plan["memories"].items():
            if memories[port] in parts.textures:
                parts.add_drawing(memories[port], f"FETCH({names[surface]}Sampler, place.x, place.y)")
                self.notes.append("what it remembers is black when it starts")
        width, height = self.size
        output = self.plan["output"]
        channels = "rrr" if surfaces[output]["format"].startswith("r3") else "rgb"
        parts.lines.append(_SCREEN.format(texture=names[output], width=width, height=height, channels=channels))
        parts.add_pass("draw_screen")

    def _add_pass(self, parts: EffectParts, number: int, record: Record, names: list[str]) -> None:
        owner = record["nodes"][-1] if record["nodes"] else ""
        program = self._translate(record["program"], owner)
        for table in record.get("tables", ()):
            parts.add_table(table)
        samplers = [f"{names[texture]}Sampler" for texture in record["textures"]]
        functions = write_pass(program, record, samplers, parts.numbers, parts.tables)
        parts.lines += [f"namespace pass_{number} {{", *functions, "}"]
        parts.add_pass(f"pass_{number}::draw", *(names[target] for target in record["targets"]))

    def _translate(self, number: int, owner: str) -> HlslProgram:
        if number not in self._programs:
            try:
                self._programs[number] = write_fx(self.package.programs[number][0])
            except ValueError as error:
                place = describe_owner(owner)
                raise GraphError(f"{place} cannot be written in ReShade FX: {error}", node=owner) from None
        return self._programs[number]

    def _write_technique(self, passes: list[EffectPass]) -> list[str]:
        label = quote_text(self.order.name.replace("_", " ").capitalize())
        lines = [f"technique {write_name(self.stem, 'Halation')} < ui_label = {label}; > {{"]
        for each in passes:
            targets = "".join(f" RenderTarget{at} = {name};" for at, name in enumerate(each.targets))
            lines.append(f"    pass {{ VertexShader = cover; PixelShader = {each.function};{targets} }}")
        return [*lines, "}"]

    def _write_head(self, notes: tuple[str, ...], pictures: PackedPictures, *, needs_depth: bool) -> list[str]:
        width, height = self.size
        marks = {"MADE_BY": self.package.document["made_by"], "SIZE": f"{width}x{height}"}
        text = read_shipped_text("reshade_head.fx")
        for mark, value in {**marks, "FILES": ", ".join(pictures.files) or "none"}.items():
            text = text.replace(f"/*{mark}*/", value)
        include = ['#include "ReShade.fxh"'] if needs_depth else []
        return [text, *(f"// Note: {quote_text(note)[1:-1]}" for note in notes), *include]


def _name_surface(surface: Record, memories: dict[str, str]) -> str:
    """The name of the texture that holds a surface: one for each slot, source, list and memory."""
    if "history" in surface:
        return memories[surface["history"]]
    if "source" in surface:
        return f"Source{surface['source']}"
    return f"List{surface['numbers']}" if "numbers" in surface else f"Surface{surface['slot']}"
