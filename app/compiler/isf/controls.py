"""Controls of a graph as inputs of a shader, and as the knobs that `affine` measures."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from halation.nodes import Value
from msgspec import Struct

from ...custom_nodes.isf.inputs import encode_light
from ...graph import Graph
from ..knobs import Knob, KnobControl, describe_control, find_knob_controls
from .affine import FittedKnob

_ODD = re.compile(r"[^A-Za-z0-9]+")
Section = dict[str, Any]


class IsfControl(Struct, frozen=True):
    """A control with its entry in the head of the shader, and the knobs that are fitted."""

    control: KnobControl
    entry: Section
    knobs: tuple[FittedKnob, ...]


def make_identifier(name: str, used_names: Iterable[str]) -> str:
    """The name as a GLSL identifier that is not in use yet."""
    plain = _ODD.sub("_", name).strip("_") or "value"
    plain = f"x{plain}" if plain[0].isdigit() or plain.startswith(("gl_", "isf_", "IMG_")) else plain
    candidate, number = plain, 1
    while candidate in set(used_names):
        number += 1
        candidate = f"{plain}{number}"
    return candidate


def find_controls(graph: Graph, used_names: Iterable[str]) -> tuple[list[IsfControl], list[str]]:
    """The controls that can become inputs, and a sentence on each of the others."""
    names, controls = set(used_names), list[IsfControl]()
    turnable, remarks = find_knob_controls(graph, _has_input)
    for control in turnable:
        shader_name = make_identifier(control.name, names)
        names.add(shader_name)
        controls.append(_make_control(shader_name, control))
    return controls, [describe_control(name, remark) for name, remark in remarks.items()]


def _has_input(value: Value) -> bool:
    return value.type in ("float", "int", "bool", "color") or (value.type == "vector" and value.length == 2)


def _make_control(shader_name: str, control: KnobControl) -> IsfControl:
    value, parts = control.value, [knob.rest for knob in control.knobs]
    low, high = control.knobs[0].low, control.knobs[0].high
    entry: Section = {"NAME": shader_name, "LABEL": control.label or control.name}
    if value.type == "color":
        straight = [*map(encode_light, parts[:3]), *parts[3:], 1.0]
        entry |= {"TYPE": "color", "DEFAULT": straight[:4]}
        texts = [f"@halation_light(@{shader_name}.{letter})" for letter in "rgb"] + [f"@{shader_name}.a"]
    elif value.type == "vector":
        flips, (across, down) = value.handle, parts
        place = [across, 1.0 - down if flips else down]
        entry |= {"TYPE": "point2D", "DEFAULT": place, "MIN": [low, low], "MAX": [high, high]}
        texts = [f"@{shader_name}.x", f"(1.0 - @{shader_name}.y)" if flips else f"@{shader_name}.y"]
    elif value.type == "bool":
        entry |= {"TYPE": "bool", "DEFAULT": bool(parts[0])}
        texts = [f"(@{shader_name} ? 1.0 : 0.0)"]
    else:
        entry |= {"TYPE": "float", "DEFAULT": parts[0], "MIN": low, "MAX": high}
        texts = [f"@{shader_name}" if value.type == "float" else f"floor(@{shader_name} + 0.5)"]
    knobs = tuple(_make_knob(knob, text, value) for knob, text in zip(control.knobs, texts, strict=False))
    return IsfControl(control, entry, knobs)


_STEP_SHARE = 0.0371
"""Step between samples as a part of the slider's range: no node has such odd values as special ones, at which it might
do nothing, and the farthest sample, after six steps, is within a quarter of the range."""

_FARTHEST_STEPS = 6.0
"""Steps to the farthest sample: the first is one step away, and the check of the fit another five."""


def _make_knob(knob: Knob, text: str, value: Value) -> FittedKnob:
    name, rest = knob.name, knob.rest
    if value.type == "bool":
        return FittedKnob(name, text, rest, rest, 1.0 - 2.0 * rest, 1)
    step = 1.0 if value.type == "int" else (knob.high - knob.low) * _STEP_SHARE
    step = -step if rest + _FARTHEST_STEPS * step > min(knob.high, value.maximum) else step
    return FittedKnob(name, text, rest, rest + step, step)
