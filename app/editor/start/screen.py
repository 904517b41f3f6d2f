"""The start screen: presets, recent files, unsaved work."""

from __future__ import annotations

import re
from time import localtime, strftime
from typing import TYPE_CHECKING

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...authoring.recovery.recovery import RecoveredWork
from ...language.translation import mark, translate, translate_plural
from ..theme.style import ui_scale, vec4
from ..toolkit.buttons import entry, main_button, quiet_button
from ..toolkit.dialogs import backdrop, dialog, escape_pressed
from ..toolkit.keys import chord, display_shortcut
from ..toolkit.labels import make_label
from ..toolkit.places import record
from ..toolkit.words import cut_middle, draw_dim, draw_wrapped, font, tip
from .gallery import PresetGallery
from .recent import RecentList

if TYPE_CHECKING:
    from .context import StartContext

HINTS = (
    mark("{node.add} adds a node. Drag from a socket to empty canvas to add one that fits."),
    mark(
        "Double-click a node to view it. {viewer.assign.1} assigns it to the key "
        "{viewer.recall.1}, which shows it again."
    ),
    mark("Drop pictures and graphs on the window."),
    mark("{help.palette} finds every command, {help.shortcuts} shows all shortcuts."),
    mark("Unsaved work comes back after a crash."),
)


class StartScreen:
    """The start screen, which opens at the start and from the File menu."""

    def __init__(self, context: StartContext) -> None:
        self._context = context
        self._recovered: tuple[RecoveredWork, ...] | None = None
        self._gallery = PresetGallery(context)
        self._recent = RecentList(context)

    def close(self) -> None:
        """Release textures."""
        self._gallery.close()
        self._recent.close()

    def draw(self) -> None:
        """Draw the screen, if it is open."""
        if "start" not in self._context.dialogs.open:
            self._recovered = None
            return
        if self._recovered is None:
            self._recovered = self._context.recovery.find_abandoned()
            self._gallery.begin()
            self._recent.begin()
        covered = self._context.dialogs.browse is not None or self._context.dialogs.question is not None
        close = backdrop(self._context, "start") and not covered
        with dialog(self._context, "Start", (1240, 640)):
            height = imgui.get_content_region_avail().y
            imgui.begin_child("left", ImVec2(290 * ui_scale(), height), imgui.ChildFlags_.nav_flattened.value)
            self._draw_title()
            self._recent.draw()
            imgui.end_child()
            imgui.same_line(0, 18 * ui_scale())
            imgui.begin_child("right", ImVec2(0, height), imgui.ChildFlags_.nav_flattened.value)
            self._draw_recoveries(self._recovered)
            self._gallery.draw(covered)
            imgui.end_child()
            if not covered:
                close = close or escape_pressed()
                self._run_shortcuts()
        if close:
            self._context.dialogs.open.discard("start")

    def _run_shortcuts(self) -> None:
        """Run the shortcuts that work on the start screen."""
        for id in ("file.new", "file.open", "file.open_render", "file.quit", "help.shortcuts", "help.palette"):
            keys = self._context.actions.shortcut(id)
            if keys and imgui.is_key_chord_pressed(chord(keys)):
                self._context.actions.run(id)

    def _draw_title(self) -> None:
        with font(self._context, "bold", 30.0):
            imgui.text_unformatted("Halation")
        draw_dim(self._context, translate("Screen-space effects, node by node"))
        imgui.dummy(ImVec2(0, 8 * ui_scale()))
        width = imgui.get_content_region_avail().x
        if main_button(self._context, f"{icons.ICON_FA_PLUS}  {translate('New graph')}", "start new", width=width):
            self._context.actions.run("file.new")
        if imgui.button(make_label(f"{icons.ICON_FA_FOLDER_OPEN}  {translate('Open...')}", "open"), ImVec2(width, 0)):
            self._context.actions.run("file.open")
        record(self._context, "start open")
        if imgui.button(
            make_label(f"{icons.ICON_FA_FILM}  {translate('Open Render...')}", "open render"), ImVec2(width, 0)
        ):
            self._context.actions.run("file.open_render")
        record(self._context, "start open render")
        tip(translate("Start a graph that reads the layers of a render, or a picture or sequence"))
        self._draw_menu(
            mark("Tutorials"), icons.ICON_FA_GRADUATION_CAP, "tutorial.", translate("Five minutes each, in the editor")
        )
        doc = translate("Twelve short lessons about the techniques of screen-space effects, each with a task")
        self._draw_menu(mark("Lessons"), icons.ICON_FA_BOOK_OPEN, "lesson.", doc)
        if not self._context.store.current.hint_seen:
            self._draw_hint()

    def _draw_menu(self, label: str, icon: str, prefix: str, doc: str) -> None:
        """Draw a button that lists the actions whose ids begin with `prefix`."""
        name = f"start {label.lower()}"
        if imgui.button(
            make_label(f"{icon}  {translate(label)}", label), ImVec2(imgui.get_content_region_avail().x, 0)
        ):
            imgui.open_popup(name)
        record(self._context, name)
        tip(doc)
        if imgui.begin_popup(name):
            for action in self._context.actions.all:
                if action.id.startswith(prefix):
                    entry(self._context, action)
            imgui.end_popup()

    def _draw_hint(self) -> None:
        imgui.dummy(ImVec2(0, 4 * ui_scale()))
        with font(self._context, "bold"):
            imgui.text_unformatted(translate("First time here?"))
        for line in HINTS:
            draw_wrapped(self._context.palette.dim, self._fill_in_keys(translate(line)))
        if quiet_button(
            self._context,
            f"{icons.ICON_FA_CHECK}  {translate('Got it')}",
            "hint seen",
            translate("Do not show this again"),
        ):
            self._context.log.attempt(lambda: self._context.store.change(hint_seen=True))

    def _fill_in_keys(self, line: str) -> str:
        """The text with the current shortcuts of the actions that it names in braces."""
        actions = self._context.actions
        return re.sub(r"\{([\w.]+)\}", lambda match: display_shortcut(actions.shortcut(match[1])), line)

    def _draw_recoveries(self, recovered: tuple[RecoveredWork, ...]) -> None:
        if not recovered:
            return
        with font(self._context, "bold"):
            imgui.text_colored(vec4(self._context.palette.warning), translate("Recover unsaved work"))
        for index, work in enumerate(recovered):
            when = strftime("%Y-%m-%d %H:%M", localtime(work.time))
            nodes = translate_plural("{count} node", "{count} nodes", work.nodes)
            if main_button(self._context, translate("Recover"), f"recover {index}", enabled=not work.fault):
                self._context.documents.recover(work)
                self._recovered = None
            imgui.same_line()
            if imgui.button(make_label(translate("Discard"), f"discard {index}")):
                self._context.log.attempt(work.discard)
                self._recovered = None
            record(self._context, f"discard {index}")
            imgui.same_line()
            imgui.text_unformatted(cut_middle(work.title, 200 * ui_scale()))
            tip(str(work.path or translate("never saved")))
            imgui.same_line()
            draw_dim(self._context, cut_middle(work.fault or f"{when}, {nodes}", imgui.get_content_region_avail().x))
        imgui.dummy(ImVec2(0, 6 * ui_scale()))
