"""The two columns of the inspector: names at the left, fields at the right."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from ..theme.palette import RGB
from ..theme.style import mix, u32, ui_scale, vec4
from ..toolkit.buttons import quiet_button
from ..toolkit.labels import make_label
from ..toolkit.places import item_rect, place
from ..toolkit.words import SMALL, draw_wrapped, font, tip, write

if TYPE_CHECKING:
    from ..fields.fields import Fields
    from .context import InspectorContext

DIAMOND_WIDTH = 16.0
"""The width of the diamond of keys with its margin, between a name and its field, at UI scale 1."""


class Rows:
    """The layout of names and fields in this frame."""

    def __init__(self, context: InspectorContext, fields: Fields) -> None:
        self.context, self.fields, self.palette = context, fields, context.palette
        self.gap = imgui.get_style().item_inner_spacing.x
        width = imgui.get_content_region_avail().x
        self.width = width
        self._acts: list[Callable[[], object]] = []
        self.fit(())

    def act(self, act: Callable[[], object]) -> None:
        """Run an action after everything is drawn: the document must not change before."""
        self._acts.append(act)

    def finish(self) -> None:
        """Run the actions of `act`."""
        for act in self._acts:
            self.context.log.attempt(act)

    def inset(self) -> Rows:
        """Rows for the width that is left after an indent."""
        inner = Rows(self.context, self.fields)
        inner._acts = self._acts
        return inner

    def fit(self, labels: Iterable[str], least: float = 0.3) -> None:
        """Fit the left column to these names: from a fraction `least` up to half of the panel."""
        scale = ui_scale()
        longest = max((imgui.calc_text_size(label.replace("_", " ")).x for label in labels), default=42.0 * scale)
        needed_width = max(self.width * least, longest + (9.0 + DIAMOND_WIDTH) * scale + 1.0)
        self.name_width = min(needed_width, self.width * 0.48, 210.0 * scale)
        self.field_width = max(self.width - self.name_width - self.gap, 1.0)

    def name(
        self,
        key: str,
        label: str,
        *,
        doc: str = "",
        changed: bool = False,
        color: RGB | None = None,
        spare: float = 0.0,
    ) -> None:
        """The name of a row, as the last item; the field comes next, on the same line.

        `spare` pixels of the column are left for something between.
        """
        rect = place(self.name_width - spare)
        imgui.invisible_button(f"##name {key}", (rect[2] - rect[0], rect[3] - rect[1]))
        self.context.places[f"name {key}"] = rect
        hovered, palette, scale = imgui.is_item_hovered(), self.palette, ui_scale()
        if changed:
            center = rect[0] + 3.0 * scale, (rect[1] + rect[3]) * 0.5
            imgui.get_window_draw_list().add_circle_filled(center, 2.5 * scale, u32(palette.accent))
        ink = palette.text if changed or hovered else palette.dim
        right = rect[2] - 14.0 * scale if color else rect[2]
        write((rect[0] + 9.0 * scale, rect[1], right, rect[3]), label.replace("_", " "), ink, align=1.0)
        if color:
            dot = rect[2] - 5.0 * scale, (rect[1] + rect[3]) * 0.5
            imgui.get_window_draw_list().add_circle_filled(dot, 4.0 * scale, u32(color))
        tip(doc)

    def field(self) -> float:
        """Move the cursor to the field of the row; returns its width."""
        imgui.same_line(0.0, self.gap)
        return self.field_width

    def indent(self) -> None:
        """Move the cursor to the left edge of fields, on a new line."""
        imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + self.name_width + self.gap)

    def record(self, key: str) -> None:
        """Record the place of a row's field: that of the last item."""
        self.context.places[f"field {key}"] = item_rect()

    def draw_heading(self, text: str) -> None:
        """Draw the title of a section."""
        imgui.spacing()
        with font(self.context, "bold", SMALL):
            rect = place(self.width, imgui.get_text_line_height() * 1.3)
            imgui.dummy((self.width, rect[3] - rect[1]))
            used = write(rect, text, mix(self.palette.dim, self.palette.text, 0.35))
        middle = (rect[1] + rect[3]) * 0.5
        imgui.get_window_draw_list().add_line(
            (rect[0] + used + self.gap, middle), (rect[2], middle), u32(self.palette.raised), ui_scale()
        )

    def fold(self, text: str, key: str, *, is_open: bool) -> bool:
        """Draw the title of a section that a click folds and unfolds; True if it is open, as `is_open` says at first.

        A section that begins open and one that begins folded remember their states apart.
        """
        imgui.spacing()
        flags = int(imgui.TreeNodeFlags_.no_tree_push_on_open) | int(imgui.TreeNodeFlags_.span_avail_width)
        flags |= int(imgui.TreeNodeFlags_.default_open) if is_open else 0
        imgui.push_style_color(imgui.Col_.text, vec4(mix(self.palette.dim, self.palette.text, 0.35)))
        with font(self.context, "bold", SMALL):
            opened = imgui.tree_node_ex(make_label(text, f"{key} {is_open}"), flags)
        imgui.pop_style_color()
        self.context.places[f"fold {key}"] = item_rect()
        return opened

    def note(self, text: str, color: RGB | None = None, *, icon: str = "") -> None:
        """Draw a sentence over the whole width."""
        draw_wrapped(color or self.palette.dim, f"{icon}  {text}" if icon else text)

    def field_note(self, text: str, color: RGB | None = None) -> None:
        """Draw a sentence below a field."""
        self.indent()
        with font(self.context, "text", SMALL):
            draw_wrapped(color or self.palette.dim, text)

    def icon(self, glyph: str, key: str, doc: str, *, lit: bool = False, enabled: bool = True) -> bool:
        """Draw a quiet square button; True if it was clicked."""
        return quiet_button(self.context, glyph, f"button {key}", doc, lit=lit, enabled=enabled)

    def chip(self, text: str, key: str, width: float, color: RGB, doc: str) -> bool:
        """Draw a link as a button of a width; True if it was clicked."""
        rect = place(width)
        pressed = imgui.invisible_button(f"##chip {key}", (rect[2] - rect[0], rect[3] - rect[1]))
        hovered, pad, lines = imgui.is_item_hovered(), imgui.get_style().frame_padding.x, imgui.get_window_draw_list()
        fill = mix(self.palette.panel, color, 0.35 if hovered else 0.2)
        lines.add_rect_filled(rect[:2], rect[2:], u32(fill), imgui.get_style().frame_rounding)
        write((rect[0] + pad, rect[1], rect[2] - pad, rect[3]), text, self.palette.text)
        self.context.places[f"chip {key}"] = rect
        tip(doc)
        return pressed

    def wide_button(self, label: str, key: str, doc: str = "") -> bool:
        """Draw a button over the whole width; True if it was clicked."""
        pressed = imgui.button(make_label(label, key), (self.width, 0.0))
        self.context.places[f"button {key}"] = item_rect()
        tip(doc)
        return pressed
