"""Writes the controls of a package as values that a user of ReShade sees, and knobs as expressions of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..engine_text import quote_text, write_float, write_name
from ..package.curves import Record

FRAME = "frame"


def write_controls(
    controls: list[Record], ranges: Mapping[str, tuple[float, float]]
) -> tuple[list[str], dict[str, str]]:
    """The lines of all controls, and the expression of each knob. `ranges` are narrower ones of some knobs."""
    lines: list[str] = []
    knobs: dict[str, str] = {}
    for control in controls:
        name, own = write_name(control["name"], "control"), control["knobs"]
        while any(f" {name} <" in line for line in lines):  # names may differ in marks that names here have not
            name += "_"
        kind = "float" if control["kind"] not in ("switch", "whole", "choice") else "int"
        kind = "bool" if control["kind"] == "switch" else kind
        spans = [ranges.get(knob["name"], (knob["low"], knob["high"])) for knob in own]
        rest = [_write_rest(knob["rest"], kind) for knob in own]
        size = str(len(own)) if len(own) > 1 else ""
        value = f"{kind}{size}({', '.join(rest)})" if size else rest[0]
        notes = _write_notes(control, kind, (min(low for low, _ in spans), max(high for _, high in spans)))
        lines.append(f"uniform {kind}{size} {name} < {' '.join(notes)} > = {value};")
        for at, knob in enumerate(own):
            part = f"{name}.{'xyzw'[at]}" if size else name
            part = f"({part} ? 1.0 : 0.0)" if kind == "bool" else f"float({part})" if kind == "int" else part
            low, high = (write_float(end) for end in spans[at])
            knobs[knob["name"]] = part if kind == "bool" else f"clamp({part}, {low}, {high})"
    return lines, knobs


def write_time(document: Record) -> list[str]:
    """The function that gives the frame: time runs through all of them, unless the user holds one."""
    first, last = document["frames"]
    count = last - first + 1
    return [
        'uniform float elapsed < source = "timer"; >;',
        f'uniform int still_frame < ui_type = "slider"; ui_min = {first - 1}; ui_max = {last}; ui_label = "Frame"; '
        f'ui_tooltip = "The lowest value lets time run."; > = {first - 1};',
        "float frame() {",
        f"    float played = floor(elapsed * {write_float(0.001 * document['rate'])});",
        f"    return still_frame < {first} ? {first}.0 + played - {count}.0 * floor(played / {count}.0) : "
        "float(still_frame);",
        "}",
    ]


def _write_rest(number: float, kind: str) -> str:
    if kind == "bool":
        return "true" if number else "false"
    return str(round(number)) if kind == "int" else write_float(number)


def _write_notes(control: Record, kind: str, span: tuple[float, float]) -> list[str]:
    label = f"{control['label']} ({control['unit']})" if control["unit"] else control["label"]
    notes: dict[str, Any] = {"ui_label": quote_text(label)}
    if control["doc"]:
        notes["ui_tooltip"] = quote_text(control["doc"])
    if control["kind"] == "color":
        notes["ui_type"] = '"color"'
    elif control["kind"] == "choice":
        items = "".join(quote_text(choice)[1:-1] + "\\0" for choice in control["choices"])
        notes |= {"ui_type": '"combo"', "ui_items": f'"{items}"'}
    elif kind != "bool":
        low, high = (str(round(end)) if kind == "int" else write_float(end) for end in span)
        notes |= {"ui_type": '"slider"', "ui_min": low, "ui_max": high}
    return [f"{name} = {text};" for name, text in notes.items()]
