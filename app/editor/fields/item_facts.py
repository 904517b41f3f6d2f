"""Named items as text: names, numbers and icons of their rows. Nothing here draws."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from halation.nodes import Items, ItemSet
from imgui_bundle import icons_fontawesome_6 as icons

from ...graph.names import name_several
from ...language.translation import mark, mark_plural, translate, translate_plural

ICONS: Mapping[str, str] = MappingProxyType(
    {
        "point": icons.ICON_FA_LIGHTBULB,
        "spot": icons.ICON_FA_BULLSEYE,
        "sun": icons.ICON_FA_SUN,
        "sphere": icons.ICON_FA_CIRCLE,
        "brush": icons.ICON_FA_PAINTBRUSH,
        "erase": icons.ICON_FA_ERASER,
        "clone": icons.ICON_FA_STAMP,
        "reveal": icons.ICON_FA_FILM,
        "blur": icons.ICON_FA_DROPLET,
        "smear": icons.ICON_FA_HAND_POINTER,
        "transform": icons.ICON_FA_ARROWS_UP_DOWN_LEFT_RIGHT,
        "track": icons.ICON_FA_LOCATION_CROSSHAIRS,
    }
)
"""The icons of kinds of items, by their name; other kinds have a plain one."""


def icon_of(kind: str) -> str:
    """The icon of a kind of items."""
    return ICONS.get(kind, icons.ICON_FA_SHAPES)


def choose_item(chosen: Mapping[str, str], id: str, items: ItemSet) -> str:
    """The name of the selected item of a value: the one chosen last, else the first; "" if there is none."""
    name = chosen.get(id, "")
    return name if name in items else next(iter(items), "")


def neighbor_of(items: ItemSet, name: str) -> str:
    """The item that is selected when one is removed: that after it, else that before; "" if there is none."""
    names = list(items)
    place = names.index(name)
    return next(iter((*names[place + 1 : place + 2], *names[max(place - 1, 0) : place])), "")


_COUNTS: Mapping[str, tuple[str, str, str]] = MappingProxyType(
    {
        "light": (mark("no lights"), *mark_plural("{count} light", "{count} lights")),
        "shape": (mark("no shapes"), *mark_plural("{count} shape", "{count} shapes")),
        "light group": (mark("no light groups"), *mark_plural("{count} light group", "{count} light groups")),
        "pair of curves": (
            mark("no pairs of curves"),
            *mark_plural("{count} pair of curves", "{count} pairs of curves"),
        ),
        "stroke": (mark("no strokes"), *mark_plural("{count} stroke", "{count} strokes")),
    }
)
"""How many items there are, by their noun."""


def describe_count(items: ItemSet, noun: str) -> str:
    """The number of items in words: `no lights`, `1 light`, `3 lights`."""
    count = len(items)
    nouns = name_several(noun)
    nothing, singular, plural = _COUNTS.get(noun, (f"no {nouns}", f"{{count}} {noun}", f"{{count}} {nouns}"))
    return translate_plural(singular, plural, count) if count else translate(nothing)


def describe_strength(fields: Mapping[str, Any]) -> str:
    """The intensity of an item as a short text, with its exposure in stops if it has one; "" without an intensity."""
    if "intensity" not in fields:
        return ""
    intensity, exposure = float(fields["intensity"]), float(fields.get("exposure", 0.0))
    size = abs(intensity)
    number = f"{intensity:.0f}" if 1e3 <= size < 1e6 else f"{intensity:.3g}"
    return f"{number} {exposure:+.3g} EV" if exposure else number


def find_unit(declared: Items, kind: str, field: str) -> str | None:
    """The unit behind a number, if it is not a unit of values: a light's intensity is W/sr, a sun's W/m²."""
    if field != "intensity" or declared.noun != "light":
        return None
    return "W/m²" if kind == "sun" else "W/sr"
