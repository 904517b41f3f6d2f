"""Where to begin: presets, recent files, unsaved work."""

from __future__ import annotations

from pathlib import Path
from time import localtime, strftime
from typing import TYPE_CHECKING

from halation.presets import picture
from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...authoring.services.preferences import Recent
from ...authoring.services.recovery import Recovered
from ...custom_nodes.plugins import preset_paths
from ...media.pictures.thumbnail import load_thumbnail
from ..theme.style import mix, u32, ui_scale, vec4
from ..toolkit.buttons import main_button, outline, quiet
from ..toolkit.dialogs import backdrop, dialog, escaped
from ..toolkit.keys import chord
from ..toolkit.places import record
from ..toolkit.textures import Textures
from ..toolkit.words import dim, elided, font, tip, wrapped
from ..workflows.documents import open_graph, open_preset, recover

if TYPE_CHECKING:
    from ..window.editor import Editor

_CARD, _PICTURE_HEIGHT = 200.0, 112.0

HINTS = (
    "Tab adds a node; drag from a pin into the open to add one that fits.",
    "Double-click a node to see its result; Ctrl+1 keeps it on a key, 1 brings it back.",
    "Drop pictures and graphs on the window.",
    "Ctrl+P finds everything that can be done, F1 shows all shortcuts.",
    "Unsaved work comes back after a crash.",
)


