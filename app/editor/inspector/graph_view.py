"""The inspector of the graph: size, time, inputs, outputs and controls. Also of frames and comments."""

from __future__ import annotations

from functools import partial
from pathlib import PurePath

from halation.nodes import Kind, Value
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...authoring.commands import (
    AddInput,
    AddOutput,
    DescribeControl,
    EditComment,
    EditFrame,
    ExposeValue,
    HideControl,
    RemoveEnd,
    RenameControl,
    RenameEnd,
)
from ...authoring.edits.element_id import NO_ELEMENT, ElementId
from ...authoring.edits.elements import entry
from ...authoring.edits.naming import value_label
from ...document.about import find_about
from ...graph import Control, Port, Unknown, signature
from ...graph.names import fresh_name
from ...language.translation import translate
from ..fields.color_field import color_field
from ..fields.colors import decode, encode
from ..fields.fields import Fields
from ..fields.text_field import text_field
from ..theme.palette import RGB
from ..toolkit.labels import make_label
from ..toolkit.places import item_rect
from ..toolkit.words import tip
from .end_view import describe_binding, draw_text
from .heading import draw_faults, draw_heading
from .project_rows import ProjectRows
from .rows import Rows
from .value_rows import ValueRows, go_to

_TEXT = Value("name", "text", "")
_COLOR = Value("color", "color", (0.0,) * 4, 4, low=0.0, high=1.0)
_KINDS = tuple(
    (kind, width) for kind in Kind for width in ((2, 3, 4) if kind is Kind.VECTOR else (kind.facts.channels,))
)


