"""Rendering from any thread of a Python program: see `threads`."""

from __future__ import annotations

import contextlib
from functools import cache
from typing import TYPE_CHECKING

from ..errors import UsageError
from ..graph import Graph
from ..renderer import FrameRenderer, Renderer, RenderRequest
from .threads import DrawingThread

if TYPE_CHECKING:
    from ..renderer.execution.decoding import Array
    from ..resources.sandbox import Sandbox


class ScriptedRendering:
    """Frames of one graph, from whichever thread they are asked for; `thread` draws them."""

    def __init__(self, graph: Graph, request: RenderRequest, thread: DrawingThread, sandbox: Sandbox) -> None:
        self._thread = thread
        self._frames = thread.call(lambda: FrameRenderer(_open_renderer(thread, sandbox), graph, request))

    @property
    def frames(self) -> tuple[int, int]:
        """The first and last frame of the range."""
        return self._frames.frames

    def render(self, frame: int) -> dict[str, Array]:
        """Every output by name as [height, width, channels]. Raises the errors of `app.errors`."""
        return self._thread.call(self._frames.render_frame, frame)

    def close(self) -> None:
        """Let go of what nodes remember. Nothing is raised: the program may be at its end."""
        with contextlib.suppress(RuntimeError, UsageError):
            self._thread.call(self._frames.close)


@cache
def _open_renderer(thread: DrawingThread, sandbox: Sandbox) -> Renderer:
    """The renderer of a thread: opening another device for each call would cost more than most graphs."""
    return Renderer(sandbox=sandbox, trial_process=thread.trial_process)
