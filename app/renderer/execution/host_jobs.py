"""Programs that run on the processor for passes, on a thread of their own.

A run asks for a job when its next pass needs one, and goes on with others until it is done. A run that is dropped, as
while a slider is dragged, abandons its job. The job goes on, since the next run mostly asks for the same pixels. It is
cancelled as soon as somebody asks for others.
"""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from threading import Event

from halation.nodes import HostProgram

from .host_programs import HOST_PROGRAMS, Array


class HostJob:
    """A program that runs, or has run, on another thread."""

    def __init__(self, threads: ThreadPoolExecutor, program: HostProgram, pictures: Mapping[str, Array]) -> None:
        self.progress = 0.0
        """The part that is done, 0 to 1."""
        self._stop = Event()
        run = HOST_PROGRAMS[program.name]
        self._future: Future[Array] = threads.submit(run, pictures, dict(program.settings), self._report)

    @property
    def is_done(self) -> bool:
        return self._future.done()

    def wait(self) -> Array:
        """The pixels. Raises what the program raised."""
        return self._future.result()

    def cancel(self) -> None:
        """Ask the program to stop; nobody may wait for it any more."""
        self._stop.set()
        self._future.cancel()

    def _report(self, progress: float) -> bool:
        self.progress = progress
        return not self._stop.is_set()


class HostJobs:
    """The jobs of an executor, by the key of what they make."""

    def __init__(self) -> None:
        self._threads = ThreadPoolExecutor(1, thread_name_prefix="host")
        self._jobs: dict[str, HostJob] = {}
        self._abandoned: set[str] = set()

    def __contains__(self, key: str) -> bool:
        return key in self._jobs

    def find(self, key: str) -> HostJob | None:
        """The job that makes these pixels, which is no longer abandoned."""
        self._abandoned.discard(key)
        return self._jobs.get(key)

    def start(self, key: str, program: HostProgram, pictures: Mapping[str, Array]) -> HostJob:
        """Start a job. Jobs that were abandoned are cancelled."""
        for other in self._abandoned:
            self._jobs.pop(other).cancel()
        self._abandoned.clear()
        job = self._jobs[key] = HostJob(self._threads, program, pictures)
        return job

    def finish(self, key: str) -> Array:
        """Wait for the pixels of a job, once. Raises what its program raised."""
        self._abandoned.discard(key)
        return self._jobs.pop(key).wait()

    def abandon(self, key: str) -> None:
        """Say that nobody waits for a job any more."""
        if key in self._jobs:
            self._abandoned.add(key)

    def close(self) -> None:
        """Cancel all jobs."""
        for job in self._jobs.values():
            job.cancel()
        self._jobs.clear()
        self._threads.shutdown(cancel_futures=True)
