"""Renders to files in processes of their own: the interface stays quick, and a fault there harms nothing here."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from threading import RLock

from msgspec.structs import replace

from ... import document
from ...errors import UsageError
from ...graph import Graph
from ...renderer.jobs.render_job import RenderJob
from ...resources.sandbox import Sandbox
from .queued_render import QueuedJob, QueuedRender, RenderState

__all__ = ["QueuedRender", "RenderJob", "RenderQueue", "RenderState"]


class RenderQueue:
    """The exports of one editor: so many run `at_once`, the others wait in their order."""

    def __init__(self, sandbox: Sandbox, at_once: int = 1) -> None:
        self._sandbox = sandbox
        self.all: tuple[QueuedRender, ...] = ()
        self.at_once = at_once
        self._lock = RLock()
        self._closed = False

    @property
    def running(self) -> tuple[QueuedRender, ...]:
        """Those that are computed now."""
        return tuple(render for render in self.all if render.state == "running")

    @property
    def waiting(self) -> tuple[QueuedRender, ...]:
        """Those whose turn is still to come, the next one first."""
        return tuple(render for render in self.all if render.state == "waiting")

    @property
    def unfinished(self) -> tuple[QueuedRender, ...]:
        """Those that run or wait."""
        return tuple(render for render in self.all if render.state in ("running", "waiting"))

    def start(
        self,
        graph: Graph,
        destinations: Sequence[tuple[str, Path]],
        bindings: Mapping[str, object] | None = None,
        options: RenderJob | None = None,
    ) -> QueuedRender:
        """Render the graph as it is now, saved or not, to pairs of an output's name and a file; "" is all outputs.

        `bindings` are files for graph inputs; `options` say how to render and write, its graph, inputs and destinations
        are replaced. It waits for those before it. Raises UsageError, and GraphError for what JSON cannot hold.
        """
        if not destinations:
            raise UsageError("nothing says where to write: choose a file")
        inputs: dict[str, str] = {}
        for name, item in (bindings or {}).items():
            if not isinstance(item, str | Path):
                raise UsageError(f"input '{name}' is filled from memory, which an export cannot see: save it to a file")
            inputs[name] = os.path.abspath(item)  # noqa: PTH100 - a layer may follow the path
        order = replace(
            options or RenderJob(sandbox=self._sandbox),
            graph="-",
            document=document.dumps(graph),
            inputs=inputs,
            destinations=tuple((name, str(path.absolute())) for name, path in destinations),
        )
        return self._queue(QueuedJob(order, graph))

    def resume(self, export: QueuedRender) -> QueuedRender:
        """Go on with one that has ended, in its place: frames that are finished and would be the same are kept."""
        if export not in self.all or export in self.unfinished:
            return export
        job = export.job
        return self._queue(QueuedJob(replace(job.order, resume=True), job.graph), export)

    def move(self, export: QueuedRender, by: int) -> None:
        """Let one that waits have its turn earlier or later."""
        with self._lock:
            line = list(self.waiting)
            if export not in line:
                return
            place = line.index(export)
            line.insert(min(max(place + by, 0), len(line) - 1), line.pop(place))
            turns = iter(line)
            self.all = tuple(next(turns) if render.state == "waiting" else render for render in self.all)

    def clear(self) -> None:
        """Forget those that have ended."""
        with self._lock:
            self.all = self.unfinished

    def close(self, wait: bool = False) -> None:
        """Cancel what runs and waits, or wait for it."""
        if not wait:
            self._closed = True
            for render in reversed(self.unfinished):
                render.cancel()
        for render in self.all:
            render.wait()

    def _queue(self, job: QueuedJob, instead: QueuedRender | None = None) -> QueuedRender:
        queued = QueuedRender(job, self._start_next)
        with self._lock:
            if instead is None:
                self.all = (*self.all, queued)
            else:
                self.all = tuple(queued if render is instead else render for render in self.all)
        self._start_next()
        return queued

    def _start_next(self) -> None:
        """Begin with the next ones; also called on the threads of those that end."""
        with self._lock:
            while not self._closed and self.waiting and len(self.running) < self.at_once:
                self.waiting[0].begin()
