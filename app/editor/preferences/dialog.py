"""The Preferences dialog: appearance, shortcuts, folders, memory."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons
from msgspec.structs import asdict

from ...authoring.background.shader_files import CUSTOMARY
from ...authoring.preferences import MAX_SCALE, MIN_SCALE, Preferences
from ...authoring.recovery.recovery import LONGEST
from ...language.translation import LANGUAGES, mark, translate
from ...resources.user_folders import PRESETS_VARIABLE, own_presets_folder
from ..theme.style import ui_scale, vec4
from ..toolkit.buttons import close_button, quiet_button
from ..toolkit.dialogs import backdrop, dialog, escape_pressed
from ..toolkit.fields import combo, label, measure_labels
from ..toolkit.labels import make_label, translate_label
from ..toolkit.places import record
from ..toolkit.words import draw_dim, draw_wrapped, font
from .shortcut_editor import ShortcutEditor

if TYPE_CHECKING:
    from .context import PreferencesContext

_THEMES: Mapping[str, str] = MappingProxyType(
    {"dark": mark("Dark"), "light": mark("Light"), "contrast": mark("High contrast")}
)
_SCALES = (0.0, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0)
_FLAT = imgui.ChildFlags_.nav_flattened.value
_LABELS = 120.0
_TITLES = ("Theme", "Scale", "Language", "Autosave every", "For pictures")
_PAGES = (mark("Interface"), mark("Shortcuts"), mark("System"))


class PreferencesDialog:
    """The Preferences dialog. Changes apply at once."""

    def __init__(self, context: PreferencesContext) -> None:
        self._context = context
        self._page = _PAGES[0]
        self._shortcuts = ShortcutEditor(context)
        self._edited: dict[str, float] = {}
        self._folders: dict[str, str] = {}

    def draw(self) -> None:
        """Draw the dialog, if it is open."""
        if "preferences" not in self._context.dialogs.open:
            self._shortcuts.stop()
            return
        listening = self._shortcuts.listening
        close = backdrop(self._context, "preferences") and not listening
        with dialog(self._context, "Preferences", (720, 640)):
            height = imgui.get_content_region_avail().y - imgui.get_frame_height_with_spacing() - 6 * ui_scale()
            self._draw_pages(height)
            imgui.same_line(0, 16 * ui_scale())
            imgui.begin_child("page", ImVec2(0, height), _FLAT)
            pages = (self._draw_interface, self._shortcuts.draw, self._draw_system)
            pages[_PAGES.index(self._page)]()
            imgui.end_child()
            close = close_button(self._context, "close preferences") or close
            close = close or (escape_pressed() and not listening)
        if close:
            self._context.dialogs.open.discard("preferences")

    def _draw_pages(self, height: float) -> None:
        title = translate("Preferences")
        with font(self._context, "bold", 18.0):
            width = max(imgui.calc_text_size(title).x, 130 * ui_scale())
        imgui.begin_child("pages", ImVec2(width, height), _FLAT)
        with font(self._context, "bold", 18.0):
            imgui.text_unformatted(title)
        imgui.dummy(ImVec2(0, 6 * ui_scale()))
        for page in _PAGES:
            if imgui.selectable(translate_label(page), page == self._page)[0]:
                self._page = page
                self._shortcuts.stop()
            record(self._context, f"page {page}")
        imgui.end_child()

    def _draw_interface(self) -> None:
        preferences = self._context.store.current
        _draw_heading(self._context, translate("Appearance"))
        label(translate("Theme"), _label_width())
        for theme, title in _THEMES.items():
            if imgui.radio_button(translate_label(title), preferences.theme == theme):
                _change(self._context, theme=theme)
            record(self._context, f"theme {theme}")
            imgui.same_line()
        imgui.new_line()
        label(translate("Scale"), _label_width())
        names = {_scale(scale): scale for scale in _SCALES}
        if chosen := combo(
            self._context, "ui scale", _scale(preferences.ui_scale), tuple(names), _measure_choices(names)
        ):
            _change(self._context, ui_scale=names[chosen])
        if preferences.ui_scale not in _SCALES or not MIN_SCALE <= (preferences.ui_scale or 1.0) <= MAX_SCALE:
            imgui.same_line()
            draw_dim(self._context, translate("own", "scale"))
        label(translate("Language"), _label_width())
        languages = {"": translate("Same as the system"), **LANGUAGES}
        if chosen := combo(
            self._context,
            "language",
            languages[preferences.language],
            tuple(languages.values()),
            _measure_choices(languages.values()),
        ):
            _change(self._context, language=next(code for code, name in languages.items() if name == chosen))
        _draw_switch(self._context, "reduced_motion", translate("Less motion: nothing blinks or fades"))
        _draw_switch(self._context, "separate_windows", translate("Panels outside of the window (from the next start)"))
        _draw_heading(self._context, translate("Graph"))
        _draw_switch(self._context, "thumbnails", translate("Thumbnails on nodes"))
        _draw_switch(self._context, "timings", translate("Time and memory of each node"))
        _draw_switch(self._context, "minimap", translate("Overview in the corner"))
        _draw_heading(self._context, translate("Viewer"))
        _draw_switch(self._context, "proxy_while_dragging", translate("Lower resolution while a value is dragged"))

    def _draw_system(self) -> None:
        _draw_heading(self._context, translate("Recovery"))
        label(translate("Autosave every"), _label_width())
        self._draw_number("autosave", "%.1f s", 0.5, 10.0)
        draw_wrapped(
            self._context.palette.dim,
            translate("Unsaved work is saved separately from your files, and offered after a crash."),
        )
        _draw_heading(self._context, translate("Memory"))
        label(translate("For pictures"), _label_width())
        self._draw_number("memory_budget", "%.0f MiB", 64.0, 16384.0, logarithmic=True)
        draw_wrapped(
            self._context.palette.dim,
            translate("Graphics memory in which results are kept. Takes effect at the next start."),
        )
        _draw_heading(self._context, translate("Presets"))
        self._draw_folders(
            "preset",
            translate(
                "Folders with graphs that everybody here shares. Your own are in {folder}; folders in "
                "${variable} are listed too.",
                folder=own_presets_folder(),
                variable=PRESETS_VARIABLE,
            ),
        )
        _draw_heading(self._context, translate("Shaders"))
        self._draw_folders(
            "isf",
            translate(
                "Folders with .fs files in the Interactive Shader Format; their shaders can be added to "
                "the graph. {folders} are always searched too.",
                folders=", ".join(CUSTOMARY),
            ),
        )
        _draw_heading(self._context, translate("Files"))
        folder = str(self._context.store.file.parent)
        draw_wrapped(
            self._context.palette.dim,
            translate("Preferences, recovered work and thumbnails are in {folder}", folder=folder),
        )
        if imgui.button(translate_label("Copy the path")):
            self._context.clipboard.put(folder)
        imgui.same_line()
        default = Preferences()
        if imgui.button(translate_label("Reset all preferences")):
            lists = ("recent", "folders", "extra", "shortcuts", "hint_seen", "isf_folders", "preset_folders")
            _change(self._context, **{name: value for name, value in asdict(default).items() if name not in lists})
        record(self._context, "reset preferences")

    def _draw_folders(self, kind: str, sentence: str) -> None:
        """Draw the list `<kind>_folders` of the preferences, and a field that adds a folder to it."""
        name, context = f"{kind}_folders", self._context
        folders: tuple[str, ...] = getattr(context.store.current, name)
        draw_wrapped(context.palette.dim, sentence)
        for index, folder in enumerate(folders):
            if quiet_button(context, icons.ICON_FA_XMARK, f"forget {kind} {index}", translate("Remove this folder")):
                _change(context, **{name: tuple(other for other in folders if other != folder)})
                context.store.flush()
            imgui.same_line()
            imgui.align_text_to_frame_padding()
            note = "" if os.path.isdir(folder) else translate("  (folder not found)")  # noqa: PTH112
            imgui.text_unformatted(f"{folder}{note}")
        imgui.set_next_item_width(320 * ui_scale())
        entered, text = imgui.input_text_with_hint(
            f"##{kind} folder",
            translate("path of a folder"),
            self._folders.get(kind, ""),
            int(imgui.InputTextFlags_.enter_returns_true),
        )
        self._folders[kind] = text
        record(context, f"field {kind} folder")
        imgui.same_line()
        typed = text.strip().strip('"')
        if (imgui.button(make_label(translate("Add"), f"{kind}")) or entered) and typed:
            whole = str(Path(typed).expanduser().absolute())
            _change(context, **{name: tuple(dict.fromkeys((*folders, whole)))})
            context.store.flush()
            self._folders[kind] = ""
        record(context, f"button add {kind}")

    def _draw_number(
        self,
        name: str,
        text: str,
        low: float,
        high: float,
        logarithmic: bool = False,
    ) -> None:
        """Draw a slider that applies when the mouse button is released."""
        whole = isinstance(getattr(self._context.store.current, name), int)
        value = self._edited.get(name, float(getattr(self._context.store.current, name)))
        imgui.set_next_item_width(220 * ui_scale())
        flags = int(imgui.SliderFlags_.always_clamp) | (int(imgui.SliderFlags_.logarithmic) if logarithmic else 0)
        moved, value = imgui.slider_float(f"##{name}", value, low, high, text, flags)
        record(self._context, f"preference {name}")
        if moved:
            self._edited[name] = value
        if imgui.is_item_deactivated_after_edit():
            value = self._edited.pop(name, value)
            _change(self._context, **{name: round(value) if whole else round(value, 1)})


def _change(context: PreferencesContext, **values: Any) -> None:
    context.log.attempt(lambda: context.store.change(**values))
    context.recovery.interval = min(context.store.current.autosave, LONGEST)


def _draw_heading(context: PreferencesContext, title: str) -> None:
    imgui.dummy(ImVec2(0, 4 * ui_scale()))
    with font(context, "bold"):
        imgui.text_colored(vec4(context.palette.accent), title)


def _draw_switch(context: PreferencesContext, name: str, title: str) -> None:
    changed, value = imgui.checkbox(make_label(title, name), getattr(context.store.current, name))
    record(context, f"preference {name}")
    if changed:
        _change(context, **{name: value})


def _label_width() -> float:
    """The width of the column of names, in units."""
    return measure_labels(map(translate, _TITLES), _LABELS)


def _measure_choices(choices: Iterable[str]) -> float:
    """The width of a list with these choices and its arrow."""
    widest = max(imgui.calc_text_size(choice).x for choice in choices)
    return max(widest + 2 * imgui.get_style().frame_padding.x + imgui.get_frame_height(), 160 * ui_scale())


def _scale(scale: float) -> str:
    return f"{scale:.0%}" if scale else translate("Same as the system")
