"""The Code panel: the text of the active node, its errors, and where it is saved."""

from __future__ import annotations

from collections import OrderedDict
from pathlib import PurePath
from typing import TYPE_CHECKING

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...authoring.commands import EmbedCode
from ...authoring.edits import paths
from ...custom_nodes import Code
from ...language.translation import translate
from ..theme.style import EM, ui_scale, vec4
from ..toolkit.buttons import align_right, quiet_button
from ..toolkit.keys import chord
from ..toolkit.places import record
from ..toolkit.words import cut_middle, draw_dim, draw_empty_panel, draw_wrapped, font, tip
from .help import CodeHelp
from .page import Page

if TYPE_CHECKING:
    from .context import CodeContext

MAX_PAGES = 16
"""Pages that keep their cursor and undo history: the least recently used one goes first."""

_SIZE = EM * 0.94
_OURS = 0x434F4445
"""The id under which the panel owns keys: "CODE" in ASCII."""
_FOR_THIS_FRAME = int(imgui.internal.InputFlagsPrivate_.lock_this_frame)
"""The widget of the text does not see a key that is locked: it would begin a line."""


class CodePanel:
    """Shows the code of the active node, or else of the last node with code."""

    def __init__(self, context: CodeContext) -> None:
        self._context = context
        self._pages: OrderedDict[tuple[str, ...], Page] = OrderedDict()
        self._page: Page | None = None
        self._help = CodeHelp(context)
        self._focused = False

    def draw(self) -> None:
        """Draw into the current window."""
        self._context.code.flush = self._flush
        page = self._choose_page()
        code = self._context.session.code_files.find_code(page.id) if page else None
        if page is None or code is None:
            draw_empty_panel(
                self._context,
                icons.ICON_FA_CODE,
                translate("No code"),
                translate(
                    "Add a Code node to the graph, or select one: the code that you write here becomes the node."
                ),
            )
            return
        focused = imgui.is_window_focused(imgui.FocusedFlags_.root_and_child_windows.value)
        if self._context.code.focus:
            self._context.code.focus = False
            page.widget.set_focus()
        if focused:
            self._handle_keys(page, code)
        self._draw_header(page, code)
        fault = page.fault
        room = imgui.get_content_region_avail()
        foot = 0.0
        if fault:
            text_width = max(room.x - 26 * ui_scale(), 1.0)
            foot = imgui.calc_text_size(fault.text, wrap_width=text_width).y + 2 * imgui.get_style().item_spacing.y
        with font(self._context, "mono", _SIZE):
            page.draw((room.x, max(room.y - foot, 40 * ui_scale())))
        record(self._context, "code text")
        if fault:
            self._draw_fault(page)
        if self._focused and not focused:
            page.commit()
            page.end_burst()
        self._focused = focused

    # --- parts -------------------------------------------------------------------------------------------------------

    def _choose_page(self) -> Page | None:
        """The page of the active node, or else the last page."""
        session = self._context.session
        if session.code_files.find_code(session.active) is not None:
            key = (*session.place, session.active)
            if key not in self._pages:
                self._pages[key] = Page(self._context, session.active, session.place)
                if len(self._pages) > MAX_PAGES:
                    self._pages.popitem(last=False)
            self._pages.move_to_end(key)
            if self._page is not self._pages[key]:
                self._flush()
                self._page = self._pages[key]
        elif self._page and (self._page.place != session.place or session.code_files.find_code(self._page.id) is None):
            self._page = None
        return self._page

    def _flush(self) -> None:
        if self._page:
            self._page.commit()

    def _handle_keys(self, page: Page, code: Code) -> None:
        """Handle shortcuts while the text has the keyboard focus; the widget handles undo and the clipboard."""
        if imgui.is_key_chord_pressed(chord("Ctrl+Enter")):
            page.commit()
            page.end_burst()
            for key in (imgui.Key.enter, imgui.Key.keypad_enter):
                imgui.internal.set_key_owner(key, _OURS, _FOR_THIS_FRAME)
        if imgui.is_key_chord_pressed(chord("Ctrl+S")):
            imgui.internal.set_key_owner(imgui.Key.s, _OURS, _FOR_THIS_FRAME)
            page.commit()
            page.end_burst()
            self._save(page, code)

    def _save(self, page: Page, code: Code) -> None:
        if code.file:
            self._context.log.attempt(lambda: self._context.code_files.save(page.id))
        else:
            self._context.actions.run("file.save")

    def _draw_header(self, page: Page, code: Code) -> None:
        """The name of the node, where its code is saved, and buttons to save or move it."""
        session, style = self._context.session, imgui.get_style()
        imgui.align_text_to_frame_padding()
        with font(self._context, "bold"):
            imgui.text_unformatted(page.id)
        imgui.same_line()
        glyphs = (icons.ICON_FA_FLOPPY_DISK, icons.ICON_FA_FILE_IMPORT, icons.ICON_FA_CIRCLE_QUESTION)
        glyphs = glyphs if code.file else (icons.ICON_FA_FILE_EXPORT, icons.ICON_FA_CIRCLE_QUESTION)
        draft = bool(code.file) and paths.resolve_path(code.file, session.graph.folder) in session.code_files.drafts
        where = f"{PurePath(code.file).name}{' *' if draft else ''}" if code.file else translate("in the graph")
        room = imgui.get_content_region_avail().x - len(glyphs) * (imgui.get_frame_height() + style.item_spacing.x)
        imgui.align_text_to_frame_padding()
        draw_dim(self._context, cut_middle(where, max(room, 1.0)))
        record(self._context, "code where")
        tip(
            (translate("{file}: not saved yet", file=code.file) if draft else code.file)
            if code.file
            else translate("Saved with the graph")
        )
        editable = not session.borrowed
        align_right(*glyphs)
        if code.file:
            if quiet_button(
                self._context,
                glyphs[0],
                "button save code",
                translate("Save to the file (Ctrl+S)"),
                enabled=draft and editable,
            ):
                page.commit()
                self._save(page, code)
            imgui.same_line()
            if quiet_button(
                self._context,
                glyphs[1],
                "button inline code",
                translate("Move into the graph; the file stays"),
                enabled=editable,
            ):
                page.commit()
                self._context.log.attempt(lambda: session.apply(EmbedCode(page.id)))
        elif quiet_button(
            self._context, glyphs[0], "button export code", translate("Move to a file of its own ..."), enabled=editable
        ):
            page.commit()
            self._context.actions.run("code.export")
        imgui.same_line()
        self._help.draw(page, code)

    def _draw_fault(self, page: Page) -> None:
        """The error below the text; a click goes to its line."""
        fault = page.fault
        if fault is None:
            return
        self._context.code.next_fault_path = page.path
        imgui.text_colored(vec4(self._context.palette.error), icons.ICON_FA_TRIANGLE_EXCLAMATION)
        imgui.same_line()
        draw_wrapped(self._context.palette.error, fault.text)
        record(self._context, "code fault")
        if fault.line and imgui.is_item_hovered():
            imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
            if imgui.is_item_clicked():
                page.go_to(fault.line)
