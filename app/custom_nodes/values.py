"""Values from what comments say of parameters."""

from __future__ import annotations

import re
from typing import Any, cast

from halation.nodes import Scalar, Unit, Value

from .code import CodeFault
from .notes import ParameterNote

_LARGEST_FLOAT = 3.4e38
"""Just below the largest float of 32 bits (3.403e38)."""

_LEAST_INT_RANGE = 8.0
"""The end of the slider of a whole number with a small default: chosen by eye, so that it has some steps."""

_GLSL = {"float": 1, "int": 1, "bool": 1, "vec2": 2, "vec3": 3, "vec4": 4}


def make_value(glsl: str, name: str, note: ParameterNote, line: int) -> Value:
    """The value that a parameter with a default is. Raises CodeFault."""
    if glsl not in _GLSL:
        raise CodeFault(line, f"'{name}' has the type {glsl}: values are {', '.join(_GLSL)}")
    unit = cast("Unit", note.unit) or None
    fields: dict[str, Any] = {
        "name": name,
        "doc": note.doc,
        "label": note.label,
        "unit": unit,
        "minimum": note.minimum,
        "maximum": note.maximum,
    }
    length = _GLSL[glsl]
    if glsl == "int" and note.choices:
        if note.default not in note.choices:
            raise CodeFault(line, f"the default of '{name}' is '{note.default}', which is none of its choices")
        return Value(**{**fields, "type": "choice", "choices": note.choices, "default": note.default})
    if note.choices:
        raise CodeFault(line, f"'{name}' has choices, so it is an int, not a {glsl}")
    if note.color and length < 3:
        raise CodeFault(line, f"'{name}' is a color, so it is a vec4 or vec3, not a {glsl}")
    if note.handle and length != 2:
        raise CodeFault(line, f"'{name}' has a handle in the viewer, so it is a vec2, not a {glsl}")
    default = _parse_default(glsl, name, note.default, line)
    if length > 1:
        kind = "color" if note.color else "vector"
        fields |= {"type": kind, "length": length, "handle": note.handle}
    else:
        fields |= {"type": glsl}
    low, high = _choose_range(glsl, default, note)
    if low > high or not note.minimum <= note.maximum:
        raise CodeFault(line, f"the range of '{name}' is empty")
    if glsl != "bool" and not note.color:
        fields |= {"low": low, "high": high}
    if any(not note.minimum <= number <= note.maximum for number in _numbers(default)):
        raise CodeFault(line, f"the default of '{name}' lies beyond its limits")
    return Value(**{**fields, "default": default})


def _parse_default(glsl: str, name: str, text: str, line: int) -> Scalar:
    words = {"true": True, "on": True, "false": False, "off": False}
    if glsl == "bool":
        if text not in words:
            raise CodeFault(line, f"the default of '{name}' is '{text}': a bool must be true or false")
        return words[text]
    length = _GLSL[glsl]
    parts = re.sub(r"^(?:vec\d)?\(|\)$", "", text).replace(",", " ").split()
    numbers = tuple(_parse_number(part) for part in parts)
    if len(numbers) == 1 and length > 1:
        numbers *= length
    if len(numbers) != length or not all(abs(number) < _LARGEST_FLOAT for number in numbers):
        expected = "a number" if length == 1 else f"{length} numbers, as (1, 0.5, 0)"
        raise CodeFault(line, f"the default of '{name}' is '{text}': a {glsl} is {expected}")
    if glsl == "int":
        if numbers[0] != int(numbers[0]):
            raise CodeFault(line, f"the default of '{name}' is '{text}': an int must be a whole number")
        return int(numbers[0])
    return numbers[0] if length == 1 else numbers


def _parse_number(text: str) -> float:
    """What a word means; NaN if it is no number."""
    try:
        return float(text.removesuffix("f"))
    except ValueError:
        return float("nan")


def _numbers(default: Scalar) -> tuple[float, ...]:
    assert not isinstance(default, str)
    return default if isinstance(default, tuple) else (float(default),)


def _choose_range(glsl: str, default: Scalar, note: ParameterNote) -> tuple[float, float]:
    """The soft range: as it is said, else one that the default lies well inside of."""
    if note.low is not None and note.high is not None:
        return note.low, note.high
    if isinstance(default, tuple):
        return (0.0, 1.0) if note.handle else (-1.0, 1.0)
    top = max(1.0, 2.0 * abs(float(default)))
    if glsl == "int":
        top = max(_LEAST_INT_RANGE, top)
    low = note.minimum if note.minimum > float("-inf") else (0.0 if float(default) >= 0.0 else -top)
    return low, min(max(top, low + 1.0), note.maximum)
