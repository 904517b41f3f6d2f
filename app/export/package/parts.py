"""What the plans of a package have in common, written once: numbers, programs, pixels, tables and triangles."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from halation.nodes import Kind
from msgspec import Struct, field

from ...compiler import Plan, Upload
from ...compiler.knobs import FRAME
from ...resources.color_program import LookupTable
from ...resources.mesh import Mesh
from ...resources.picture import Picture
from .curves import Jumps, PairSamples, Record, add_grids, measure_error, write_slot
from .sampling import Array, LoadFunction, Sample

_ROUNDED = 0.51
"""How far from a line its rounded numbers are at most: a half, and the rounding of floats."""

_GRID_MARGIN = 8
"""Grids are added until the error is so many times below what counts as poor. Chosen by judgement."""

POOR_FIT = 0.02
"""The error of numbers, as a part of the largest, above which a note says so: about two steps of 8 bits for what scales
a color of middle gray."""

Checks = list[Any]


class VariantSamples(Struct, eq=False):
    """The samples of one variant: at rest, along each knob, at checks, and by pairs of knobs."""

    rest: Sample
    by_knob: Mapping[str, Mapping[float, Sample]]
    checks: Checks
    pairs: Callable[[str, str], PairSamples]

    def find_jumps(self, places: list[int]) -> Jumps:
        """Where the numbers of a pass jump along each knob: these slots are its numbers."""
        whole, lengths = dict[str, Array](), dict[str, Array]()
        for name, group in self.by_knob.items():
            xs, slots = np.array(list(group)), [[sample.slots[place] for place in places] for sample in group.values()]
            rows = np.array([[x for slot in row if slot.is_whole for x in slot.numbers] for row in slots])
            counts = np.array([[len(slot.numbers) for slot in row] for row in slots])
            has_more = np.asarray(np.diff(counts, axis=0).any(axis=1))
            if has_more.any():
                lengths[name] = has_more
            if len(xs) > 2:
                lines = rows[0] + (xs - xs[0])[:, None] / (xs[-1] - xs[0]) * (rows[-1] - rows[0])
                is_changed = np.asarray(np.diff(rows, axis=0).any(axis=1))
                if np.abs(lines - rows).max(initial=0.0) > _ROUNDED and (is_changed & ~has_more).any():
                    whole[name] = is_changed
        return Jumps(whole, lengths)

    def has_one_length(self, place: int) -> bool:
        """True if a slot has equally many numbers everywhere."""
        samples = [self.rest, *(sample for group in self.by_knob.values() for sample in group.values())]
        return len({len(sample.slots[place].numbers) for sample in samples}) == 1


class SharedParts(Struct):
    """Parts by what they are, numbered in the order in which they came."""

    load: LoadFunction
    programs: dict[tuple[str, str], int] = field(default_factory=dict[tuple[str, str], int])
    blobs: dict[bytes, int] = field(default_factory=dict[bytes, int])
    slots: list[Record] = field(default_factory=list[Record])
    sources: list[Record] = field(default_factory=list[Record])
    poor_knobs: set[str] = field(default_factory=set[str])
    """Knobs that change numbers together in a way that curves and grids do not follow."""
    _numbers: dict[str, int] = field(default_factory=dict[str, int])
    _pictures: dict[Picture, int] = field(default_factory=dict[Picture, int])
    _tables: dict[str, Record] = field(default_factory=dict[str, Record])
    _meshes: dict[str, Record] = field(default_factory=dict[str, Record])

    def add_program(self, fragment: str, vertex: str = "") -> int:
        """The number of a program, GLSL 4.10."""
        return self.programs.setdefault((fragment, vertex), len(self.programs))

    def add_slot(self, place: int, samples: VariantSamples, jumps: Jumps) -> int:
        """The number of a slot with all its curves."""
        record = write_slot(place, samples.rest, samples.by_knob, samples.checks, jumps)
        if len(record.get("curves", ())) > 1:
            if samples.has_one_length(place):
                add_grids(record, place, samples.pairs, samples.checks, POOR_FIT / _GRID_MARGIN)
            if measure_error(record, place, samples.checks) > POOR_FIT:
                self.poor_knobs |= {curve["knob"] for curve in record["curves"]} - {FRAME}
        text = json.dumps(record)
        if text not in self._numbers:
            self._numbers[text] = len(self.slots)
            self.slots.append(record)
        return self._numbers[text]

    def add_blob(self, content: bytes) -> int:
        """The number of some bytes."""
        return self.blobs.setdefault(content, len(self.blobs))

    def add_source(self, upload: Upload, plan: Plan) -> int:
        """The number of a picture from a file, or of a bound one."""
        picture, node = upload.picture, upload.node
        if picture not in self._pictures:
            surface, pixels = plan.surfaces[upload.surface], self.load(picture)
            depth = np.float16 if surface.depth == "f2" else np.float32
            whole = np.zeros((*pixels.shape[:2], surface.components), depth)
            whole[..., : pixels.shape[2]] = pixels[..., : surface.components]
            self._pictures[picture] = len(self.sources)
            self.sources.append(
                {
                    "name": node.removeprefix("inputs."),
                    "is_input": node.startswith("inputs.") and picture.kind is Kind.IMAGE,
                    "is_end": node.startswith("inputs."),
                    "size": list(surface.size),
                    "format": surface.texel,
                    "blob": self.add_blob(whole.tobytes()),
                }
            )
        return self._pictures[picture]

    def add_table(self, table: LookupTable) -> Record:
        """A table of a color library. No device has textures of three floats: a fourth channel is 0."""
        if table.sampler not in self._tables:
            values = np.ascontiguousarray(table.values, np.float32)
            if values.shape[-1] == 3:
                values = np.concatenate([values, np.zeros_like(values[..., :1])], axis=-1)
            self._tables[table.sampler] = {
                "sampler": table.sampler,
                "shape": list(values.shape),
                "size": list(values.shape[-2::-1]),
                "format": f"{'rgba'[: values.shape[-1]]}32f",
                "linear": table.linear,
                "blob": self.add_blob(values.tobytes()),
            }
        return self._tables[table.sampler]

    def add_mesh(self, mesh: Mesh) -> Record:
        """The triangles of a mesh."""
        if mesh.digest not in self._meshes:
            self._meshes[mesh.digest] = {
                "vertices": self.add_blob(np.ascontiguousarray(mesh.vertices, np.float32).tobytes()),
                "indices": self.add_blob(np.ascontiguousarray(mesh.indices, np.uint32).tobytes()),
            }
        return self._meshes[mesh.digest]
