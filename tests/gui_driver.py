"""Runs the real editor in a real OpenGL window without a display, moved by a simulated mouse and keyboard.

The clock of the window goes on by a sixtieth of a second per frame, however long the machine needs for it: double
clicks, repeated keys, and whatever else depends on how quick the user is, are the same on a busy machine.
HALATION_SHOTS=folder takes screenshots and keeps them there. HALATION_TEST_FORM=fragment is OpenGL 4.1, as on macOS.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from devices import form_to_test
from halation.editor.toolkit.keys import chord
from halation.editor.window.editor import Editor
from halation.editor.window.opengl import needs_no_display
from halation.editor.window.painting import view_commands
from halation.editor.window.window import Window
from halation.resources.sandbox import UNRESTRICTED
from imgui_bundle import ImVec2, hello_imgui, imgui, immapp
from imgui_bundle.immapp import testing

FRAME_SECONDS = 1.0 / 60.0
PATIENCE = 120.0
"""Seconds of real time after which what never became true fails a test; a busy machine needs some of them."""

PROMPT, REST = 0.5, 0.1
"""Seconds after which what a test waits for is taken for the work of another process, and then between two frames: a
window that draws all the time takes the processor from whoever it waits for. Its own preview is made in frames."""

CANVAS = (480, 270)
"""Pixels of a graph's picture where neither it nor a file says how large it is: a sixteenth of what a user sees."""

UNSEEN = 0.1
"""The part of the window's width and height in which the grounds of docks, which come after all panels, are drawn while
nobody looks. With 0 the library ends the process."""

TITLE, SPLITTER = 24.0, 6.0
"""Pixels of a panel that its title takes, and those at its border where a click takes the splitter (4 in ImGui)."""

SHOTS = os.environ.get("HALATION_SHOTS", "")
"""The folder for screenshots; "" for none."""

immapp.run = immapp.immapp_cpp.run
"""Without what the package wraps it in: for each window that reads the sources of all loaded modules, to see whether it
is in a tutorial of its own."""

T = TypeVar("T")
Point = tuple[float, float]


