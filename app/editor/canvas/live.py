"""Fields of the node under the mouse: real widgets, at the place and in the size in which the node shows them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from halation.nodes import Plain, Value
from imgui_bundle import imgui
from msgspec import Struct, field

from ...authoring.commands import SetExpression, SetValue
from ...authoring.edits import paths
from ...authoring.edits.element_id import NO_ELEMENT, ElementId
from ...authoring.session import Session
from ...graph import Port
from ..fields.choice_field import toggle_field
from ..fields.color_field import color_picker, has_alpha, rgba
from ..fields.colors import intensity
from ..fields.fields import Edit, Fields
from ..fields.number_field import number_field, row_of_numbers
from ..fields.text_field import text_field
from ..shared.declared_words import name_choice
from ..shared.dialogs import browse
from ..toolkit.labels import make_label
from ..toolkit.words import show_tip
from .brush import TEXT, DrawContext, make_node_palette
from .geometry import Rect
from .layout import FIELD_HEIGHT, MOST_PARTS, NodeRow
from .paint_field import paint_label, split_vector
from .scene import ElementBox
from .sketch import Sketch

if TYPE_CHECKING:
    from .context import CanvasContext

_FIELD = "canvas "
"""The prefix of ids of fields on nodes, before the port."""

_CHOICES, _PICKER = "choices of a node", "color of a node"


def has_live_widget(row: NodeRow) -> bool:
    """True for fields with a real widget; other fields are painted and only react to clicks."""
    if row.value is None or row.field is None:
        return False
    few = row.value.type == "vector" and len(row.texts) <= MOST_PARTS
    return few or row.value.type in ("float", "int", "bool", "text")


class LiveFields(Struct):
    """The widgets on nodes. `open` is the value whose list or picker is open."""

    context: CanvasContext
    fields: Fields | None = None
    open: tuple[Port, Value] | None = None
    _opening: str = ""
    _dragged: bool = False
    _popup_position: tuple[float, float] = (0.0, 0.0)
    _edits: list[tuple[Port, Edit]] = field(default_factory=list[tuple[Port, Edit]])

    @property
    def holder(self) -> ElementId:
        """The node whose field is dragged or typed in; empty if there is none."""
        if self.fields is None:
            return NO_ELEMENT
        field_id = self.fields.typing.id if self.fields.typing else self.fields.drag_id or self.fields.pressed
        return ElementId.of_port(_port_of(field_id)) if field_id else NO_ELEMENT

    def begin(self) -> None:
        """Call before any node is drawn."""
        palette = make_node_palette(self.context.palette.name)
        if self.fields is None or self.fields.palette is not palette:
            self.fields = Fields(palette)
        self.fields.places, self.fields.store = self.context.places, self.context.store
        self.fields.begin(imgui.is_mouse_down(imgui.MouseButton_.left))
        self._dragged = self.fields.dragging

    def draw(self, brush: DrawContext, box: ElementBox, rows: tuple[NodeRow, ...]) -> None:
        """Draw the widgets of a node; call after the node is painted."""
        fields = self.fields
        if fields is None:
            return
        s = brush.to.scale
        imgui.push_font(brush.fonts.text, TEXT * brush.zoom)
        imgui.push_style_var(imgui.StyleVar_.frame_padding, (6.0 * s, max((FIELD_HEIGHT - TEXT) / 2 * s, 0.0)))
        imgui.push_style_var(imgui.StyleVar_.frame_rounding, 4.0 * s)
        imgui.push_style_var(imgui.StyleVar_.item_inner_spacing, (6.0 * s, 4.0 * s))
        for row in rows:
            if row.value and row.field and row.plain is not None:
                place = row.field
                rect = box.x + place[0], box.y + place[1], box.x + place[2], box.y + place[3]
                self._draw_field(fields, brush, rect, Port(box.key, row.value.name), row, row.value, row.plain)
        imgui.pop_style_var(3)
        imgui.pop_font()

    def _draw_field(
        self, fields: Fields, brush: DrawContext, rect: Rect, port: Port, row: NodeRow, value: Value, plain: Plain
    ) -> None:
        low, high = brush.project_corners(rect)
        width, id = high[0] - low[0], f"{_FIELD}{port}"
        imgui.set_cursor_screen_pos(low)
        edit: Edit | None = None
        if value.type in ("float", "int"):
            edit = number_field(fields, id, plain, value, width, label=row.label)
        elif value.type == "bool":
            edit = toggle_field(fields, id, plain, value, width, label=row.label)
        elif value.type == "text":
            edit = text_field(fields, id, plain, value, width, label=row.label, hint=row.label, lines=1)
        elif value.type == "vector" and isinstance(plain, tuple) and len(plain) <= MOST_PARTS:
            label = Sketch(brush)
            paint_label(label, rect, row.label, len(plain))
            label.draw(brush, 0.0, 0.0)
            left, parts = split_vector(rect, len(plain))
            imgui.set_cursor_screen_pos(brush.project_corners((left, *parts[0][1:]))[0])
            edit = row_of_numbers(fields, id, plain, value, (rect[2] - left) * brush.to.scale, ("",) * len(plain))
        elif value.type in ("choice", "color", "path") and imgui.invisible_button(f"##{id}", (width, high[1] - low[1])):
            self.open, self._opening, self._popup_position = (port, value), value.type, (low[0], high[1])
        idle = not fields.dragging and fields.typing is None
        if value.doc and idle and imgui.is_item_hovered(int(imgui.HoveredFlags_.for_tooltip)):
            show_tip(value.doc)
        if edit:
            self._edits.append((port, edit))

    def end(self) -> None:
        """Call after all nodes: draws the open popup, and applies the edits."""
        fields = self.fields
        if fields is None:
            return
        self._draw_popups(fields)
        if last_edit := fields.end():
            self._edits.append((_port_of(last_edit[0]), last_edit[1]))
        if fields.eyedropper:
            self.context.viewer.picking = fields.eyedropper.removeprefix("canvas ")
        self.context.interface.dragging = self.context.interface.dragging or fields.dragging
        for port, edit in self._edits:
            self.context.log.attempt(lambda port=port, edit=edit: _apply_edit(self.context.session, port, edit))
        self._edits.clear()
        if self._dragged and not fields.dragging:
            self.context.session.seal()

    def _draw_popups(self, fields: Fields) -> None:
        """Draw the popup of a field, at the place where it was opened: the node may move meanwhile, or be removed."""
        if self.open is None:
            return
        (port, value), opening, self._opening = self.open, self._opening, ""
        if port.node not in self.context.session.graph.nodes:
            self.open = None
            return
        plain = self.context.session.time.evaluated_graph.value(port)
        if opening == "path":
            self.open = None
            self.context.dialogs.browse = browse(
                value,
                lambda path: self.context.log.attempt(lambda: _apply_path(self.context.session, port, path)),
            )
            return
        if opening:
            fields.stops = intensity(rgba(plain)) if opening == "color" else 0.0
            imgui.open_popup(_PICKER if opening == "color" else _CHOICES)
        imgui.set_next_window_pos(self._popup_position, imgui.Cond_.appearing)
        if value.type == "color" and imgui.begin_popup(_PICKER):
            if edit := color_picker(fields, f"canvas {port} picker", rgba(plain), alpha=has_alpha(plain)):
                self._edits.append((port, edit))
            imgui.end_popup()
        elif value.type == "choice" and imgui.begin_popup(_CHOICES):
            self._draw_choices(port, value, plain)
            imgui.end_popup()
        elif not opening:
            self.open = None

    def _draw_choices(self, port: Port, value: Value, plain: Plain) -> None:
        appearing = imgui.is_window_appearing()
        for choice in value.choices:
            if imgui.selectable(make_label(name_choice(choice) or " ", f"choice {choice}"), choice == plain)[0]:
                self._edits.append((port, Edit(choice)))
            low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
            self.context.places[f"choice {choice}"] = low.x, low.y, high.x, high.y
            if choice == plain and appearing:
                imgui.set_scroll_here_y()
                imgui.set_item_default_focus()
        if imgui.is_key_pressed(imgui.Key.escape):
            imgui.close_current_popup()


def _port_of(field_id: str) -> Port:
    """The port whose field has that id; a field of a vector adds `#` and the number of its part."""
    return Port.parse(field_id.removeprefix(_FIELD).partition("#")[0])


def _apply_path(session: Session, port: Port, path: Path) -> None:
    session.apply(SetValue(port, paths.make_relative(path, session.root.folder)))


def _apply_edit(session: Session, port: Port, edit: Edit) -> None:
    if edit.expression:
        session.apply(SetExpression(port, edit.expression))
    else:
        session.apply(SetValue(port, edit.value, edit.merge))
