"""The file browser dialog."""

from __future__ import annotations

import os
from functools import partial
from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...language.translation import translate, translate_plural
from ..shared.dialogs import Browse, Question
from ..theme.style import ui_scale
from ..toolkit.buttons import align_right, main_button, quiet_button, width_of_buttons
from ..toolkit.dialogs import backdrop, dialog, escape_pressed, takes_enter
from ..toolkit.labels import make_label, translate_label
from ..toolkit.places import record
from ..toolkit.words import cut_middle, draw_dim, draw_wrapped, font, tip
from .browsing import Browsing, FolderMemory, begin_browsing, find_own_folder
from .file_list import FileGrid, FileTable
from .listing import make_folder
from .places import PlaceKind, complete_name, complete_path

if TYPE_CHECKING:
    from .context import BrowserContext

PLACE_ICONS: dict[PlaceKind, str] = {
    "home": icons.ICON_FA_HOUSE,
    "document": icons.ICON_FA_DIAGRAM_PROJECT,
    "folder": icons.ICON_FA_FOLDER,
    "recent": icons.ICON_FA_CLOCK_ROTATE_LEFT,
    "drive": icons.ICON_FA_HARD_DRIVE,
}

_ENTERED = int(imgui.InputTextFlags_.enter_returns_true)
_COMPLETES = int(imgui.InputTextFlags_.callback_completion)


