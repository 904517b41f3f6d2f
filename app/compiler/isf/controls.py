"""Controls of a graph as inputs of a shader, and as the knobs that `affine` measures."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from halation.nodes import ItemSet, Scalar, Value

from ...graph import Graph, find_declaration
from .affine import Knob

_ODD = re.compile(r"[^A-Za-z0-9]+")
Section = dict[str, Any]


@dataclass(frozen=True)
class IsfControl:
    """A control with the value that it sets, its entry in the head of the shader, and a knob for each component."""

    name: str
    value: Value
    entry: Section
    knobs: tuple[Knob, ...]

    def value_at(self, point: Mapping[str, float]) -> Scalar:
        """The value of the control at a point."""
        parts = tuple(point.get(knob.name, knob.rest) for knob in self.knobs)
        if self.value.length > 1:
            return parts
        return {"bool": bool, "int": round}.get(self.value.type, float)(parts[0])


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
    names, controls, notes = set(used_names), list[IsfControl](), list[str]()
    for name, control in graph.controls.items():
        target = control.target
        item = graph.nodes.get(target.node)
        value = find_declaration(item, target.socket) if item else None
        rest = graph.value(target) if value else None
        if value is None or rest is None or isinstance(rest, ItemSet):
            continue
        fits = value.type in ("float", "int", "bool", "color") or (value.type == "vector" and value.length == 2)
        if not fits:
            notes.append(f"control '{name}' keeps its value: the format has no input for a {value.type} like it")
            continue
        if target in graph.animation or target in graph.links:
            notes.append(f"control '{name}' is no input: it is animated or linked")
            continue
        shader_name = make_identifier(name, names)
        names.add(shader_name)
        controls.append(_make_control(shader_name, name, control.label or value.label or name, value, rest))
    return controls, notes


def _make_control(shader_name: str, name: str, label: str, value: Value, rest: Scalar) -> IsfControl:
    parts = list(rest) if isinstance(rest, tuple) else [float(rest)]
    low, high = _find_range(value, parts)
    entry: Section = {"NAME": shader_name, "LABEL": label}
    if value.type == "color":
        straight = [*map(_encode_light, parts[:3]), *parts[3:], 1.0]
        entry |= {"TYPE": "color", "DEFAULT": straight[:4]}
        texts = [f"@halation_light(@{shader_name}.{letter})" for letter in "rgb"] + [f"@{shader_name}.a"]
    elif value.type == "vector":
        flips, (across, down) = value.handle, parts
        place = [across, 1.0 - down if flips else down]
        entry |= {"TYPE": "point2D", "DEFAULT": place, "MIN": [low, low], "MAX": [high, high]}
        texts = [f"@{shader_name}.x", f"(1.0 - @{shader_name}.y)" if flips else f"@{shader_name}.y"]
    elif value.type == "bool":
        entry |= {"TYPE": "bool", "DEFAULT": bool(rest)}
        texts = [f"(@{shader_name} ? 1.0 : 0.0)"]
    else:
        entry |= {"TYPE": "float", "DEFAULT": parts[0], "MIN": low, "MAX": high}
        texts = [f"@{shader_name}" if value.type == "float" else f"floor(@{shader_name} + 0.5)"]
    knobs = tuple(
        _make_knob(f"{name}.{at}" if len(parts) > 1 else name, text, value, part, low, high)
        for at, (part, text) in enumerate(zip(parts, texts, strict=False))
    )
    return IsfControl(name, value, entry, knobs)


def _make_knob(name: str, text: str, value: Value, rest: float, low: float, high: float) -> Knob:
    if value.type == "bool":
        return Knob(name, text, rest, rest, 1.0 - 2.0 * rest, 1)
    # A part of the range that no node has as a special value: at round values nodes may do nothing.
    step = 1.0 if value.type == "int" else (high - low) * 0.0371
    step = -step if rest + 6.0 * step > min(high, value.maximum) else step
    return Knob(name, text, rest, rest + step, step)


def _find_range(value: Value, parts: list[float]) -> tuple[float, float]:
    low, high = max(value.low, value.minimum), min(value.high, value.maximum)
    if low == float("-inf") or high == float("inf") or low >= high:
        low, high = 0.0, 1.0
    return min(low, *parts), max(high, *parts)


def _encode_light(light: float) -> float:
    code = 12.92 * abs(light) if abs(light) <= 0.0031308 else 1.055 * abs(light) ** (1.0 / 2.4) - 0.055
    return code if light >= 0.0 else -code
