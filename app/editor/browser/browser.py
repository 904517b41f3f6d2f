"""Choosing a file without leaving the window."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ..shared.dialogs import Question
from ..theme.style import ui_scale
from ..toolkit.buttons import align_right, main_button, quiet_button, width_of_buttons
from ..toolkit.dialogs import backdrop, dialog, escape_pressed
from ..toolkit.places import record
from ..toolkit.words import cut_middle, draw_dim, draw_wrapped, font, tip
from .browsing import Browsing, begin_browsing
from .file_list import FileGrid, FileTable
from .listing import make_folder
from .places import PlaceKind, complete_path

if TYPE_CHECKING:
    from .context import BrowserContext

PLACE_ICONS: dict[PlaceKind, str] = {
    "home": icons.ICON_FA_HOUSE,
    "document": icons.ICON_FA_DIAGRAM_PROJECT,
    "folder": icons.ICON_FA_FOLDER,
    "recent": icons.ICON_FA_CLOCK_ROTATE_LEFT,
    "drive": icons.ICON_FA_HARD_DRIVE,
}


class FileBrowser:
    """Places, a path that can be typed, a list or a grid; letters filter, arrows choose, Enter opens, Escape closes."""

    def __init__(self, context: BrowserContext) -> None:
        self._context = context
        self._now: Browsing | None = None
        self._table, self._grid = FileTable(context), FileGrid(context)
        self._as_grid = True
        self._path = ""
        self._new = ""
        self._naming = False
        self._focus = ""
        self._elsewhere = False

    def close(self) -> None:
        """End what runs beside the window."""
        self._grid.close()

    def draw(self) -> None:
        """Draw over everything, if a file is wanted."""
        browse = self._context.dialogs.browse
        if browse is None:
            self._now = None
            return
        if self._now is None or self._now.browse is not browse:
            self._now, self._naming, self._focus = begin_browsing(self._context, browse), False, "field"
            self._path = str(self._now.folder)
        now = self._now
        now.poll()
        backdrop(self._context, "files")
        with dialog(self._context, "Files", (940, 620)):
            self._top(now)
            foot = 2 * imgui.get_frame_height_with_spacing() + 4 * ui_scale()
            height = imgui.get_content_region_avail().y - foot
            self._places(now, height)
            imgui.same_line()
            framed, still = imgui.ChildFlags_.borders.value, imgui.WindowFlags_.no_nav.value
            imgui.begin_child("files", ImVec2(0, height), framed, still)
            self._files(now)
            imgui.end_child()
            self._bottom(now)
            if escape_pressed() and self._context.dialogs.question is None:
                self._context.dialogs.browse = None

    def _top(self, now: Browsing) -> None:
        with font(self._context, "bold", 18.0):
            imgui.text_unformatted(now.browse.title)
        if quiet_button(self._context, icons.ICON_FA_ARROW_UP, "folder up", "The folder around this one (Backspace)"):
            self._go(now, now.folder.parent)
        imgui.same_line()
        shown = (icons.ICON_FA_FOLDER_PLUS, icons.ICON_FA_EYE, icons.ICON_FA_LIST)
        buttons = width_of_buttons(*shown) + imgui.get_style().item_spacing.x
        imgui.set_next_item_width(imgui.get_content_region_avail().x - buttons)
        entered, self._path = imgui.input_text("##path", self._path, int(imgui.InputTextFlags_.enter_returns_true))
        record(self._context, "path field")
        self._elsewhere = imgui.is_item_active() or imgui.is_item_deactivated()
        if entered:
            self._open_typed_path(now)
        imgui.same_line()
        if quiet_button(self._context, icons.ICON_FA_FOLDER_PLUS, "new folder", "New folder"):
            self._naming, self._new, self._focus = True, "", "folder"
        imgui.same_line()
        eye = icons.ICON_FA_EYE if now.hidden else icons.ICON_FA_EYE_SLASH
        if quiet_button(self._context, eye, "hidden files", "Hide hidden files" if now.hidden else "Show hidden files"):
            now.hidden = not now.hidden
        imgui.same_line()
        other = icons.ICON_FA_LIST if self._as_grid else icons.ICON_FA_TABLE_CELLS_LARGE
        if quiet_button(self._context, other, "list or grid", "As a list" if self._as_grid else "As pictures"):
            self._as_grid = not self._as_grid

    def _open_typed_path(self, now: Browsing) -> None:
        path = complete_path(self._path, now.folder)
        if path.is_dir() or now.browse.saving or not path.is_file():
            self._go(now, path)
            return
        self._go(now, path.parent)
        now.listing.wait()
        now.search(path.name)

    def _go(self, now: Browsing, folder: object) -> None:
        now.go(complete_path(str(folder), now.folder))
        self._path, self._focus = str(now.folder), "field"

    def _places(self, now: Browsing, height: float) -> None:
        imgui.begin_child("places", ImVec2(176 * ui_scale(), height), 0, int(imgui.WindowFlags_.no_nav))
        for index, place in enumerate(now.offered):
            room = imgui.get_content_region_avail().x - 30 * ui_scale()
            label = f"{PLACE_ICONS[place.kind]}  {cut_middle(place.title, room)}##{index}"
            if imgui.selectable(label, place.path == now.folder)[0]:
                self._go(now, place.path)
            tip(str(place.path))
            record(self._context, f"place {place.title}")
        imgui.end_child()

    def _files(self, now: Browsing) -> None:
        if self._naming:
            self._name_folder(now)
        if now.listing.fault:
            draw_wrapped(self._context.palette.error, now.listing.fault)
            return
        items = now.items
        if not items:
            nothing = "Nothing here is called that." if now.query else "Nothing here to choose."
            draw_dim(self._context, "Reading..." if now.listing.busy else nothing)
            return
        shape = self._grid if self._as_grid and now.browse.purpose == "image" else self._table
        done = shape.draw(now)
        self._steer(now, shape.columns)
        if done:
            self._enter(now)

    def _name_folder(self, now: Browsing) -> None:
        if self._focus == "folder":
            imgui.set_keyboard_focus_here()
            self._focus = ""
        imgui.set_next_item_width(220 * ui_scale())
        entered, self._new = imgui.input_text_with_hint(
            "##new", "Name of the new folder", self._new, int(imgui.InputTextFlags_.enter_returns_true)
        )
        record(self._context, "new folder name")
        self._elsewhere = True
        if entered:
            self._naming, self._focus = False, "field"
            made = self._context.log.attempt(lambda: make_folder(now.folder, self._new))
            if made:
                self._go(now, made)
        elif imgui.is_item_deactivated():
            self._naming = False

    def _steer(self, now: Browsing, columns: int) -> None:
        """Arrows choose; up and down only where a field does not need them."""
        if self._elsewhere:
            return
        keys = (
            (imgui.Key.down_arrow, columns),
            (imgui.Key.up_arrow, -columns),
            (imgui.Key.page_down, 10 * columns),
            (imgui.Key.page_up, -10 * columns),
        )
        step = sum(amount for key, amount in keys if imgui.is_key_pressed(key))
        if columns > 1 and not now.query and not now.browse.saving:
            step += imgui.is_key_pressed(imgui.Key.right_arrow) - imgui.is_key_pressed(imgui.Key.left_arrow)
        if step:
            now.choose(min(max(now.chosen + step, 0), len(now.items) - 1))
            self._table.reveal = self._grid.reveal = True

    def _bottom(self, now: Browsing) -> None:
        free = not imgui.is_any_item_active() and not self._naming and self._context.dialogs.question is None
        if self._focus == "field" or free:
            imgui.set_keyboard_focus_here()
            self._focus = ""
        empty = not now.query
        imgui.set_next_item_width(imgui.get_content_region_avail().x)
        if now.browse.saving:
            changed, name = imgui.input_text_with_hint("##name", "Name of the file", now.name)
            if changed:
                now.name, now.chosen = name, -1
        else:
            changed, query = imgui.input_text_with_hint("##query", "Type to find", now.query)
            if changed:
                now.search(query)
        record(self._context, "file field")
        if not self._elsewhere and self._context.dialogs.question is None:
            if imgui.is_key_pressed(imgui.Key.backspace, False) and empty and not now.browse.saving:
                self._go(now, now.folder.parent)
            if any(imgui.is_key_pressed(key, False) for key in (imgui.Key.enter, imgui.Key.keypad_enter)):
                self._enter(now)
        self._buttons(now)

    def _buttons(self, now: Browsing) -> None:
        verb = "Save" if now.browse.saving else "Open"
        target = now.target
        imgui.align_text_to_frame_padding()
        counted = f"{len(now.items)} items" if target is None else cut_middle(str(target), 560 * ui_scale())
        draw_dim(self._context, counted)
        align_right("Cancel", f"    {verb}    ")
        if imgui.button("Cancel"):
            self._context.dialogs.browse = None
        record(self._context, "cancel file")
        imgui.same_line()
        can = target is not None or (now.item is not None and now.item.is_folder)
        if main_button(self._context, f"    {verb}    ", "choose file", enabled=can):
            self._enter(now)

    def _enter(self, now: Browsing) -> None:
        """Open the folder that is chosen, or answer with the file."""
        item, target = now.item, now.target
        if item and item.is_folder:
            self._go(now, now.folder / item.name)
            return
        if target is None or self._context.dialogs.question is not None:
            return
        answer = partial(_answer, self._context, now, target)
        if not now.browse.saving or not target.exists():
            answer()
            return
        self._context.dialogs.question = Question(
            "Replace the file?",
            f"{target.name} is already in {target.parent.name or target.parent}.",
            (("Replace", answer), ("Cancel", lambda: None)),
        )


def _answer(context: BrowserContext, now: Browsing, target: object) -> None:
    path = now.folder / str(target)
    context.dialogs.browse = None
    context.log.attempt(lambda: context.store.note_folder(now.browse.purpose, path))
    context.log.attempt(lambda: now.browse.then(path))
