"""Colors by their use. All are display-referred sRGB."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from halation.nodes import Kind

RGB = tuple[float, float, float]


def _hex(text: str) -> RGB:
    red, green, blue = (int(text[at : at + 2], 16) / 255 for at in (0, 2, 4))
    return red, green, blue


@dataclass(frozen=True)
class Palette:
    """One theme."""

    name: str
    window: RGB
    """Behind panels."""
    panel: RGB
    field: RGB
    """Where something can be typed or dragged."""
    fill: RGB
    """The part of a slider up to its value."""
    raised: RGB
    """Buttons, tabs, headers."""
    hover: RGB
    border: RGB
    text: RGB
    dim: RGB
    """Text of less weight: hints, units, disabled."""
    accent: RGB
    """What is selected or active."""
    on_accent: RGB
    good: RGB
    warning: RGB
    error: RGB
    canvas: RGB
    grid: RGB
    node: RGB
    shadow: RGB
    surround: RGB
    """Around the picture in the viewer: neutral, so that it does not tint what is judged."""
    kinds: Mapping[Kind, RGB]
    categories: Mapping[str, RGB]
    """The header of a node by its menu; "" for menus that have none of their own."""

    def category(self, name: str) -> RGB:
        """The header color of a node of that menu."""
        return self.categories.get(name, self.categories[""])


_KINDS = MappingProxyType(
    {
        Kind.IMAGE: _hex("e2b93b"),
        Kind.FIELD: _hex("b6bcc6"),
        Kind.VECTOR: _hex("8f83f0"),
        Kind.NUMBER: _hex("4fb3a5"),
        Kind.COLOR: _hex("e0709a"),
        Kind.CAMERA: _hex("5aa7e0"),
    }
)

_KINDS_LIGHT = MappingProxyType(
    {
        Kind.IMAGE: _hex("ad7c00"),
        Kind.FIELD: _hex("5f6772"),
        Kind.VECTOR: _hex("6152d9"),
        Kind.NUMBER: _hex("0f8273"),
        Kind.COLOR: _hex("c23d70"),
        Kind.CAMERA: _hex("1f74b5"),
    }
)

DARK = Palette(
    "dark",
    window=_hex("141416"),
    panel=_hex("1d1d20"),
    field=_hex("2a2a2e"),
    fill=_hex("42424a"),
    raised=_hex("333338"),
    hover=_hex("404047"),
    border=_hex("0d0d0f"),
    text=_hex("e4e4e7"),
    dim=_hex("9a9aa3"),
    accent=_hex("e8833a"),
    on_accent=_hex("1a1108"),
    good=_hex("5fb878"),
    warning=_hex("e6b450"),
    error=_hex("ef6b6b"),
    canvas=_hex("18181b"),
    grid=_hex("232327"),
    node=_hex("2b2b30"),
    shadow=_hex("000000"),
    surround=_hex("161616"),
    kinds=_KINDS,
    categories=MappingProxyType(
        {
            "": _hex("4a4a52"),
            "input": _hex("7a4a3a"),
            "output": _hex("7a4a3a"),
            "color": _hex("73642a"),
            "tone": _hex("7a5a2e"),
            "blur": _hex("3f5f7f"),
            "filter": _hex("3f5f7f"),
            "glow": _hex("8a4f2a"),
            "light": _hex("6f5d1c"),
            "lens": _hex("5b5378"),
            "distort": _hex("4a6b4a"),
            "edge": _hex("2f6b6b"),
            "geometry": _hex("3d5378"),
            "merge": _hex("5a4a7a"),
            "channel": _hex("4f5560"),
            "measure": _hex("2f6258"),
            "time": _hex("6b4a5a"),
            "noise": _hex("6b3f5f"),
            "stylize": _hex("6b3f5f"),
            "group": _hex("3a6a48"),
            "code": _hex("3e4a8a"),
        }
    ),
)

LIGHT = Palette(
    "light",
    window=_hex("c9c9ce"),
    panel=_hex("ececef"),
    field=_hex("ffffff"),
    fill=_hex("cbced9"),
    raised=_hex("d8d8de"),
    hover=_hex("c6c6ce"),
    border=_hex("b3b3ba"),
    text=_hex("1b1b1f"),
    dim=_hex("52525c"),
    accent=_hex("ab4f0a"),
    on_accent=_hex("ffffff"),
    good=_hex("1c7037"),
    warning=_hex("825900"),
    error=_hex("b32020"),
    canvas=_hex("dcdce1"),
    grid=_hex("cfcfd5"),
    node=_hex("f6f6f8"),
    shadow=_hex("6a6a70"),
    surround=_hex("b8b8b8"),
    kinds=_KINDS_LIGHT,
    categories=MappingProxyType(
        {
            "": _hex("c3c3cb"),
            "input": _hex("e3bfae"),
            "output": _hex("e3bfae"),
            "color": _hex("e6d79a"),
            "tone": _hex("e6c99a"),
            "blur": _hex("aecbe6"),
            "filter": _hex("aecbe6"),
            "glow": _hex("f0c09a"),
            "light": _hex("ecd88a"),
            "lens": _hex("cdc3e8"),
            "distort": _hex("b9d9b9"),
            "edge": _hex("a3d6d6"),
            "geometry": _hex("b4c3ec"),
            "merge": _hex("c9bce6"),
            "channel": _hex("c6ccd6"),
            "measure": _hex("a8d6cb"),
            "time": _hex("e3bccb"),
            "noise": _hex("e0b9d3"),
            "stylize": _hex("e0b9d3"),
            "group": _hex("aed9ba"),
            "code": _hex("b9c0f2"),
        }
    ),
)

PALETTES: Mapping[str, Palette] = MappingProxyType({palette.name: palette for palette in (DARK, LIGHT)})
