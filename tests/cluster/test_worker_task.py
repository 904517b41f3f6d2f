"""What a worker decides by itself, with a stand-in for Dask: memory, messages, whether a task is still needed."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from halation.cluster import worker_task
from halation.cluster.worker_task import (
    FrameReporter,
    choose_memory,
    find_report_interval,
    make_cancel_check,
    read_memory_limit,
)

GIB = 1 << 30


@pytest.mark.parametrize(
    ("memory", "limit", "expected"),
    [
        (0, 0, 0),  # any number
        (3 * GIB, 0, 3 * GIB),
        (0, 4 * GIB, 4 * GIB - GIB // 2),  # without what the process takes
        (GIB, 4 * GIB, GIB),
        (5 * GIB, 4 * GIB, 4 * GIB - GIB // 2),
        (0, GIB // 2, GIB // 8),  # a quarter where that is more
    ],
)
def test_a_frame_gets_what_its_worker_may_take(memory: int, limit: int, expected: int) -> None:
    assert choose_memory(memory, limit) == expected


@pytest.mark.parametrize(("limit", "expected"), [(None, 0), (0, 0), (GIB, GIB), (64 * GIB, 0), (99 * GIB, 0)])
def test_a_limit_that_is_no_less_than_the_machine_has_is_none(monkeypatch, limit: int | None, expected: int) -> None:
    monkeypatch.setattr(worker_task, "machine_memory", lambda: 64 * GIB)
    worker: Any = SimpleNamespace(memory_manager=SimpleNamespace(memory_limit=limit))
    assert read_memory_limit(worker) == expected
    nothing: Any = SimpleNamespace()
    assert read_memory_limit(nothing) == 0


@pytest.mark.parametrize(("slots", "seconds"), [({}, 0.25), ({"a": 40, "b": 10}, 0.25), ({"a": 900, "b": 100}, 5.0)])
def test_all_workers_together_send_two_hundred_messages_a_second(slots: dict[str, int], seconds: float) -> None:
    assert find_report_interval(slots) == seconds


@pytest.mark.parametrize(
    ("task", "worker", "expected"),
    [
        ("executing", "running", False),
        ("executing", "paused", False),
        ("executing", "closing", True),
        ("cancelled", "running", True),
        ("resumed", "running", True),
        (None, "running", True),
    ],
)
def test_a_task_that_nobody_needs_any_more_is_cancelled(task: str | None, worker: str, expected: bool) -> None:
    tasks = {} if task is None else {"job-1": SimpleNamespace(state=task)}
    dask: Any = SimpleNamespace(
        get_current_task=lambda: "job-1", state=SimpleNamespace(tasks=tasks), status=SimpleNamespace(name=worker)
    )
    assert make_cancel_check(dask)() is expected


def test_finished_frames_are_told_together(monkeypatch) -> None:
    clock = SimpleNamespace(now=10.0)
    monkeypatch.setattr(worker_task, "time", SimpleNamespace(monotonic=lambda: clock.now))
    sent: list[tuple[str, dict[str, Any]]] = []
    worker: Any = SimpleNamespace(address="tcp://near", log_event=lambda topic, event: sent.append((topic, event)))
    chunk: Any = SimpleNamespace(topic="job", slots={"near": 100})
    reporter = FrameReporter(worker, chunk)  # every half of a second
    for seconds, frame in ((0.2, 1), (0.2, 2), (0.2, 3), (0.3, 4)):
        clock.now += seconds
        reporter.report_frame({"frame": frame})
    frames = [{"frame": 1}, {"frame": 2}, {"frame": 3}]
    assert sent == [("job", {"worker": "tcp://near", "frames": frames})]
    reporter.flush()
    reporter.flush()
    assert [event["frames"] for _, event in sent] == [frames, [{"frame": 4}]]


def test_without_a_topic_nobody_is_told() -> None:
    worker: Any = SimpleNamespace(address="tcp://near", log_event=None)
    chunk: Any = SimpleNamespace(topic="", slots={})
    reporter = FrameReporter(worker, chunk)
    reporter.report_frame({"frame": 1})
    assert reporter.flush() is None
