"""The inspector of a node, or of several nodes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePath
from typing import TYPE_CHECKING

from halation.nodes import Node, Socket, Value
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...authoring.commands import MakeGroupLocal, RenameNode, ResetNode, ToggleMute
from ...authoring.edits import paths
from ...authoring.edits.coding import LANGUAGES
from ...authoring.edits.element_id import ElementId
from ...custom_nodes import Code
from ...graph import Group, Item, Port, Signature, Unknown, signature
from ...language.translation import translate, translate_plural
from ..fields.fields import Fields
from ..shared.declared_words import name_value
from ..shared.render_facts import render_path
from ..toolkit.labels import make_label
from ..toolkit.places import item_rect
from ..toolkit.words import tip
from .applying import common
from .heading import doc_of, draw_explanation, draw_faults, draw_heading, draw_name_field, title_of
from .render_rows import RenderRows
from .value_rows import ValueRows, link_chip

if TYPE_CHECKING:
    from .rows import Rows


class NodeView:
    """Shows and edits the selected nodes."""

    def __init__(self, fields: Fields, values: ValueRows) -> None:
        self._fields, self._values = fields, values
        self._renders = RenderRows(values)
        self._explained = False

    def draw(self, rows: Rows, id: str) -> None:
        """Draw one node: header, values, inputs."""
        session = rows.context.session
        item = session.graph.nodes[id]
        interface = signature(item)
        rows.fit((translate("name", "value"), *map(name_value, interface.unfolded_inputs), *_list_labels(interface)))
        draw_heading(
            rows, title_of(item), rows.palette.category(_category(item)), lambda: self._draw_buttons(rows, id, item), 3
        )
        draw_name_field(
            rows,
            self._fields,
            id,
            id,
            lambda new: session.apply(RenameNode(id, new)),
            translate("The name of the node"),
        )
        self._explained = draw_explanation(rows, doc_of(item), self._explained)
        draw_faults(rows, ElementId(id))
        if isinstance(item, Group):
            self._group(rows, id, item)
        if code := session.code_files.find_code(id):
            self._code(rows, id, code)
            if isinstance(item, Unknown):
                return
        if isinstance(item, Unknown):
            rows.note(translate("This node type is not installed. The node does nothing and is saved unchanged."))
            return
        if interface.values:
            rows.draw_heading(translate("Controls") if isinstance(item, Group) else translate("Values"))
        if isinstance(item, Node) and render_path(item):
            self._renders.draw(rows, id, item)
        else:
            self._values.draw_wheels(rows, id, interface.values.values())
            for name, declaration in interface.values.items():
                if not declaration.folded:
                    self._values.draw(rows, (Port(id, name),), declaration)
        if interface.unfolded_inputs:
            rows.draw_heading(translate("Inputs"))
        for name, socket in interface.unfolded_inputs.items():
            _input(rows, Port(id, name), socket)
        self._draw_mask(rows, (id,), [declaration for declaration in interface.values.values() if declaration.folded])

    def several(self, rows: Rows, ids: tuple[str, ...]) -> None:
        """Draw the values that several nodes have in common; the first node is the active one."""
        session = rows.context.session
        items = [session.graph.nodes[id] for id in ids]
        kinds = {title_of(item) for item in items}
        kind = f"{len(ids)} × {kinds.pop()}" if len(kinds) == 1 else translate("{count} Nodes", count=len(ids))  # noqa: RUF001
        draw_heading(
            rows, kind, rows.palette.category(_category(items[0])), lambda: self._draw_shared_buttons(rows, ids), 1
        )
        rows.note(", ".join(ids))
        declarations = common(session.graph, ids)
        if not declarations:
            rows.note(translate("These nodes have no value in common."))
            return
        unfolded = [declaration for declaration in declarations if not declaration.folded]
        if unfolded:
            rows.draw_heading(translate("Values in Common"))
        rows.fit(name_value(declaration.label or declaration.name) for declaration in unfolded or declarations)
        for declaration in unfolded:
            self._values.draw(rows, tuple(Port(id, declaration.name) for id in ids), declaration)
        self._draw_mask(rows, ids, [declaration for declaration in declarations if declaration.folded])

    def _draw_mask(self, rows: Rows, ids: tuple[str, ...], declarations: Sequence[Value]) -> None:
        """Draw the mask of nodes and its values below a heading that stays closed until one of the nodes uses them.

        The input is drawn for a single node only: what several nodes share is values.
        """
        if not declarations:
            return
        graph = rows.context.session.graph
        ports = {declaration.name: tuple(Port(id, declaration.name) for id in ids) for declaration in declarations}
        is_used = any(Port(id, "mask") in graph.links for id in ids) or any(
            port in graph.animation or graph.value(port) != declaration.default
            for declaration in declarations
            for port in ports[declaration.name]
        )
        if not rows.fold(translate("Mask"), f"mask {' '.join(ids)}", is_open=is_used):
            return
        if len(ids) == 1:
            for name, socket in signature(graph.nodes[ids[0]]).inputs.items():
                if socket.folded:
                    _input(rows, Port(ids[0], name), socket)
        for declaration in declarations:
            self._values.draw(rows, ports[declaration.name], declaration)

    # --- parts -------------------------------------------------------------------------------------------------------

    def _draw_buttons(self, rows: Rows, id: str, item: Item) -> None:
        context = rows.context
        session = context.session
        if rows.icon(icons.ICON_FA_EYE, f"view {id}", translate("Show in the viewer")):
            rows.act(lambda: session.views.show_element(ElementId(id)))
        imgui.same_line()
        self._mute(rows, (id,))
        imgui.same_line()
        has_values = not isinstance(item, Unknown) and bool(signature(item).values)
        if rows.icon(icons.ICON_FA_ROTATE_LEFT, f"reset {id}", translate("Reset all values"), enabled=has_values):
            rows.act(lambda: session.apply(ResetNode(id)))

    def _draw_shared_buttons(self, rows: Rows, ids: tuple[str, ...]) -> None:
        self._mute(rows, ids)

    def _mute(self, rows: Rows, ids: tuple[str, ...]) -> None:
        session = rows.context.session
        muted = session.graph.muted.issuperset(ids)
        doc = translate("Muted: passes its first input through. Click to unmute") if muted else translate("Mute")
        glyph = icons.ICON_FA_EYE_SLASH if muted else icons.ICON_FA_POWER_OFF
        if rows.icon(glyph, f"mute {ids[0]}", doc, lit=muted):
            rows.act(lambda: session.apply(ToggleMute()))

    def _code(self, rows: Rows, id: str, code: Code) -> None:
        context = rows.context
        if code.file:
            rows.name(f"{id} file", translate("file", "value"), doc=translate("The file with the code of this node"))
            file = paths.resolve_path(code.file, context.session.graph.folder)
            draft = " *" if file in context.session.code_files.drafts else ""
            rows.chip(PurePath(code.file).name + draft, f"{id} file", rows.field(), rows.palette.good, code.file)
        label = f"{icons.ICON_FA_CODE}  {translate('Edit Code')}"
        if rows.wide_button(
            label, f"code {id}", translate("Show the {language} of this node", language=LANGUAGES[code.language])
        ):
            rows.act(lambda: context.actions.run("code.edit"))

    def _group(self, rows: Rows, id: str, item: Group) -> None:
        context, half = rows.context, (rows.width - rows.gap) / 2
        if item.path:
            rows.name(
                f"{id} path", translate("file", "value"), doc=translate("The graph file that this group comes from")
            )
            rows.chip(PurePath(item.path).name, f"{id} path", rows.field(), rows.palette.good, item.path)
        local = f"{icons.ICON_FA_HOUSE}  {translate('Make Local')}"
        beside = imgui.calc_text_size(local).x + 2 * imgui.get_style().frame_padding.x <= half
        width = half if item.path and beside else rows.width
        if imgui.button(
            make_label(f"{icons.ICON_FA_RIGHT_TO_BRACKET}  {translate('Enter')}", f"enter {id}"), (width, 0.0)
        ):
            rows.act(lambda: context.session.enter(id))
        tip(translate("Show what is in the group"))
        context.places[f"button enter {id}"] = item_rect()
        if item.path:
            if beside:
                imgui.same_line(0.0, rows.gap)
            if imgui.button(make_label(local, f"local {id}"), (width, 0.0)):
                rows.act(lambda: context.session.apply(MakeGroupLocal(id)))
            tip(translate("Copy it into this document, so that it can be edited here"))
            context.places[f"button local {id}"] = item_rect()


def _list_labels(interface: Signature) -> list[str]:
    """What the values of a node are called, without those of its mask."""
    values = [value for value in interface.values.values() if not value.folded]
    fields = [field for value in values if value.items for kind in value.items.kinds for field in kind.declarations]
    return [name_value(value.label or value.name) for value in (*values, *fields)]


def _input(rows: Rows, port: Port, socket: Socket) -> None:
    """Draw a socket: its link, or what it does without one."""
    channels = translate_plural("{count} channel", "{count} channels", socket.channels)
    doc = "\n".join(part for part in (translate(socket.doc), f"{translate(socket.kind, 'kind')}, {channels}") if part)
    rows.name(str(port), name_value(port.socket), doc=doc, color=rows.palette.kinds[socket.kind])
    source = rows.context.session.graph.links.get(port)
    width = rows.field()
    if source is not None:
        link_chip(rows, port, source, width)
        return
    imgui.align_text_to_frame_padding()
    if socket.optional:
        imgui.text_disabled(translate("not linked: {default}", default=_default(socket)))
    else:
        imgui.push_style_color(imgui.Col_.text, imgui.get_color_u32((*rows.palette.warning, 1.0)))
        imgui.text(translate("not linked"))
        imgui.pop_style_color()
    rows.record(str(port))


def _default(socket: Socket) -> str:
    default = socket.default
    return " ".join(f"{part:g}" for part in default) if isinstance(default, tuple) else f"{default:g}"


def _category(item: Item) -> str:
    if isinstance(item, Unknown) and item.type in LANGUAGES:
        return "code"
    return "group" if isinstance(item, Group) else getattr(item, "category", "")
