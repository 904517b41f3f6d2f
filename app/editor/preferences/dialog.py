"""What a person may have otherwise."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...authoring.services.preferences import MAX_SCALE, MIN_SCALE, Preferences
from ...authoring.services.recovery import LONGEST
from ...authoring.services.shader_files import CUSTOMARY
from ..theme.style import ui_scale, vec4
from ..toolkit.buttons import close_button, quiet
from ..toolkit.dialogs import backdrop, dialog, escaped
from ..toolkit.fields import combo, label
from ..toolkit.places import record
from ..toolkit.words import dim, font, wrapped
from .shortcut_editor import ShortcutEditor

if TYPE_CHECKING:
    from ..window.editor import Editor

_SCALES = (0.0, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0)
_FLAT = imgui.ChildFlags_.nav_flattened.value
_LABELS = 120.0
_PAGES = ("Interface", "Shortcuts", "System")


class PreferencesDialog:
    """Changes hold at once; there is nothing to confirm."""

    def __init__(self) -> None:
        self._page = _PAGES[0]
        self._shortcuts = ShortcutEditor()
        self._edited: dict[str, float] = {}
        self._folder = ""

    def draw(self, editor: Editor) -> None:
        """Draw over everything, if it is open."""
        if "preferences" not in editor.dialogs.open:
            self._shortcuts.stop()
            return
        listening = self._shortcuts.listening
        close = backdrop(editor, "preferences") and not listening
        with dialog(editor, "Preferences", (720, 500)):
            height = imgui.get_content_region_avail().y - imgui.get_frame_height_with_spacing() - 6 * ui_scale()
            self._pages(editor, height)
            imgui.same_line(0, 16 * ui_scale())
            imgui.begin_child("page", ImVec2(0, height), _FLAT)
            pages = (self._interface, self._shortcuts.draw, self._system)
            pages[_PAGES.index(self._page)](editor)
            imgui.end_child()
            close = close_button(editor, "close preferences") or close
            close = close or (escaped() and not listening)
        if close:
            editor.dialogs.open.discard("preferences")

    def _pages(self, editor: Editor, height: float) -> None:
        imgui.begin_child("pages", ImVec2(130 * ui_scale(), height), _FLAT)
        with font(editor, "bold", 18.0):
            imgui.text_unformatted("Preferences")
        imgui.dummy(ImVec2(0, 6 * ui_scale()))
        for page in _PAGES:
            if imgui.selectable(page, page == self._page)[0]:
                self._page = page
                self._shortcuts.stop()
            record(editor, f"page {page}")
        imgui.end_child()

    def _interface(self, editor: Editor) -> None:
        now = editor.store.now
        _heading(editor, "Appearance")
        label("Theme", _LABELS)
        for theme in ("dark", "light"):
            if imgui.radio_button(theme.capitalize(), now.theme == theme):
                _change(editor, theme=theme)
            record(editor, f"theme {theme}")
            imgui.same_line()
        imgui.new_line()
        label("Scale", _LABELS)
        names = {_scale(scale): scale for scale in _SCALES}
        if chosen := combo(editor, "ui scale", _scale(now.ui_scale), tuple(names), 160 * ui_scale()):
            _change(editor, ui_scale=names[chosen])
        if now.ui_scale not in _SCALES or not MIN_SCALE <= (now.ui_scale or 1.0) <= MAX_SCALE:
            imgui.same_line()
            dim(editor, "own")
        _heading(editor, "Graph")
        _switch(editor, "thumbnails", "Thumbnails on nodes")
        _switch(editor, "timings", "Time and memory of each node")
        _switch(editor, "minimap", "Overview in the corner")
        _heading(editor, "Viewer")
        _switch(editor, "proxy_while_dragging", "Coarser pictures while a value is dragged")

    def _system(self, editor: Editor) -> None:
        _heading(editor, "Recovery")
        label("Autosave every", _LABELS)
        self._number(editor, "autosave", "%.1f s", 0.5, 10.0)
        wrapped(editor.palette.dim, "Unsaved work is kept apart from your files and offered again after a crash.")
        _heading(editor, "Memory")
        label("For pictures", _LABELS)
        self._number(editor, "memory_budget", "%.0f MiB", 64.0, 16384.0, logarithmic=True)
        wrapped(editor.palette.dim, "On the graphics card. More keeps more results; it holds from the next start on.")
        _heading(editor, "Shaders")
        self._folders(editor)
        _heading(editor, "Files")
        folder = str(editor.store.file.parent)
        wrapped(editor.palette.dim, f"Preferences, recovered work and thumbnails are kept in {folder}")
        if imgui.button("Copy the path"):
            editor.clipboard.put(folder)
        imgui.same_line()
        default = Preferences()
        if imgui.button("Reset all preferences"):
            kept = ("recent", "folders", "extra", "shortcuts", "hint_seen", "isf_folders")
            _change(editor, **{name: value for name, value in vars(default).items() if name not in kept})
        record(editor, "reset preferences")

    def _folders(self, editor: Editor) -> None:
        """Where shaders in the Interactive Shader Format are looked for."""
        now = editor.store.now.isf_folders
        wrapped(
            editor.palette.dim,
            "Folders with .fs files in the Interactive Shader Format; what is in them can be "
            f"added to the graph. {', '.join(CUSTOMARY)} are looked at anyway.",
        )
        for index, folder in enumerate(now):
            if quiet(editor, icons.ICON_FA_XMARK, f"forget isf {index}", "No longer look there"):
                _change(editor, isf_folders=tuple(one for one in now if one != folder))
            imgui.same_line()
            imgui.align_text_to_frame_padding()
            gone = "" if os.path.isdir(folder) else "  (there is no such folder)"  # noqa: PTH112
            imgui.text_unformatted(f"{folder}{gone}")
        imgui.set_next_item_width(320 * ui_scale())
        entered, self._folder = imgui.input_text_with_hint(
            "##isf folder", "path of a folder", self._folder, int(imgui.InputTextFlags_.enter_returns_true)
        )
        record(editor, "field isf folder")
        imgui.same_line()
        typed = self._folder.strip().strip('"')
        if (imgui.button("Add") or entered) and typed:
            whole = str(Path(typed).expanduser().absolute())
            _change(editor, isf_folders=tuple(dict.fromkeys((*now, whole))))
            self._folder = ""
        record(editor, "button add isf")

    def _number(
        self,
        editor: Editor,
        name: str,
        text: str,
        low: float,
        high: float,
        logarithmic: bool = False,
    ) -> None:
        """A slider that takes effect when it is let go."""
        whole = isinstance(getattr(editor.store.now, name), int)
        value = self._edited.get(name, float(getattr(editor.store.now, name)))
        imgui.set_next_item_width(220 * ui_scale())
        flags = int(imgui.SliderFlags_.always_clamp) | (int(imgui.SliderFlags_.logarithmic) if logarithmic else 0)
        moved, value = imgui.slider_float(f"##{name}", value, low, high, text, flags)
        record(editor, f"preference {name}")
        if moved:
            self._edited[name] = value
        if imgui.is_item_deactivated_after_edit():
            value = self._edited.pop(name, value)
            _change(editor, **{name: round(value) if whole else round(value, 1)})


def _change(editor: Editor, **values: Any) -> None:
    editor.attempt(lambda: editor.store.change(**values))
    editor.recovery.interval = min(editor.store.now.autosave, LONGEST)


def _heading(editor: Editor, title: str) -> None:
    imgui.dummy(ImVec2(0, 4 * ui_scale()))
    with font(editor, "bold"):
        imgui.text_colored(vec4(editor.palette.accent), title)


def _switch(editor: Editor, name: str, title: str) -> None:
    changed, value = imgui.checkbox(title, getattr(editor.store.now, name))
    record(editor, f"preference {name}")
    if changed:
        _change(editor, **{name: value})


def _scale(scale: float) -> str:
    return f"{scale:.0%}" if scale else "As the system"
