"""Colors of node categories: of their titles on sheets, and in both themes of the editor.

All are display-referred sRGB. "" stands for any other category.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

RGB = tuple[float, float, float]


def parse_hex(text: str) -> RGB:
    """Red, green and blue, 0 to 1, from six hexadecimal digits."""
    red, green, blue = (int(text[at : at + 2], 16) / 255 for at in (0, 2, 4))
    return red, green, blue


def _parse_all(colors: Mapping[str, str]) -> Mapping[str, RGB]:
    return MappingProxyType({name: parse_hex(text) for name, text in colors.items()})


DARK_CATEGORIES = _parse_all(
    {
        "": "4a4a52",
        "input": "7a4a3a",
        "output": "7a4a3a",
        "color": "73642a",
        "tone": "7a5a2e",
        "blur": "3f5f7f",
        "filter": "3f5f7f",
        "glow": "8a4f2a",
        "light": "6f5d1c",
        "lens": "5b5378",
        "distort": "4a6b4a",
        "edge": "2f6b6b",
        "matte": "5f6a3a",
        "geometry": "3d5378",
        "merge": "5a4a7a",
        "channel": "4f5560",
        "measure": "2f6258",
        "time": "6b4a5a",
        "noise": "6b3f5f",
        "stylize": "6b3f5f",
        "group": "3a6a48",
        "code": "3e4a8a",
    }
)

LIGHT_CATEGORIES = _parse_all(
    {
        "": "c3c3cb",
        "input": "e3bfae",
        "output": "e3bfae",
        "color": "e6d79a",
        "tone": "e6c99a",
        "blur": "aecbe6",
        "filter": "aecbe6",
        "glow": "f0c09a",
        "light": "ecd88a",
        "lens": "cdc3e8",
        "distort": "b9d9b9",
        "edge": "a3d6d6",
        "geometry": "b4c3ec",
        "merge": "c9bce6",
        "channel": "c6ccd6",
        "measure": "a8d6cb",
        "time": "e3bccb",
        "noise": "e0b9d3",
        "stylize": "e0b9d3",
        "group": "aed9ba",
        "code": "b9c0f2",
    }
)


def category_color(name: str, colors: Mapping[str, RGB] = DARK_CATEGORIES) -> RGB:
    """The color of a category."""
    return colors.get(name, colors[""])
