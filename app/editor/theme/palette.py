"""The color themes. All colors are display-referred sRGB."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from halation.nodes import Kind
from msgspec import Struct

from ...media.comparison.category_colors import DARK_CATEGORIES, LIGHT_CATEGORIES, RGB, category_color, parse_hex


class Palette(Struct, frozen=True):
    """The colors of one theme, by their use."""

    name: str
    window: RGB
    """Behind panels."""
    panel: RGB
    field: RGB
    """Behind fields."""
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
    """Selected or active things."""
    on_accent: RGB
    good: RGB
    warning: RGB
    error: RGB
    canvas: RGB
    grid: RGB
    node: RGB
    shadow: RGB
    surround: RGB
    """Around the picture in the viewer: neutral, so that it does not change how colors look."""
    kinds: Mapping[Kind, RGB]
    categories: Mapping[str, RGB]
    """The header color of nodes by menu; "" for other menus."""

    @property
    def is_dark(self) -> bool:
        """True if what is drawn on panels is brighter than they are."""
        return sum(self.panel) < 1.5

    def category(self, name: str) -> RGB:
        """The header color of a node of that menu."""
        return category_color(name, self.categories)


def _darken(color: RGB) -> RGB:
    red, green, blue = (0.6 * part for part in color)
    return red, green, blue


_KINDS = MappingProxyType(
    {
        Kind.IMAGE: parse_hex("e2b93b"),
        Kind.FIELD: parse_hex("b6bcc6"),
        Kind.VECTOR: parse_hex("8f83f0"),
        Kind.NUMBER: parse_hex("4fb3a5"),
        Kind.COLOR: parse_hex("e0709a"),
        Kind.CAMERA: parse_hex("5aa7e0"),
    }
)

_KINDS_LIGHT = MappingProxyType(
    {
        Kind.IMAGE: parse_hex("ad7c00"),
        Kind.FIELD: parse_hex("5f6772"),
        Kind.VECTOR: parse_hex("6152d9"),
        Kind.NUMBER: parse_hex("0f8273"),
        Kind.COLOR: parse_hex("c23d70"),
        Kind.CAMERA: parse_hex("1f74b5"),
    }
)

DARK = Palette(
    "dark",
    window=parse_hex("141416"),
    panel=parse_hex("1d1d20"),
    field=parse_hex("2a2a2e"),
    fill=parse_hex("42424a"),
    raised=parse_hex("333338"),
    hover=parse_hex("404047"),
    border=parse_hex("0d0d0f"),
    text=parse_hex("e4e4e7"),
    dim=parse_hex("b0b0b7"),
    accent=parse_hex("e8833a"),
    on_accent=parse_hex("1a1108"),
    good=parse_hex("5fb878"),
    warning=parse_hex("e6b450"),
    error=parse_hex("f17c7c"),
    canvas=parse_hex("18181b"),
    grid=parse_hex("232327"),
    node=parse_hex("2b2b30"),
    shadow=parse_hex("000000"),
    surround=parse_hex("161616"),
    kinds=_KINDS,
    categories=DARK_CATEGORIES,
)

LIGHT = Palette(
    "light",
    window=parse_hex("c9c9ce"),
    panel=parse_hex("ececef"),
    field=parse_hex("ffffff"),
    fill=parse_hex("cbced9"),
    raised=parse_hex("d8d8de"),
    hover=parse_hex("c6c6ce"),
    border=parse_hex("b3b3ba"),
    text=parse_hex("1b1b1f"),
    dim=parse_hex("52525c"),
    accent=parse_hex("96450a"),
    on_accent=parse_hex("ffffff"),
    good=parse_hex("185f2f"),
    warning=parse_hex("6e4c00"),
    error=parse_hex("a11d1d"),
    canvas=parse_hex("dcdce1"),
    grid=parse_hex("cfcfd5"),
    node=parse_hex("f6f6f8"),
    shadow=parse_hex("6a6a70"),
    surround=parse_hex("b8b8b8"),
    kinds=_KINDS_LIGHT,
    categories=LIGHT_CATEGORIES,
)

CONTRAST = Palette(
    "contrast",
    window=parse_hex("000000"),
    panel=parse_hex("000000"),
    field=parse_hex("101010"),
    fill=parse_hex("2c2c66"),
    raised=parse_hex("262626"),
    hover=parse_hex("33333f"),
    border=parse_hex("c8c8c8"),
    text=parse_hex("ffffff"),
    dim=parse_hex("d6d6d6"),
    accent=parse_hex("ffd000"),
    on_accent=parse_hex("000000"),
    good=parse_hex("5df08a"),
    warning=parse_hex("ffc24d"),
    error=parse_hex("ffaaaa"),
    canvas=parse_hex("000000"),
    grid=parse_hex("1c1c1c"),
    node=parse_hex("101010"),
    shadow=parse_hex("000000"),
    surround=parse_hex("000000"),
    kinds=_KINDS,
    categories=MappingProxyType({name: _darken(color) for name, color in DARK_CATEGORIES.items()}),
)
"""For users who need it: text at 7 to 1 and more (WCAG 2.1, 1.4.6), and borders that can be seen."""

PALETTES: Mapping[str, Palette] = MappingProxyType({palette.name: palette for palette in (DARK, LIGHT, CONTRAST)})
