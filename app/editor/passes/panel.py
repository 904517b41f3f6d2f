"""The Passes panel."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...authoring.edits.element_id import ElementId
from ...language.translation import translate
from ..theme.style import u32, ui_scale, vec4
from ..toolkit.buttons import outline
from ..toolkit.places import record
from ..toolkit.textures import Textures, fit_picture
from ..toolkit.words import SMALL, draw_empty_panel, draw_wrapped, font, tip

if TYPE_CHECKING:
    from ...authoring.preview.pass_pictures import PassPicture
    from .context import PassesContext

_CARD, _HEIGHT = 300.0, 92.0
"""A card is so high, and at least so wide: a picture with four short lines beside it."""


class PassesPanel:
    """The passes in their order, as cards: below each other, or in columns where the panel is wide."""

    def __init__(self, context: PassesContext) -> None:
        self._context = context
        self._textures = Textures()
        self._revision = 0
        self._scrolled_to = ("", 0)

    def close(self) -> None:
        """Release textures."""
        self._textures.clear()

    def draw(self) -> None:
        """Draw into the current window."""
        pictures = self._context.pictures
        pictures.is_shown = True
        if pictures.revision != self._revision:
            self._revision = pictures.revision
            self._textures.clear()
        if not pictures.passes:
            sentence = pictures.fault or translate("Passes of what the viewer shows appear here.")
            draw_empty_panel(self._context, icons.ICON_FA_LAYER_GROUP, translate("No passes"), sentence)
            return
        room, gap = imgui.get_content_region_avail().x, imgui.get_style().item_spacing.x
        columns = max(int((room + gap) // (_CARD * ui_scale() + gap)), 1)
        width = (room - gap * (columns - 1)) / columns
        for index, entry in enumerate(pictures.passes):
            if index % columns:
                imgui.same_line()
            self._draw_card(index, entry, width)

    def _draw_card(self, index: int, entry: PassPicture, width: float) -> None:
        scale, palette = ui_scale(), self._context.palette
        pad, size = 6.0 * scale, ImVec2(width, _HEIGHT * scale)
        start = imgui.get_cursor_pos()
        imgui.set_next_item_allow_overlap()
        if imgui.invisible_button(f"##pass{index}", size, int(imgui.ButtonFlags_.enable_nav)):
            self._select_nodes(entry)
        record(self._context, f"pass {entry.number}" if entry.number else f"file {entry.nodes[0]}")
        tip(self._describe(entry))
        low, high, lines = imgui.get_item_rect_min(), imgui.get_item_rect_max(), imgui.get_window_draw_list()
        color = palette.hover if imgui.is_item_hovered() else palette.raised
        lines.add_rect_filled(low, high, u32(color), imgui.get_style().frame_rounding)
        if self._context.pictures.marked in entry.functions:
            outline(palette.accent)
            self._scroll_once()
        after = imgui.get_cursor_pos()
        if imgui.is_item_visible():
            codes = entry.picture.codes
            box = min(0.42 * width, 132.0 * scale)
            across, down = fit_picture(codes, box, size.y - 2 * pad)
            corner = low + ImVec2(pad + (box - across) / 2, (size.y - down) / 2)
            lines.add_image(self._textures.get(index, lambda: codes), corner, corner + ImVec2(across, down))
            imgui.set_cursor_pos(ImVec2(start.x + box + 2 * pad, start.y + pad))
            self._draw_words(index, entry, width - box - 3 * pad, size.y - 2 * pad)
        imgui.set_cursor_pos(after)
        imgui.dummy(ImVec2(0, 0))

    def _scroll_once(self) -> None:
        """Bring the first marked pass into view: again only when others are marked, or other passes have run."""
        target = self._context.pictures.marked, self._revision
        if target != self._scrolled_to:
            self._scrolled_to = target
            imgui.set_scroll_here_y(0.5)

    def _draw_words(self, index: int, entry: PassPicture, width: float, height: float) -> None:
        palette = self._context.palette
        imgui.begin_child(
            f"words{index}",
            ImVec2(width, height),
            window_flags=int(imgui.WindowFlags_.no_inputs) | int(imgui.WindowFlags_.no_scrollbar),
        )
        with font(self._context, "bold"):
            title = ", ".join(entry.functions or entry.nodes)
            imgui.text_colored(vec4(palette.text), f"{entry.number}  {title}" if entry.number else title)
        with font(self._context, "text", SMALL):
            draw_wrapped(
                palette.text, translate("reads {sources}", sources=", ".join(entry.reads) or translate("nothing"))
            )
            draw_wrapped(palette.dim, translate("makes {makes}", makes=entry.makes) if entry.number else entry.makes)
            if time := self._find_time(entry):
                imgui.text_colored(vec4(palette.dim), time)
        imgui.end_child()

    def _find_time(self, entry: PassPicture) -> str:
        seconds = self._context.pictures.seconds
        return f"{1000.0 * seconds[entry.number - 1]:.2f} ms" if 0 < entry.number <= len(seconds) else ""

    def _describe(self, entry: PassPicture) -> str:
        """All that is known of a pass."""
        span = entry.picture.span
        parts = (
            translate("Pass {number}", number=entry.number) if entry.number else translate("Read from outside"),
            ", ".join(entry.nodes),
            ", ".join(entry.functions),
            translate("Reads {sources}", sources=", ".join(entry.reads)) if entry.reads else "",
            translate("Makes {makes}", makes=entry.makes),
            translate("{low:.4g} is black, {high:.4g} is white", low=span[0], high=span[1]) if span else "",
            self._find_time(entry),
        )
        return "\n".join(filter(None, parts))

    def _select_nodes(self, entry: PassPicture) -> None:
        session = self._context.session
        ids = [ElementId(node) for node in entry.nodes if node in session.graph.nodes]
        self._context.log.attempt(lambda: session.select(ids))
