"""Writes the feature of a look: its controls as Unity's inspector shows them, and their values by knob."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ..engine_text import quote_text, write_float
from ..package.curves import Record

_FIELDS = "look"
"""The field of the feature that holds all controls, so that no name is one of Unity's own."""


def write_class_name(name: str) -> str:
    """A name as classes of C# have it: soft_bloom is SoftBloom."""
    words = re.findall(r"[A-Za-z0-9]+", name)
    joined = "".join(word[0].upper() + word[1:] for word in words)
    return joined if joined and joined[0].isalpha() else f"Look{joined}"


def write_feature(document: Record, name: str, folder: str, about: str, notes: Sequence[str], head: str) -> str:
    """The text. `about` is what the look is, in a line; `notes` say what it leaves out."""
    fields: list[str] = []
    knobs: list[str] = []
    types: list[str] = []
    used_names: set[str] = set()
    for control in document["controls"]:
        own = _choose_name(control["name"], used_names)
        fields += _write_field(own, control)
        knobs += _write_knobs(own, control)
        if control["kind"] == "choice":
            types += _write_choices(own, control)
    first, last = document["frames"]
    frame: list[str] = []
    if last > first:
        own = _choose_name("frame", used_names)
        note = _write_note("The frame that is held. The lowest value lets time run.")
        fields += [note, f"[Range({first - 1}, {last})] public int {own} = {first - 1};"]
        frame = ["", "protected override int ChooseFrame()", "{", f"    return {_FIELDS}.{own};", "}"]
    comments = [f"/// {_write_comment(text)}" for text in (about, *(f"Note: {note}." for note in notes))]
    body = [
        *types,
        "[Serializable]",
        "public sealed class Controls",
        "{",
        *_indent(fields),
        "}",
        "",
        f"public Controls {_FIELDS} = new Controls();",
        "",
        f"protected override string Folder {{ get {{ return {quote_text(folder)}; }} }}",
        "",
        "protected override double[] ListKnobs()",
        "{",
        "    return new double[]",
        "    {",
        *_indent(_indent(knobs)),
        "    };",
        "}",
        *frame,
    ]
    lines = [*comments, f"public sealed class {name}Feature : LookFeature", "{", *_indent(body), "}"]
    start = [head, "using System;", "using UnityEngine;", "", f"namespace Halation.{name}", "{"]
    return "\n".join([*start, *_indent(lines), "}", ""])


def _indent(lines: Sequence[str]) -> list[str]:
    return [f"    {line}" if line else line for line in lines]


def _choose_name(name: str, used_names: set[str]) -> str:
    """A name of a field, as C# has it: film_grain is filmGrain. Keywords are allowed behind an @."""
    joined = write_class_name(name)
    own = joined[0].lower() + joined[1:]
    while own in used_names:  # names may differ in marks that names here have not
        own += "_"
    used_names.add(own)
    return f"@{own}"


def _write_comment(text: str) -> str:
    """A text in a comment for documentation, which is XML."""
    plain = quote_text(text)[1:-1]
    return f"<remarks>{plain.replace('&', '&amp;').replace('<', '&lt;').replace('>', '&gt;')}</remarks>"


def _write_note(text: str) -> str:
    return f"[Tooltip({quote_text(text)})]"


def _describe(control: Record) -> str:
    label = f"{control['label']}, in {control['unit']}" if control["unit"] else control["label"]
    return f"{label}: {control['doc']}" if control["doc"] else f"{label}."


def _write_field(own: str, control: Record) -> list[str]:
    """The field of a control, with what the inspector says of it."""
    knobs = control["knobs"]
    rests = [knob["rest"] for knob in knobs]
    low, high = min(knob["low"] for knob in knobs), max(knob["high"] for knob in knobs)
    numbers = ", ".join(_write_single(rest) for rest in rests)
    note = _describe(control)
    match control["kind"]:
        case "switch":
            field = f"public bool {own} = {'true' if rests[0] else 'false'};"
        case "choice":
            type_ = _name_choices(own)
            field = f"public {type_} {own} = ({type_}){round(rests[0])};"
        case "whole":
            field = f"[Range({round(low)}, {round(high)})] public int {own} = {round(rests[0])};"
        case "color":
            note += f" From {low:g} to {high:g}."  # such fields have no sliders
            field = f"[ColorUsage(false, true)] public Color {own} = new Color({numbers});"
        case _ if len(knobs) == 1:
            field = f"[Range({_write_single(low)}, {_write_single(high)})] public float {own} = {numbers};"
        case _:
            note += f" From {low:g} to {high:g}."
            field = f"public Vector{len(knobs)} {own} = new Vector{len(knobs)}({numbers});"
    return [_write_note(note), field]


def _name_choices(own: str) -> str:
    return f"{own[1].upper()}{own[2:]}Choice"


def _write_choices(own: str, control: Record) -> list[str]:
    """The type of a choice; the inspector shows the names as they are."""
    lines = [f"[InspectorName({quote_text(choice)})] Choice{at}," for at, choice in enumerate(control["choices"])]
    return [f"public enum {_name_choices(own)}", "{", *_indent(lines), "}", ""]


def _write_knobs(own: str, control: Record) -> list[str]:
    """The value of each knob of a control, within its range."""
    parts = "rgba" if control["kind"] == "color" else "xyzw"
    lines: list[str] = []
    for at, knob in enumerate(control["knobs"]):
        part = f"{_FIELDS}.{own}"
        if len(control["knobs"]) > 1 or control["kind"] == "color":
            part = f"{part}.{parts[at]}"
        low, high = write_float(knob["low"]), write_float(knob["high"])
        value = f"Math.Min(Math.Max((double){part}, {low}), {high})"
        if control["kind"] == "switch":
            value = f"{part} ? 1.0 : 0.0"
        elif control["kind"] == "choice":
            value = f"(double)(int){part}"
        lines.append(f"{value},")
    return lines


def _write_single(number: float) -> str:
    """A number of 32 bits in C#."""
    return f"{write_float(number)}f"
