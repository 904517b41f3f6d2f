"""The rows of a node that reads a render: the file, the role of each layer and why, and unused layers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from halation.nodes import Kind, Node, Socket, Value
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...authoring.commands import AddMatte, SetValue
from ...graph import Port
from ...language.translation import mark, translate
from ...render_layers.naming import Role
from ...render_layers.overview import RenderOverview, RoleUse
from ...render_layers.recognition import RenderPass
from ...render_layers.report import join_choices, list_camera
from ..shared.declared_words import name_value
from ..shared.render_facts import FOUND, overview_of, render_path, rule_words
from ..theme.palette import RGB
from ..toolkit.buttons import dropdown
from ..toolkit.labels import make_label
from ..toolkit.places import item_rect, place
from ..toolkit.words import SMALL, cut_middle, draw_wrapped, font, tip, write
from .matte_rows import MatteRows
from .value_rows import ValueRows

if TYPE_CHECKING:
    from .rows import Rows

_USE_AS = mark("use as")
_LONGEST = 200
"""The most letters that are shown of a header entry."""


class RenderRows:
    """Draws the values of such a node, with facts of the file."""

    def __init__(self, values: ValueRows) -> None:
        self._values = values
        self._mattes = MatteRows(values.fields)

    def draw(self, rows: Rows, id: str, item: Node) -> None:
        """Draw the values, then the facts of the file."""
        context, path = rows.context, render_path(item)
        overview = overview_of(context, id)
        plain_values = [value for value in item.values.values() if not value.role]
        rows.fit(
            [*(value.name for value in plain_values), *(_label(value) for value in item.values.values() if value.role)]
        )
        for value in plain_values:
            self._values.draw(rows, (Port(id, value.name),), value)
            if value.name == path:
                _about(rows, overview)
            if value.matte:
                self._mattes.draw(rows, Port(id, value.name))
        roles = [value for value in item.values.values() if value.role]
        if roles:
            self._layers(rows, id, item, roles, overview)
        if not isinstance(overview, RenderOverview):
            return
        if roles:
            self._others(rows, id, roles, overview)
        if any(output.socket.kind is Kind.CAMERA for output in item.outputs.values()):
            _camera(rows, id, overview)
        _file(rows, id, overview)

    # --- parts -------------------------------------------------------------------------------------------------------

    def _layers(
        self, rows: Rows, id: str, item: Node, roles: Sequence[Value], overview: RenderOverview | str | None
    ) -> None:
        """Draw a field for the layer of every output and for its convention; missing layers come last."""
        uses = overview.uses if isinstance(overview, RenderOverview) else {}
        there = {role for role, use in uses.items() if use.layer or use.is_open or use.fault}
        there |= {Role(value.role) for value in roles if item.setting(value.name) != value.default}
        visible_roles = [value for value in roles if Role(value.role) in there]
        rest = [value for value in roles if Role(value.role) not in there]
        if visible_roles:
            rows.draw_heading(translate("Layers"))
        for value in visible_roles:
            self._role(rows, id, item, value, uses.get(Role(value.role)))
        if not rest:
            return
        count = len({value.role for value in rest})
        title = (
            translate("Not in This File ({count})", count=count) if uses else translate("Layers ({count})", count=count)
        )
        if _draw_fold(rows, make_label(title, f"rest {id}"), f"more {id} layers"):
            for value in rest:
                self._role(rows, id, item, value, None)

    def _role(self, rows: Rows, id: str, item: Node, value: Value, use: RoleUse | None) -> None:
        """Draw one value, and a note on its layer."""
        socket = _socket(item, value)
        color = rows.palette.kinds[socket.kind] if socket and value.type == "text" else None
        self._values.draw(rows, (Port(id, value.name),), value, _label(value), color)
        if use is None:
            return
        has_choice = f"{_output(value)}_is" in item.values
        if value.type == "text":
            explanation = use.fault or use.reason
            rows.field_note(
                explanation, rows.palette.error if use.fault else rows.palette.warning if use.is_open else None
            )
            if use.rule and not has_choice:
                rows.field_note(rule_words(use.rule, kind_shown=False))
        elif use.rule:
            chosen = item.setting(value.name) != FOUND
            words = (
                translate("chosen by hand; detected: {words}", words=use.rule.words)
                if chosen
                else rule_words(use.rule, kind_shown=True)
            )
            unsure = not use.rule.kind and not chosen
            rows.field_note(words, rows.palette.warning if unsure else None)

    def _others(self, rows: Rows, id: str, roles: Sequence[Value], overview: RenderOverview) -> None:
        """Draw the layers that no output uses, each with a menu of possible uses."""
        if overview.mattes:
            self._offer_mattes(rows, id, overview)
        if not overview.other_passes:
            return
        rows.draw_heading(translate("Not Used"))
        for item in overview.other_passes:
            self._other(rows, id, [value for value in roles if value.type == "text"], item)

    def _other(self, rows: Rows, id: str, roles: Sequence[Value], item: RenderPass) -> None:
        key, session = f"{id} {item.layer.name}", rows.context.session
        button = f"{translate(_USE_AS)}  {icons.ICON_FA_CHEVRON_DOWN}"
        room = imgui.calc_text_size(button).x + 2 * imgui.get_style().frame_padding.x
        rect = place(rows.width - room - rows.gap)
        imgui.dummy((rect[2] - rect[0], rect[3] - rect[1]))
        tip(f"{item.layer.full_name}: {', '.join(item.layer.channels)}, {item.layer.format}")
        write(rect, item.layer.name, rows.palette.text)
        imgui.same_line(0.0, rows.gap)

        def offer() -> None:
            likely = [value for value in roles if value.role in item.candidates or value.role == item.role]
            for value in (*likely, *(value for value in roles if value not in likely)):
                if imgui.menu_item(make_label(name_value(_label(value)), value.name), "", value in likely)[0]:
                    rows.act(lambda value=value: session.apply(SetValue(Port(id, value.name), item.layer.name)))
                rows.context.places[f"menu {_label(value)}"] = item_rect()

        dropdown(rows.context, button, f"button use {key}", translate("Choose what this layer is used for"), offer)
        maybe = item.role is None and bool(item.candidates)
        words = (
            translate("may be {roles}", roles=join_choices([role.words for role in item.candidates]))
            if maybe
            else (item.role.words if item.role else item.reason)
        )
        with font(rows.context, "text", SMALL):
            draw_wrapped(rows.palette.warning if maybe else rows.palette.dim, words)

    def _offer_mattes(self, rows: Rows, id: str, overview: RenderOverview) -> None:
        """Draw the cryptomattes of the file, and a button that adds a cryptomatte node."""
        rows.draw_heading(translate("Cryptomatte"))
        words = [
            translate("{kind}: {count} names", kind=matte.kind or translate("unnamed"), count=len(matte.ids))
            if matte.ids
            else translate("{kind}: no manifest", kind=matte.kind)
            for matte in overview.mattes
        ]
        rows.note(", ".join(words))
        session = rows.context.session
        if rows.wide_button(
            f"{icons.ICON_FA_OBJECT_GROUP}  {translate('Pick Objects')}",
            f"matte {id}",
            translate("Add a cryptomatte node"),
        ):
            rows.act(lambda: session.apply(AddMatte(id, overview.mattes[0].kind)))


def _about(rows: Rows, overview: RenderOverview | str | None) -> None:
    """Draw a summary of the file below its path."""
    if overview is None:
        rows.field_note(translate("reading the file…"))
    elif isinstance(overview, RenderOverview):
        rows.field_note(f"{overview.size}\n{overview.maker}")
        if overview.fault:
            rows.field_note(overview.fault, rows.palette.error)


def _camera(rows: Rows, id: str, overview: RenderOverview) -> None:
    """Draw whether the file has a camera, and how exact it is."""
    rows.draw_heading(translate("Camera"))
    facts = dict(list_camera(overview.camera))
    for name in ("found", "none", "residual", "field of view"):
        if name in facts:
            _fact(rows, name, facts[name], rows.palette.warning if name == "none" else None)
    rows.context.places[f"camera {id}"] = item_rect()


def _file(rows: Rows, id: str, overview: RenderOverview) -> None:
    """Draw what `halation info` shows besides: parts, the whole camera, metadata."""
    rows.draw_heading(translate("File"))
    if _draw_fold(
        rows, make_label(translate("Parts ({count})", count=len(overview.parts)), f"parts {id}"), f"more {id} parts"
    ):
        names = [part[1] or f"part {part[0]}" for part in overview.parts]
        heads = {name.partition(".")[0] for name in names}
        shared = heads.pop() if len(heads) == 1 and len(names) > 1 else ""
        _facts(
            rows,
            [
                (name.removeprefix(f"{shared}."), ", ".join(word for word in part[2:] if word))
                for name, part in zip(names, overview.parts, strict=True)
            ],
        )
    if overview.camera.camera and _draw_fold(
        rows, make_label(translate("Camera"), f"camera {id}"), f"more {id} camera"
    ):
        _facts(rows, list_camera(overview.camera))
    if overview.metadata and _draw_fold(
        rows,
        make_label(translate("Metadata ({count})", count=len(overview.metadata)), f"metadata {id}"),
        f"more {id} metadata",
    ):
        _facts(
            rows,
            [(name, words if len(words) <= _LONGEST else f"{words[:_LONGEST]}…") for name, words in overview.metadata],
        )
    if overview.report and rows.wide_button(
        f"{icons.ICON_FA_COPY}  {translate('Copy Report')}", f"report {id}", translate("Copy all of it as text")
    ):
        rows.context.clipboard.put(overview.report)


def _facts(rows: Rows, facts: Sequence[tuple[str, str]]) -> None:
    """Draw small rows of a name and a text."""
    with font(rows.context, "text", SMALL):
        longest = max(imgui.calc_text_size(name).x for name, _ in facts)
    width = min(max(longest, rows.name_width), rows.width * 0.42)
    for name, words in facts:
        _fact(rows, name, words, width=width)


def _fact(rows: Rows, name: str, words: str, color: RGB | None = None, width: float = 0.0) -> None:
    """Draw a small row: a name (shortened in the middle) and a text."""
    with font(rows.context, "text", SMALL):
        rect = place(width or rows.name_width, imgui.get_text_line_height())
        imgui.dummy((rect[2] - rect[0], rect[3] - rect[1]))
        tip(name)
        write(rect, cut_middle(name, rect[2] - rect[0]), rows.palette.dim, align=1.0)
        imgui.same_line(0.0, rows.gap)
        draw_wrapped(color or rows.palette.text, words)


def _draw_fold(rows: Rows, label: str, key: str) -> bool:
    """Draw a section that is collapsed at first; True if it is open."""
    imgui.push_style_color(imgui.Col_.text, imgui.get_color_u32((*rows.palette.dim, 1.0)))
    opened = imgui.tree_node_ex(label, int(imgui.TreeNodeFlags_.no_tree_push_on_open))
    imgui.pop_style_color()
    rows.context.places[key] = item_rect()
    return opened


def _output(value: Value) -> str:
    """The output that a value belongs to."""
    return value.name.removesuffix("_layer").removesuffix("_is")


def _label(value: Value) -> str:
    return _output(value) if value.type == "text" else value.name


def _socket(item: Node, value: Value) -> Socket | None:
    output = item.outputs.get(_output(value))
    return output.socket if output else None