class GraphView:
    """Shows and edits the graph while nothing is selected, and frames and comments."""

    def __init__(self, fields: Fields, values: ValueRows) -> None:
        self._fields, self._values, self._project = fields, values, ProjectRows(fields)

    def draw(self, rows: Rows) -> None:
        """Draw the graph that the canvas shows."""
        session = rows.context.session
        inside = session.place[-1] if session.place else ""
        draw_heading(
            rows,
            translate("Group {inside}", inside=inside) if inside else session.name,
            rows.palette.category("group" if inside else ""),
        )
        draw_faults(rows, NO_ELEMENT)
        has_controls = bool(session.graph.controls)
        if doc := find_about(session.graph).doc:
            rows.note(doc)
        if has_controls:
            self._controls(rows)
        # What the graph offers comes first. So the settings of the project, which are set once, are folded then.
        if not inside and rows.fold(translate("Project"), "project", is_open=not has_controls):
            self._project.draw(rows)
        self._ends(rows, "inputs")
        self._ends(rows, "outputs")
        if not has_controls:
            self._controls(rows)

    def frame(self, rows: Rows, frame: ElementId) -> None:
        """Draw the title and color of a frame."""
        session = rows.context.session
        facts = entry(session.graph, frame)
        draw_heading(rows, translate("Frame", "element"), rows.palette.accent)
        draw_text(
            rows,
            self._fields,
            f"{frame} title",
            translate("title", "value"),
            str(facts.get("title", "")),
            lambda title: session.apply(EditFrame(frame, title=title)),
        )
        saved_color = facts.get("color")
        color = (
            tuple(float(part) for part in saved_color)
            if isinstance(saved_color, tuple) and len(saved_color) == 3
            else None
        )
        red, green, blue = color or rows.palette.raised
        rows.name(f"{frame} color", translate("color", "value"))
        light = decode(red), decode(green), decode(blue), 1.0
        edit = color_field(self._fields, f"{frame} color", light, _COLOR, rows.field(), eyedropper=False)
        if edit and isinstance(edit.value, tuple):
            encoded = tuple(min(max(encode(part), 0.0), 1.0) for part in edit.value[:3])
            rows.act(
                lambda: session.apply(EditFrame(frame, color=(encoded[0], encoded[1], encoded[2]), merge=edit.merge))
            )

    def comment(self, rows: Rows, comment: ElementId) -> None:
        """Draw the text of a comment."""
        session = rows.context.session
        draw_heading(rows, translate("Comment"), rows.palette.accent)
        text = str(entry(session.graph, comment).get("text", ""))
        edit = text_field(
            self._fields, f"{comment} text", text, _TEXT, rows.width, hint=translate("Type a comment"), lines=6
        )
        rows.record(f"{comment} text")
        if edit:
            rows.act(lambda: session.apply(EditComment(comment, str(edit.value))))
        rows.note(translate("Ctrl+Enter starts a new line."))

    # --- parts -------------------------------------------------------------------------------------------------------

    def _ends(self, rows: Rows, side: str) -> None:
        session = rows.context.session
        ends = session.graph.inputs if side == "inputs" else session.graph.outputs
        rows.draw_heading(translate("Inputs") if side == "inputs" else translate("Outputs"))
        rows.fit((f"{translate(end.kind, 'kind')}2" for end in ends.values()), least=0.0)
        for name, end in ends.items():
            key = f"{side}.{name}"
            width = str(end.width) if end.kind is Kind.VECTOR else ""
            rows.name(f"{key} row", f"{translate(end.kind, 'kind')}{width}", color=rows.palette.kinds[end.kind])
            room = rows.field() - imgui.get_frame_height() * 2
            edit = text_field(self._fields, f"{key} row", name, _TEXT, room)
            rows.record(f"{key} row")
            if edit:
                rows.act(lambda key=key, edit=edit: session.apply(RenameEnd(ElementId(key), str(edit.value))))
            imgui.same_line(0.0, 0.0)
            if rows.icon(icons.ICON_FA_ARROW_RIGHT, f"go {key}", translate("Select it")):
                rows.act(lambda name=name: go_to(rows.context, Port(side, name)))
            imgui.same_line(0.0, 0.0)
            if rows.icon(icons.ICON_FA_XMARK, f"remove {key}", translate("Remove it and its links")):
                rows.act(lambda key=key: session.apply(RemoveEnd(ElementId(key))))
            if side == "inputs":
                text, color = _comes_in(rows, name)
                rows.field_note(text, color)
        word = side[:-1]
        title = translate("Add Input") if side == "inputs" else translate("Add Output")
        if rows.wide_button(f"{icons.ICON_FA_PLUS}  {title}", f"add {word}"):
            imgui.open_popup(f"kinds {side}")
        if imgui.begin_popup(f"kinds {side}"):
            for kind, width in _KINDS:
                number = width if kind is Kind.VECTOR else ""
                label = f"{kind}{number}"
                chosen = imgui.menu_item(make_label(f"{translate(kind, 'kind')}{number}", label), "", False)[0]
                rows.context.places[f"menu {label}"] = item_rect()
                if chosen:
                    name = fresh_name(kind.lower(), ends)
                    command = AddInput if side == "inputs" else AddOutput
                    rows.act(partial(session.apply, command(name, kind, width)))
            imgui.end_popup()

    def _controls(self, rows: Rows) -> None:
        session = rows.context.session
        rows.draw_heading(translate("Controls"))
        rows.fit(control.label or name for name, control in session.graph.controls.items())
        if not session.graph.controls:
            rows.note(translate("Values that this graph offers on the command line, and when it is used as a group."))
        for name, control in session.graph.controls.items():
            self._control(rows, name, control)
        if rows.wide_button(f"{icons.ICON_FA_PLUS}  {translate('Add Control')}", "add control"):
            imgui.open_popup("add control")
        if imgui.begin_popup("add control"):
            self._candidates(rows)
            imgui.end_popup()

    def _control(self, rows: Rows, name: str, control: Control) -> None:
        """Draw the value of a control, and a section with its name, label and description."""
        key, target = f"controls.{name}", control.target
        session = rows.context.session
        item = session.graph.nodes.get(target.node)
        values = {} if item is None or isinstance(item, Unknown) else signature(item).values
        declaration = values.get(target.socket)
        if declaration:
            self._values.draw(rows, (target,), declaration, control.label or name)
        else:
            rows.name(key, name)
            rows.field()
            rows.note(translate("its value no longer exists"), rows.palette.error)
        imgui.push_style_color(imgui.Col_.text, imgui.get_color_u32((*rows.palette.dim, 1.0)))
        opened = imgui.tree_node(make_label(str(target), key))
        imgui.pop_style_color()
        tip(translate("Name, label and description of the control"))
        rows.context.places[f"more {key}"] = item_rect()
        if opened:
            self._control_details(rows, name, control, declaration)
            imgui.tree_pop()

    def _control_details(self, rows: Rows, name: str, control: Control, declaration: Value | None) -> None:
        session, key = rows.context.session, f"controls.{name}"
        inner = rows.inset()
        draw_text(
            inner,
            self._fields,
            f"{key} name",
            translate("name", "value"),
            name,
            lambda new: session.apply(RenameControl(name, new)),
        )
        draw_text(
            inner,
            self._fields,
            f"{key} label",
            translate("label", "value"),
            control.label,
            lambda label: session.apply(DescribeControl(name, label=label)),
            hint=name,
        )
        draw_text(
            inner,
            self._fields,
            f"{key} doc",
            translate("description", "value"),
            control.doc,
            lambda doc: session.apply(DescribeControl(name, doc=doc)),
            hint=translate(declaration.doc) if declaration else "",
        )
        if imgui.small_button(make_label(f"{icons.ICON_FA_ARROW_RIGHT}  {translate('Go to Node')}", f"go {key}")):
            rows.act(lambda: go_to(rows.context, control.target))
        imgui.same_line()
        if imgui.small_button(make_label(f"{icons.ICON_FA_XMARK}  {translate('Remove')}", f"remove {key}")):
            rows.act(lambda: session.apply(HideControl(name)))

    def _candidates(self, rows: Rows) -> None:
        """The values that are not controls yet, by node."""
        session = rows.context.session
        exposed = {control.target for control in session.graph.controls.values()}
        has_candidates = False
        for id, item in session.graph.nodes.items():
            ports = (
                []
                if isinstance(item, Unknown)
                else [port for name in signature(item).values if (port := Port(id, name)) not in exposed]
            )
            if not ports or not imgui.begin_menu(id):
                has_candidates |= bool(ports)
                continue
            has_candidates = True
            for port in ports:
                if imgui.menu_item(make_label(value_label(session.graph, port), str(port)), "", False)[0]:
                    rows.act(lambda port=port: session.apply(ExposeValue(port)))
            imgui.end_menu()
        if not has_candidates:
            imgui.text_disabled(translate("There is no other value to expose"))


def _comes_in(rows: Rows, name: str) -> tuple[str, RGB]:
    """What an input of the graph reads now, as text, and the color of that text."""
    session, palette = rows.context.session, rows.palette
    end = session.graph.inputs[name]
    bound = describe_binding(session, name)
    if bound:
        return translate("bound to {name}", name=PurePath(bound).name), palette.good
    if end.file:
        return translate("reads {name}", name=PurePath(end.file).name), palette.dim
    if end.default is not None:
        parts = end.default if isinstance(end.default, tuple) else (end.default,)
        return translate("default {numbers}", numbers=" ".join(f"{part:g}" for part in parts)), palette.dim
    return (
        (translate("linked where the group is used"), palette.dim)
        if session.place
        else (translate("no file and no default"), palette.warning)
    )
