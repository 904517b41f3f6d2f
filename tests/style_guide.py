"""The looks that a panel may have: a palette whose colors can be told apart, and names for what is drawn with it.

Every color on the screen is one of the palette's, or lies between two of them. With a palette in which no two are alike
nor on a line with a third, a pixel's color says which two they were, and how much of each: `field>hover 0.35` is a
field that has gone 35 % of the way to what is under the pointer.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from itertools import permutations
from pathlib import Path

import pytest
import still_editor
from drawn_shapes import Shape
from halation.editor.canvas import brush
from halation.editor.theme.palette import DARK, Palette
from halation.editor.toolkit import context

Color = tuple[float, float, float]

GUIDE = Path(__file__).parent / "data/style_guide.txt"
"""Panels, and below each its shapes with their corners, widths or radii at a scale of 1, their colors, and pointers."""

_DARK = "panel", "window", "canvas"
"""Grounds: what asks whether a theme is dark looks at these."""

SIZED = "line", "rect", "filled rect", "polyline", "stroke", "ngon", "outlined ngon", "disk", "circle"
"""Shapes with corners, a width or a radius."""

UNNAMED = "clip", "unclip", "image", "picture", "arc", "path line", "path curve", "shaded rect"
"""What has no color of its own."""


@cache
def read_guide() -> dict[str, set[str]]:
    """The looks that each panel has, as `name_shape` calls them."""
    guide, looks = dict[str, set[str]](), set[str]()
    for line in GUIDE.read_text("utf-8").splitlines():
        if not line.startswith(" "):
            looks = guide[line] = set[str]()
        else:
            shape, _, colors = line.strip().partition(": ")
            looks |= {f"{shape}: {color}" for color in colors.split(", ")}
    return guide


@cache
def make_guide() -> Palette:
    """A palette in which no two colors are alike."""
    chance = random.Random(7)

    def make(name: str) -> Color:
        most = 102 if name in _DARK else 255
        red, green, blue = (chance.randrange(most) / 255.0 for _ in range(3))
        return red, green, blue

    names = [name for name in Palette.__struct_fields__ if isinstance(getattr(DARK, name), tuple)]
    kinds = {kind: make("") for kind in DARK.kinds}
    categories = {name: make("") for name in DARK.categories}
    return Palette("dark", **{name: make(name) for name in names}, kinds=kinds, categories=categories)


@contextmanager
def use_guide() -> Iterator[None]:
    """Draw with that palette."""
    with pytest.MonkeyPatch.context() as patch:
        for module in (context, brush, still_editor):
            patch.setattr(module, "PALETTES", {"dark": make_guide()})
        _forget_colors()
        yield
    _forget_colors()


def _forget_colors() -> None:
    for made in (brush.make_canvas_colors, brush.make_node_palette):
        made.cache_clear()


def name_color(color: int) -> str:
    """The role of a color or of the two that it lies between, and its strength if it lets something through."""
    rgb = color & 255, color >> 8 & 255, color >> 16 & 255
    strength = round((color >> 24) / 255.0, 2)
    return _list_names().get(rgb, "other") + (f" at {strength:g}" if strength != 1.0 else "")


def name_shape(shape: Shape, zoom: float = 1.0) -> str:
    """The kind of a shape, its corners and widths, and its color."""
    lengths = " ".join(f"{round(length / zoom, 1):g}" for length in shape.lengths) if shape.kind in SIZED else ""
    return f"{shape.kind} {lengths}: {name_color(shape.color)}".replace(" :", ":")


@cache
def _list_names() -> dict[tuple[int, ...], str]:
    guide = make_guide()
    plain = [(name, color) for name in guide.__struct_fields__ if isinstance(color := getattr(guide, name), tuple)]
    plain += [("kind", color) for color in guide.kinds.values()]
    plain += [("category", color) for color in guide.categories.values()]
    names = dict[tuple[int, ...], str]()
    for share in (step / 100.0 for step in sorted(range(1, 100), key=lambda step: (step % 5 > 0, step > 50, step))):
        for (first, one), (second, other) in permutations(plain, 2):
            mixed = tuple(int((a + (b - a) * share) * 255.0 + 0.5) for a, b in zip(one, other, strict=True))
            names.setdefault(mixed, f"{first}>{second} {share:g}")
    return names | {tuple(int(part * 255.0 + 0.5) for part in color): name for name, color in plain}
