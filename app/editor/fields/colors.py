"""Converts scene-linear colors for the color picker: sRGB, and an intensity beyond 1. Nothing here draws."""

from __future__ import annotations

import math
import re

from ...errors import UsageError
from ...language.translation import translate
from ..theme.palette import RGB

RGBA = tuple[float, float, float, float]

_HEX = re.compile(r"#?([0-9a-fA-F]{3,4}|[0-9a-fA-F]{6}|[0-9a-fA-F]{8})")


def encode(light: float) -> float:
    """The sRGB number of linear light (IEC 61966-2-1), mirrored below 0."""
    size = abs(light)
    return math.copysign(size * 12.92 if size <= 0.0031308 else 1.055 * size ** (1 / 2.4) - 0.055, light)


def decode(number: float) -> float:
    """The linear light of an sRGB number."""
    size = abs(number)
    return math.copysign(size / 12.92 if size <= 0.04045 else ((size + 0.055) / 1.055) ** 2.4, number)


def swatch(color: RGBA | RGB) -> RGB:
    """The display color of a scene-linear color: encoded as sRGB and clamped to 0 to 1."""
    red, green, blue = (min(max(encode(part), 0.0), 1.0) for part in color[:3])
    return red, green, blue


def intensity(color: RGBA) -> float:
    """How many stops a color is brighter than display white; 0 if it is not."""
    return max(math.log2(max(*color[:3], 1e-30)), 0.0)


def from_display(number: RGB, stops: float, alpha: float) -> RGBA:
    """The scene-linear color of display numbers, brightened by `stops`."""
    red, green, blue = (decode(part) * 2.0**stops for part in number)
    return red, green, blue, alpha


def to_display(color: RGBA, stops: float) -> RGB:
    """The display color of a scene-linear color, darkened by `stops` first."""
    return swatch((color[0] / 2.0**stops, color[1] / 2.0**stops, color[2] / 2.0**stops))


def brighten(color: RGBA, stops: float) -> RGBA:
    """The color, brightened by some stops."""
    red, green, blue = (part * 2.0**stops for part in color[:3])
    return red, green, blue, color[3]


def hexadecimal(color: RGBA) -> str:
    """The color as sRGB, `#rrggbb`, with its alpha behind unless that is 1."""
    parts = [*swatch(color), *([] if color[3] == 1.0 else [min(max(color[3], 0.0), 1.0)])]
    return "#" + "".join(f"{round(part * 255):02x}" for part in parts)


def from_hexadecimal(text: str, alpha: float = 1.0) -> RGBA:
    """The scene-linear color of sRGB digits: `#f80`, `ff8800`, `#ff880080`. Raises UsageError."""
    match = _HEX.fullmatch(text.strip())
    if match is None:
        raise UsageError(
            translate("'{text}' is not a color: type six hexadecimal digits, such as #ff8800", text=text.strip())
        )
    digits = match[1] if len(match[1]) > 4 else "".join(digit * 2 for digit in match[1])
    parts = [int(digits[at : at + 2], 16) / 255.0 for at in range(0, len(digits), 2)]
    red, green, blue = (decode(part) for part in parts[:3])
    return red, green, blue, parts[3] if len(parts) == 4 else alpha
