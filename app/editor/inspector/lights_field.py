"""Editing lights."""

from __future__ import annotations

from imgui_bundle import imgui

from ....nodes import Plain, Value, lights_of
from .fields import Edit, Fields


def lights_field(
    fields: Fields, id: str, value: Plain, declaration: Value, width: float, *, label: str = "", mixed: bool = False
) -> Edit | None:
    """How many lights there are."""
    assert isinstance(value, tuple)
    count = len(lights_of(value))
    imgui.text_disabled(f"{count} light{'' if count == 1 else 's'}")
    return None
