"""The whole editor on a device without pixels, its panels drawn into a still window: opened in a hundredth of a second.

What needs pictures, threads or an operating system's window is tested in tests/gui; here is what panels show and where,
and what a click in them does to the document.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from drawn_shapes import Point, Shape
from halation.authoring.background.cache import BackgroundCache
from halation.authoring.commands import ReplaceGraph
from halation.authoring.edits.element_id import ElementId
from halation.compiler import NULL
from halation.editor.browser import listing
from halation.editor.theme.fonts import Fonts
from halation.editor.theme.palette import PALETTES
from halation.editor.timeline.timeline import Timeline
from halation.editor.toolkit.textures import Textures
from halation.editor.viewer.wanted import list_wanted_ports, list_whole_sides
from halation.editor.window.assembly import assemble, take_apart
from halation.editor.window.contexts import Contexts, compose_contexts
from halation.editor.window.editor import Editor
from halation.editor.window.panels import DOCKED, OVERLAYS, Panel
from halation.editor.window.status import draw_status
from halation.graph import Graph, Port
from halation.resources.sandbox import UNRESTRICTED
from imgui_bundle import imgui
from null_device import NullDevice
from still_window import StillWindow, open_still

PATIENCE = 60.0
"""Seconds for files that threads read."""


@dataclass
class StillEditor:
    """An editor and the pane that its panels are drawn into, one at a time."""

    pane: StillWindow
    editor: Editor
    contexts: Contexts
    panels: dict[str, Panel] = field(default_factory=dict[str, Panel])

    @property
    def places(self) -> dict[str, tuple[float, float, float, float]]:
        return self.editor.places

    def show(self, title: str, frames: int = 3) -> list[Shape]:
        """Draw a panel or a dialog; all that it has drawn in the last frame."""
        body = self.find(title).draw
        self.pane.draw(self._frame(body), frames)
        return [*self.pane.shapes.shapes, *self.pane.widgets]

    def compute(self) -> None:
        """Make the pictures that panels want: they have sizes, and pixels that are all black."""
        context, preview, session = self.contexts.viewer, self.editor.preview, self.editor.session
        deadline = time.monotonic() + PATIENCE
        while True:
            wanted, scale = list_wanted_ports(context)
            ports = {name: Port("/".join((*session.place, port.node)), port.socket) for name, port in wanted.items()}
            preview.want(
                session.root, ports, bindings=session.bindings, scale=scale, frame=session.time.frame,
                whole=list_whole_sides(context),
            )  # fmt: skip
            preview.work(1.0)
            if all(preview.find_whole_image(name) or preview.fault(name) for name in ports) and not preview.busy:
                return
            assert time.monotonic() < deadline, "a file is not read"
            time.sleep(0.005)

    def click(self, title: str, place: str, button: int = 0, part: Point = (0.5, 0.5)) -> None:
        """Click at a part of a place of a panel, by the place's name."""
        self.show(title, 1)
        self.click_at(title, self.find_point(place, part), button)

    def click_at(self, title: str, point: Point, button: int = 0) -> None:
        """Click at a point while a panel is drawn."""
        self.pane.click((*point, *point), self._frame(self.find(title).draw), button)
        self.show(title, 2)

    def type(self, title: str, place: str, text: str, part: Point = (0.5, 0.5)) -> None:
        """Click in a field, replace its text, and press Enter."""
        self.click(title, place, part=part)
        body, io = self._frame(self.find(title).draw), imgui.get_io()
        for is_down in (True, False):
            for key in (imgui.Key.mod_ctrl, imgui.Key.a):
                io.add_key_event(key, is_down)
            self.pane.draw(body, 2)
        io.add_input_characters_utf8(text)
        self.pane.draw(body, 2)
        self.pane.press(imgui.Key.enter, body)
        self.show(title, 2)

    def drag(self, title: str, place: str, start: Point, end: Point) -> None:
        """Press at a part of a place and let go at another one."""
        body, io = self._frame(self.find(title).draw), imgui.get_io()
        first, last = self.find_point(place, start), self.find_point(place, end)
        self.pane.point(first)
        self.pane.draw(body, 2)
        io.add_mouse_button_event(0, True)
        self.pane.draw(body)
        for part in (0.5, 1.0):
            self.pane.point((first[0] + (last[0] - first[0]) * part, first[1] + (last[1] - first[1]) * part))
            self.pane.draw(body)
        io.add_mouse_button_event(0, False)
        self.pane.draw(body, 2)

    def pull(self, title: str, place: str, by: Point, steps: int = 4) -> None:
        """Press in the middle of a place, move the mouse by some pixels, and let go."""
        body, io = self._frame(self.find(title).draw), imgui.get_io()
        x, y = self.find_point(place)
        self.pane.point((x, y))
        self.pane.draw(body, 3)
        io.add_mouse_button_event(0, True)
        self.pane.draw(body)
        for step in range(1, steps + 1):
            self.pane.point((x + by[0] * step / steps, y + by[1] * step / steps))
            self.pane.draw(body, 2)
        io.add_mouse_button_event(0, False)
        self.pane.draw(body, 2)
        self.show(title, 2)

    def undo_to(self, root: Graph) -> None:
        """Take back what was done since the document was this."""
        while self.editor.session.root is not root and self.editor.session.history.steps:
            self.editor.session.undo()

    def turn_wheel(self, title: str, place: str, steps: float) -> None:
        """Turn the wheel over a place, with Ctrl held."""
        body, io = self._frame(self.find(title).draw), imgui.get_io()
        self.pane.point(self.find_point(place))
        self.pane.draw(body, 2)
        io.add_key_event(imgui.Key.mod_ctrl, True)
        io.add_mouse_wheel_event(0.0, steps)
        self.pane.draw(body)
        io.add_key_event(imgui.Key.mod_ctrl, False)
        self.pane.draw(body)

    def calm(self, title: str) -> None:
        """Leave what is open, take the pointer away, and wait: the next click is no second one."""
        body, io = self._frame(self.find(title).draw), imgui.get_io()
        for _ in range(2):
            self.pane.press(imgui.Key.escape, body)
        self.pane.point((1.0, 1.0))
        io.delta_time = 1.0
        self.pane.draw(body)
        io.delta_time = 1.0 / 60.0

    def find_point(self, place: str, part: Point = (0.5, 0.5)) -> Point:
        """A point in a place, by the place's name."""
        left, top, right, bottom = self.places[place]
        return left + (right - left) * part[0], top + (bottom - top) * part[1]

    def find(self, title: str) -> Panel:
        """The panel with a title, made on first use."""
        if title not in self.panels:
            makers = {docked.title: docked.make for docked in DOCKED} | dict(OVERLAYS)
            makers["Timeline"] = lambda contexts: Timeline(contexts.timeline)
            makers["Status"] = lambda contexts: _StatusLine(self.editor, contexts)
            self.panels[title] = makers[title](self.contexts)  # pyright: ignore[reportArgumentType]
        return self.panels[title]

    def select(self, *names: str) -> None:
        """Select elements."""
        self.editor.session.select([ElementId(name) for name in names])

    def _frame(self, body: Callable[[], Any]) -> Callable[[], Any]:
        def draw() -> Any:
            self.places.clear()
            return body()

        return draw