@dataclass
class Ui:
    """A person at the editor. Places are names in `editor.places`, or points on the screen."""

    window: Window
    ctx: Any
    folder: Path
    is_seen: bool = True
    """False lays the window out and hits what is there, and draws no panel: a quarter of the processor time of a test
    is saved. Screenshots are of a window that is seen."""
    last_click: str = "none"
    """Where the last click was, and what was there then."""
    _asked: list[Callable[[], object]] = field(default_factory=list)

    @property
    def editor(self) -> Editor:
        return self.window.editor

    @property
    def session(self):
        return self.editor.session

    def wait(self, frames: int = 3) -> None:
        """Let the window draw."""
        self.ctx.yield_(frames)

    def until(self, question: Callable[[], bool], seconds: float = PATIENCE) -> None:
        """Wait for something to become true, and for the frame that shows it: rows may move then."""
        self._wait_for(question, seconds)
        self.wait(1)

    def _wait_for(self, question: Callable[[], bool], seconds: float = PATIENCE) -> None:
        began = time.monotonic()
        while not question():
            waited = time.monotonic() - began
            assert waited < seconds, "this never became true"
            if waited > PROMPT and not self.editor.preview.busy:
                time.sleep(REST)
            self.ctx.yield_()

    def settled(self) -> None:
        """Wait until all pictures are ready."""
        self.wait(3)
        self.until(lambda: not self.editor.preview.busy)
        self.wait(2)

    def ask(self, question: Callable[[], T]) -> T:
        """What the window answers in its own thread, the only one that may touch pixels."""
        answers: list[T] = []
        self._asked.append(lambda: answers.append(question()))
        self._wait_for(lambda: bool(answers))
        return answers[0]

    def answer(self) -> None:
        """What was asked; to be called by the window."""
        while self._asked:
            self._asked.pop(0)()

    def at(self, place: str | Point, fraction: Point = (0.5, 0.5)) -> Point:
        """A point in a place; its middle if nothing else is said."""
        if not isinstance(place, str):
            return place
        if place not in self.editor.places:
            self.wait(2)
        assert place in self.editor.places, f"no '{place}' is shown; there is {sorted(self.editor.places)}"
        left, top, right, bottom = self.editor.places[place]
        return left + (right - left) * fraction[0], top + (bottom - top) * fraction[1]

    def move(self, place: str | Point, fraction: Point = (0.5, 0.5)) -> None:
        """Move the mouse."""
        self.ctx.mouse_move_to_pos(ImVec2(*self.at(place, fraction)))

    def click(self, place: str | Point, button: int = 0, fraction: Point = (0.5, 0.5), keys: str = "") -> None:
        """Click, holding modifier keys such as "Ctrl"."""
        point = self.at(place, fraction)
        self.move(point)
        self.last_click = f"at {point}, where {place} was"
        with self.held(keys):
            self.ctx.mouse_click(button)
        self.wait(3)

    def double_click(self, place: str | Point, fraction: Point = (0.5, 0.5)) -> None:
        """Click twice."""
        self.move(place, fraction)
        self.ctx.mouse_double_click(0)
        self.wait(3)

    def drag(
        self,
        start: str | Point,
        end: str | Point,
        button: int = 0,
        keys: str = "",
        release: bool = True,
        fraction: Point = (0.5, 0.5),
    ) -> None:
        """Press at one place, let go at another."""
        target = self.at(end)
        self.move(start, fraction)
        with self.held(keys):
            self.ctx.mouse_down(button)
            self.ctx.mouse_lift_drag_threshold(button)
            self.wait(1)
            self.ctx.mouse_move_to_pos(ImVec2(*target))
            self.wait(2)
            if release:
                self.ctx.mouse_up(button)
                self.wait(3)

    def held(self, keys: str):
        """Hold modifier keys inside a block."""
        return _HeldKeys(self.ctx, keys)

    def wheel(self, steps: float) -> None:
        """Turn the wheel where the mouse is."""
        self.ctx.mouse_wheel_y(steps)
        self.wait(2)

    def reveal(self, place: str, panel: str = "Inspector") -> None:
        """Turn the wheel over a panel until a place is between its title and its border, where splitters are hit."""
        self.wait(2)
        for _ in range(60):
            _, first, _, last = self.editor.places[panel]
            _, top, _, bottom = self.editor.places[place]
            if first + TITLE <= top and bottom <= last - SPLITTER:
                return
            self.move(panel, (0.02, 0.5))
            self.wheel(1.0 if top < first + TITLE else -1.0)
        raise AssertionError(f"'{place}' cannot be scrolled to")

    def keys(self, text: str) -> None:
        """Press a shortcut such as "Ctrl+Z" once."""
        self.ctx.key_press(chord(text))
        self.wait(3)

    def type(self, text: str, enter: bool = True) -> None:
        """Replace the text of the field that is being edited: key by key, as a hand does, a frame for each."""
        self.ctx.key_press(chord("Ctrl+A"))
        self.ctx.key_press(chord("Delete"))
        for character in text:
            self.ctx.key_chars(character)
            self.wait(1)
        if enter:
            self.ctx.key_press(chord("Enter"))
        self.wait(3)

    def show_panel(self, title: str) -> None:
        """Bring a docked panel to the front."""
        self.ctx.window_focus(f"//{title}")
        self.wait(4)

    def describe(self) -> str:
        """What helps to see why a test failed: the messages, what the mouse is over, and where it clicked last."""
        said = "".join(f"\n  {entry.level}: {entry.sentence}\n{entry.detail}" for entry in self.editor.log.entries)
        window, mouse = imgui.get_current_context().hovered_window, imgui.get_io().mouse_pos
        over = [name for name, (left, top, right, bottom) in self.editor.places.items()
                if left <= mouse.x <= right and top <= mouse.y <= bottom]  # fmt: skip
        return (
            f"last click: {self.last_click}\nmouse at ({mouse.x}, {mouse.y}), over {over} of the window "
            f"'{window.name if window else ''}'\nmessages: {said or 'none'}"
        )

    def shot(self, name: str) -> None:
        """A screenshot for who sets HALATION_SHOTS: to draw all pixels and to write them takes 0.7 s of a processor."""
        if SHOTS:
            self.capture(Path(SHOTS) / name)
        else:
            self.wait(3)

    def capture(self, path: Path) -> Path:
        """A screenshot in a file."""
        path.parent.mkdir(parents=True, exist_ok=True)
        was_seen, self.is_seen = self.is_seen, True
        self.wait(2)
        testing.capture(self.ctx, str(path))
        self.is_seen = was_seen
        return path

    def pixels(self, name: str = "seen.png") -> np.ndarray:
        """The window as [height, width, 3] of 8 bits."""
        import OpenImageIO as oiio

        pixels = oiio.ImageBuf(str(self.capture(self.folder / name))).get_pixels(oiio.UINT8)
        assert pixels is not None
        return pixels[..., :3]


