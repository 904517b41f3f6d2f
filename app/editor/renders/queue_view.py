"""Draws the queue of renders: one block for each."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...authoring.flipbook import FlipbookStrip
from ...authoring.render_queue.queue import QueuedRender, RenderState
from ...language.translation import mark, translate
from ..theme.style import u32, ui_scale, vec4
from ..toolkit.buttons import align_right, quiet_button, width_of_buttons
from ..toolkit.labels import translate_label
from ..toolkit.places import record
from ..toolkit.textures import Textures, fit_picture
from ..toolkit.thumbnails import FileThumbnails
from ..toolkit.words import SMALL, cut_middle, draw_dim, draw_empty_panel, draw_wrapped, font, tip
from .folders import show_folder
from .wording import progress_text, state_text, title, under_way

if TYPE_CHECKING:
    from .context import RendersContext

_WIDTH, _HEIGHT = 92.0, 56.0
_PAUSE = 1.5
"""Seconds between two thumbnails of a running render: a choice, for decoding takes time."""

_COLORS: dict[RenderState, str] = {
    "done": "good",
    "failed": "error",
    "cancelled": "dim",
    "running": "text",
    "waiting": "dim",
}
_ICONS: dict[RenderState, str] = {
    "done": icons.ICON_FA_FILM,
    "failed": icons.ICON_FA_TRIANGLE_EXCLAMATION,
    "cancelled": icons.ICON_FA_BAN,
    "running": icons.ICON_FA_FILM,
    "waiting": icons.ICON_FA_HOURGLASS_HALF,
}


class _Button(NamedTuple):
    icon: str
    name: str
    doc: str
    act: Callable[[], object]
    lit: bool = False
    enabled: bool = True


class RenderQueueView:
    """The queue: running renders on top, then waiting ones, then ended ones, the last one first."""

    def __init__(self, context: RendersContext) -> None:
        self._context = context
        self._open: set[QueuedRender] = set()
        """The renders whose messages are shown."""
        self._pictures: FileThumbnails | None = None
        self._textures = Textures()
        self._seen: dict[QueuedRender, tuple[Path, float, float]] = {}
        """The file of each render's thumbnail, when it was written, and when it was chosen."""
        self._shown: dict[QueuedRender, tuple[Path, float]] = {}

    def close(self) -> None:
        """Release the thumbnails."""
        if self._pictures is not None:
            self._pictures.close()
        self._textures.clear()

    def draw(self) -> None:
        """Draw into the current window."""
        exports = self._context.exports
        if not exports.all:
            sentence = translate("Renders appear here. You can keep working while they run.")
            draw_empty_panel(self._context, icons.ICON_FA_FILM, translate("No renders yet"), sentence)
            return
        running, waiting = exports.running, exports.waiting
        ended = [render for render in exports.all if render not in running and render not in waiting]
        ended.sort(key=lambda render: -render.ended_at)
        imgui.align_text_to_frame_padding()
        counts = (
            (len(running), mark("{count} running")),
            (len(waiting), mark("{count} waiting")),
            (len(ended), mark("{count} ended")),
        )
        draw_dim(self._context, ", ".join(translate(words, count=count) for count, words in counts if count))
        align_right(f"{icons.ICON_FA_TRASH}  {translate('Clear')}")
        doc = translate("Remove renders that have ended from the list")
        if quiet_button(
            self._context, f"{icons.ICON_FA_TRASH}  {translate('Clear')}", "clear renders", doc, enabled=bool(ended)
        ):
            exports.clear()
        self._forget(exports.all)
        for index, export in enumerate((*running, *waiting, *ended)):
            imgui.push_id(index)
            if index:
                imgui.dummy((0, 2 * ui_scale()))
            self._draw_row(index, export, waiting.index(export) + len(running) if export in waiting else 0)
            imgui.pop_id()

    # --- one of them -------------------------------------------------------------------------------------------------

    def _draw_row(self, index: int, export: QueuedRender, position: int) -> None:
        scale, palette = ui_scale(), self._context.palette
        start = imgui.get_cursor_screen_pos()
        self._draw_picture(export, start)
        indent = (_WIDTH + 12) * scale
        imgui.indent(indent)
        self._draw_head(index, export, position)
        if export.state == "running":
            high = imgui.get_text_line_height() + 2 * scale
            imgui.progress_bar(export.fraction, ImVec2(-1, high), progress_text(export))
        else:
            words = state_text(export, position)
            imgui.text_colored(vec4(getattr(palette, _COLORS[export.state])), words[:1].upper() + words[1:])
        record(self._context, f"export {index}")
        with font(self._context, "text", SMALL):
            self._draw_details(export)
        if export.failure:
            draw_wrapped(palette.error, export.failure)
            record(self._context, f"export fault {index}")
        if export in self._open:
            for note in export.notes:
                draw_wrapped(palette.dim, note)
            record(self._context, f"export notes {index}")
        imgui.unindent(indent)
        low = start.y + _HEIGHT * scale
        if imgui.get_cursor_screen_pos().y < low:
            imgui.dummy((0, max(low - imgui.get_cursor_screen_pos().y - imgui.get_style().item_spacing.y, 0.0)))

    def _draw_head(self, index: int, export: QueuedRender, position: int) -> None:
        buttons = self._buttons(index, export, position)
        button_icons, spacing = [button.icon for button in buttons], 2 * ui_scale()
        imgui.align_text_to_frame_padding()
        with font(self._context, "bold"):
            room = imgui.get_content_region_avail().x - width_of_buttons(*button_icons) - 12 * ui_scale()
            imgui.text_unformatted(cut_middle(title(export), room))
        tip("\n".join(str(path) for _, path in export.destinations))
        imgui.push_style_var(imgui.StyleVar_.item_spacing, ImVec2(spacing, imgui.get_style().item_spacing.y))
        align_right(*button_icons)
        for place, button in enumerate(buttons):
            if place:
                imgui.same_line()
            label, lit, enabled = f"{button.name} {index}", button.lit, button.enabled
            if quiet_button(self._context, button.icon, label, button.doc, lit=lit, enabled=enabled):
                self._context.log.attempt(button.act)
        imgui.pop_style_var()
        self._draw_compare_menu(index, export)

    def _buttons(self, index: int, export: QueuedRender, position: int) -> list[_Button]:
        """The buttons of a row, from left to right; its right border is where they are lined up.

        What comes or goes is left of what stays: none moves from under the mouse while a render goes on.
        """
        exports, over, buttons = self._context.exports, export.state not in ("running", "waiting"), list[_Button]()
        if export.state == "waiting" and position > len(exports.running):
            sooner = partial(exports.move, export, -1)
            buttons.append(_Button(icons.ICON_FA_ARROW_UP, "earlier", translate("Move up"), sooner))
        if export.state in ("failed", "cancelled"):
            again = translate("Continue: frames that are up to date are skipped")
            doc = again if export.done else translate("Try again")
            buttons.append(_Button(icons.ICON_FA_ROTATE_RIGHT, "again", doc, partial(exports.resume, export)))
        if export.notes:
            toggle, lit = partial(self._toggle_notes, export), export in self._open
            buttons.append(_Button(icons.ICON_FA_LIST_UL, "notes", translate("Show messages"), toggle, lit))
        if export.state != "waiting" and not export.has_many_files:  # many files are no sequence
            buttons.extend(self._make_play_buttons(index, export))
        buttons.append(self._make_copy_button(export) if over else _make_cancel_button(export))
        doc, show = translate("Show {folder}", folder=export.folder), partial(_open, self._context, export.folder)
        return [*buttons, _Button(icons.ICON_FA_FOLDER_OPEN, "open folder", doc, show)]

    def _make_copy_button(self, export: QueuedRender) -> _Button:
        written = export.has_many_files and export.written_files
        path = written[-1] if written else export.destinations[0][1]
        copy = partial(self._context.clipboard.put, str(path))
        return _Button(icons.ICON_FA_COPY, "copy path", translate("Copy the path"), copy)

    def _make_play_buttons(self, index: int, export: QueuedRender) -> tuple[_Button, _Button]:
        doc, begun = translate("Compare it with another version, in the viewer"), bool(export.written_files)
        choose, play = partial(imgui.open_popup, f"compare {index}"), partial(_play, self._context, export)
        return (
            _Button(icons.ICON_FA_TABLE_COLUMNS, "compare", doc, choose, enabled=begun),
            _Button(icons.ICON_FA_PLAY, "play", translate("Play it in the viewer"), play, enabled=begun),
        )

    def _draw_compare_menu(self, index: int, export: QueuedRender) -> None:
        """Draw the menu of renders to compare with."""
        if not imgui.begin_popup(f"compare {index}"):
            return
        candidates = [
            render
            for render in self._context.exports.all
            if render is not export and render.written_files and not render.has_many_files
        ]
        for place, candidate in enumerate(candidates):
            path = candidate.destinations[0][1]
            name = f"{path.parent.name}/{title(candidate)}" if title(candidate) == title(export) else title(candidate)
            left, wide = imgui.get_cursor_pos_x(), imgui.calc_text_size(name).x
            if imgui.selectable(f"##{place}", False, 0, ImVec2(wide, 0))[0]:
                self._context.log.attempt(partial(_compare, self._context, export, candidate))
            record(self._context, f"compare with {place}")
            tip(str(path))
            imgui.same_line(left)
            imgui.text_unformatted(name)
        if candidates:
            imgui.separator()
        if imgui.menu_item(translate_label("Other pictures..."), "", False)[0]:
            self._context.log.attempt(partial(_choose, self._context, export))
        record(self._context, "compare with other")
        imgui.end_popup()

    def _draw_details(self, export: QueuedRender) -> None:
        """Draw what is computed now, and the last written file."""
        last = export.written_files[-1] if export.written_files else None
        parts = [under_way(export)] if export.state == "running" else [str(export.folder)]
        if last is not None and export.state == "running":
            parts.append(translate("last: {name}", name=last.name))
        draw_dim(self._context, cut_middle("   ".join(parts), imgui.get_content_region_avail().x))
        tip(f"{last}" if last is not None else "")

    # --- small pictures ----------------------------------------------------------------------------------------------

    def _draw_picture(self, export: QueuedRender, start: ImVec2) -> None:
        """Draw a thumbnail of the last written file, or an icon.

        The picture before it stays until the new one is read, or the row would flicker with every frame that is done.
        """
        scale, palette, lines = ui_scale(), self._context.palette, imgui.get_window_draw_list()
        width, height = _WIDTH * scale, _HEIGHT * scale
        corner = ImVec2(start.x + width, start.y + height)
        lines.add_rect_filled(start, corner, u32(palette.field), 4 * scale)
        chosen = self._choose_picture(export)
        if chosen is not None:
            if self._pictures is None:
                self._pictures = FileThumbnails(
                    self._context.store.file.parent / "thumbnails", self._context.session.sandbox
                )
            pixels_or_fault = self._pictures.get(*chosen)
            if pixels_or_fault is not None and not isinstance(pixels_or_fault, str):
                self._shown[export] = chosen
        displayed = self._shown.get(export)
        pixels = self._pictures.get(*displayed) if self._pictures is not None and displayed is not None else None
        if displayed is None or pixels is None or isinstance(pixels, str):
            size = 20 * scale
            middle = start.x + (width - size) / 2, start.y + (height - size) / 2
            face = self._context.fonts.text if self._context.fonts else imgui.get_font()
            lines.add_text(face, size, middle, u32(palette.dim, 0.6), _ICONS[export.state])
            return
        across, down = fit_picture(pixels, width, height)
        left, top = start.x + (width - across) / 2, start.y + (height - down) / 2
        texture = self._textures.get(displayed, lambda: pixels)
        lines.add_image_rounded(
            texture, (left, top), (left + across, top + down), (0, 0), (1, 1), u32((1.0, 1.0, 1.0)), 4 * scale
        )

    def _choose_picture(self, export: QueuedRender) -> tuple[Path, float] | None:
        """The file to show as a thumbnail; a new one only every `_PAUSE` seconds, for decoding takes time."""
        if not export.written_files:
            return None
        path, time_now, before = export.written_files[-1], imgui.get_time(), self._seen.get(export)
        late = before is None or time_now - before[2] > _PAUSE or export.state != "running"
        if late and (before is None or before[0] != path):
            try:
                self._seen[export] = path, os.stat(path).st_mtime, time_now  # noqa: PTH116
            except OSError:
                return None
        choice = self._seen.get(export)
        return choice and choice[:2]

    def _forget(self, renders: tuple[QueuedRender, ...]) -> None:
        for remembered in (self._seen, self._shown):
            for export in [render for render in remembered if render not in renders]:
                del remembered[export]
        self._open.intersection_update(renders)

    def _toggle_notes(self, export: QueuedRender) -> None:
        self._open ^= {export}


def _make_cancel_button(export: QueuedRender) -> _Button:
    doc = (
        translate("Remove it from the queue")
        if export.state == "waiting"
        else translate("Stop it. Finished frames are kept.")
    )
    return _Button(icons.ICON_FA_XMARK, "cancel", doc, export.cancel)


def _play(context: RendersContext, export: QueuedRender) -> None:
    context.flipbooks.open(FlipbookStrip.from_render(export))


def _compare(context: RendersContext, first: QueuedRender, second: QueuedRender) -> None:
    context.flipbooks.open(FlipbookStrip.from_render(first), FlipbookStrip.from_render(second))


def _choose(context: RendersContext, export: QueuedRender) -> None:
    context.flipbooks.choose(FlipbookStrip.from_render(export))


def _open(context: RendersContext, folder: Path) -> None:
    if not show_folder(folder):
        context.clipboard.put(str(folder))
        context.log.add(
            translate("{folder}: no program on this machine shows folders; the path is on the clipboard", folder=folder)
        )
