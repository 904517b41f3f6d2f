"""Files as a table and as a grid of thumbnails; only visible items are drawn."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ..theme.style import u32, ui_scale
from ..toolkit.buttons import outline
from ..toolkit.labels import make_label, translate_label
from ..toolkit.places import record
from ..toolkit.textures import Textures, fit_picture
from ..toolkit.thumbnails import FileThumbnails
from ..toolkit.words import cut_middle, draw_dim, show_tip, tip
from .browsing import Browsing, size_text, time_text
from .listing import Item, Order

if TYPE_CHECKING:
    from .context import BrowserContext

_ORDERS: tuple[Order, ...] = ("name", "size", "time")
_CELL, _PICTURE = (168.0, 128.0), (152.0, 88.0)


class FileTable:
    """Name, size and date; a click on a header sorts."""

    columns = 1

    def __init__(self, context: BrowserContext) -> None:
        self._context = context
        self.reveal = False

    def draw(self, browsing: Browsing) -> bool:
        """True if an item was double-clicked."""
        flags = int(imgui.TableFlags_.sortable) | int(imgui.TableFlags_.scroll_y) | int(imgui.TableFlags_.row_bg)
        if not imgui.begin_table("table", 3, flags):
            return False
        scale, fixed = ui_scale(), imgui.TableColumnFlags_.width_fixed.value
        imgui.table_setup_scroll_freeze(0, 1)
        imgui.table_setup_column(translate_label("Name"), imgui.TableColumnFlags_.width_stretch.value)
        imgui.table_setup_column(translate_label("Size"), fixed, 84 * scale)
        imgui.table_setup_column(translate_label("Changed"), fixed, 136 * scale)
        imgui.table_headers_row()
        _sort(browsing)
        items, double_clicked = browsing.items, False
        clipper = imgui.ListClipper()
        clipper.begin(len(items))
        if self.reveal:
            clipper.include_item_by_index(browsing.chosen)
        while clipper.step():
            for index in range(clipper.display_start, clipper.display_end):
                imgui.table_next_row()
                double_clicked = self._draw_row(browsing, index, items[index]) or double_clicked
        clipper.end()
        imgui.end_table()
        return double_clicked

    def _draw_row(self, browsing: Browsing, index: int, item: Item) -> bool:
        imgui.table_next_column()
        icon = icons.ICON_FA_FOLDER if item.is_folder else _icon(item.name)
        flags = int(imgui.SelectableFlags_.span_all_columns) | int(imgui.SelectableFlags_.allow_double_click)
        room = imgui.get_content_region_avail().x - 26 * ui_scale()
        chosen = index == browsing.chosen
        double_clicked = False
        if imgui.selectable(make_label(f"{icon}  {cut_middle(item.name, room)}", str(index)), chosen, flags)[0]:
            browsing.choose(index)
            double_clicked = imgui.is_mouse_double_clicked(imgui.MouseButton_.left)
        record(self._context, f"file {item.name}")
        if chosen and self.reveal:
            imgui.internal.scroll_to_item()
            self.reveal = False
        imgui.table_next_column()
        draw_dim(self._context, "" if item.is_folder else size_text(item.size))
        imgui.table_next_column()
        draw_dim(self._context, time_text(item.time))
        return double_clicked


class FileGrid:
    """A grid of thumbnails with names; visible ones are decoded in a thread."""

    def __init__(self, context: BrowserContext) -> None:
        self._context = context
        self.reveal = False
        self.columns = 1
        self._pictures: FileThumbnails | None = None
        self._textures = Textures()

    def close(self) -> None:
        """Stop the decoding and release textures."""
        if self._pictures:
            self._pictures.close()
        self._textures.clear()

    def draw(self, browsing: Browsing) -> bool:
        """True if an item was double-clicked."""
        if self._pictures is None:
            self._pictures = FileThumbnails(
                self._context.store.file.parent / "thumbnails", self._context.session.sandbox
            )
        scale, items, double_clicked = ui_scale(), browsing.items, False
        self.columns = max(int((imgui.get_content_region_avail().x - 16 * scale) / (_CELL[0] * scale)), 1)
        imgui.begin_child("grid")
        clipper = imgui.ListClipper()
        clipper.begin(-(-len(items) // self.columns), _CELL[1] * scale)
        if self.reveal:
            clipper.include_item_by_index(browsing.chosen // self.columns)
        start = imgui.get_cursor_pos() + ImVec2(4 * scale, 4 * scale)
        while clipper.step():
            for row in range(clipper.display_start, clipper.display_end):
                for index in range(row * self.columns, min((row + 1) * self.columns, len(items))):
                    corner = ((index % self.columns) * _CELL[0], row * _CELL[1])
                    imgui.set_cursor_pos(ImVec2(start.x + corner[0] * scale, start.y + corner[1] * scale))
                    double_clicked = self._draw_cell(browsing, index, items[index], self._pictures) or double_clicked
        clipper.end()
        imgui.end_child()
        return double_clicked

    def _draw_cell(self, browsing: Browsing, index: int, item: Item, pictures: FileThumbnails) -> bool:
        scale, palette = ui_scale(), self._context.palette
        chosen = index == browsing.chosen
        size = ImVec2((_CELL[0] - 6) * scale, (_CELL[1] - 6) * scale)
        imgui.push_id(index)
        flags = int(imgui.SelectableFlags_.allow_double_click)
        clicked, _ = imgui.selectable("##cell", chosen, flags, size)
        record(self._context, f"file {item.name}")
        tip(f"{item.name}\n{size_text(item.size)}, {time_text(item.time)}")
        if chosen:
            outline(palette.accent)
            if self.reveal:
                imgui.internal.scroll_to_item()
                self.reveal = False
        low = imgui.get_item_rect_min()
        self._draw_picture(browsing.listing.folder / item.name, item, low, pictures)
        lines = imgui.get_window_draw_list()
        name = cut_middle(item.name, _PICTURE[0] * scale)
        left = low.x + (size.x - imgui.calc_text_size(name).x) / 2
        lines.add_text(ImVec2(left, low.y + (_PICTURE[1] + 10) * scale), u32(palette.text), name)
        imgui.pop_id()
        if clicked:
            browsing.choose(index)
        return clicked and imgui.is_mouse_double_clicked(imgui.MouseButton_.left)

    def _draw_picture(self, path: Path, item: Item, low: ImVec2, pictures: FileThumbnails) -> None:
        scale, palette, lines = ui_scale(), self._context.palette, imgui.get_window_draw_list()
        left, top = low.x + 5 * scale, low.y + 5 * scale
        width, height = _PICTURE[0] * scale, _PICTURE[1] * scale
        pixels = None if item.is_folder else pictures.get(path, item.time)
        if pixels is not None and not isinstance(pixels, str):
            across, down = fit_picture(pixels, width, height)
            corner = ImVec2(left + (width - across) / 2, top + (height - down) / 2)
            texture = self._textures.get((path, item.time), lambda: pixels)
            lines.add_image(texture, corner, ImVec2(corner.x + across, corner.y + down))
            return
        broken = isinstance(pixels, str)
        icon = icons.ICON_FA_FOLDER if item.is_folder else icons.ICON_FA_BAN if broken else icons.ICON_FA_IMAGE
        size = 34 * scale
        color = palette.error if broken else palette.dim
        font = self._context.fonts.text if self._context.fonts else imgui.get_font()
        corner = ImVec2(left + (width - size) / 2, top + (height - size) / 2)
        lines.add_text(font, size, corner, u32(color, 0.7), icon)
        if broken and imgui.is_item_hovered():
            show_tip(str(pixels))


def _sort(browsing: Browsing) -> None:
    """Sort as the user asked by a click on a header."""
    specs = imgui.table_get_sort_specs()
    if specs is not None and specs.specs_dirty and specs.specs_count:
        first = specs.get_specs(0)
        browsing.order = _ORDERS[first.column_index]
        browsing.down = first.get_sort_direction() == imgui.SortDirection.descending
        specs.specs_dirty = False


def _icon(name: str) -> str:
    return icons.ICON_FA_DIAGRAM_PROJECT if name.lower().endswith(".json") else icons.ICON_FA_IMAGE
