"""The recent documents of the start screen, with pictures of what the viewer showed when they were saved."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from halation.presets import picture
from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...authoring.preferences import Recent
from ...errors import HalationError
from ...language.translation import translate
from ...media.pictures.thumbnail import load_thumbnail
from ...resources.sandbox import UNRESTRICTED
from ..theme.style import mix, u32, ui_scale, vec4
from ..toolkit.buttons import quiet_button
from ..toolkit.places import record
from ..toolkit.textures import Textures, fit_picture
from ..toolkit.words import cut_middle, draw_dim, font, tip

if TYPE_CHECKING:
    from ...color.transforms import Array
    from .context import StartContext

_PICTURE = 72.0, 40.0


class RecentList:
    """Documents that were open, newest first."""

    def __init__(self, context: StartContext) -> None:
        self._context = context
        self._textures = Textures()
        self._exists: dict[str, bool] = {}
        self._pixels: dict[str, Array | None] = {}

    def begin(self) -> None:
        """Look which files are there."""
        self._textures.clear()
        recent_files = self._context.store.current.recent
        self._exists = {recent.path: recent.exists for recent in recent_files}
        self._pixels = {recent.path: self._load_picture(recent.path) for recent in recent_files}

    def _load_picture(self, path: str) -> Array | None:
        """What the viewer showed when a document was saved; for a preset that never was, its own picture."""
        candidates = self._context.documents.pictures.find(path), picture(Path(path))
        return next((_load(candidate) for candidate in candidates if candidate.is_file()), None)

    def close(self) -> None:
        """Release textures."""
        self._textures.clear()

    def draw(self) -> None:
        """Draw the list."""
        imgui.dummy(ImVec2(0, 4 * ui_scale()))
        with font(self._context, "bold"):
            imgui.text_unformatted(translate("Recent"))
        if not self._context.store.current.recent:
            draw_dim(self._context, translate("Files that you open appear here."))
        for index, recent in enumerate(self._context.store.current.recent):
            imgui.push_id(index)
            self._draw_row(index, recent)
            imgui.pop_id()

    def _draw_row(self, index: int, recent: Recent) -> None:
        """Draw one file: first a row that takes clicks, then the text and the button over it, from the same corner.

        The empty item at the end tells the interface library that the cursor was moved on purpose.
        """
        scale, path, there = ui_scale(), Path(recent.path), self._exists.get(recent.path, True)
        line = imgui.get_text_line_height()
        indent = (_PICTURE[0] + 12) * scale
        room = imgui.get_content_region_avail().x - 30 * scale - indent
        start = imgui.get_cursor_pos()
        imgui.set_next_item_allow_overlap()
        clicked, _ = imgui.selectable("##recent", False, 0, ImVec2(0, 2 * line + 8 * scale))
        record(self._context, f"recent {index}")
        tip(str(path) if there else translate("{path}\nThis file no longer exists.", path=path))
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        over = imgui.is_mouse_hovering_rect(low, high)
        after = imgui.get_cursor_pos()
        self._draw_picture(recent, ImVec2(low.x + 4 * scale, (low.y + high.y - _PICTURE[1] * scale) / 2))
        imgui.set_cursor_pos(ImVec2(start.x + indent, start.y + 2 * scale))
        faint = mix(self._context.palette.dim, self._context.palette.panel, 0.4)
        imgui.text_colored(vec4(self._context.palette.text if there else faint), cut_middle(path.stem, room))
        imgui.set_cursor_pos(ImVec2(start.x + indent, start.y + line + 5 * scale))
        imgui.text_colored(vec4(self._context.palette.dim if there else faint), cut_middle(str(path.parent), room))
        if over:
            imgui.set_cursor_pos(ImVec2(start.x + indent + room + 2 * scale, start.y + 6 * scale))
            if quiet_button(
                self._context, icons.ICON_FA_XMARK, f"forget {index}", translate("Remove it from this list")
            ):
                self._context.store.forget(recent.path)
                clicked = False
        imgui.set_cursor_pos(after)
        imgui.dummy(ImVec2(0, 0))
        if clicked and there:
            self._context.documents.open_graph(path)
        elif clicked:
            self._context.log.add(
                translate("{path}: this file no longer exists; restore it, or remove it from the list", path=path),
                "warning",
            )

    def _draw_picture(self, recent: Recent, corner: ImVec2) -> None:
        """Draw the picture of a document in its box, or an empty box."""
        scale, lines = ui_scale(), imgui.get_window_draw_list()
        width, height = _PICTURE[0] * scale, _PICTURE[1] * scale
        lines.add_rect_filled(corner, corner + ImVec2(width, height), u32(self._context.palette.raised), 3 * scale)
        pixels = self._pixels.get(recent.path)
        if pixels is None:
            return
        across, down = fit_picture(pixels, width, height)
        low = corner + ImVec2((width - across) / 2, (height - down) / 2)
        lines.add_image(self._textures.get(recent.path, lambda: pixels), low, low + ImVec2(across, down))


def _load(path: Path) -> Array | None:
    """The picture of a document; None if the file is damaged: the next save replaces it."""
    try:
        return load_thumbnail(path, sandbox=UNRESTRICTED)
    except HalationError:
        return None
