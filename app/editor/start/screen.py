"""The start screen: presets, recent files, unsaved work."""

from __future__ import annotations

from pathlib import Path
from time import localtime, strftime
from typing import TYPE_CHECKING

from halation.presets import picture
from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...authoring.preferences import Recent
from ...authoring.recovery.recovery import RecoveredWork
from ...custom_nodes.plugins import preset_paths
from ...media.pictures.thumbnail import load_thumbnail
from ...resources.sandbox import UNRESTRICTED
from ..theme.style import mix, u32, ui_scale, vec4
from ..toolkit.buttons import main_button, outline, quiet_button
from ..toolkit.dialogs import backdrop, dialog, escape_pressed
from ..toolkit.keys import chord
from ..toolkit.places import record
from ..toolkit.textures import Textures
from ..toolkit.words import cut_middle, draw_dim, draw_wrapped, font, tip

if TYPE_CHECKING:
    from .context import StartContext

_CARD, _PICTURE_HEIGHT = 200.0, 112.0

HINTS = (
    "Tab adds a node. Drag from a socket to empty canvas to add one that fits.",
    "Double-click a node to view it. Ctrl+1 assigns it to the key 1, which shows it again.",
    "Drop pictures and graphs on the window.",
    "Ctrl+P finds every command, F1 shows all shortcuts.",
    "Unsaved work comes back after a crash.",
)


