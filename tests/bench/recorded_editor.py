"""Runs the editor on the display and records each frame. `python recorded_editor.py STATE [GRAPH]`.

Lines on the standard input are commands: a method of `Recorder` and its word. Each is answered by a line of JSON. A
thread reads them and wakes the window, so that waiting for them costs nothing.
"""

from __future__ import annotations

import json
import os
import resource
import sys
import time
from collections import deque
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from threading import Thread
from typing import Any

import glfw
from halation.authoring.commands import ArrangeElements, SetValue
from halation.authoring.edits.element_id import ElementId
from halation.editor.window.opening import run
from halation.editor.window.window import Window
from halation.graph import Port
from halation.resources.sandbox import UNRESTRICTED
from imgui_bundle import imgui


@dataclass
class Recorder:
    """The frames of a window, and what it was told to do."""

    window: Window
    lines: deque[str] = field(default_factory=deque[str])
    frames: list[tuple[float, float, float, int, int, float]] = field(default_factory=list)
    """When each frame was shown, where it found the mouse, the frame of the timeline, the picture of the viewer, and
    the processor time of the thread that draws until then."""
    first_picture: float = 0.0

    def note(self) -> None:
        """Record the frame that was just shown, and do what was asked."""
        editor, mouse = self.window.editor, imgui.get_io().mouse_pos
        image = editor.preview.find_whole_image("A")
        now = time.monotonic()
        revision, used = image.revision if image else 0, time.thread_time()
        self.frames.append((now, mouse.x, mouse.y, editor.session.time.frame, revision, used))
        if image and not self.first_picture:
            self.first_picture = now
        while self.lines:
            name, _, word = self.lines.popleft().partition(" ")
            print(json.dumps(getattr(self, name)(word)), flush=True)

    def listen(self) -> None:
        """Read commands until there are no more."""
        for line in sys.stdin:
            self.lines.append(line.strip())
            with suppress(glfw.GLFWError):  # before the window is there nobody needs to be woken
                glfw.post_empty_event()

    def arrange(self, _: str) -> None:
        """Arrange the graph and show all of it."""
        editor = self.window.editor
        editor.session.apply(ArrangeElements(editor.canvas.sizes or {}, editor.canvas.find_pins()))
        editor.canvas.fit()

    def select(self, name: str) -> None:
        """Select a node."""
        self.window.editor.session.select([ElementId(name)])

    def play(self, _: str) -> None:
        """Play, or stop."""
        self.window.editor.actions.run("time.play")

    def set(self, words: str) -> None:
        """Set a value of a node."""
        port, text = words.split()
        self.window.editor.session.apply(SetValue(Port.parse(port), float(text)))

    def state(self, _: str) -> dict[str, Any]:
        """What there is now."""
        editor = self.window.editor
        used = os.times()
        return {
            "first_picture": self.first_picture,
            "busy": editor.preview.busy,
            "cached": len(editor.preview.frames),
            "places": {name: list(place) for name, place in editor.places.items()},
            "processor": used.user + used.system,
            "peak": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
            "frames": len(self.frames),
        }

    def take_frames(self, _: str) -> list[tuple[float, float, float, int, int, float]]:
        """The frames since this was asked last."""
        frames, self.frames = self.frames, []
        return frames

    def close(self, _: str) -> None:
        """End the editor."""
        self.window.editor.commands.closing = True


def main(state: Path, graph: Path | None) -> None:
    """Open a graph, or the start screen, until the window is closed."""
    window = Window(graph, {}, UNRESTRICTED, version=(4, 5), state=state, size=(1920, 1080))
    window.params.ini_disable = True
    recorder, before = Recorder(window), window.params.callbacks.after_swap

    def after_swap() -> None:
        if before is not None:
            before()
        recorder.note()

    window.params.callbacks.after_swap = after_swap
    Thread(target=recorder.listen, daemon=True).start()
    run(window)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else None)
