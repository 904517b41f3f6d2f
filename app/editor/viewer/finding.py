"""Finds the first node that makes NaN or infinity, some of it every frame."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import TYPE_CHECKING

from ...graph import Port
from ...renderer import Nonfinite, RenderRequest, first_nonfinite

if TYPE_CHECKING:
    from ..window.editor import Editor

BUDGET = 0.010
"""Seconds per frame."""


class Finder:
    """A search that goes on while `editor.viewer.finding`."""

    def __init__(self) -> None:
        self._steps: Iterator[Nonfinite | None] | None = None
        self._of: object = None

    def step(self, editor: Editor) -> None:
        """Go on; at the end, select the node and say what was found. Another graph starts it anew."""
        if not editor.viewer.finding:
            self._stop()
            return
        port = editor.session.viewed_in_root("A")
        if port is None:
            editor.viewer.finding = False
            return
        if self._of != (id(editor.session.root), port):
            self._stop()
            self._of = (id(editor.session.root), port)
            self._steps = _search(editor, port)
        try:
            self._go_on(editor)
        except Exception:
            editor.viewer.finding = False
            raise

    def _go_on(self, editor: Editor) -> None:
        assert self._steps is not None
        started = time.perf_counter()
        found = None
        for found in self._steps:
            if found is not None or time.perf_counter() - started > BUDGET:
                break
        else:
            editor.say("every number is finite up to here")
            editor.viewer.finding = False
        if found is not None:
            editor.viewer.finding = False
            _show(editor, found)
        if not editor.viewer.finding:
            self._stop()

    def _stop(self) -> None:
        steps, self._steps, self._of = self._steps, None, None
        if steps is not None and hasattr(steps, "close"):
            steps.close()  # type: ignore[attr-defined]


def _search(editor: Editor, port: Port) -> Iterator[Nonfinite | None]:
    viewer = editor.viewer
    wanted = RenderRequest(editor.session.bindings, {"A": port}, scale=viewer.proxy)
    return first_nonfinite(editor.preview.renderer, editor.session.root, wanted, port)


def _show(editor: Editor, found: Nonfinite) -> None:
    """Go to the node that was found, and mark the pixel."""
    x, y = found.pixel
    editor.log.add(f"{found.path} is the first node that makes {found.value} (pixel {x}, {y} of its output)", "warning")
    *place, name = found.path.split("/")
    editor.attempt(lambda: editor.session.go(tuple(place)))
    key = name if name in editor.session.graph.nodes else f"{found.port.node.split('/')[-1]}.{found.port.socket}"
    editor.attempt(lambda: editor.session.select({key}))
    editor.canvas.fit({key})