class _HeldKeys:
    def __init__(self, ctx: Any, keys: str) -> None:
        self._ctx, self._keys = ctx, chord(f"{keys}+A") - chord("A") if keys else 0

    def __enter__(self) -> None:
        if self._keys:
            self._ctx.key_down(self._keys)

    def __exit__(self, *_: object) -> None:
        if self._keys:
            self._ctx.key_up(self._keys)


def drive(
    body: Callable[[Ui], object],
    folder: Path,
    path: Path | None = None,
    bindings: Mapping[str, str] | None = None,
    size: tuple[int, int] = (1400, 900),
    likes: Mapping[str, object] | None = None,
    faulty: bool = False,
    content_scale: float = 1.0,
    is_seen: bool = False,
) -> Window:
    """Open the editor, run `body(ui)` beside it, and close it. Its state is in `folder / "state"`.

    `content_scale` is that of the display: 2 for one of 192 dots per inch; `size` grows with it.
    A panel that fails, or anything else that says it is a fault in Halation, fails the test unless it is `faulty`.
    """
    window = headless(folder, path, bindings, size)
    window.params.dpi_aware_params.dpi_window_size_factor = content_scale
    window.params.fps_idling.enable_idling = False

    ui = Ui(window, None, folder, is_seen)
    join_frames(ui)

    def run_test(ctx: Any) -> None:
        ui.ctx = ctx
        engine = imgui.test_engine.get_io(hello_imgui.get_imgui_test_engine())
        engine.config_watchdog_warning = engine.config_watchdog_kill_test = 600.0
        engine.config_fixed_delta_time = FRAME_SECONDS
        began = time.time() - imgui.get_time()
        window.editor.log.clock = lambda: began + imgui.get_time()
        imgui.get_io().config_error_recovery_enable_assert = True  # what a panel leaves open is a fault here
        if likes:
            ui.editor.store.change(**likes)
        ui.wait(8)
        try:
            body(ui)
        except Exception as error:
            error.add_note(ui.describe())
            raise
        found = [entry for entry in ui.editor.log.entries if entry.detail]
        assert faulty or not found, "\n".join(f"{entry.sentence}\n{entry.detail}" for entry in found)

    testing.run(test_function=run_test, runner_params=window.params, add_ons_params=immapp.AddOnsParams())
    return window


def join_frames(ui: Ui) -> None:
    """Take part in each frame of the window: answer what was asked, draw nothing that nobody sees, close at once."""
    calls = ui.window.params.callbacks
    before_panels, after_panels, end = calls.post_new_frame, calls.before_imgui_render, calls.before_exit

    def start_frame() -> None:
        before_panels()
        ui.answer()
        if not ui.is_seen:
            imgui.get_main_viewport().framebuffer_scale = ImVec2(UNSEEN, UNSEEN)

    def end_frame() -> None:
        after_panels()
        if not ui.is_seen:
            leave_undrawn()

    def leave() -> None:
        ui.editor.commands.closing = True  # as if a person had said so
        end()

    calls.post_new_frame, calls.before_imgui_render, calls.before_exit = start_frame, end_frame, leave


def leave_undrawn() -> None:
    """Take the triangles out of what the panels of this frame have drawn; to be called when all are complete."""
    for panel in imgui.get_current_context().windows:
        if panel.active:
            view_commands(panel.draw_list)["count"] = 0


def headless(
    folder: Path,
    path: Path | None = None,
    bindings: Mapping[str, str] | None = None,
    size: tuple[int, int] = (1400, 900),
) -> Window:
    """A window that is ready to run and needs no display: what it shows is real all the same."""
    assert needs_no_display()
    state = folder / "state"
    state.mkdir(exist_ok=True)
    form = form_to_test()
    version = (4, 1) if form == "fragment" else (4, 5)
    window = Window(path, bindings or {}, version=version, state=state, size=size, form=form, sandbox=UNRESTRICTED)
    window.params.ini_disable = True
    return window