@dataclass(frozen=True)
class _StatusLine:
    """The line at the bottom of the window, as if it were a panel."""

    editor: Editor
    contexts: Contexts

    def draw(self) -> None:
        draw_status(self.editor, self.contexts)


def _make_at_once(cache: BackgroundCache[Any, Any], key: Any) -> Any:
    """What a thread would have made a few frames later."""
    if key not in cache._finished:
        cache._finished[key] = cache._make(key)
    return cache._finished[key]


@contextmanager
def open_still_editor(
    folder: Path,
    graph: Graph | Path | None = None,
    *,
    size: Point = (340.0, 900.0),
    at: Point = (20.0, 30.0),
    scale: float = 1.0,
    theme: str = "dark",
    screen: Point = (1600.0, 1200.0),
    density: float = 1.0,
) -> Iterator[StillEditor]:
    """An editor with a graph or a graph file. What it remembers is in a folder of its own there."""
    with open_still(size, at, scale, PALETTES[theme], screen, density) as pane, pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_DATA_HOME", str(folder / "data"))  # no preset of the user is written
        patch.delenv("HALATION_PATH", raising=False)  # and none of the site is listed
        patch.setattr(BackgroundCache, "get", _make_at_once)
        patch.setattr(listing._FolderReader, "start", listing._FolderReader.run)
        patch.setattr(Textures, "get", lambda textures, key, make: (make(), imgui.ImTextureRef(1))[1])
        editor = assemble(NullDevice(NULL), UNRESTRICTED, folder / "state")
        try:
            editor.store.change(theme=theme, ui_scale=scale)
            assert pane.font is not None
            editor.interface.fonts = Fonts(pane.font, pane.font, pane.font)
            contexts = compose_contexts(editor)
            if isinstance(graph, Path):
                editor.session.files.open(graph)
            elif graph is not None:
                editor.session.apply(ReplaceGraph("Start", graph))
            yield StillEditor(pane, editor, contexts)
        finally:
            editor.commands.closing = True
            editor.exports.all = ()  # a render that a test made up has no process that ends
            take_apart(editor)


def name_kind(place: str) -> str:
    """What places of one kind have in common: "field bloom.size" is a field, "button play" is the button "play"."""
    return " ".join(place.split()[: 2 if place.startswith("button") else 1])


def is_alike(one: object, other: object) -> bool:
    """True if all is the same but a hundredth of a number: places have whole pixels."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(is_alike(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(is_alike, one, other))
    if isinstance(one, float) and isinstance(other, float):
        return abs(one - other) < 0.01
    return one == other
