"""The wheels of a node that balances colors, side by side above its values."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from halation.nodes import Value
from imgui_bundle import imgui

from ...graph import Expression, Graph, Port
from ..fields.color_field import rgba
from ..fields.fields import Edit, Fields
from ..fields.wheel_field import wheel_field
from .keying import value_now

if TYPE_CHECKING:
    from .rows import Rows

_NARROWEST = 5.0
"""The least width of a wheel in heights of a text line: below it, the point hides an eighth of the disk."""

_WIDEST = 11.0


def draw_wheels(
    rows: Rows, fields: Fields, id: str, values: Iterable[Value], take: Callable[[Port, Value, Edit], object]
) -> None:
    """Draw the wheels of a node, as many in a row as fit; `take` applies an edit."""
    session, em = rows.context.session, imgui.get_font_size()
    wheels = [value for value in values if value.wheel and _is_free(session.graph, Port(id, value.name))]
    if not wheels:
        return
    columns = min(len(wheels), max(int((rows.width + rows.gap) / (_NARROWEST * em + rows.gap)), 1))
    width = round(min((rows.width - (columns - 1) * rows.gap) / columns, _WIDEST * em))
    for index, value in enumerate(wheels):
        if index % columns:
            imgui.same_line(0.0, rows.gap)
        port = Port(id, value.name)
        color = rgba(value_now(session, port)[0])
        edit = wheel_field(fields, str(port), color, value, width)
        if edit:
            rows.act(lambda port=port, value=value, edit=edit: take(port, value, edit))
    imgui.spacing()


def _is_free(graph: Graph, port: Port) -> bool:
    """True if the user sets the value: no link and no expression does."""
    return port not in graph.links and not isinstance(graph.animation.get(port), Expression)
