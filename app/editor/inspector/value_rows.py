"""The rows of values: name, field or link, notes on files, and a menu."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import TYPE_CHECKING

from halation.nodes import ItemSet, Node, Plain, Value
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...authoring.commands import ConvertLength, Disconnect, ExposeValue, HideControl, RenameControl
from ...authoring.edits.element_id import ElementId
from ...authoring.edits.values import can_animate, find_control
from ...graph import INPUTS, Graph, Port, find_declaration, signature
from ...graph.named_items import split_path
from ...language.translation import mark, translate
from ..fields.choice_field import choose
from ..fields.fields import Edit, Fields
from ..fields.item_facts import find_unit
from ..fields.numbers import describe_default, describe_value
from ..fields.value_field import value_field
from ..shared.declared_words import name_value
from ..shared.render_facts import convention_words, first_words, use_of
from ..theme.palette import RGB
from ..theme.style import ui_scale
from ..toolkit.labels import make_label
from ..toolkit.places import item_rect
from .applying import (
    Ports,
    apply,
    as_text,
    declare,
    default_of,
    find_height,
    from_text,
    list_other_units,
    reset,
)
from .color_rows import space_field
from .file_field import FileField
from .item_rows import ItemRows
from .keying import Keying, spoken, value_now
from .rows import DIAMOND_WIDTH
from .wheel_rows import draw_wheels

if TYPE_CHECKING:
    from .context import InspectorContext
    from .rows import Rows

_MENU = "value menu"


class ValueRows:
    """Draws the values of one node, or those that several nodes have in common."""

    def __init__(self, fields: Fields, files: FileField) -> None:
        self.fields, self.files = fields, files
        self._keying = Keying(fields)
        self._targets: dict[str, tuple[Ports, Value]] = {}
        self._renaming = ""

    def draw(self, rows: Rows, ports: Ports, declaration: Value, label: str = "", color: RGB | None = None) -> None:
        """Draw one row; `ports` are the same value of several nodes, the active one first."""
        context, port = rows.context, ports[0]
        session, key = context.session, str(port)
        graph = session.graph
        declaration = declare(graph, port, declaration)
        source = session.graph.links.get(port)
        moves = source is None and can_animate(session.graph, port)
        value = value_now(session, port)[0] if moves else graph.value(port)
        changed = any(
            row_port in graph.animation or graph.value(row_port) != default_of(graph, row_port) for row_port in ports
        )
        control = find_control(session.graph, port) if len(ports) == 1 else None
        rows.name(
            key,
            label or name_value(declaration.label or declaration.name),
            doc=_tip(declaration, control),
            changed=changed,
            color=color,
            spare=DIAMOND_WIDTH * ui_scale(),
        )
        if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left):
            rows.act(lambda: reset(session, ports))
        menu = imgui.is_item_hovered() and imgui.is_mouse_released(imgui.MouseButton_.right)
        if moves:
            self._keying.diamond(rows, ports)
            menu |= imgui.is_item_hovered() and imgui.is_mouse_released(imgui.MouseButton_.right)
        else:
            imgui.same_line(0.0, 0.0)
            imgui.dummy((DIAMOND_WIDTH * ui_scale(), 1.0))
        width = rows.field()
        if source is not None:
            link_chip(rows, port, source, width)
        elif moves and len(ports) == 1 and self._keying.field(rows, port, width):
            menu |= imgui.is_item_hovered() and imgui.is_mouse_released(imgui.MouseButton_.right)
            self._keying.note(rows, port, spoken(value))
        else:
            menu |= self._draw_field(rows, ports, declaration, value, control, width, moves)
            self._draw_notes(rows, ports, declaration, value)
        if self.fields.eyedropper == key:
            context.viewer.picking = key
        self._targets[key] = ports, declaration
        if menu:
            imgui.open_popup(f"{_MENU} {key}")
        if imgui.begin_popup(f"{_MENU} {key}"):
            self._menu(rows, ports, declaration, value, source, control)
            imgui.end_popup()

    def draw_wheels(self, rows: Rows, id: str, declarations: Iterable[Value]) -> None:
        """Draw the wheels of a node that balances colors; nothing for others."""

        def take(port: Port, declaration: Value, edit: Edit) -> None:
            self._take(rows, (port,), declaration, edit)

        draw_wheels(rows, self.fields, id, declarations, take)

    def _draw_field(
        self,
        rows: Rows,
        ports: Ports,
        declaration: Value,
        value: Plain,
        control: str | None,
        width: float,
        moves: bool,
    ) -> bool:
        """Draw the field of a value with its marks; True if the user opens the menu."""
        port, key = ports[0], str(ports[0])
        marks = imgui.get_frame_height() * ((control is not None) + declaration.handle)
        mixed = any(value_now(rows.context.session, other_port)[0] != value for other_port in ports[1:])
        edit = self._field(rows, ports, declaration, value, width - marks, mixed)
        rows.record(key)
        released = imgui.is_item_hovered() and imgui.is_mouse_released(imgui.MouseButton_.right)
        if moves:
            self._keying.tint(rows, port, item_rect())
        if edit:
            rows.act(lambda: self._take(rows, ports, declaration, edit))
        if declaration.handle:
            _crosshair(rows, key)
        if control:
            self._mark(rows, port, control)
        return released and declaration.type not in ("curve", "ramp", "spline", "stroke", "point", "items")

    def _draw_notes(self, rows: Rows, ports: Ports, declaration: Value, value: Plain) -> None:
        """Draw what belongs below a field: the file of a path, a color space, the selected light."""
        session, port = rows.context.session, ports[0]
        if declaration.type == "path" and isinstance(value, str):
            self.files.about(rows, value, declaration, _layer_of(session.graph, port, declaration))
        if declaration.space and isinstance(value, str):
            self._about_space(rows, port, value)
        if len(ports) == 1 and (items := self._item_rows(rows, port, declaration, value)):
            items.draw_fields()

    def _item_rows(self, rows: Rows, port: Port, declaration: Value, value: Plain) -> ItemRows | None:
        """The rows of a value that holds named items; None for any other."""
        if declaration.items is None or not isinstance(value, ItemSet):
            return None

        def draw_field(end: Port) -> None:
            field = find_declaration(rows.context.session.graph.node(end.node), end.socket)
            if field:
                self.draw(rows, (end,), field)

        return ItemRows(rows, port, declaration.items, value, draw_field)

    def take_abandoned(self, context: InspectorContext, abandoned: tuple[str, Edit]) -> None:
        """Apply text that was typed in a field before the selection changed."""
        id, edit = abandoned
        graph = context.session.graph
        ports, declaration = self._targets.get(id, ((), None))
        if declaration and all(port.node in graph.nodes for port in ports):
            context.log.attempt(lambda: apply(context.session, ports, declaration, edit))

    def begin(self) -> None:
        """Call once a frame, before the rows."""
        if self.fields.typing is None:
            self._targets.clear()

    # --- parts -------------------------------------------------------------------------------------------------------

    def _take(self, rows: Rows, ports: Ports, declaration: Value, edit: Edit) -> None:
        """Apply an edit to the values of a row."""
        session = rows.context.session
        if edit.expression:
            self._keying.take_expression(session, ports[0], edit.expression)
        elif (
            edit.merge and imgui.is_key_pressed(imgui.Key.escape) and session.graph.animation.get(ports[0]) is not None
        ):
            session.abandon(edit.merge)  # a key that the drag set goes with it
        else:
            apply(session, ports, declaration, edit)

    def _field(
        self, rows: Rows, ports: Ports, declaration: Value, value: Plain, width: float, mixed: bool
    ) -> Edit | None:
        port = ports[0]
        graph = rows.context.session.graph
        if declaration.type == "path" and isinstance(value, str):
            return self.files.path(
                rows,
                str(port),
                value,
                declaration,
                width,
                lambda path: apply(rows.context.session, ports, declaration, Edit(path)),
            )
        if declaration.role and isinstance(value, str):
            return self._of_layer(rows, port, declaration, value, width, mixed)
        if declaration.space and isinstance(value, str):
            return space_field(rows, self.fields, str(port), value, width)
        file = _file_of(graph, port)
        if file is not None and isinstance(value, str):
            return self.files.layer(rows, str(port), file, value, width)
        if declaration.items:
            items = self._item_rows(rows, port, declaration, value)
            self._draw_items(rows, items, width, len(rows.context.session.selection))
            return None
        unit = self._find_unit(graph, port)
        return value_field(self.fields, str(port), value, declaration, width, mixed=mixed, suffix=unit)

    def _draw_items(self, rows: Rows, items: ItemRows | None, width: float, count: int) -> None:
        """Draw the list of named items; only that of one node can be edited."""
        imgui.begin_group()
        if items and count == 1:
            items.draw_list(width)
        else:
            rows.note(translate("Select one node to edit this list."))
        imgui.end_group()

    def _find_unit(self, graph: Graph, port: Port) -> str | None:
        """The unit of a field of a named item, where it is not a unit of values."""
        value, item, field = split_path(port.socket)
        if not item:
            return None
        declaration, items = find_declaration(graph.node(port.node), value), graph.value(Port(port.node, value))
        if declaration is None or declaration.items is None or not isinstance(items, ItemSet):
            return None
        return find_unit(declaration.items, items[item].kind, field)

    def _about_space(self, rows: Rows, port: Port, value: str) -> None:
        """Draw the color space of the file that a node reads."""
        item = rows.context.session.graph.nodes.get(port.node)
        file, layer = (getattr(item, name, None) for name in ("path", "layer"))
        if isinstance(file, str):
            self.files.space(rows, file, layer if isinstance(layer, str) else "", value)

    def _of_layer(
        self, rows: Rows, port: Port, declaration: Value, value: str, width: float, mixed: bool
    ) -> Edit | None:
        """Draw the field for the layer of a render, or for its convention."""
        use, key = use_of(rows.context, port, declaration), str(port)
        if declaration.type == "choice":
            words = convention_words(declaration, use)
            current = words[declaration.choices.index(value)] if value in declaration.choices else value
            index = choose(self.fields, key, current, words, width, mixed=mixed)
            return None if index is None else Edit(declaration.choices[index])
        item = rows.context.session.graph.nodes.get(port.node)
        file = str(item.setting(declaration.file)) if isinstance(item, Node) else ""
        return self.files.layer(rows, key, file, value, width, first_words(use), bool(use and use.fault))

    def _mark(self, rows: Rows, port: Port, control: str) -> None:
        """Draw the mark of a control; a click renames the control."""
        imgui.same_line(0.0, 0.0)
        if rows.icon(
            icons.ICON_FA_SLIDERS,
            f"control {port}",
            translate("Shown as the control '{control}'; click to rename", control=control),
        ):
            self._renaming = control
            imgui.open_popup(f"rename {port}")
        if imgui.begin_popup(f"rename {port}"):
            if imgui.is_window_appearing():
                imgui.set_keyboard_focus_here()
            imgui.set_next_item_width(imgui.get_font_size() * 12)
            entered, self._renaming = imgui.input_text(
                "##control name", self._renaming, int(imgui.InputTextFlags_.enter_returns_true)
            )
            if entered:
                session, new = rows.context.session, self._renaming
                rows.act(lambda: session.apply(RenameControl(control, new)))
                imgui.close_current_popup()
            imgui.end_popup()

    def _menu(
        self, rows: Rows, ports: Ports, declaration: Value, value: Plain, source: Port | None, control: str | None
    ) -> None:
        context, port = rows.context, ports[0]
        session = context.session

        def entry(icon: str, label: str, enabled: bool, act: Callable[[], object], **places: str) -> None:
            id = label.format(**places)
            if imgui.menu_item(make_label(f"{icon}  {translate(label, **places)}", id), "", False, enabled)[0]:
                rows.act(act)
            context.places[f"menu {id}"] = item_rect()

        entry(icons.ICON_FA_ROTATE_LEFT, mark("Reset"), True, lambda: reset(session, ports))
        entry(icons.ICON_FA_COPY, mark("Copy Value"), True, lambda: context.clipboard.put(as_text(declaration, value)))
        entry(
            icons.ICON_FA_PASTE,
            mark("Paste Value"),
            source is None,
            lambda: apply(session, ports, declaration, Edit(from_text(context.clipboard.get()))),
        )
        imgui.separator()
        if control is None:
            entry(
                icons.ICON_FA_SLIDERS,
                mark("Expose as Control"),
                len(ports) == 1,
                lambda: session.apply(ExposeValue(port)),
            )
        else:
            entry(icons.ICON_FA_EYE_SLASH, mark("Hide Control"), True, lambda: session.apply(HideControl(control)))
        units = list_other_units(session.graph, port, declaration) if source is None else ()
        if units:
            imgui.separator()
        height = find_height(session.graph, context.viewer.picture[1])
        for unit in units:
            entry(
                icons.ICON_FA_RULER,
                mark("Unit: {unit}"),
                True,
                partial(session.apply, ConvertLength(ports, unit, height)),
                unit=unit,
            )
        if source is None and can_animate(session.graph, port):
            self._keying.menu(rows, ports, as_text(declaration, value))
        if source is not None:
            imgui.separator()
            entry(icons.ICON_FA_ARROW_LEFT, mark("Go to Source"), True, lambda: go_to(context, source))
            entry(icons.ICON_FA_LINK_SLASH, mark("Unlink"), True, lambda: session.apply(Disconnect(port)))


def _crosshair(rows: Rows, key: str) -> None:
    """Draw the switch that picks a position with the next click in the viewer."""
    viewer = rows.context.viewer
    imgui.same_line(0.0, 0.0)
    lit = viewer.picking == key
    if rows.icon(
        icons.ICON_FA_CROSSHAIRS, f"place {key}", translate("Click on the picture to place it there"), lit=lit
    ):
        viewer.picking = "" if lit else key


def link_chip(rows: Rows, target: Port, source: Port, width: float) -> None:
    """Draw the source of a link; a click goes there, the cross unlinks."""
    context, side = rows.context, imgui.get_frame_height()
    start = context.session.graph.source(source)
    color = rows.palette.kinds[start.kind] if start else rows.palette.dim
    text = f"{icons.ICON_FA_ARROW_LEFT}  {source.socket if source.node == INPUTS else source}"
    if rows.chip(
        text,
        str(target),
        max(width - side, 1.0),
        color,
        translate("Linked from {source}: click to go there", source=source),
    ):
        rows.act(lambda: go_to(context, source))
    first = item_rect()
    imgui.same_line(0.0, 0.0)
    if rows.icon(icons.ICON_FA_XMARK, f"unlink {target}", translate("Unlink")):
        rows.act(lambda: context.session.apply(Disconnect(target)))
    last = item_rect()
    context.places[f"field {target}"] = (first[0], first[1], last[2], last[3])


def go_to(context: InspectorContext, port: Port) -> None:
    """Select the element of a port and bring it into view."""
    element = ElementId.of_port(port)
    context.session.select(element)
    context.canvas.fit((element,))


def _file_of(graph: Graph, port: Port) -> str | None:
    """The path value whose layer a value chooses, if any."""
    for name, declaration in signature(graph.node(port.node)).values.items():
        if declaration.layer_by == port.socket:
            path = graph.value(Port(port.node, name))
            return path if isinstance(path, str) else None
    return None


def _layer_of(graph: Graph, port: Port, declaration: Value) -> str:
    layer = graph.value(Port(port.node, declaration.layer_by)) if declaration.layer_by else ""
    return layer if isinstance(layer, str) else ""


def _tip(declaration: Value, control: str | None) -> str:
    lines = describe_value(declaration, describe_default(declaration))
    hints = translate("Double click: reset. Right click: more.")
    return "\n".join(
        part for part in (lines, translate("Control: {control}", control=control) if control else "", hints) if part
    )
