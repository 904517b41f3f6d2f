"""A stand-in for Dask whose workers answer at once, as a test says."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from halation.cluster import worker_task
from halation.cluster.chunk import FrameChunk
from halation.version import VERSION

A, B = "tcp://a:1", "tcp://b:1"


class KilledWorker(Exception):
    """What Dask raises where workers have ended one after the other."""


class Future:
    def __init__(self, key: str, outcome: object) -> None:
        self.key, self.outcome, self.is_cancelled = key, outcome, False
        self.status = "pending" if outcome is None else "error" if isinstance(outcome, Exception) else "finished"

    def result(self, timeout: float) -> Any:
        return self.outcome

    exception = result

    def cancel(self, *, force: bool) -> None:
        self.is_cancelled = force

    def add_done_callback(self, callback: Callable[[Any], None]) -> None:
        if self.outcome is not None:
            callback(self)


class Client:
    """Hands each chunk to a worker that may have it; `answer(address, chunk)` says what comes of it."""

    def __init__(self, answer: Callable[[str, FrameChunk], object], *addresses: str, **facts: Any) -> None:
        self.answer, self.status = answer, "running"
        self.workers: dict[str, Any] = {address: {"nthreads": 1, **facts} for address in addresses}
        self.versions: dict[str, Any] = dict.fromkeys((A, B), VERSION)
        self.asked: list[str] = []
        self.sent: list[tuple[FrameChunk, dict[str, Any], Future]] = []
        self.removed: list[str] = []
        self.cancelled: list[Any] = []
        self.topics = dict[str, Any]()

    def scheduler_info(self, n_workers: int) -> dict[str, Any]:
        assert n_workers == -1
        return {"workers": dict(self.workers)}

    def run(self, function: Any, workers: list[str], on_error: str) -> dict[str, Any]:
        self.asked += workers
        return {address: self.versions[address] for address in workers}

    def subscribe_topic(self, name: str, listen: Any) -> None:
        self.topics[name] = listen

    def unsubscribe_topic(self, name: str) -> None:
        del self.topics[name]

    def submit(self, function: Any, text: str, *, pure: bool, **options: Any) -> Any:
        assert not pure, "the same chunk may be sent again"
        if function is worker_task.remove_results:
            self.removed.append(text)
            return SimpleNamespace(result=lambda timeout: None)
        chunk, places = FrameChunk.from_json(text), options["workers"] or [*self.workers]
        place = next(place for place in places[len(self.sent) % len(places) :] + places if place in self.workers)
        self.sent.append((chunk, options, Future(options["key"], self.answer(place, chunk))))
        return self.sent[-1][2]

    def cancel(self, futures: list[Any], *, asynchronous: bool, force: bool) -> None:
        assert force and not asynchronous
        self.cancelled += futures

    @property
    def parts(self) -> list[tuple[int, ...]]:
        return [chunk.parts for chunk, _, _ in self.sent]


class Listener:
    """Keeps what it is told."""

    def __init__(self) -> None:
        self.notes, self.progress = list[str](), list[tuple[int, int, int]]()

    def report_progress(self, report: Any, workers: int) -> None:
        self.progress.append((len(report.seconds), len(report.faults), workers))

    def report_note(self, sentence: str) -> None:
        self.notes.append(sentence)
