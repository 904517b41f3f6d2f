"""Searches for the first node that makes NaN or infinity, a part of it in every frame of the window."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import TYPE_CHECKING

from ...authoring.edits.element_id import ElementId
from ...graph import Port
from ...language.translation import translate
from ...renderer import NonfinitePixel, RenderRequest, find_first_nonfinite

if TYPE_CHECKING:
    from .context import ViewerContext

BUDGET = 0.010
"""Seconds of search per frame of the window: the window stays fluid."""


class InvalidPixelSearch:
    """A search that goes on while `editor.viewer.finding`."""

    def __init__(self, context: ViewerContext) -> None:
        self._context = context
        self._steps: Iterator[NonfinitePixel | None] | None = None
        self._search_key: object = None

    def step(self) -> None:
        """Continue the search; at the end, select the node and report it. Another graph restarts the search."""
        if not self._context.viewer.finding:
            self._stop()
            return
        port = self._context.session.views.find_root_port("A")
        if port is None:
            self._context.viewer.finding = False
            return
        if self._search_key != (id(self._context.session.root), port):
            self._stop()
            self._search_key = (id(self._context.session.root), port)
            self._steps = _search(self._context, port)
        try:
            self._go_on()
        except Exception:
            self._context.viewer.finding = False
            raise

    def _go_on(self) -> None:
        assert self._steps is not None
        started = time.perf_counter()
        bad_pixel = None
        for bad_pixel in self._steps:
            if bad_pixel is not None or time.perf_counter() - started > BUDGET:
                break
        else:
            self._context.log.add(translate("no NaN or infinity up to here"))
            self._context.viewer.finding = False
        if bad_pixel is not None:
            self._context.viewer.finding = False
            _show(self._context, bad_pixel)
        if not self._context.viewer.finding:
            self._stop()

    def _stop(self) -> None:
        steps, self._steps, self._search_key = self._steps, None, None
        if steps is not None and hasattr(steps, "close"):
            steps.close()  # type: ignore[attr-defined]


def _search(context: ViewerContext, port: Port) -> Iterator[NonfinitePixel | None]:
    viewer = context.viewer
    request = RenderRequest(context.session.bindings, {"A": port}, scale=viewer.proxy)
    return find_first_nonfinite(context.preview.renderer, context.session.root, request, port)


def _show(context: ViewerContext, bad_pixel: NonfinitePixel) -> None:
    """Select the node, and mark the pixel."""
    x, y = bad_pixel.pixel
    context.log.add(
        translate(
            "{path} is the first node with {value} (pixel {x}, {y} of its output)",
            path=bad_pixel.path,
            value=bad_pixel.value,
            x=x,
            y=y,
        ),
        "warning",
    )
    *place, name = bad_pixel.path.split("/")
    context.log.attempt(lambda: context.session.go(tuple(place)))
    port = Port(bad_pixel.port.node.rpartition("/")[2], bad_pixel.port.socket)
    element = ElementId(name) if name in context.session.graph.nodes else ElementId.of_port(port)
    context.log.attempt(lambda: context.session.select(element))
    context.canvas.fit({element})
