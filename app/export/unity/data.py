"""Writes what runs when as Unity's reader of JSON takes it: classes with fields, no dictionaries, no lists of lists.

`assets/unity_data.cs` declares the same fields. Knobs and ports are numbers, and what is not there is -1.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from ..game import list_plans
from ..package.curves import Record
from .shaders import OWN_PASSES, ShaderPass

FRAME = "frame"
NONE = -1


def list_knobs(document: Record) -> list[str]:
    """The names of all knobs in their order; the frame is the last one."""
    return [knob["name"] for control in document["controls"] for knob in control["knobs"]] + [FRAME]


def find_lengths(document: Record) -> dict[int, dict[str, int]]:
    """The numbers that lists of each program are given at most, by program and name."""
    lengths: dict[int, dict[str, int]] = {}
    for plan in list_plans(document):
        for record in plan["passes"]:
            longest = lengths.setdefault(record["program"], {})
            for name, slot in _list_slots(record):
                longest[name] = max(longest.get(name, 0), len(document["slots"][slot]["base"]))
    return lengths


def write_data(document: Record, passes: Mapping[int, ShaderPass], roles: Mapping[int, str]) -> dict[str, Any]:
    """The whole file."""
    return _DataWriter(document, passes, roles).write()


class _DataWriter:
    def __init__(self, document: Record, passes: Mapping[int, ShaderPass], roles: Mapping[int, str]) -> None:
        self.document, self.passes, self.roles = document, passes, roles
        self.numbers = {name: number for number, name in enumerate(list_knobs(document))}
        self.places = {program: place for place, program in enumerate(passes)}
        self.ports = list(document["plans"][0][0]["memories"])
        self.tables: dict[str, int] = {}
        self._written_tables: list[Record] = []

    def write(self) -> dict[str, Any]:
        document = self.document
        first, last = document["frames"]
        plans = [[self._write_plan(plan) for plan in variants] for variants in document["plans"]]
        return {
            "firstFrame": first,
            "lastFrame": last,
            "rate": document["rate"],
            "memories": len(self.ports),
            "axes": [{"knob": self.numbers[axis["knob"]], "edges": list(axis["edges"])} for axis in document["axes"]],
            "slots": [self._write_slot(slot) for slot in document["slots"]],
            "sources": [
                {**_write_size(source), "blob": source["blob"], "role": self.roles.get(number, "")}
                for number, source in enumerate(document["sources"])
            ],
            "tables": self._written_tables,
            "openings": plans[0] if self.ports else [],
            "plans": plans[-1],
        }

    def _write_slot(self, slot: Record) -> Record:
        return {
            "start": slot["base"],
            "multiplies": slot.get("mode", "") == "multiply",
            "whole": bool(slot.get("whole")),
            "curves": [
                {
                    "knob": self.numbers[curve["knob"]],
                    "snaps": bool(curve.get("snap")),
                    "at": curve["at"],
                    "values": _join(curve["values"]),
                }
                for curve in slot.get("curves", ())
            ],
            "grids": [
                {
                    "first": self.numbers[grid["knobs"][0]],
                    "second": self.numbers[grid["knobs"][1]],
                    "firstAt": grid["at"][0],
                    "secondAt": grid["at"][1],
                    "values": _join(row for line in grid["values"] for row in line),
                }
                for grid in slot.get("grids", ())
            ],
        }

    def _write_plan(self, plan: Record) -> Record:
        return {
            "output": plan["output"],
            "surfaces": [
                {
                    **_write_size(surface),
                    "source": surface.get("source", NONE),
                    "numbers": surface.get("numbers", NONE),
                    "memory": self.ports.index(surface["history"]) if "history" in surface else NONE,
                }
                for surface in plan["surfaces"]
            ],
            "passes": [self._write_pass(record) for record in plan["passes"]],
            "kept": [plan["memories"].get(port, NONE) for port in self.ports],
        }

    def _write_pass(self, record: Record) -> Record:
        own = self.passes[record["program"]]
        pictures = {f"t{unit}": surface for unit, surface in enumerate(record["textures"])}
        tables = {table["sampler"]: self._add_table(table) for table in record.get("tables", ())}
        return {
            "pass": len(OWN_PASSES) + self.places[record["program"]],
            "name": ", ".join(record["nodes"]),
            "rows": own.count,
            "targets": record["targets"],
            "uniforms": [
                {"row": own.rows[name], "group": own.groups[name], "slot": slot}
                for name, slot in _list_slots(record)
                if name in own.rows
            ],
            "pictures": _write_bindings(own, pictures),
            "tables": _write_bindings(own, tables),
        }

    def _add_table(self, table: Record) -> int:
        if table["sampler"] not in self.tables:
            self.tables[table["sampler"]] = len(self.tables)
            *depth, height, width, channels = table["shape"]
            self._written_tables.append(
                {
                    "width": width,
                    "height": height,
                    "depth": depth[0] if depth else 1,
                    "format": f"{'rgba'[:channels]}32f",
                    "linear": table["linear"],
                    "blob": table["blob"],
                }
            )
        return self.tables[table["sampler"]]


def _list_slots(record: Record) -> Iterable[tuple[str, int]]:
    """The slot of each uniform of a pass, and that of its weights."""
    weights = [("weights", record["weights"])] if "weights" in record else []
    return [*record["uniforms"].items(), *weights]


def _write_bindings(own: ShaderPass, numbers: Mapping[str, int]) -> list[Record]:
    return [{"property": own.pictures[name], "number": numbers[name]} for name in numbers if name in own.pictures]


def _write_size(surface: Record) -> Record:
    width, height = surface["size"]
    return {"width": width, "height": height, "format": surface["format"]}


def _join(rows: Iterable[Sequence[float]]) -> list[float]:
    """Rows of numbers one after another."""
    return [number for row in rows for number in row]
