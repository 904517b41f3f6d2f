"""Writes the script of a look: its controls as Godot's inspector shows them, and their values by knob."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ..engine_text import quote_text, write_float, write_name
from ..package.curves import Record

_GROUP = "look"
"""How names of controls begin: the inspector leaves it out, and no name is one of Godot's own."""


def write_script(document: Record, about: str, notes: Sequence[str]) -> str:
    """The text. `about` is what the look is, in a line; `notes` say what it leaves out."""
    lines = [
        "@tool",
        'extends "halation_effect.gd"',
        *_write_comments([about, *(f"Note: {note}." for note in notes)]),
        "",
    ]
    lines += [f'@export_group("Look", "{_GROUP}_")']
    knobs: list[str] = []
    taken: set[str] = set()
    for control in document["controls"]:
        name = write_name(control["name"], _GROUP)
        while name in taken:  # names may differ in marks that names here have not
            name += "_"
        taken.add(name)
        lines += ["", *_write_comments([_describe(control)]), _write_variable(name, control)]
        knobs += _write_knobs(name, control)
    first, last = document["frames"]
    if last > first:
        name = f"{_GROUP}_frame"
        while name in taken:
            name += "_"
        lines += ["", "## The frame that is held. The lowest value lets time run."]
        lines += [f"@export_range({first - 1}, {last}) var {name}: int = {first - 1}"]
        frame = f"return {name} if {name} >= {first} else -1"
        lines += ["", "", "func choose_frame() -> int:", f"\t{frame}"]
    return "\n".join([*lines, "", "", "func list_knobs() -> Dictionary:", "\treturn {", *knobs, "\t}", ""])


def _write_comments(texts: Sequence[str]) -> list[str]:
    return [f"## {quote_text(text)[1:-1]}" for text in texts if text]


def _describe(control: Record) -> str:
    label = f"{control['label']}, in {control['unit']}" if control["unit"] else control["label"]
    return f"{label}: {control['doc']}" if control["doc"] else f"{label}."


def _write_variable(name: str, control: Record) -> str:
    knobs = control["knobs"]
    rests = [knob["rest"] for knob in knobs]
    low, high = (pick(knob[end] for knob in knobs) for pick, end in ((min, "low"), (max, "high")))
    match control["kind"]:
        case "switch":
            return f"@export var {name}: bool = {'true' if rests[0] else 'false'}"
        case "choice":
            choices = ", ".join(map(quote_text, control["choices"]))
            return f"@export_enum({choices}) var {name}: int = {round(rests[0])}"
        case "whole":
            return f"@export_range({round(low)}, {round(high)}) var {name}: int = {round(rests[0])}"
        case "color":
            return f"@export var {name}: Color = Color({_join([*rests, 1.0][:4])})"
        case _ if len(knobs) == 1:
            return f"@export_range({_join((low, high, (high - low) / _STEPS))}) var {name}: float = {_join(rests)}"
        case _:
            return f"@export var {name}: Vector{len(knobs)} = Vector{len(knobs)}({_join(rests)})"


_STEPS = 1000
"""Steps of a slider: Godot rounds numbers to them, and would to thousandths if nothing were said."""


def _write_knobs(name: str, control: Record) -> list[str]:
    """The entry of each knob of a control: its name and the number, within its range."""
    parts = "rgba" if control["kind"] == "color" else "xyzw"
    lines: list[str] = []
    for at, knob in enumerate(control["knobs"]):
        part = f"{name}.{parts[at]}" if len(control["knobs"]) > 1 or control["kind"] == "color" else name
        value = f"clampf({part}, {_join((knob['low'], knob['high']))})"
        if control["kind"] == "switch":
            value = f"1.0 if {part} else 0.0"
        lines.append(f"\t\t{quote_text(knob['name'])}: {value},")
    return lines


def _join(numbers: Iterable[float]) -> str:
    return ", ".join(map(write_float, numbers))
