"""Paints on the picture: a drag becomes a stroke of the active node, which is one step of undo."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from halation.nodes import PAINT_STROKES, STROKE_ROWS, ItemSet, PaintStroke, PaintTool, natural_order, simplify_stroke

from ...authoring.commands import AddItem, SetValues
from ...graph import Port
from ...graph.named_items import join_path
from ...language.translation import translate
from .brush import PaintBrush
from .geometry import Point, Sight
from .item_lists import find_item_list

if TYPE_CHECKING:
    from .context import ViewerContext

NEAR = 0.5
"""How far in pixels of the screen the pointer moves from point to point, and points may be from a finished stroke that
are left out of it: half of what a mouse can tell."""

_PRESSURE = 0.02
"""How far the pressure may be from that of points that are left out."""


def find_strokes(context: ViewerContext) -> Port | None:
    """The value of the active node that holds strokes; None while handles are hidden."""
    return find_item_list(context, PAINT_STROKES)


def can_paint(context: ViewerContext) -> bool:
    """True if the active node holds strokes."""
    return find_strokes(context) is not None


def paints(context: ViewerContext) -> bool:
    """True while a drag on the picture paints."""
    return context.viewer.brush.is_on and can_paint(context)


def toggle_brush(context: ViewerContext) -> None:
    """Start to paint with the mouse, or stop."""
    context.viewer.brush.is_on = not context.viewer.brush.is_on


def scale_brush(context: ViewerContext, factor: float) -> None:
    """Make the brush larger or smaller."""
    context.viewer.brush.resize(context.viewer.brush.size * factor)


def measure_brush(context: ViewerContext, sight: Sight) -> float:
    """The radius of the brush on the screen, down; across, it is as many pixels of the picture."""
    return 0.5 * context.viewer.brush.size * sight.picture[1] * sight.zoom / sight.density


def make_stroke_token(context: ViewerContext) -> str:
    """The merge token of the stroke that is drawn."""
    return f"paint {find_strokes(context)}"


def begin_stroke(context: ViewerContext, start: Point) -> None:
    """Add a stroke of one point."""
    brush, port = context.viewer.brush, find_strokes(context)
    if port is None or brush.needs_place:
        return
    frames = context.session.graph.settings.frames
    frame = context.session.time.frame
    fields = brush.describe_stroke(start, frame, max(frame, frames[1] if frames else frame))
    brush.rows = [(*_round(start), 1.0)]
    fields["points"] = brush.rows[0]

    def add() -> None:
        command = AddItem(port, brush.tool, fields, _name_stroke(context, port), merge=make_stroke_token(context))
        brush.stroke = context.session.apply(command)
        context.items[str(port)] = brush.stroke

    context.session.seal()
    context.log.attempt(add)


def extend_stroke(context: ViewerContext, sight: Sight, to: Point) -> None:
    """Add a point to the stroke, unless the pointer has hardly moved."""
    brush = context.viewer.brush
    if not brush.stroke:
        return
    context.interface.dragging = True
    x, y = brush.rows[-1][:2]
    if math.dist(sight.place((x, y)), sight.place(to)) < NEAR:
        return
    brush.rows.append((*_round(to), 1.0))
    if len(brush.rows) == STROKE_ROWS.most:
        brush.rows = [*_simplify(brush, sight)]
    _set_points(context)


def finish_stroke(context: ViewerContext, sight: Sight) -> None:
    """Leave out points that are not needed, and end the step of undo."""
    brush = context.viewer.brush
    if brush.stroke:
        brush.rows = [*_simplify(brush, sight)]
        _set_points(context)
        context.session.seal()
    brush.stroke, brush.rows = "", []


def cancel_stroke(context: ViewerContext) -> None:
    """Forget the stroke that is drawn: the session has abandoned its step."""
    context.viewer.brush.stroke, context.viewer.brush.rows = "", []


def _simplify(brush: PaintBrush, sight: Sight) -> tuple[tuple[float, ...], ...]:
    across, down = (NEAR / (step * size) for step, size in zip(sight.pixel_size, sight.picture, strict=True))
    return simplify_stroke(tuple(brush.rows), (across, down, _PRESSURE))


def _set_points(context: ViewerContext) -> None:
    brush, port = context.viewer.brush, find_strokes(context)
    if port is None:
        return
    target = Port(port.node, join_path(port.socket, brush.stroke, "points"))
    command = SetValues({target: STROKE_ROWS.join(brush.rows)}, translate("Paint"), merge=make_stroke_token(context))
    context.log.attempt(lambda: context.session.apply(command))


def _name_stroke(context: ViewerContext, port: Port) -> str:
    """The name of the next stroke: after all others, so that it lies on top."""
    items = context.session.graph.value(port)
    names = list(items) if isinstance(items, ItemSet) else []
    last = names[-1] if names else "stroke_0"
    numbers = (name.removeprefix("stroke_") for name in names if name.startswith("stroke_"))
    name = f"stroke_{max((int(number) for number in numbers if number.isdecimal()), default=0) + 1}"
    return name if natural_order(name) > natural_order(last) else f"{last}_1"


def _round(place: Point) -> Point:
    return round(place[0], 6), round(place[1], 6)


def find_chosen_stroke(context: ViewerContext) -> PaintStroke | None:
    """The stroke that is selected in the inspector, at this frame."""
    port = find_strokes(context)
    items = context.session.time.evaluated_graph.value(port) if port else None
    name = context.items.get(str(port), "")
    if not isinstance(items, ItemSet) or name not in items:
        return None
    return PaintStroke(PaintTool(items[name].kind), **PAINT_STROKES.settings(items[name]))
