"""Fields for the frame, the value and the handles of a single selected key."""

from __future__ import annotations

from halation.nodes import Value
from imgui_bundle import imgui
from msgspec import structs

from ...authoring.edits.values import can_animate
from ...graph import Keys, Port
from ...language.translation import translate
from ..fields.fields import Edit, Fields
from ..fields.number_field import row_of_numbers
from ..theme.palette import DARK
from ..theme.style import ui_scale
from ..toolkit.places import place
from ..toolkit.words import write
from . import commands
from .editing import KeyEdit, has_handle, move_keys, with_number
from .frame import CurvesFrame
from .hits import SIDES
from .rows import list_spots

_LABEL, _SHARE, _INF = 46.0, 0.6, float("inf")


class KeyFields:
    """The fields below the column of names."""

    def __init__(self) -> None:
        self._fields = Fields(DARK)

    def measure_height(self, frame: CurvesFrame) -> float:
        """The height of the fields in pixels."""
        rows = len(self._list_fitting_rows(frame))
        return rows * self._measure_line(frame) + 10.0 * frame.scale if rows else 0.0

    def draw(self, frame: CurvesFrame, top: float) -> None:
        """Draw the fields, and apply edits to the graph."""
        context, fields = frame.context, self._fields
        fields.palette, fields.places = context.palette, context.places
        dragged = fields.dragging
        fields.begin(imgui.is_mouse_down(imgui.MouseButton_.left))
        scale = ui_scale()
        left, _, right, _ = frame.list
        y = top + 6.0 * scale
        for name, label, numbers, declaration in self._list_fitting_rows(frame):
            imgui.set_cursor_screen_pos((left + 8.0 * scale, y))
            rect = place(_LABEL * scale)
            write(rect, label, context.palette.dim)
            imgui.set_cursor_screen_pos((left + (_LABEL + 10.0) * scale, y))
            width = right - left - (_LABEL + 18.0) * scale
            id, start = f"keys {name}", left + (_LABEL + 10.0) * scale
            context.places[f"field {id}"] = (start, y, right - 8.0 * scale, y + rect[3] - rect[1])
            edit = row_of_numbers(fields, id, numbers, declaration, width, ("",) * len(numbers), keep_type=True)
            if edit:
                context.log.attempt(lambda name=name, edit=edit: self._apply(frame, name, edit))
            y += self._measure_line(frame)
        if dragged and not fields.dragging:
            context.session.seal()
        left_over = fields.end()
        if left_over and frame.state.single:
            id, edit = left_over
            context.log.attempt(lambda: self._apply(frame, id.removeprefix("keys ").partition("#")[0], edit))
        context.interface.dragging |= fields.dragging

    def _measure_line(self, frame: CurvesFrame) -> float:
        return imgui.get_frame_height() + 3.0 * frame.scale

    def _list_fitting_rows(self, frame: CurvesFrame) -> list[tuple[str, str, tuple[float, ...], Value]]:
        """As many rows as leave room for the names."""
        room = (frame.list[3] - frame.list[1]) * _SHARE - 10.0 * frame.scale
        return self._list_rows(frame)[: max(int(room / self._measure_line(frame)), 0)]

    def _list_rows(self, frame: CurvesFrame) -> list[tuple[str, str, tuple[float, ...], Value]]:
        """Name, label, numbers and declaration of every line."""
        single_key = _find_single_key(frame)
        if single_key is None:
            return []
        port, keys, at = single_key
        index = keys.frames.index(at)
        key = keys.keys[index]
        declaration = frame.graph.declaration(port)
        first, last = frame.context.session.time.frames
        time = Value("frame", "float", 1.0, low=float(first), high=float(max(last, first + 1)))
        rows: list[tuple[str, str, tuple[float, ...], Value]] = [
            ("frame", translate("Frame", "time"), (key.frame,), time)
        ]
        if key.channels and len(key.channels) <= 4:
            kind = structs.replace(declaration, type="int" if declaration.type == "int" else "float")
            value = key.value if isinstance(key.value, tuple) else (key.value,)
            rows.append(("value", translate("Value"), value, kind))  # type: ignore
            if not frame.is_sheet and len(key.channels) == 1:
                loose = structs.replace(
                    kind,
                    type="float",
                    unit=None,
                    low=-_INF,
                    high=_INF,
                    minimum=-_INF,
                    maximum=_INF,
                )
                rows += [
                    (side, label, handle, loose)
                    for side, label, handle in zip(SIDES, _side_names(), keys.handles(at), strict=True)
                    if handle and has_handle(keys, index, side)
                ]
        return rows

    def _apply(self, frame: CurvesFrame, name: str, edit: Edit) -> None:
        single_key = _find_single_key(frame)
        if single_key is None or not isinstance(edit.value, tuple):
            return
        port, keys, at = single_key
        context, state = frame.context, frame.state
        numbers = edit.value
        if name == "frame":
            change = move_keys(frame.graph.animation, list_spots(port, keys, (at,)), numbers[0] - at)
        elif name == "value":
            new_keys = keys
            for channel, number in enumerate(numbers):
                new_keys = with_number(new_keys, at, channel, number)
            change = KeyEdit({port: new_keys}, state.spots)
        else:
            across = min(numbers[0], 0.0) if name == "left" else max(numbers[0], 0.0)
            handle = (across, *numbers[1:])
            new_keys = keys.with_handles(at, **{name: handle})
            state.free.add((port, at))
            change = KeyEdit({port: new_keys}, state.spots)
        commands.set_keys(context, change.new_keys, translate("Set {name} of a key", name=name), edit.merge)
        state.spots = change.spots


def _side_names() -> tuple[str, str]:
    """The names of the handles of a key."""
    return translate("In", "handle of a key"), translate("Out", "handle of a key")


def _find_single_key(frame: CurvesFrame) -> tuple[Port, Keys, float] | None:
    single = frame.state.single
    keys = frame.graph.animation.get(single[0]) if single else None
    if single is None or not isinstance(keys, Keys) or keys.key(single[1]) is None:
        return None
    if not can_animate(frame.context.session.graph, single[0]):
        return None
    return single[0], keys, single[1]


__all__ = ["KeyFields"]
