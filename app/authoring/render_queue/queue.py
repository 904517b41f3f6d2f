"""The render queue: each render runs in its own process, so the window stays fast and a crash there does no harm."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from threading import RLock

from msgspec.structs import replace

from ... import document
from ...errors import UsageError
from ...graph import Graph
from ...language.translation import translate
from ...renderer.jobs.render_job import RenderJob
from ...resources.sandbox import Sandbox
from .queued_files import QueuedFiles, list_entries
from .queued_render import QueuedJob, QueuedRender, RenderState

__all__ = ["QueuedFiles", "QueuedRender", "RenderJob", "RenderQueue", "RenderState"]


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
        """The renders that run now."""
        return tuple(render for render in self.all if render.state == "running")

    @property
    def waiting(self) -> tuple[QueuedRender, ...]:
        """The renders that wait, the next one first."""
        return tuple(render for render in self.all if render.state == "waiting")

    @property
    def unfinished(self) -> tuple[QueuedRender, ...]:
        """The renders that run or wait."""
        return tuple(render for render in self.all if render.state in ("running", "waiting"))

    def start(
        self,
        graph: Graph,
        destinations: Sequence[tuple[str, Path]],
        bindings: Mapping[str, object] | None = None,
        options: RenderJob | None = None,
        *,
        files: QueuedFiles | None = None,
        cluster: str = "",
    ) -> QueuedRender:
        """Render the graph as it is now, saved or not, to pairs of an output's name and a file; "" is all outputs.

        `bindings` are files for graph inputs; `options` say how to render and write, its graph, inputs and destinations
        are replaced. With `files` it is rendered once for each of them, which {stem} and the like in destinations stand
        for. `cluster` is the address of the workers that render, "" for this machine alone. It waits for those before
        it. Raises UsageError, and GraphError for what JSON cannot hold.
        """
        if not destinations:
            raise UsageError(translate("no file to write to: choose a file"))
        inputs = _list_inputs(bindings or {})
        entries = list_entries(graph, files, destinations, inputs, self._sandbox) if files else ()
        order = replace(
            options or RenderJob(sandbox=self._sandbox),
            graph="-",
            document=document.dumps(graph),
            inputs={} if files else inputs,
            entries=entries,
            destinations=tuple((name, str(path.absolute())) for name, path in destinations),
        )
        return self._queue(QueuedJob(order, graph, cluster))

    def resume(self, export: QueuedRender) -> QueuedRender:
        """Continue a render that has ended: frames that are up to date are skipped."""
        if export not in self.all or export in self.unfinished:
            return export
        job = export.job
        return self._queue(QueuedJob(replace(job.order, resume=True), job.graph, job.cluster), export)

    def move(self, export: QueuedRender, by: int) -> None:
        """Move a waiting render up or down in the queue."""
        with self._lock:
            line = list(self.waiting)
            if export not in line:
                return
            place = line.index(export)
            line.insert(min(max(place + by, 0), len(line) - 1), line.pop(place))
            turns = iter(line)
            self.all = tuple(next(turns) if render.state == "waiting" else render for render in self.all)

    def clear(self) -> None:
        """Remove the renders that have ended."""
        with self._lock:
            self.all = self.unfinished

    def close(self, wait: bool = False) -> None:
        """Cancel the renders that run and wait, or wait for them."""
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
        """Start the next renders; also called on the threads of renders that end."""
        with self._lock:
            while not self._closed and self.waiting and len(self.running) < self.at_once:
                self.waiting[0].begin()


def _list_inputs(bindings: Mapping[str, object]) -> dict[str, str]:
    """The files of inputs by name, as absolute paths. Raises UsageError for a picture in memory."""
    inputs: dict[str, str] = {}
    for name, item in bindings.items():
        if not isinstance(item, str | Path):
            raise UsageError(
                translate(
                    "input '{name}' is a picture in memory, which renders cannot read: save it to a file", name=name
                )
            )
        inputs[name] = os.path.abspath(item)  # noqa: PTH100 - a layer may follow the path
    return inputs
