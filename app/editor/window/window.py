"""The window: sets up the library that hosts it, and draws all panels."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

from imgui_bundle import ImVec2, hello_imgui, imgui

import glfw  # isort: skip

from ...compiler import Form
from ...language.translation import translate
from ...renderer.opening import adopt_window
from ...resources.sandbox import Sandbox
from ..shared.dialogs import Browse
from ..shared.window_commands import PanelTitle
from ..theme import fonts, style
from ..timeline.timeline import HEIGHT, Timeline
from ..toolkit.labels import make_label, translate_label
from ..toolkit.places import Rect
from .appearance import Appearance, find_host
from .assembly import assemble, open_first, take_apart
from .contexts import Contexts, compose_contexts
from .dock_shares import DockShares
from .dropped_files import take_files
from .editor import Editor
from .frame_updater import FrameUpdater
from .full_screen import FullScreen, begin_filling, find_pointed_panel
from .guard import draw_failure, draw_guarded, enable_error_recovery
from .input_events import InputQueue
from .layouts import LAYOUTS, apply_layout, find_panel, make_splits
from .menus import MenuBar
from .painting import RESIZED, WindowPainter, measure_window
from .panels import DOCKED, OVERLAYS, Docked, Panel
from .resting import GRACE, FrameWaker, Settling, choose_idle_rate
from .screenshot import save_screenshot
from .shortcuts import note_scope, run_shortcuts
from .status import draw_status
from .walked_panel import WalkedPanel

SIZE = (1600, 1000)
_ASSETS = str(Path(__file__).parents[1] / "assets")
"""Has the icon of the window, where the library looks for it."""
_HIDDEN = 2
"""Frames in which panels stay empty: the library finds out which of them are behind the tabs of others."""
_APPEARING = 3
"""Frames until panels that are shown again are in their docks: each comes to the front there as it appears."""

_NODE = int(imgui.internal.DockNodeFlagsPrivate_.no_close_button.value)
"""Tabs can be closed, not whole docks."""


class Window:
    """One window with one editor, from opening to closing."""

    def __init__(
        self,
        path: Path | None,
        bindings: Mapping[str, str],
        sandbox: Sandbox,
        *,
        first_action: str = "",
        version: tuple[int, int] = (4, 5),
        state: Path | None = None,
        size: tuple[int, int] = SIZE,
        form: Form | None = None,
        on_shown: Callable[[], None] = lambda: None,
    ) -> None:
        self._on_shown = on_shown
        self._path, self._bindings, self._sandbox, self._state = path, dict(bindings), sandbox, state
        self._form: Form | None = form
        self.editor: Editor
        self._contexts: Contexts
        self._panels: dict[str, Panel] = {}
        self._overlays, self._first_action = dict[str, Panel](), first_action
        self._updater: FrameUpdater
        self._waker: FrameWaker
        self._worked_at, self._settling = 0.0, Settling()
        self._hidden: tuple[PanelTitle, ...] = ()
        """Panels that are hidden while another one fills the window."""
        self._front: frozenset[PanelTitle] = frozenset()
        """The panels in front of their docks, as they were before one filled the window."""
        self._front_again: tuple[PanelTitle, ...] = ()
        self._front_at = 0
        """Panels that come to the front from that frame on: one in each, as a tab follows only the last focus."""
        self._filling: PanelTitle | None = None
        """The panel that fills the window."""
        self._docks = DockShares(lambda name: self.params.docking_params.dock_space_id_from_name(name))
        self._dropped, self._input = list[str](), InputQueue()
        self._fronted: set[str] = set()
        self._appearance = Appearance()
        self._layout = LAYOUTS["composite"]
        self.params = self._make_params(version, size)
        self._menu_bar, self._walked_panel = MenuBar(), WalkedPanel()
        self._full_screen = FullScreen(self.params)
        self.frames = 0
        self.fault: Exception | None = None
        """Why the window could not begin."""
        self._closed = False

    # --- what the host asks for --------------------------------------------------------------------------------------

    def _make_params(self, version: tuple[int, int], size: tuple[int, int]) -> hello_imgui.RunnerParams:
        params = hello_imgui.RunnerParams()
        params.app_window_params.window_title = "Halation"
        hello_imgui.set_assets_folder(_ASSETS)
        params.app_window_params.window_geometry.size = size
        params.app_window_params.restore_previous_geometry = True
        options = params.renderer_backend_options.open_gl_options or hello_imgui.OpenGlOptions()
        options.major_version, options.minor_version = version
        options.use_core_profile = options.use_forward_compat = True
        options.glsl_version = "410"
        options.anti_aliasing_samples = 0
        params.renderer_backend_options.open_gl_options = options
        window = params.imgui_window_params
        window.default_imgui_window_type = hello_imgui.DefaultImGuiWindowType.provide_full_screen_dock_space
        window.show_menu_bar = window.show_status_bar = True
        window.show_menu_app = window.show_menu_view = window.show_status_fps = False
        window.remember_theme = window.remember_status_bar_settings = False
        params.fps_idling.time_active_after_last_event = 0.0  # `resting` knows about events, the library does not
        params.docking_params.docking_splits = make_splits(self._layout)
        params.docking_params.main_dock_space_node_flags |= _NODE
        params.docking_params.dockable_windows = [self._dockable(docked) for docked in DOCKED]
        calls = params.callbacks
        calls.load_additional_fonts = self._load_fonts
        calls.post_init = self._begin
        calls.pre_new_frame = self._input.forward
        calls.post_new_frame = self._before_panels
        calls.show_menus = self._draw_menus
        calls.show_status = self._draw_status
        bar = hello_imgui.EdgeToolbarOptions(size_em=HEIGHT / style.EM, window_padding_em=ImVec2(0.0, 0.0))
        calls.add_edge_toolbar(hello_imgui.EdgeToolbarType.bottom, self._draw_timeline, bar)
        calls.show_gui = self._draw_overlays
        calls.before_imgui_render = self._after_panels
        calls.custom_background = _draw_nothing
        calls.before_swap = self._before_swap
        calls.after_swap = self._after_swap
        calls.confirm_exit = self._confirm_exit
        calls.before_exit = self.close
        return params

    def _dockable(self, docked: Docked) -> hello_imgui.DockableWindow:
        dockable = hello_imgui.DockableWindow(
            make_label("", docked.title), docked.dock, partial(self._draw_panel, docked)
        )
        dockable.include_in_view_menu = dockable.call_begin_end = False
        return dockable

    # --- from opening to closing -------------------------------------------------------------------------------------

    def _begin(self) -> None:
        """The library crashes if anything is raised from here, and leaves nothing to close."""
        try:
            self._prepare()
        except Exception as error:
            self.fault = error
            self.params.app_shall_exit = True

    def _prepare(self) -> None:
        enable_error_recovery()
        self.device = adopt_window(self._form, sandbox=self._sandbox)
        self._painter = WindowPainter(self.device, is_able=not self.params.use_imgui_test_engine)
        self.editor = assemble(self.device, self._sandbox, self._state)
        open_first(self.editor, self._path, self._bindings)
        self._contexts = compose_contexts(self.editor)
        self._updater = FrameUpdater(self.editor, self._contexts)
        self._waker = FrameWaker(lambda: self.editor.watcher.has_news)
        self._panels = {docked.title: docked.make(self._contexts) for docked in DOCKED}
        self._panels["Timeline"] = Timeline(self._contexts.timeline)
        self._overlays = {name: make(self._contexts) for name, make in OVERLAYS}
        if self._first_action:
            self.editor.actions.run(self._first_action)
        imgui.get_io().config_flags |= int(imgui.ConfigFlags_.nav_enable_keyboard)
        imgui.get_io().config_drag_click_to_input_text = True
        self._input.connect(find_host())
        glfw.set_window_refresh_callback(find_host(), lambda _: self._painter.redraw_all(RESIZED))
        glfw.set_drop_callback(find_host(), lambda _, paths: self._dropped.extend(paths))  # pyright: ignore

    def _load_fonts(self) -> None:
        """Comes after `_begin`."""
        if self.fault is None:
            self.editor.interface.fonts = fonts.load()

    def close(self) -> None:
        """Release everything, once; unsaved work is kept, unless the user discarded it."""
        if self._closed:
            return
        self._closed = True
        self._restore_panels()  # the next window begins with all of them
        for panel in (*self._panels.values(), *self._overlays.values()):
            getattr(panel, "close", bool)()
        if hasattr(self, "_waker"):
            self._waker.close()
        if hasattr(self, "editor"):
            take_apart(self.editor)

    def _confirm_exit(self) -> bool:
        return self.fault is not None or self._contexts.documents.ask_to_close()

    @property
    def _has_begun(self) -> bool:
        """True from the frame on before which panels were seen: until then nothing else takes time."""
        return self.frames > _HIDDEN + 1

    # --- every frame -------------------------------------------------------------------------------------------------

    def _before_panels(self) -> None:
        """Prepare a frame, and work on pictures before any panel is drawn: all panels of a frame show one state.

        The window becomes the target again whatever happens, or the interface would be drawn into a texture.
        """
        if self.fault is not None:
            return
        editor = self.editor
        self.frames += 1
        if self._appearance.follow(self.editor):
            self._painter.redraw_all()
        self._docks.follow_window()
        editor.interface.walked_panel = self._walked_panel.follow()
        editor.interface.pointed_panel = editor.interface.walked_panel or find_pointed_panel(editor.places)
        if self._filling is None:
            self._front = frozenset(title for title in PanelTitle if title in editor.places)
        if self._front_again and self.frames >= self._front_at:
            self._fronted.add(self._front_again[0])
            self._front_again = self._front_again[1:]
        self._contexts.tutorials.progress.note_widgets(editor.places)
        editor.places.clear()
        if not any(map(imgui.is_mouse_down, (imgui.MouseButton_.left, imgui.MouseButton_.middle))):
            editor.interface.dragging = False
        note_scope(editor)
        editor.canvas.hovered = editor.viewer.hovered = editor.curves.hovered = False
        if self._has_begun:
            try:
                draw_guarded(editor, "Rendering", self._updater.update)
            finally:
                self.device.target_window()
        if self._dropped:
            paths, self._dropped = [Path(path) for path in self._dropped], []
            editor.log.attempt(lambda: take_files(editor, self._contexts.documents, paths))
        if editor.commands.closing:
            self.params.app_shall_exit = True
        self._serve_commands()
        self._rest()

    def _draw_menus(self) -> None:
        windows = {docked.title: find_panel(self.params, docked.title) for docked in DOCKED}
        visible = {title: window.is_visible for title, window in windows.items()}
        draw_guarded(self.editor, "Menus", lambda: self._menu_bar.draw(self._contexts.dialogs, visible))
        for title, is_shown in visible.items():
            windows[title].is_visible = is_shown

    def _draw_status(self) -> None:
        draw_guarded(self.editor, "Status", lambda: draw_status(self.editor, self._contexts))

    def _draw_timeline(self) -> None:
        self._draw_inside("Timeline")

    def _draw_panel(self, docked: Docked) -> None:
        host = find_panel(self.params, docked.title)
        label = translate_label(docked.title)
        if docked.bare:
            imgui.push_style_var(imgui.StyleVar_.window_padding, (0.0, 0.0))
        if docked.title in self._fronted:  # the library only does so for windows that it begins itself
            self._fronted.discard(docked.title)
            imgui.set_next_window_focus()
        if docked.title == self._filling:
            is_seen = begin_filling(docked.title, self._find_dock_area(), style.UNSCROLLED if docked.bare else 0)
        else:
            is_seen, stays = imgui.begin(label, host.is_visible, style.UNSCROLLED if docked.bare else 0)
            host.is_visible = bool(stays)
        if docked.bare:
            imgui.pop_style_var()
        if is_seen and self.frames > _HIDDEN:
            self._draw_inside(docked.title)
        imgui.end()

    def _find_dock_area(self) -> Rect:
        """The part of the window that holds the panels."""
        node = imgui.internal.dock_builder_get_node(
            self.params.docking_params.dock_space_id_from_name("MainDockSpace") or 0
        )
        while node.parent_node is not None:
            node = node.parent_node
        return node.pos.x, node.pos.y, node.pos.x + node.size.x, node.pos.y + node.size.y

    def _draw_inside(self, title: str) -> None:
        corner, size = imgui.get_window_pos(), imgui.get_window_size()
        self.editor.places[title] = (corner.x, corner.y, corner.x + size.x, corner.y + size.y)
        if title in self.editor.faults:
            draw_failure(self.editor, title)
        else:
            draw_guarded(self.editor, title, self._panels[title].draw)

    def _draw_overlays(self) -> None:
        for name, overlay in self._overlays.items():
            failed_before = name in self.editor.faults
            if not draw_guarded(self.editor, name, overlay.draw) and not failed_before:
                self.editor.dialogs.close()  # a hidden window would take all keys
        run_shortcuts(self.editor)

    def _after_panels(self) -> None:
        """Panels draw pictures of their own: the screen must be bound again before the window is drawn."""
        self.device.target_window()
        self._painter.paint(is_empty=self.frames <= _HIDDEN)

    def _before_swap(self) -> None:
        if self.fault is None:
            self._painter.leave_mark()

    def _after_swap(self) -> None:
        if self.fault is None:
            self._painter.check_mark()
        if self.frames == _HIDDEN + 1:
            self._on_shown()

    # --- parts -------------------------------------------------------------------------------------------------------

    def _rest(self) -> None:
        """Say how often the next frames come."""
        editor, time_now = self.editor, imgui.get_time()
        if not self._has_begun or self._updater.is_working or editor.timeline.playback.playing or editor.viewer.finding:
            self._worked_at = time_now
        resting = self.params.fps_idling
        resting.enable_idling = (time_now - self._worked_at > GRACE or self._updater.waits_long) and not self._input
        settling = self._settling.choose_rate(self._input.has_forwarded, time_now)
        resting.fps_idle = max(settling, choose_idle_rate(editor))

    def _serve_commands(self) -> None:
        """Do what panels and actions asked the window to do."""
        commands = self.editor.commands
        if commands.layout is not None:
            self._restore_panels()
            self._layout, commands.layout = LAYOUTS[commands.layout], None
            apply_layout(self.params, self._layout)
            self._front_again, self._front_at = self._layout.front, self.frames + _APPEARING
        if commands.saves_screenshot:
            commands.saves_screenshot = False
            self._screenshot()
        if commands.maximizes_pointed:
            commands.maximizes = self.editor.interface.pointed_panel or self._filling
            commands.maximizes_pointed = False
        if commands.toggles_full_screen:
            commands.toggles_full_screen = False
            if self._full_screen.toggle() is (self._filling is None):
                commands.maximizes = PanelTitle.VIEWER
        if commands.maximizes is not None:
            self._maximize(commands.maximizes)
            commands.maximizes = None
        if any(title != self._filling for title in commands.panels):
            self._restore_panels()  # else the panel would be below the one that fills the window
        if commands.panels:
            docks = {docked.title: self._layout.find_dock(docked.title, docked.dock) for docked in DOCKED}
            new_docks = {docks[title] for title in commands.panels}
            others = (title for title in self._front_again if docks[title] not in new_docks)
            self._front_again = (*others, *commands.panels)
        for title in commands.panels:
            find_panel(self.params, title).is_visible = True
            self._fronted.add(title)
        commands.panels.clear()

    def _maximize(self, title: PanelTitle) -> None:
        """Hide all panels but one, or show again those that were hidden for one."""
        if self._restore_panels():
            return
        panels = {docked.title: find_panel(self.params, docked.title) for docked in DOCKED}
        self._filling = title
        self._hidden = tuple(name for name, panel in panels.items() if panel.is_visible and name != title)
        for name in self._hidden:
            panels[name].is_visible = False
        panels[title].is_visible = True
        imgui.set_nav_cursor_visible(False)  # the panel gets the focus, but the user did not choose anything in it

    def _restore_panels(self) -> bool:
        """Show the panels that were hidden for one; False if none was."""
        hidden, self._hidden = self._hidden, ()
        if self._filling is not None:
            self._front_again, self._front_at = tuple(sorted(self._front)), self.frames + _APPEARING
        was_filling, self._filling = self._filling is not None, None
        for name in hidden:
            find_panel(self.params, name).is_visible = True
        return was_filling

    def _screenshot(self) -> None:
        """Save the window as it was shown last."""
        pixels = self.device.read_window(measure_window())
        self._painter.redraw_all()
        self.editor.dialogs.browse = Browse(
            translate("Save a screenshot"),
            "export",
            lambda path: self.editor.log.attempt(lambda: save_screenshot(path, pixels)),
            saving=True,
            name="halation.png",
        )


def _draw_nothing() -> None:
    """The background: the painter clears where it draws, so that the rest of the window stays."""
