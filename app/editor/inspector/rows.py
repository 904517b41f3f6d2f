"""The two columns of the panel: names at the left, fields at the right."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ..theme.palette import RGB
from ..theme.style import EM, mix, u32, ui_scale, vec4
from .drawing import Rect, item_rect, place, write

if TYPE_CHECKING:
    from ..editor import Editor
    from .fields import Fields


class Rows:
    """Where names and fields go in this frame."""

    def __init__(self, editor: Editor, fields: Fields) -> None:
        self.editor, self.fields, self.palette = editor, fields, editor.palette
        self.gap = imgui.get_style().item_inner_spacing.x
        width = imgui.get_content_region_avail().x
        self.width = width
        self._acts: list[Callable[[], object]] = []
        self.fit(())

    def act(self, act: Callable[[], object]) -> None:
        """Do something once everything is drawn: until then the document stays as it is."""
        self._acts.append(act)

    def finish(self) -> None:
        """Do what was asked for."""
        for act in self._acts:
            self.editor.attempt(act)

    def inset(self) -> Rows:
        """Rows for what is left of the width after an indent."""
        inner = Rows(self.editor, self.fields)
        inner._acts = self._acts
        return inner

    def fit(self, labels: Iterable[str], least: float = 0.3) -> None:
        """Make the left column as wide as these names ask for: from a `least` part up to half of the panel."""
        scale = ui_scale()
        longest = max((imgui.calc_text_size(label.replace("_", " ")).x for label in labels), default=42.0 * scale)
        wanted = max(self.width * least, longest + 22.0 * scale)
        self.name_width = min(wanted, self.width * 0.48, 170.0 * scale)
        self.field_width = max(self.width - self.name_width - self.gap, 1.0)

    def name(self, key: str, label: str, *, tip: str = "", changed: bool = False, color: RGB | None = None) -> None:
        """The name of a row, as the last item; the field comes next, on the same line."""
        rect = place(self.name_width)
        imgui.invisible_button(f"##name {key}", (self.name_width, rect[3] - rect[1]))
        self.editor.places[f"name {key}"] = rect
        hovered, palette, scale = imgui.is_item_hovered(), self.palette, ui_scale()
        if changed:
            center = rect[0] + 3.0 * scale, (rect[1] + rect[3]) * 0.5
            imgui.get_window_draw_list().add_circle_filled(center, 2.5 * scale, u32(palette.accent))
        ink = palette.text if changed or hovered else palette.dim
        box = (rect[0] + 9.0 * scale, rect[1], rect[2], rect[3])
        width = write(box, label.replace("_", " "), ink, align=1.0)
        if color:
            dot = max(rect[2] - width - 9.0 * scale, rect[0] + 4.0 * scale)
            imgui.get_window_draw_list().add_circle_filled((dot, (rect[1] + rect[3]) * 0.5), 4.0 * scale, u32(color))
        self.tooltip(tip)

    def field(self) -> float:
        """Go on to the field of the row; its width."""
        imgui.same_line(0.0, self.gap)
        return self.field_width

    def indent(self) -> None:
        """Go to where fields begin, on a line of its own."""
        imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + self.name_width + self.gap)

    def record(self, key: str) -> None:
        """Note where the field of a row is: the last item."""
        self.editor.places[f"field {key}"] = item_rect()

    def tooltip(self, text: str) -> None:
        """A tooltip of the last item, as many lines as it needs."""
        if text and imgui.begin_item_tooltip():
            imgui.push_text_wrap_pos(imgui.get_font_size() * 22)
            imgui.text_unformatted(text)
            imgui.pop_text_wrap_pos()
            imgui.end_tooltip()

    def heading(self, text: str) -> None:
        """The title of a section."""
        imgui.spacing()
        with font(self.editor, "bold", EM * 0.86):
            rect = place(self.width, imgui.get_text_line_height() * 1.3)
            imgui.dummy((self.width, rect[3] - rect[1]))
            used = write(rect, text, mix(self.palette.dim, self.palette.text, 0.35))
        middle = (rect[1] + rect[3]) * 0.5
        imgui.get_window_draw_list().add_line(
            (rect[0] + used + self.gap, middle), (rect[2], middle), u32(self.palette.raised), ui_scale()
        )

    def note(self, text: str, color: RGB | None = None, *, icon: str = "") -> None:
        """A sentence over the whole width."""
        imgui.push_style_color(imgui.Col_.text, vec4(color or self.palette.dim))
        imgui.text_wrapped(f"{icon}  {text}" if icon else text)
        imgui.pop_style_color()

    def field_note(self, text: str, color: RGB | None = None) -> None:
        """A sentence below a field."""
        self.indent()
        with font(self.editor, "text", EM * 0.86):
            imgui.push_text_wrap_pos(0.0)
            imgui.text_colored(vec4(color or self.palette.dim), text)
            imgui.pop_text_wrap_pos()

    def icon(self, glyph: str, key: str, tip: str, *, lit: bool = False, enabled: bool = True) -> bool:
        """A quiet square button."""
        side = imgui.get_frame_height()
        imgui.push_style_color(imgui.Col_.button, vec4(self.palette.accent, 0.2 if lit else 0.0))
        imgui.push_style_color(imgui.Col_.text, vec4(self.palette.accent if lit else self.palette.text))
        imgui.push_style_var(imgui.StyleVar_.frame_padding, (0.0, imgui.get_style().frame_padding.y))
        imgui.begin_disabled(not enabled)
        pressed = imgui.button(f"{glyph}##{key}", (side, side))
        imgui.end_disabled()
        imgui.pop_style_var()
        imgui.pop_style_color(2)
        self.editor.places[f"button {key}"] = item_rect()
        self.tooltip(tip)
        return pressed

    def chip(self, text: str, key: str, width: float, color: RGB, tip: str) -> bool:
        """A link or the like, as a button cut to a width."""
        rect = place(width)
        pressed = imgui.invisible_button(f"##chip {key}", (rect[2] - rect[0], rect[3] - rect[1]))
        hovered, pad, lines = imgui.is_item_hovered(), imgui.get_style().frame_padding.x, imgui.get_window_draw_list()
        fill = mix(self.palette.panel, color, 0.35 if hovered else 0.2)
        lines.add_rect_filled(rect[:2], rect[2:], u32(fill), imgui.get_style().frame_rounding)
        write((rect[0] + pad, rect[1], rect[2] - pad, rect[3]), text, self.palette.text)
        self.editor.places[f"chip {key}"] = rect
        self.tooltip(tip)
        return pressed

    def wide_button(self, label: str, key: str, tip: str = "") -> bool:
        """A button over the whole width."""
        pressed = imgui.button(f"{label}##{key}", (self.width, 0.0))
        self.editor.places[f"button {key}"] = item_rect()
        self.tooltip(tip)
        return pressed


@contextmanager
def font(editor: Editor, name: str, size: float = EM) -> Iterator[None]:
    """Text in another font; `size` in pixels at scale 1."""
    imgui.push_font(getattr(editor.fonts, name, None), size)
    try:
        yield
    finally:
        imgui.pop_font()


ARROW = icons.ICON_FA_ARROW_LEFT


def union(first: Rect, second: Rect) -> Rect:
    """The rectangle around two."""
    return min(first[0], second[0]), min(first[1], second[1]), max(first[2], second[2]), max(first[3], second[3])
