"""A strip of small pictures: a node on the sample, with its main value from low to high."""

from __future__ import annotations

from collections.abc import Generator

from halation.nodes import Node
from msgspec.structs import replace

from ...errors import HalationError
from ...graph import OUTPUTS, Graph, Port
from ...reference.node_page import find_main_value, list_steps, make_example
from ...reference.specimen import NODE, drawable_outputs, name_specimen
from ...renderer import DeviceTexture, Display, Renderer
from ..background.render_overviews import OverviewPending
from .picture_job import PictureJob
from .request import PreviewRequest
from .stepwise import StepwiseWork
from .thumbnails import Thumbnails, list_thumbnail_sources

_OUTPUT = "strip"
_DRAWN_LIKE_NODES = 1.0
"""The scale of the picture from which a small one is made: the sample is small itself."""


class ValueStrip(StepwiseWork):
    """Draws a strip while somebody looks at it, one part of a pass per `work`. What cannot be drawn has no picture."""

    def __init__(self, renderer: Renderer, display: Display) -> None:
        super().__init__()
        self._renderer, self._thumbnails = renderer, Thumbnails(renderer, display)
        self._job: PictureJob | None = None
        self.node: type[Node] | None = None
        self.numbers: tuple[float, ...] = ()
        """The numbers of the value, from low to high; none for a node without one."""

    def want(self, node: type[Node]) -> None:
        """Say whose strip is shown. The same again is free."""
        if node is self.node:
            return
        self.stop()
        self._thumbnails.clear()
        value, self.node = find_main_value(node), node
        self.numbers = tuple(list_steps(value)) if value and drawable_outputs(node) else ()
        self._steps = self._draw(node) if self.numbers else None

    def find(self, index: int) -> DeviceTexture | None:
        """The picture for a number, None where it is not drawn yet."""
        found = self._thumbnails.find(_name_slot(index), lambda path: None)
        return found[0] if found else None

    def close(self) -> None:
        """Give back what the device holds."""
        self.stop()
        self._thumbnails.close()
        self.node, self.numbers = None, ()

    def stop(self) -> None:
        """End what is under way. What it has drawn so far stays."""
        self._stop_job()
        super().stop()

    def _note_failure(self, error: HalationError) -> None:
        self._stop_job()

    def _draw(self, node: type[Node]) -> Generator[None]:
        value = find_main_value(node)
        assert value is not None
        graph = make_example(node)
        yield
        for index, number in enumerate(self.numbers):
            with name_specimen(node):
                yield from self._draw_picture(graph.set(Port(NODE, value.name), number), index)

    def _draw_picture(self, graph: Graph, index: int) -> Generator[None]:
        """Compute the first output of a graph, and draw it while its result is on the device."""
        ports = {_OUTPUT: Port(OUTPUTS, next(iter(graph.outputs)))}
        request = PreviewRequest(graph, ports, {}, _DRAWN_LIKE_NODES, 1, None)
        job = yield from self._compute(request)
        assert job.plan is not None
        source = list_thumbnail_sources(request, job.plan)[NODE]
        self._thumbnails.offer({_name_slot(index): replace(source, path=_name_slot(index))})
        self._thumbnails.draw_next()
        self._stop_job()
        yield

    def _compute(self, request: PreviewRequest) -> Generator[None, None, PictureJob]:
        """Compute the pictures of a request. Returns the job that holds them."""
        while True:
            self._stop_job()
            try:
                self._job = job = PictureJob(self._renderer, request, request.ports, 1, timed=False)
                while not job.is_ready or not job.step():
                    with self._renderer.device.make_current():
                        self._renderer.device.finish()
                    yield
                return job
            except OverviewPending as pending:  # the sample is a render: its layers are read on another thread
                is_ready = pending.ready
            while not is_ready():
                yield

    def _stop_job(self) -> None:
        if self._job is not None:
            self._job.close()
        self._job = None


def _name_slot(index: int) -> str:
    """A name that no node has, because names have no space."""
    return f"strip {index}"
