"""Renders to files in processes of their own: the interface stays quick, and a fault there harms nothing here."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from threading import RLock

from ... import document
from ...compiler import Precision
from ...errors import UsageError
from ...graph import Graph
from ...graph.frames import format_frames
from .export import Export, Job, State

__all__ = ["Export", "Exports", "Options", "State"]


@dataclass(frozen=True)
class Options:
    """What to render and how to write it, as `halation render` has it. Without `frames`, the first of the graph."""

    node: str = ""
    size: tuple[int, int] | None = None
    scale: float = 1.0
    frames: tuple[int, ...] = ()
    precision: Precision | None = None
    view: str = ""
    compression: str = "zip"
    jobs: int = 1
    resume: bool = False

    def words(self) -> Iterator[str]:
        """The flags for it."""
        yield from (f"--scale={self.scale!r}", f"--compression={self.compression}")
        if self.frames:
            yield f"--frames={format_frames(self.frames)}"
        if self.size:
            yield f"--size={self.size[0]}x{self.size[1]}"
        if self.jobs > 1:
            yield f"--jobs={self.jobs}"
        if self.resume:
            yield "--resume"
        for flag, text in (("node", self.node), ("precision", self.precision), ("view", self.view)):
            if text:
                yield f"--{flag}={text}"


class Exports:
    """The exports of one editor: so many run `at_once`, the others wait in their order."""

    def __init__(self, at_once: int = 1) -> None:
        self.all: tuple[Export, ...] = ()
        self.at_once = at_once
        self._lock = RLock()
        self._closed = False

    @property
    def running(self) -> tuple[Export, ...]:
        """Those that are computed now."""
        return tuple(one for one in self.all if one.state == "running")

    @property
    def waiting(self) -> tuple[Export, ...]:
        """Those whose turn is still to come, the next one first."""
        return tuple(one for one in self.all if one.state == "waiting")

    @property
    def unfinished(self) -> tuple[Export, ...]:
        """Those that run or wait."""
        return tuple(one for one in self.all if one.state in ("running", "waiting"))

    def start(
        self,
        graph: Graph,
        destinations: Sequence[tuple[str, Path]],
        bindings: Mapping[str, object] | None = None,
        options: Options = Options(),
    ) -> Export:
        """Render the graph as it is now, saved or not, to pairs of an output's name and a file; "" is all outputs.

        `bindings` are files for graph inputs. It waits for those before it. Raises UsageError, and GraphError for what
        JSON cannot hold.
        """
        if not destinations:
            raise UsageError("nothing says where to write: choose a file")
        files = tuple((name, path.absolute()) for name, path in destinations)
        # -P: a folder with graphs in it is no place to import modules from.
        words = [sys.executable, "-P", "-m", "halation.cli", "render", "-", "--json", "--progress=json"]
        for name, path in files:
            words += ["-o", f"{name}={path}" if name else str(path)]
        for name, item in (bindings or {}).items():
            if not isinstance(item, str | Path):
                raise UsageError(f"input '{name}' is filled from memory, which an export cannot see: save it to a file")
            words += ["-i", f"{name}={os.path.abspath(item)}"]  # noqa: PTH100 - a layer may follow the path
        words += options.words()
        return self._queue(Job(tuple(words), document.dumps(graph), graph, files, options.frames, options.jobs))

    def again(self, export: Export) -> Export:
        """Go on with one that has ended, in its place: frames that are finished and would be the same are kept."""
        if export not in self.all or export in self.unfinished:
            return export
        words = tuple(word for word in export.job.words if word != "--resume")
        return self._queue(replace(export.job, words=(*words, "--resume")), export)

    def move(self, export: Export, by: int) -> None:
        """Let one that waits have its turn earlier or later."""
        with self._lock:
            line = list(self.waiting)
            if export not in line:
                return
            place = line.index(export)
            line.insert(min(max(place + by, 0), len(line) - 1), line.pop(place))
            turns = iter(line)
            self.all = tuple(next(turns) if one.state == "waiting" else one for one in self.all)

    def clear(self) -> None:
        """Forget those that have ended."""
        with self._lock:
            self.all = self.unfinished

    def close(self, wait: bool = False) -> None:
        """Cancel what runs and waits, or wait for it."""
        if not wait:
            self._closed = True
            for one in reversed(self.unfinished):
                one.cancel()
        for one in self.all:
            one.wait()

    def _queue(self, job: Job, instead: Export | None = None) -> Export:
        made = Export(job, self._go_on)
        with self._lock:
            if instead is None:
                self.all = (*self.all, made)
            else:
                self.all = tuple(made if one is instead else one for one in self.all)
        self._go_on()
        return made

    def _go_on(self) -> None:
        """Begin with the next ones; also called on the threads of those that end."""
        with self._lock:
            while not self._closed and self.waiting and len(self.running) < self.at_once:
                self.waiting[0].begin()
