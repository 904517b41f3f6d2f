"""Assembles a package of the plans for all variants and of the parts that they share."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from functools import cache

from halation.nodes import Value
from msgspec import Struct

from ...compiler import Plan
from ...compiler.knobs import FRAME, Knob, KnobControl, Point, describe_control, find_control_name
from ...graph import find_declaration
from ...version import VERSION
from ..order import ExportOrder
from .curves import PairSamples, Record, find_needed_places
from .display import write_display_program
from .parts import SharedParts, VariantSamples
from .planning import OUTPUT, Phase, PointPlanner
from .sampling import Sample, is_irregular, is_number_table
from .variants import Span, VariantAxis, choose_axes, find_axis

LARGEST_DRAFT = 0.4
"""The side of a draft at most, as a part of the picture's. Chosen by judgement: with a half, the first picture of a
page of 480x270 comes no sooner on SwiftShader, which takes longer for the programs than for the pixels then."""


class Package(Struct, frozen=True):
    """A package: its JSON without pixels, and the programs and bytes that it names by number."""

    document: Record
    notes: tuple[str, ...]
    programs: tuple[tuple[str, str], ...]
    """Fragment and vertex shader of each program, GLSL 4.10; without a vertex shader it covers the picture."""
    blobs: tuple[bytes, ...]


def assemble_package(order: ExportOrder, game: str = "", draft_pixels: int = 0) -> Package:
    """The package of one output of a graph. Raises the errors of compiling it.

    `game` is what will draw it, if it draws over pictures alone: then meshes are refused. A larger picture gets a draft
    of about `draft_pixels` pixels, which a slow device shows first.
    """
    return _Assembly(order, game, draft_pixels).assemble()


class _Assembly:
    """One package: the planner, and the parts so far."""

    def __init__(self, order: ExportOrder, game: str, draft_pixels: int) -> None:
        self.order, self.draft_pixels = order, draft_pixels
        self.planner = PointPlanner(order, game)
        self.parts = SharedParts(self.planner.provider.load_pixels)
        self.samples: dict[str, dict[float, Sample]] = {}
        """Samples of each knob while all others rest, of the last phase."""

    def assemble(self) -> Package:
        """All plans: for the first frame, and for the frames after it if nodes remember something.

        Each knob is sampled alone first. Where its passes change it becomes an axis, and every combination of axes gets
        a plan; those that would make too many plans are held at the value of the graph, with all knobs of the same
        control: a color of which one channel is held would be another color.
        """
        planner = self.planner
        first, last = planner.first, planner.last
        phases = [planner.begin_phase({})]
        opening = phases[0].take({FRAME: first}).plan
        if opening.memories:
            phases.append(planner.begin_phase(opening.memories))
        start = first + len(phases) - 1
        knobs = [knob for control in planner.controls for knob in control.knobs]
        if last > start:
            knobs.append(Knob(FRAME, start, start, last, is_whole=True))
        base = {FRAME: float(start), **planner.find_base(knobs, phases[-1])}
        self.samples = {knob.name: planner.sample_knob(knob, base, phases[-1]) for knob in knobs}
        found_axes = (find_axis(knob.name, base[knob.name], self.samples[knob.name]) for knob in knobs)
        axes, held_axes = choose_axes([axis for axis in found_axes if axis])
        irregular_knobs = [knob for knob in knobs if not knob.is_whole and is_irregular(self.samples[knob.name])]
        irregular_names = {find_control_name(knob.name) for knob in irregular_knobs}
        held_names = {find_control_name(axis.knob) for axis in held_axes} | irregular_names
        axes = [axis for axis in axes if find_control_name(axis.knob) not in held_names]
        knobs = [knob for knob in knobs if find_control_name(knob.name) not in held_names]
        opening_knobs = [knob for knob in knobs if knob.name != FRAME] if len(phases) > 1 else knobs
        plans = [self._write_plans(axes, opening_knobs, {**base, FRAME: float(first)}, phases[0])]
        plans += [self._write_plans(axes, knobs, base, phase) for phase in phases[1:]]
        remarks = {**planner.remarks, **_describe_held(held_axes, irregular_names)}
        document = self._write_head((first, first if FRAME in held_names else last), axes, remarks)
        document |= self._write_display(opening)
        document |= {"slots": self.parts.slots, "plans": plans, **self._write_draft(opening, phases[0])}
        frozen = ["it shows one frame: other frames need other passes"] if FRAME in held_names else []
        held_notes = [describe_control(name, remark) for name, remark in remarks.items()]
        notes = (*held_notes, *frozen, *_describe_skipped(axes), *self._describe_poor())
        return Package(document, notes, tuple(self.parts.programs), tuple(self.parts.blobs))

    def _write_plans(self, axes: Sequence[VariantAxis], knobs: list[Knob], base: Point, phase: Phase) -> list[Record]:
        """The plans of all variants; the span of the last axis changes fastest."""
        names = [axis.knob for axis in axes]
        return [
            self._write_variant(dict(zip(names, spans, strict=True)), knobs, base, phase)
            for spans in itertools.product(*(axis.spans for axis in axes))
        ]

    def _write_variant(self, spans: Mapping[str, Span], knobs: list[Knob], base: Point, phase: Phase) -> Record:
        """One plan: the passes within spans of the knobs that change them, with curves for all numbers."""
        planner = self.planner
        names = {knob.name for knob in knobs}  # the first frame has no knob of time
        middle = {**base, **{name: span.middle for name, span in spans.items() if name in names}}
        rest = phase.take(middle)
        by_knob: dict[str, dict[float, Sample]] = {}
        for knob in knobs:
            places = list(self.samples[knob.name])
            if span := spans.get(knob.name):
                places = [x for x in places if span.low <= x <= span.high]
            needed_places = find_needed_places(self.samples[knob.name], places)
            samples = planner.take_along(rest, middle, knob, needed_places, phase)
            if len(samples) < len(needed_places):  # the knob changes these passes in a part of its range
                samples = planner.take_along(rest, middle, knob, places, phase)
            if samples:
                by_knob[knob.name] = samples
        checks = planner.sample_checks(middle, knobs, spans, rest, phase)

        @cache
        def sample_pairs(first: str, second: str) -> PairSamples:
            pair = [(name, list(by_knob[name])) for name in (first, second)]
            return planner.sample_pairs(pair[0], pair[1], middle, rest, phase)

        return self._write_plan(VariantSamples(rest, by_knob, checks, sample_pairs), phase)

    def _write_draft(self, opening: Plan, phase: Phase) -> Record:
        """The first picture again, smaller; nothing if it would hardly be faster."""
        width, height = opening.surfaces[opening.outputs[OUTPUT]].size
        scale = math.sqrt(self.draft_pixels / (width * height))
        if not 0.0 < scale <= LARGEST_DRAFT:
            return {}
        draft = self.planner.plan_draft(scale)
        return {"draft": self._write_plan(VariantSamples(draft, {}, [], lambda _first, _second: ([], [], [])), phase)}

    def _write_plan(self, samples: VariantSamples, phase: Phase) -> Record:
        """A plan; slots are numbered as `take_apart` lists them."""
        plan, numbers, parts = samples.rest.plan, itertools.count(), self.parts
        passes: list[Record] = []
        for render_pass in plan.passes:
            places = [next(numbers) for _ in range(len(render_pass.uniforms) + bool(render_pass.weights))]
            jumps = samples.find_jumps(places)
            slots = [parts.add_slot(place, samples, jumps) for place in places]
            record: Record = {
                "nodes": list(render_pass.nodes),
                "program": parts.add_program(render_pass.shader.source, render_pass.shader.vertex),
                "textures": list(render_pass.textures),
                "targets": list(render_pass.targets),
                "uniforms": {name: slot for (name, _), slot in zip(render_pass.uniforms, slots, strict=False)},
            }
            if render_pass.weights:
                record["weights"] = slots[-1]
            if render_pass.tables:
                record["tables"] = [parts.add_table(table) for table in render_pass.tables]
            if render_pass.mesh:
                record["mesh"] = parts.add_mesh(render_pass.mesh)
            passes.append(record)
        surfaces = _write_surfaces(plan, phase)
        for upload in plan.uploads:
            if is_number_table(upload.picture):
                place = next(numbers)
                slot = parts.add_slot(place, samples, samples.find_jumps([place]))
                surfaces[upload.surface]["numbers"] = slot
            else:
                surfaces[upload.surface]["source"] = parts.add_source(upload, plan)
        keys = {surface.key: number for number, surface in enumerate(plan.surfaces)}
        memories = {str(port): keys[memory.key] for port, memory in plan.memories.items() if memory.key in keys}
        return {"surfaces": surfaces, "passes": passes, "output": plan.outputs[OUTPUT], "memories": memories}

    def _write_head(self, frames: tuple[int, int], axes: Sequence[VariantAxis], remarks: Mapping[str, str]) -> Record:
        used_knobs = {curve["knob"] for record in self.parts.slots for curve in record.get("curves", ())}
        used_knobs |= {axis.knob for axis in axes}
        controls = [control for control in self.planner.controls if {knob.name for knob in control.knobs} & used_knobs]
        if FRAME not in used_knobs and not self.planner.remembers:
            frames = frames[0], frames[0]
        return {
            "halation_package": 1,
            "made_by": f"Halation {VERSION}",
            "name": self.order.name,
            "frames": list(frames),
            "rate": float(self.order.graph.settings.rate),
            "controls": [_write_control(control) for control in controls],
            "held": self._list_held({control.name for control in controls}, remarks),
            "axes": [{"knob": axis.knob, "edges": axis.edges} for axis in axes],
            "sources": self.parts.sources,
        }

    def _list_held(self, moving: set[str], remarks: Mapping[str, str]) -> list[Record]:
        """The controls of the graph that nothing here can move, each with the reason."""
        held: list[Record] = []
        for name, control in self.order.graph.controls.items():
            node = self.order.graph.nodes.get(control.target.node)
            value = find_declaration(node, control.target.socket) if node else None
            if name not in moving and value is not None:
                label, doc = control.label or value.label or _make_label(name), control.doc or value.doc
                remark = remarks.get(name, "changes nothing in this picture")
                held.append({"name": name, "label": label, "doc": doc, "remark": remark})
        return held

    def _write_display(self, plan: Plan) -> Record:
        encodings = self.planner.provider
        fragment, tables, view = write_display_program(self.order, plan, plan.outputs[OUTPUT], encodings)
        program = self.parts.add_program(fragment)
        return {"display": {"program": program, "view": view, "tables": [self.parts.add_table(t) for t in tables]}}

    def _describe_poor(self) -> list[str]:
        names = sorted(set(map(find_control_name, self.parts.poor_knobs)))
        if not names:
            return []
        return [f"controls {', '.join(names)} change the same numbers: where both are moved far, the look may differ"]


def _write_surfaces(plan: Plan, phase: Phase) -> list[Record]:
    ports = {memory.key: str(port) for port, memory in phase.memories.items()}
    surfaces: list[Record] = []
    for surface in plan.surfaces:
        record: Record = {"size": list(surface.size), "format": surface.texel, "slot": surface.slot}
        surfaces.append({**record, "history": ports[surface.key]} if surface.key in ports else record)
    return surfaces


def _describe_held(axes: Sequence[VariantAxis], irregular_names: set[str]) -> dict[str, str]:
    """Why controls keep their values in the package: a sentence for each, by its name."""
    reasons = {find_control_name(axis.knob): "it changes passes, as others do already" for axis in axes}
    reasons |= dict.fromkeys(irregular_names, "it moves outlines, and sorted tables of them are baked")
    return {name: f"keeps its value: {reasons[name]}" for name in sorted(reasons) if name != FRAME}


def _describe_skipped(axes: Sequence[VariantAxis]) -> list[str]:
    """A sentence for each control of which a package cannot hold all lists of passes."""
    return [
        f"control {find_control_name(axis.knob)} has {len(axis.spans) + axis.skipped} lists of passes, and the package "
        f"holds {len(axis.spans)}: between them it moves in steps; narrow its range, or export with a smaller --size"
        for axis in axes
        if axis.skipped
    ]


def _choose_widget(value: Value) -> str:
    """How a control is changed: slider, whole, switch, choice, color or point."""
    return {"float": "slider", "int": "whole", "bool": "switch", "vector": "point"}.get(value.type, value.type)


def _make_label(name: str) -> str:
    return name.replace("_", " ").capitalize()


def _write_control(control: KnobControl) -> Record:
    value = control.value
    knobs = [{"name": knob.name, "rest": knob.rest, "low": knob.low, "high": knob.high} for knob in control.knobs]
    record: Record = {
        "name": control.name,
        "label": control.label or _make_label(control.name),
        "doc": control.doc,
        "kind": _choose_widget(value),
        "unit": value.unit or "",
        "knobs": knobs,
    }
    return {**record, "choices": list(value.choices)} if value.choices else record