class StartScreen:
    """The start screen, which opens at the start and from the File menu."""

    def __init__(self, context: StartContext) -> None:
        self._context = context
        self._textures = Textures()
        self._recovered: tuple[RecoveredWork, ...] | None = None
        self._recent_exists: dict[str, bool] = {}
        self._pictured = {path: picture(path).is_file() for path in preset_paths()}

    def close(self) -> None:
        """Release textures."""
        self._textures.clear()

    def draw(self) -> None:
        """Draw the screen, if it is open."""
        if "start" not in self._context.dialogs.open:
            self._recovered = None
            return
        if self._recovered is None:
            self._recovered = self._context.recovery.find_abandoned()
            self._recent_exists = {recent.path: recent.exists for recent in self._context.store.current.recent}
        covered = self._context.dialogs.browse is not None or self._context.dialogs.question is not None
        close = backdrop(self._context, "start") and not covered
        with dialog(self._context, "Start", (1180, 560)):
            height = imgui.get_content_region_avail().y
            imgui.begin_child("left", ImVec2(290 * ui_scale(), height), imgui.ChildFlags_.nav_flattened.value)
            self._draw_title()
            self._draw_recent()
            imgui.end_child()
            imgui.same_line(0, 18 * ui_scale())
            imgui.begin_child("right", ImVec2(0, height), imgui.ChildFlags_.nav_flattened.value)
            self._draw_recoveries(self._recovered)
            self._draw_presets()
            imgui.end_child()
            if not covered:
                close = close or escape_pressed()
                self._run_shortcuts()
        if close:
            self._context.dialogs.open.discard("start")

    def _run_shortcuts(self) -> None:
        """Run the shortcuts that work on the start screen."""
        for id in ("file.new", "file.open", "file.quit", "help.shortcuts"):
            keys = self._context.actions.shortcut(id)
            if keys and imgui.is_key_chord_pressed(chord(keys)):
                self._context.actions.run(id)

    def _draw_title(self) -> None:
        with font(self._context, "bold", 30.0):
            imgui.text_unformatted("Halation")
        draw_dim(self._context, "Screen-space effects, node by node")
        imgui.dummy(ImVec2(0, 8 * ui_scale()))
        width = imgui.get_content_region_avail().x
        if main_button(self._context, f"{icons.ICON_FA_PLUS}  New graph", "start new", width=width):
            self._context.actions.run("file.new")
        if imgui.button(f"{icons.ICON_FA_FOLDER_OPEN}  Open...", ImVec2(width, 0)):
            self._context.actions.run("file.open")
        record(self._context, "start open")
        if not self._context.store.current.hint_seen:
            self._draw_hint()

    def _draw_hint(self) -> None:
        imgui.dummy(ImVec2(0, 4 * ui_scale()))
        with font(self._context, "bold"):
            imgui.text_unformatted("First time here?")
        for line in HINTS:
            draw_wrapped(self._context.palette.dim, line)
        if quiet_button(self._context, f"{icons.ICON_FA_CHECK}  Got it", "hint seen", "Do not show this again"):
            self._context.log.attempt(lambda: self._context.store.change(hint_seen=True))

    def _draw_recent(self) -> None:
        imgui.dummy(ImVec2(0, 4 * ui_scale()))
        with font(self._context, "bold"):
            imgui.text_unformatted("Recent")
        if not self._context.store.current.recent:
            draw_dim(self._context, "Files that you open appear here.")
        for index, recent in enumerate(self._context.store.current.recent):
            imgui.push_id(index)
            self._draw_recent_row(index, recent)
            imgui.pop_id()

    def _draw_recent_row(self, index: int, recent: Recent) -> None:
        scale, path, there = ui_scale(), Path(recent.path), self._recent_exists.get(recent.path, True)
        line = imgui.get_text_line_height()
        room = imgui.get_content_region_avail().x - 30 * scale
        start = imgui.get_cursor_pos()
        imgui.set_next_item_allow_overlap()
        clicked, _ = imgui.selectable("##recent", False, 0, ImVec2(0, 2 * line + 4 * scale))
        record(self._context, f"recent {index}")
        tip(str(path) if there else f"{path}\nThis file no longer exists.")
        over = imgui.is_mouse_hovering_rect(imgui.get_item_rect_min(), imgui.get_item_rect_max())
        after = imgui.get_cursor_pos()
        imgui.set_cursor_pos(ImVec2(start.x + 4 * scale, start.y + scale))
        faint = mix(self._context.palette.dim, self._context.palette.panel, 0.4)
        imgui.text_colored(vec4(self._context.palette.text if there else faint), cut_middle(path.stem, room))
        imgui.set_cursor_pos(ImVec2(start.x + 4 * scale, start.y + line + 3 * scale))
        imgui.text_colored(vec4(self._context.palette.dim if there else faint), cut_middle(str(path.parent), room))
        if over:
            imgui.set_cursor_pos(ImVec2(start.x + room + 2 * scale, start.y + 4 * scale))
            if quiet_button(self._context, icons.ICON_FA_XMARK, f"forget {index}", "Remove it from this list"):
                self._context.store.forget(recent.path)
                clicked = False
        imgui.set_cursor_pos(after)
        imgui.dummy(ImVec2(0, 0))
        if clicked and there:
            self._context.documents.open_graph(path)
        elif clicked:
            self._context.log.add(
                f"{path}: this file no longer exists; restore it, or remove it from the list", "warning"
            )

    def _draw_recoveries(self, recovered: tuple[RecoveredWork, ...]) -> None:
        if not recovered:
            return
        with font(self._context, "bold"):
            imgui.text_colored(vec4(self._context.palette.warning), "Recover unsaved work")
        for index, work in enumerate(recovered):
            when = strftime("%Y-%m-%d %H:%M", localtime(work.time))
            nodes = "1 node" if work.nodes == 1 else f"{work.nodes} nodes"
            if main_button(self._context, "Recover", f"recover {index}", enabled=not work.fault):
                self._context.documents.recover(work)
                self._recovered = None
            imgui.same_line()
            if imgui.button(f"Discard##{index}"):
                self._context.log.attempt(work.discard)
                self._recovered = None
            record(self._context, f"discard {index}")
            imgui.same_line()
            imgui.text_unformatted(cut_middle(work.title, 200 * ui_scale()))
            tip(str(work.path or "never saved"))
            imgui.same_line()
            draw_dim(self._context, cut_middle(work.fault or f"{when}, {nodes}", imgui.get_content_region_avail().x))
        imgui.dummy(ImVec2(0, 6 * ui_scale()))

    def _draw_presets(self) -> None:
        scale = ui_scale()
        with font(self._context, "bold"):
            imgui.text_unformatted("Presets")
        gap = imgui.get_style().item_spacing.x
        room = imgui.get_content_region_avail().x
        count = max(int((room + gap) / (_CARD * scale + gap)), 1)
        width = (room - gap * (count - 1)) / count
        for index, path in enumerate(self._pictured):
            if index % count:
                imgui.same_line()
            self._draw_card(path, width)

    def _draw_card(self, path: Path, width: float) -> None:
        scale, palette = ui_scale(), self._context.palette
        name = path.stem.replace("_", " ")
        picture_height = width * _PICTURE_HEIGHT / _CARD
        size = ImVec2(width, picture_height + 26 * scale)
        clicked = imgui.invisible_button(f"##{path}", size)
        record(self._context, f"preset {path.stem}")
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        lines, rounding = imgui.get_window_draw_list(), imgui.get_style().frame_rounding
        lines.add_rect_filled(low, high, u32(palette.hover if imgui.is_item_hovered() else palette.raised), rounding)
        corner = ImVec2(high.x, low.y + picture_height)
        if self._pictured[path]:
            texture = self._textures.get(path, lambda: load_thumbnail(picture(path), sandbox=UNRESTRICTED))
            lines.add_image_rounded(texture, low, corner, ImVec2(0, 0), ImVec2(1, 1), 0xFFFFFFFF, rounding)
        lines.add_text(ImVec2(low.x + 8 * scale, corner.y + 5 * scale), u32(palette.text), name)
        if imgui.is_item_hovered():
            outline(palette.accent)
        if clicked:
            self._context.documents.open_preset(path)
