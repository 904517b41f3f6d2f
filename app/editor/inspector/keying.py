"""Animated values in the inspector: the diamond for keys, the field of an expression, and their menu."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Literal

from halation.nodes import Plain
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...authoring.commands import AnimateValues, BakeKeys, SetExpression, ToggleKey
from ...authoring.commands.keys import to_scalar
from ...authoring.edits.values import find_expression_fault
from ...document.animation import describe_animation, read_animation
from ...errors import GraphError, UsageError
from ...graph import Animation, Expression, Keys, Port
from ...language.translation import mark, translate
from ..fields.fields import Fields
from ..fields.text_entry import text_entry
from ..theme.palette import RGB, Palette
from ..theme.style import mix, u32, ui_scale
from ..toolkit.fields import background
from ..toolkit.labels import make_label
from ..toolkit.places import Rect, item_rect, place
from ..toolkit.words import SMALL, draw_wrapped, font, note_below, tip
from .rows import DIAMOND_WIDTH

if TYPE_CHECKING:
    from ...authoring.session import Session
    from .applying import Ports
    from .context import InspectorContext
    from .rows import Rows

Look = Literal["still", "keys", "key", "expression"]

_DOCS: dict[Look, str] = {
    "still": mark("Not animated. Click to set a key at this frame"),
    "keys": mark("Animated. Click to set a key at this frame"),
    "key": mark("Key at this frame. Click to remove it"),
    "expression": mark("Driven by an expression"),
}


def look_of(session: Session, port: Port) -> Look:
    """How a value is animated, at the current frame: not, by keys, with a key here, or by an expression."""
    animation = session.graph.animation.get(port)
    if animation is None:
        return "still"
    if isinstance(animation, Expression):
        return "expression"
    return "keys" if session.time.find_key(port) is None else "key"


def color_of(palette: Palette, look: Look) -> RGB:
    """The color of a diamond."""
    if look == "expression":
        return next(color for kind, color in palette.kinds.items() if kind.value.casefold() == "vector")
    return {"keys": palette.good, "key": palette.warning}.get(look, palette.dim)


def value_now(session: Session, port: Port) -> tuple[Plain, str]:
    """The value at the current frame, and why an expression has none, with a caret below it."""
    try:
        return session.time.evaluate(port), ""
    except GraphError as error:
        return session.graph.value(port), str(error)


def spoken(value: Plain) -> str:
    """A value as text for the user."""
    if isinstance(value, bool | str):
        return value if isinstance(value, str) else "on" if value else "off"
    return "  ".join(f"{part:.5g}" for part in (value if isinstance(value, tuple) else (value,)))


def _remove_animation(session: Session, ports: Ports) -> None:
    label = translate("Remove animation of {socket}", socket=ports[0].socket)
    session.apply(AnimateValues(dict.fromkeys(ports), label))


def _jump(context: InspectorContext, frame: int | None) -> None:
    """Show a frame, if there is one."""
    if frame is not None:
        context.timeline.stop()
        context.session.time.seek(frame)


def toggle(session: Session, ports: Ports) -> None:
    """Toggle the key of all values: set them, or remove them if the first value has one."""
    if len(ports) == 1:
        session.apply(ToggleKey(ports[0]))
        return
    removes, animations = session.time.find_key(ports[0]) is not None, dict[Port, Animation | None]()
    for port in ports:
        keys = session.graph.animation.get(port)
        if isinstance(keys, Expression):
            continue
        if removes:
            animations[port] = keys and keys.remove(session.time.frame)
        else:
            animations[port] = (keys or Keys()).set(session.time.frame, to_scalar(session.time.evaluate(port)))
    session.apply(
        AnimateValues(
            animations,
            translate("Remove keys {socket} of {count} nodes", socket=ports[0].socket, count=len(ports))
            if removes
            else translate("Key {socket} of {count} nodes", socket=ports[0].socket, count=len(ports)),
        )
    )


class Keying:
    """The diamonds and expression fields of one panel."""

    def __init__(self, fields: Fields) -> None:
        self._fields = fields
        self._drafts: dict[str, str] = {}
        """Expressions that are invalid, or still being typed, by value."""

    def diamond(self, rows: Rows, ports: Ports) -> None:
        """Draw the diamond beside a name: empty, with keys elsewhere, or with a key here."""
        session, port, scale = rows.context.session, ports[0], ui_scale()
        look = look_of(session, port)
        imgui.same_line(0.0, 0.0)
        rect = place(DIAMOND_WIDTH * scale)
        imgui.push_item_flag(int(imgui.ItemFlags_.no_nav), True)
        pressed = imgui.invisible_button(f"##diamond {port}", (rect[2] - rect[0], rect[3] - rect[1]))
        imgui.pop_item_flag()
        rows.context.places[f"diamond {port}"] = rect
        hovered = imgui.is_item_hovered()
        _paint(rows.palette, rect, look, hovered)
        tip(translate(_DOCS[look]))
        if pressed and look == "expression":
            self.begin(session, port)
        elif pressed:
            rows.act(lambda: toggle(session, ports))

    def begin(self, session: Session, port: Port, text: str = "") -> None:
        """Start to type an expression."""
        key, animation = str(port), session.graph.animation.get(port)
        current_text = animation.text if isinstance(animation, Expression) else text
        self._drafts[key] = current_text
        self._fields.next_field = f"{key} expression"

    def take_expression(self, session: Session, port: Port, text: str) -> None:
        """Apply an expression that was typed into a number field; an invalid one stays in the field."""
        if find_expression_fault(session.graph, port, text):
            self._drafts[str(port)] = text.strip().removeprefix("=").strip()
        else:
            self._drafts.pop(str(port), None)
            session.apply(SetExpression(port, text))

    def field(self, rows: Rows, port: Port, width: float) -> bool:
        """Draw the expression of a value in place of its field; False if it has none."""
        context, fields, key = rows.context, self._fields, str(port)
        session = context.session
        animation, id = session.graph.animation.get(port), f"{key} expression"
        expression = animation.text if isinstance(animation, Expression) else ""
        if not expression and key not in self._drafts:
            return False
        text = self._drafts.get(key, expression)
        fields.order.append(id)
        if fields.next_field == id:
            fields.type_in(id, text, text)
        if fields.typing and fields.typing.id == id:
            self._draw_typing(rows, port, id, text, width)
            return True
        rect = place(width)
        if imgui.invisible_button(f"##{id}", (rect[2] - rect[0], rect[3] - rect[1])):
            fields.type_in(id, text, text)
        if imgui.is_item_hovered():
            imgui.set_mouse_cursor(imgui.MouseCursor_.text_input)
        fault = find_expression_fault(session.graph, port, text) or value_now(session, port)[1]
        background(rows.palette, rect, hovered=imgui.is_item_hovered(), fault=bool(fault))
        rows.record(key)
        with font(context, "mono", SMALL):
            cut = _draw_colored(rows.palette, rect, text)
        tip(f"= {text}" if cut else "")
        return True

    def note(self, rows: Rows, port: Port, field_text: str) -> None:
        """Draw the result of the expression below the field, or why it is invalid."""
        session, key = rows.context.session, str(port)
        animation = session.graph.animation.get(port)
        text = self._drafts.get(key, animation.text if isinstance(animation, Expression) else "")
        if self._fields.typing and self._fields.typing.id == f"{key} expression":
            return
        fault = find_expression_fault(session.graph, port, text) if text else None
        fault = fault or value_now(session, port)[1]
        if fault:
            with font(rows.context, "mono", SMALL * 0.92):
                draw_wrapped(rows.palette.error, fault.removeprefix(f"{port}: "))
        else:
            rows.field_note(f"= {field_text}")

    def tint(self, rows: Rows, port: Port, rect: Rect) -> None:
        """Outline the field of an animated value in its color."""
        look = look_of(rows.context.session, port)
        if look in ("keys", "key"):
            color, lines = color_of(rows.palette, look), imgui.get_window_draw_list()
            lines.add_rect_filled(rect[:2], rect[2:], u32(color, 0.13), imgui.get_style().frame_rounding)
            lines.add_rect(rect[:2], rect[2:], u32(color, 0.6), imgui.get_style().frame_rounding)

    def menu(self, rows: Rows, ports: Ports, field_text: str) -> None:
        """Draw the entries for keys and expressions in the open menu."""
        context, port = rows.context, ports[0]
        session, look = context.session, look_of(context.session, ports[0])
        is_single, keyed = len(ports) == 1, look in ("keys", "key")
        before, after = session.time.find_previous_key(port), session.time.find_next_key(port)
        remove = partial(_remove_animation, session, ports)

        def entry(icon: str, label: str, enabled: bool, act: Callable[[], object]) -> None:
            if imgui.menu_item(make_label(f"{icon}  {translate(label)}", label), "", False, enabled)[0]:
                rows.act(act)
            context.places[f"menu {label}"] = item_rect()

        imgui.separator()
        entry(icons.ICON_FA_DIAMOND, mark("Set Key"), look in ("still", "keys"), lambda: toggle(session, ports))
        entry(icons.ICON_FA_MINUS, mark("Remove Key"), look == "key", lambda: toggle(session, ports))
        entry(icons.ICON_FA_ERASER, mark("Remove All Keys"), keyed, remove)
        entry(
            icons.ICON_FA_CHEVRON_LEFT,
            mark("Previous Key"),
            keyed and before is not None,
            lambda: _jump(context, before),
        )
        entry(
            icons.ICON_FA_CHEVRON_RIGHT,
            mark("Next Key"),
            keyed and after is not None,
            lambda: _jump(context, after),
        )
        imgui.separator()
        entry(
            icons.ICON_FA_SUPERSCRIPT, mark("Expression..."), is_single, lambda: self.begin(session, port, field_text)
        )
        entry(icons.ICON_FA_XMARK, mark("Remove Expression"), look == "expression", remove)
        entry(
            icons.ICON_FA_BARS_STAGGERED,
            mark("Bake to Keys"),
            is_single and look != "still",
            lambda: session.apply(BakeKeys(port)),
        )
        entry(
            icons.ICON_FA_COPY,
            mark("Copy Animation"),
            look != "still",
            lambda: context.clipboard.put(as_text(session, port)),
        )
        entry(
            icons.ICON_FA_PASTE, mark("Paste Animation"), True, lambda: paste(session, ports, context.clipboard.get())
        )

    def _draw_typing(self, rows: Rows, port: Port, id: str, text: str, width: float) -> None:
        """Draw the expression field while the user types in it.

        An invalid text is kept as a draft when typing ends: the value stays as it was, and nothing typed is lost.
        """
        fields, context = self._fields, rows.context
        session = context.session
        edit = text_entry(fields, width)
        rows.record(str(port))
        typing = fields.typing
        if typing and typing.id == id:
            fault = find_expression_fault(session.graph, port, typing.text) if typing.text.strip() else None
            if fault and not typing.starting:
                with font(context, "mono", SMALL):
                    note_below(rows.palette, item_rect(), fault.removeprefix(f"{port}: "), rows.palette.error)
            return
        self._drafts.pop(str(port), None)
        if edit is not None and isinstance(edit.value, str):
            typed_text = edit.value
            rows.act(
                lambda: (
                    self.take_expression(session, port, typed_text)
                    if typed_text.strip()
                    else session.apply(SetExpression(port, ""))
                )
            )
        elif text and find_expression_fault(session.graph, port, text):
            self._drafts[str(port)] = text


def as_text(session: Session, port: Port) -> str:
    """The animation of a value for the clipboard."""
    animation = session.graph.animation.get(port)
    return json.dumps(
        {"animation": None if animation is None else describe_animation(animation, session.graph.declaration(port))}
    )


def paste(session: Session, ports: Ports, text: str) -> None:
    """Paste an animation from the clipboard into values. Raises UsageError."""
    try:
        raw = json.loads(text)["animation"]
    except (ValueError, TypeError, KeyError):
        raise UsageError(translate("the clipboard holds no animation: copy one first")) from None
    animation = read_animation(raw, "clipboard", "$.animation", session.graph.declaration(ports[0]))
    session.apply(
        AnimateValues(dict.fromkeys(ports, animation), translate("Paste animation of {socket}", socket=ports[0].socket))
    )


def _paint(palette: Palette, rect: Rect, look: Look, hovered: bool) -> None:
    draw, scale = imgui.get_window_draw_list(), ui_scale()
    center = rect[2] - DIAMOND_WIDTH * 0.5 * scale + scale, (rect[1] + rect[3]) * 0.5
    color = color_of(palette, look)
    size = (5.2 if look != "still" or hovered else 4.2) * scale
    if look in ("key", "expression"):
        draw.add_ngon_filled(center, size, u32(color), 4)
        return
    strong = 1.0 if look == "keys" or hovered else 0.42
    draw.add_ngon(center, size, u32(mix(color, palette.text, 0.3) if hovered else color, strong), 4, 1.3 * scale)


def _draw_colored(palette: Palette, rect: Rect, text: str) -> bool:
    """Draw an expression with syntax colors; True if it does not fit."""
    colors = {
        "number": palette.good,
        "name": palette.text,
        "function": palette.accent,
        "constant": palette.good,
        "variable": color_of(palette, "expression"),
        "word": palette.accent,
        "unknown": palette.error,
    }
    draw, pad = imgui.get_window_draw_list(), imgui.get_style().frame_padding.x
    draw.push_clip_rect(rect[:2], rect[2:], True)
    x, y = rect[0] + pad, round((rect[1] + rect[3] - imgui.get_font_size()) * 0.5)
    each = imgui.calc_text_size("0").x
    draw.add_text((x, y), u32(palette.dim), "=")
    x += 2.0 * each
    for token in Expression(text).tokens:
        color = colors.get(token.kind, palette.dim)
        draw.add_text((x + imgui.calc_text_size(text[: token.start]).x, y), u32(color), text[token.start : token.end])
    draw.pop_clip_rect()
    return x + imgui.calc_text_size(text).x > rect[2]
