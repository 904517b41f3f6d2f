"""Angles for browsers: GLSL ES leaves it to the device how exact sin, cos and atan are.

Vulkan, on which browsers run, allows errors of 2^-11 for sin and cos and of 4096 units in the last place for atan.
SwiftShader makes use of it: a screen of dots that is rotated over 1000 pixels is off by half a pixel then. The
functions here are as exact as floats of 32 bits allow.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from types import MappingProxyType

_SIN = """float exact_wave(float x, float shift) {
    float turns = floor(x * 0.318309886 + 0.5 + shift), k = turns - shift;
    float r = (x - k * 3.140625) - k * 9.67653590e-4, s = r * r;
    float odd = -1.66666667e-1 + s * (8.33333333e-3 + s * (-1.98412698e-4 + s * (2.75573192e-6 - s * 2.50521084e-8)));
    return (mod(turns, 2.0) == 0.0 ? 1.0 : -1.0) * (r + r * s * odd);
}
float exact_sin(float x) { return exact_wave(x, 0.0); }
"""
"""The series of Taylor up to x^11 between -pi/2 and pi/2, where its error is 6e-8. Pi is taken away in two parts, of
which the first has few bits, so that its multiples are exact. A cosine is a sine, half a turn of pi later."""

_COS = "float exact_cos(float x) { return exact_wave(x, 0.5); }\n"

_TAN = "float exact_tan(float x) { return exact_sin(x) / exact_cos(x); }\n"

_ATAN = """float exact_atan(float y, float x) {
    float most = max(abs(x), abs(y)), t = most > 0.0 ? min(abs(x), abs(y)) / most : 0.0, s = t * t;
    float odd = 0.1065626393 + s * (-0.0752896400 + s * (0.0429096138 + s * (-0.0161657367 + s * 0.0028662257)));
    float angle = t + t * s * (-0.3333314528 + s * (0.1999355085 + s * (-0.1420889944 + s * odd)));
    if (abs(y) > abs(x)) angle = 1.57079633 - angle;
    if (x < 0.0) angle = 3.14159265 - angle;
    return y < 0.0 ? -angle : angle;
}
float exact_atan(float x) { return exact_atan(x, 1.0); }
"""
"""Abramowitz and Stegun 1964, 4.4.49: the error is 2e-8."""

_ASIN = "float exact_asin(float x) { return exact_atan(x, sqrt(max(1.0 - x * x, 0.0))); }\n"
_ACOS = "float exact_acos(float x) { return exact_atan(sqrt(max(1.0 - x * x, 0.0)), x); }\n"

_TEXTS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "sin": (_SIN,),
        "cos": (_SIN, _COS),
        "tan": (_SIN, _COS, _TAN),
        "atan": (_ATAN,),
        "asin": (_ATAN, _ASIN),
        "acos": (_ATAN, _ACOS),
    }
)
"""What each function needs, in order."""

_CALL = re.compile(rf"\b({'|'.join(_TEXTS)})\s*\(")


def use_exact_functions(text: str) -> tuple[str, str]:
    """The text with calls of exact functions, and these functions."""
    names = sorted(set(_CALL.findall(text)), key=list(_TEXTS).index)
    parts = dict.fromkeys(part for name in names for part in _TEXTS[name])
    vectors = "".join(_write_vectors(name) for name in names)
    return _CALL.sub(r"exact_\1(", text), "".join(parts) + vectors


def _write_vectors(name: str) -> str:
    """The function for vectors, component by component."""
    lines: list[str] = []
    for parameters in (("x",), ("y", "x")) if name == "atan" else (("x",),):
        for count in (2, 3, 4):
            calls = [f"exact_{name}({', '.join(f'{p}.{part}' for p in parameters)})" for part in "xyzw"[:count]]
            declared = ", ".join(f"vec{count} {p}" for p in parameters)
            lines.append(f"vec{count} exact_{name}({declared}) {{ return vec{count}({', '.join(calls)}); }}\n")
    return "".join(lines)