class FileBrowser:
    """Places, a path field, and files as a list or a grid. Letters filter, arrows choose, Enter opens."""

    def __init__(self, context: BrowserContext) -> None:
        self._context = context
        self._browsing: Browsing | None = None
        self._table, self._grid = FileTable(context), FileGrid(context)
        self._as_grid = True
        self._path = ""
        self._new = ""
        self._naming = False
        self._focus = ""
        self._elsewhere = False
        self._walks = False
        """True after Shift+Tab, which leads to the buttons, until the field below the files has the keyboard again."""
        self._memory: FolderMemory = {}

    def close(self) -> None:
        """Stop the threads."""
        self._grid.close()

    def draw(self) -> None:
        """Draw the dialog, if a file is asked for."""
        browse = self._context.dialogs.browse
        if browse is None:
            self._browsing = None
            return
        if self._browsing is None or self._browsing.browse is not browse:
            self._browsing, self._naming, self._focus = self._begin(browse), False, "field"
            self._path = str(self._browsing.folder)
        browsing = self._browsing
        browsing.poll()
        backdrop(self._context, "files")
        with dialog(self._context, "Files", (940, 620)):
            self._draw_path_bar(browsing)
            foot = 2 * imgui.get_frame_height_with_spacing() + 4 * ui_scale()
            height = imgui.get_content_region_avail().y - foot
            self._draw_places(browsing, height)
            imgui.same_line()
            framed, still = imgui.ChildFlags_.borders.value, imgui.WindowFlags_.no_nav.value
            imgui.begin_child("files", ImVec2(0, height), framed, still)
            self._draw_files(browsing)
            imgui.end_child()
            self._draw_name_field(browsing)
            if escape_pressed() and self._context.dialogs.question is None:
                self._context.dialogs.browse = None

    def _begin(self, browse: Browse) -> Browsing:
        return begin_browsing(self._context, browse, self._memory)

    def _complete(self, text: str, browsing: Browsing, data: imgui.InputTextCallbackData) -> int:
        """Tab: complete the path that is typed in a field."""
        if imgui.get_io().key_shift:
            return 0
        completed = complete_name(text, browsing.folder, browsing.endings)
        if completed != text:
            data.delete_chars(0, data.buf_text_len)
            data.insert_chars(0, completed)
        return 0

    def _draw_path_bar(self, browsing: Browsing) -> None:
        with font(self._context, "bold", 18.0):
            imgui.text_unformatted(browsing.browse.title)
        if self._focus == "walk":
            imgui.set_keyboard_focus_here()
            imgui.set_nav_cursor_visible(True)
            self._focus = ""
        if quiet_button(self._context, icons.ICON_FA_ARROW_UP, "folder up", translate("Parent folder (Backspace)")):
            self._go_to(browsing, browsing.folder.parent)
        imgui.same_line()
        button_icons = (icons.ICON_FA_FOLDER_PLUS, icons.ICON_FA_EYE, icons.ICON_FA_LIST)
        buttons = width_of_buttons(*button_icons) + imgui.get_style().item_spacing.x
        imgui.set_next_item_width(imgui.get_content_region_avail().x - buttons)
        completes = partial(self._complete, self._path, browsing)
        # Tab completes in it, and the field below the files takes paths too.
        imgui.push_item_flag(int(imgui.ItemFlags_.no_tab_stop), True)
        entered, self._path = imgui.input_text("##path", self._path, _ENTERED | _COMPLETES, completes)
        imgui.pop_item_flag()
        record(self._context, "path field")
        self._elsewhere = imgui.is_item_active() or imgui.is_item_deactivated()
        if entered:
            self._open_typed_path(browsing)
        imgui.same_line()
        if quiet_button(self._context, icons.ICON_FA_FOLDER_PLUS, "new folder", translate("New folder")):
            self._naming, self._new, self._focus = True, "", "folder"
        imgui.same_line()
        eye = icons.ICON_FA_EYE if browsing.hidden else icons.ICON_FA_EYE_SLASH
        if quiet_button(
            self._context,
            eye,
            "hidden files",
            translate("Hide hidden files") if browsing.hidden else translate("Show hidden files"),
        ):
            browsing.hidden = not browsing.hidden
        imgui.same_line()
        view_icon = icons.ICON_FA_LIST if self._as_grid else icons.ICON_FA_TABLE_CELLS_LARGE
        if quiet_button(
            self._context,
            view_icon,
            "list or grid",
            translate("Show as a list") if self._as_grid else translate("Show thumbnails"),
        ):
            self._as_grid = not self._as_grid

    def _open_typed_path(self, browsing: Browsing) -> None:
        path = complete_path(self._path, browsing.folder)
        if path.is_dir() or browsing.browse.saving or not path.is_file():
            self._go_to(browsing, path)
            return
        self._go_to(browsing, path.parent)
        browsing.listing.wait()
        browsing.search(path.name)

    def _go_to(self, browsing: Browsing, folder: object) -> None:
        browsing.go(complete_path(str(folder), browsing.folder))
        self._path, self._focus = str(browsing.folder), "field"

    def _draw_places(self, browsing: Browsing, height: float) -> None:
        imgui.begin_child("places", ImVec2(176 * ui_scale(), height), imgui.ChildFlags_.nav_flattened.value)
        for index, place in enumerate(browsing.offered):
            room = imgui.get_content_region_avail().x - 30 * ui_scale()
            label = f"{PLACE_ICONS[place.kind]}  {cut_middle(place.title, room)}##{index}"
            if imgui.selectable(make_label(label, str(place.path)), place.path == browsing.folder)[0]:
                self._go_to(browsing, place.path)
            tip(str(place.path))
            record(self._context, f"place {place.title}")
        imgui.end_child()

    def _draw_files(self, browsing: Browsing) -> None:
        if self._naming:
            self._draw_folder_name(browsing)
        if browsing.listing.fault:
            draw_wrapped(self._context.palette.error, browsing.listing.fault)
            return
        items = browsing.items
        if not items:
            nothing = (
                translate("No file in this folder matches.")
                if browsing.query
                else translate("This folder has no matching files.")
            )
            draw_dim(self._context, translate("Reading...") if browsing.listing.busy else nothing)
            return
        shape = self._grid if self._as_grid and browsing.browse.purpose == "image" else self._table
        double_clicked = shape.draw(browsing)
        self._move_by_arrows(browsing, shape.columns)
        if double_clicked:
            self._open_chosen(browsing)

    def _draw_folder_name(self, browsing: Browsing) -> None:
        if self._focus == "folder":
            imgui.set_keyboard_focus_here()
            self._focus = ""
        imgui.set_next_item_width(220 * ui_scale())
        entered, self._new = imgui.input_text_with_hint(
            "##new", translate("Name of the new folder"), self._new, int(imgui.InputTextFlags_.enter_returns_true)
        )
        record(self._context, "new folder name")
        self._elsewhere = True
        if entered:
            self._naming, self._focus = False, "field"
            new_folder = self._context.log.attempt(lambda: make_folder(browsing.folder, self._new))
            if new_folder:
                self._go_to(browsing, new_folder)
        elif imgui.is_item_deactivated():
            self._naming = False

    def _move_by_arrows(self, browsing: Browsing, columns: int) -> None:
        """Move the selection by arrow keys; left and right only where no text field needs them."""
        if self._elsewhere:
            return
        keys = (
            (imgui.Key.down_arrow, columns),
            (imgui.Key.up_arrow, -columns),
            (imgui.Key.page_down, 10 * columns),
            (imgui.Key.page_up, -10 * columns),
        )
        step = sum(amount for key, amount in keys if imgui.is_key_pressed(key))
        if columns > 1 and not browsing.query and not browsing.browse.saving:
            step += imgui.is_key_pressed(imgui.Key.right_arrow) - imgui.is_key_pressed(imgui.Key.left_arrow)
        if step:
            browsing.choose(min(max(browsing.chosen + step, 0), len(browsing.items) - 1))
            self._table.reveal = self._grid.reveal = True

    def _draw_name_field(self, browsing: Browsing) -> None:
        """Draw the field below the files. It takes the keyboard whenever nothing else has it, so that typing always
        finds files; Shift+Tab leads to the buttons. Backspace leaves the folder only if the field was empty before the
        key was typed into it.
        """
        is_asked = self._naming or self._context.dialogs.question is not None
        self._walks &= not imgui.is_mouse_down(imgui.MouseButton_.left)
        free = not imgui.is_any_item_active() and not is_asked and not self._walks
        if self._focus == "field" or free:
            imgui.set_keyboard_focus_here()
            self._focus = ""
        empty = not browsing.query
        imgui.set_next_item_width(imgui.get_content_region_avail().x)
        if browsing.browse.saving:
            completes = partial(self._complete, browsing.name, browsing)
            changed, name = imgui.input_text_with_hint(
                "##name", translate("Name of the file"), browsing.name, _COMPLETES, completes
            )
            if changed:
                browsing.rename(name)
        else:
            completes = partial(self._complete, browsing.query, browsing)
            hint = translate("Type to find, or a path; Tab completes it")
            changed, query = imgui.input_text_with_hint("##query", hint, browsing.query, _COMPLETES, completes)
            if changed:
                browsing.search(query)
        record(self._context, "file field")
        if imgui.is_item_active():
            self._walks = imgui.get_io().key_shift and imgui.is_key_pressed(imgui.Key.tab)
            self._focus = "walk" if self._walks else self._focus
        if not self._elsewhere and not self._walks and self._context.dialogs.question is None:
            if imgui.is_key_pressed(imgui.Key.backspace, False) and empty and not browsing.browse.saving:
                self._go_to(browsing, browsing.folder.parent)
            if takes_enter():
                self._open_chosen(browsing)
        self._draw_buttons(browsing)

    def _draw_buttons(self, browsing: Browsing) -> None:
        verb = translate("Save") if browsing.browse.saving else translate("Open")
        target = browsing.target
        imgui.align_text_to_frame_padding()
        counted = (
            translate_plural("{count} item", "{count} items", len(browsing.items))
            if target is None
            else cut_middle(str(target), 560 * ui_scale())
        )
        draw_dim(self._context, counted)
        align_right(translate("Cancel"), f"    {verb}    ")
        if imgui.button(translate_label("Cancel")):
            self._context.dialogs.browse = None
        record(self._context, "cancel file")
        imgui.same_line()
        is_folder = browsing.item is not None and browsing.item.is_folder
        can = target is not None or is_folder or bool(browsing.name.strip() or browsing.query.strip())
        if main_button(self._context, f"    {verb}    ", "choose file", enabled=can):
            self._open_chosen(browsing)

    def _open_chosen(self, browsing: Browsing) -> None:
        """Open the typed or chosen folder, or return the file."""
        if (folder := browsing.typed_folder) is not None:
            self._go_to(browsing, folder)
            return
        item, target = browsing.item, browsing.typed_file or browsing.target
        if item and item.is_folder:
            self._go_to(browsing, browsing.listing.folder / item.name)
            return
        if target is None or self._context.dialogs.question is not None:
            return
        answer = partial(self._answer, browsing, target)
        if not browsing.browse.saving or not os.path.exists(target):  # noqa: PTH110 - False for an invalid path
            answer()
            return
        self._context.dialogs.question = Question(
            translate("Replace the file?"),
            translate(
                "{name} already exists in {folder}.", name=target.name, folder=target.parent.name or target.parent
            ),
            ((translate("Replace"), answer), (translate("Cancel"), lambda: None)),
        )

    def _answer(self, browsing: Browsing, target: object) -> None:
        context, path = self._context, browsing.folder / str(target)
        self._memory[find_own_folder(context), browsing.browse.purpose] = path.parent
        context.dialogs.browse = None
        context.log.attempt(lambda: context.store.note_folder(browsing.browse.purpose, path))
        context.log.attempt(lambda: browsing.browse.then(path))
