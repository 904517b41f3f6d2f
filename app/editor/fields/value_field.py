"""Draws the field of a value, by its type."""

from __future__ import annotations

from functools import partial

from halation.nodes import Plain, Value
from imgui_bundle import imgui

from ...language.translation import translate_plural
from .choice_field import choice_field, toggle_field
from .color_field import color_field
from .curve_field import curve_field
from .fields import Edit, Fields
from .number_field import matrix_field, number_field, vector_field
from .ramp_field import ramp_field
from .text_field import text_field


def value_field(
    fields: Fields,
    id: str,
    value: Plain,
    declaration: Value,
    width: float,
    *,
    label: str = "",
    mixed: bool = False,
    suffix: str | None = None,
) -> Edit | None:
    """Draw the field of a value at the cursor; returns its edit.

    `id` is unique in the window. `label` stands inside the field, `mixed` shows that several values differ.
    `suffix` is a unit in place of that of the declaration.
    """
    match declaration.type:
        case "float" | "int":
            draw = partial(number_field, suffix=suffix)
        case "bool":
            draw = toggle_field
        case "choice":
            draw = choice_field
        case "color":
            draw = color_field
        case "vector":
            draw = vector_field
        case "matrix":
            draw = matrix_field
        case "curve":
            draw = curve_field
        case "ramp":
            draw = ramp_field
        case "path" | "text":
            draw = text_field
        case "items":
            return None  # they have rows of their own in the inspector
        case "spline" | "stroke" | "point":
            count = len(value) // declaration.length if isinstance(value, tuple) else 0
            imgui.align_text_to_frame_padding()
            moved = translate_plural("{count} point, moved in the viewer", "{count} points, moved in the viewer", count)
            drawn = translate_plural("{count} point, drawn in the viewer", "{count} points, drawn in the viewer", count)
            imgui.text_disabled(moved if declaration.type != "stroke" else drawn)
            return None
    imgui.begin_group()
    edit = draw(fields, id, value, declaration, width, label=label, mixed=mixed)
    imgui.end_group()
    return edit