class StartScreen:
    """Shown when nothing is open, and from the File menu."""

    def __init__(self) -> None:
        self._textures = Textures()
        self._found: tuple[Recovered, ...] | None = None
        self._there: dict[str, bool] = {}
        self._pictured = {path: picture(path).is_file() for path in preset_paths()}

    def close(self) -> None:
        """Give pictures back."""
        self._textures.clear()

    def draw(self, editor: Editor) -> None:
        """Draw over everything, if it is open."""
        if "start" not in editor.dialogs.open:
            self._found = None
            return
        if self._found is None:
            self._found = editor.recovery.found()
            self._there = {recent.path: recent.exists for recent in editor.store.now.recent}
        covered = editor.dialogs.browse is not None or editor.dialogs.question is not None
        close = backdrop(editor, "start") and not covered
        with dialog(editor, "Start", (1180, 560)):
            height = imgui.get_content_region_avail().y
            imgui.begin_child("left", ImVec2(290 * ui_scale(), height), imgui.ChildFlags_.nav_flattened.value)
            self._begin(editor)
            self._recent(editor)
            imgui.end_child()
            imgui.same_line(0, 18 * ui_scale())
            imgui.begin_child("right", ImVec2(0, height), imgui.ChildFlags_.nav_flattened.value)
            self._recoveries(editor, self._found)
            self._presets(editor)
            imgui.end_child()
            if not covered:
                close = close or escaped()
                self._keys(editor)
        if close:
            editor.dialogs.open.discard("start")

    def _keys(self, editor: Editor) -> None:
        """The shortcuts that make sense here."""
        for id in ("file.new", "file.open", "file.quit", "help.shortcuts"):
            keys = editor.actions.shortcut(id)
            if keys and imgui.is_key_chord_pressed(chord(keys)):
                editor.actions.run(id, editor)

    def _begin(self, editor: Editor) -> None:
        with font(editor, "bold", 30.0):
            imgui.text_unformatted("Halation")
        dim(editor, "Screen-space effects, node by node")
        imgui.dummy(ImVec2(0, 8 * ui_scale()))
        width = imgui.get_content_region_avail().x
        if main_button(editor, f"{icons.ICON_FA_PLUS}  New graph", "start new", width=width):
            editor.actions.run("file.new", editor)
        if imgui.button(f"{icons.ICON_FA_FOLDER_OPEN}  Open...", ImVec2(width, 0)):
            editor.actions.run("file.open", editor)
        record(editor, "start open")
        if not editor.store.now.hint_seen:
            self._hint(editor)

    def _hint(self, editor: Editor) -> None:
        imgui.dummy(ImVec2(0, 4 * ui_scale()))
        with font(editor, "bold"):
            imgui.text_unformatted("First time here?")
        for line in HINTS:
            wrapped(editor.palette.dim, line)
        if quiet(editor, f"{icons.ICON_FA_CHECK}  Got it", "hint seen", "Show this no more"):
            editor.attempt(lambda: editor.store.change(hint_seen=True))

    def _recent(self, editor: Editor) -> None:
        imgui.dummy(ImVec2(0, 4 * ui_scale()))
        with font(editor, "bold"):
            imgui.text_unformatted("Recent")
        if not editor.store.now.recent:
            dim(editor, "Files that you open appear here.")
        for index, recent in enumerate(editor.store.now.recent):
            imgui.push_id(index)
            self._recent_row(editor, index, recent)
            imgui.pop_id()

    def _recent_row(self, editor: Editor, index: int, recent: Recent) -> None:
        scale, path, there = ui_scale(), Path(recent.path), self._there.get(recent.path, True)
        line = imgui.get_text_line_height()
        room = imgui.get_content_region_avail().x - 30 * scale
        start = imgui.get_cursor_pos()
        imgui.set_next_item_allow_overlap()
        clicked, _ = imgui.selectable("##recent", False, 0, ImVec2(0, 2 * line + 4 * scale))
        record(editor, f"recent {index}")
        tip(str(path) if there else f"{path}\nThis file is not there any more.")
        over = imgui.is_mouse_hovering_rect(imgui.get_item_rect_min(), imgui.get_item_rect_max())
        after = imgui.get_cursor_pos()
        imgui.set_cursor_pos(ImVec2(start.x + 4 * scale, start.y + scale))
        faint = mix(editor.palette.dim, editor.palette.panel, 0.4)
        imgui.text_colored(vec4(editor.palette.text if there else faint), elided(path.stem, room))
        imgui.set_cursor_pos(ImVec2(start.x + 4 * scale, start.y + line + 3 * scale))
        imgui.text_colored(vec4(editor.palette.dim if there else faint), elided(str(path.parent), room))
        if over:
            imgui.set_cursor_pos(ImVec2(start.x + room + 2 * scale, start.y + 4 * scale))
            if quiet(editor, icons.ICON_FA_XMARK, f"forget {index}", "Take it off this list"):
                editor.store.forget(recent.path)
                clicked = False
        imgui.set_cursor_pos(after)
        imgui.dummy(ImVec2(0, 0))
        if clicked and there:
            open_graph(editor, path)
        elif clicked:
            editor.log.add(f"{path} is not there any more; take it off the list or bring it back", "warning")

    def _recoveries(self, editor: Editor, found: tuple[Recovered, ...]) -> None:
        if not found:
            return
        with font(editor, "bold"):
            imgui.text_colored(vec4(editor.palette.warning), "Recover unsaved work")
        for index, one in enumerate(found):
            when = strftime("%Y-%m-%d %H:%M", localtime(one.time))
            nodes = "1 node" if one.nodes == 1 else f"{one.nodes} nodes"
            if main_button(editor, "Recover", f"recover {index}", enabled=not one.fault):
                recover(editor, one)
                self._found = None
            imgui.same_line()
            if imgui.button(f"Discard##{index}"):
                editor.attempt(one.discard)
                self._found = None
            record(editor, f"discard {index}")
            imgui.same_line()
            imgui.text_unformatted(elided(one.title, 200 * ui_scale()))
            tip(str(one.path or "never saved"))
            imgui.same_line()
            dim(editor, elided(one.fault or f"{when}, {nodes}", imgui.get_content_region_avail().x))
        imgui.dummy(ImVec2(0, 6 * ui_scale()))

    def _presets(self, editor: Editor) -> None:
        scale = ui_scale()
        with font(editor, "bold"):
            imgui.text_unformatted("Presets")
        gap = imgui.get_style().item_spacing.x
        room = imgui.get_content_region_avail().x
        count = max(int((room + gap) / (_CARD * scale + gap)), 1)
        width = (room - gap * (count - 1)) / count
        for index, path in enumerate(self._pictured):
            if index % count:
                imgui.same_line()
            self._card(editor, path, width)

    def _card(self, editor: Editor, path: Path, width: float) -> None:
        scale, palette = ui_scale(), editor.palette
        name = path.stem.replace("_", " ")
        picture_height = width * _PICTURE_HEIGHT / _CARD
        size = ImVec2(width, picture_height + 26 * scale)
        clicked = imgui.invisible_button(f"##{path}", size)
        record(editor, f"preset {path.stem}")
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        lines, rounding = imgui.get_window_draw_list(), imgui.get_style().frame_rounding
        lines.add_rect_filled(low, high, u32(palette.hover if imgui.is_item_hovered() else palette.raised), rounding)
        corner = ImVec2(high.x, low.y + picture_height)
        if self._pictured[path]:
            texture = self._textures.get(path, lambda: load_thumbnail(picture(path)))
            lines.add_image_rounded(texture, low, corner, ImVec2(0, 0), ImVec2(1, 1), 0xFFFFFFFF, rounding)
        lines.add_text(ImVec2(low.x + 8 * scale, corner.y + 5 * scale), u32(palette.text), name)
        if imgui.is_item_hovered():
            outline(palette.accent)
        if clicked:
            open_preset(editor, path)
