"""A process beside a worker: what it answers, how it ends, and to whom it is lent. Short scripts stand in."""

from __future__ import annotations

import json
import os
import sys
import time
from typing import Any

import pytest
from halation.cluster import render_process
from halation.cluster.chunk import EntryOutcome, FrameChunk
from halation.cluster.render_process import (
    ProcessLimits,
    RenderProcess,
    RenderProcessPool,
    find_kind,
    find_machine,
    share_cores,
)
from halation.renderer.jobs.render_job import RenderJob
from halation.resources.sandbox import UNRESTRICTED, Sandbox

CHUNK = FrameChunk(RenderJob(sandbox=UNRESTRICTED, frames=(1, 2)), "/show")
NO_LIMITS = ProcessLimits(0.0)


@pytest.fixture
def start(monkeypatch: pytest.MonkeyPatch):
    """`start(code, threads)` is a process that runs this code of Python instead of a renderer."""
    started: list[RenderProcess] = []

    def make(code: str, threads: int = 1) -> RenderProcess:
        command = [sys.executable, "-S", "-c", f"import json, os, sys, time\n{code}"]
        monkeypatch.setattr(render_process, "worker_command", lambda: command)
        started.append(RenderProcess(threads))
        return started[-1]

    yield make
    for process in started:
        process.stop()


def answer(*events: object) -> str:
    """Code that answers one line with these."""
    lines = "".join(f"{event if isinstance(event, str) else json.dumps(event)}\n" for event in events)
    return f"sys.stdin.readline(); sys.stdout.write({lines!r}); sys.stdout.flush(); sys.stdin.read()"


def test_frames_are_reported_as_they_come_and_the_answer_is_the_report(start) -> None:
    frames = [
        {"frame": 1, "seconds": 0.5, "kept": False},
        {"frame": 2, "seconds": 0.0, "kept": True, "entry": {"passes": 3}},
    ]
    facts = {"faults": {"7": {"message": "no"}}, "entries": {"8": {"frames": [4]}}, "costs": {"passes": 9}}
    process, seen = start(answer(*frames, "Traceback: no JSON", {**facts, "stage": {"frame_bytes": 5}})), list[Any]()
    report = process.render(CHUNK, seen.append, lambda: False, 0)
    assert seen == frames and report.seconds == {1: 0.5, 2: 0.0} and report.kept == (2,)
    assert report.faults == {7: {"message": "no"}} and report.costs == {"passes": 9}
    assert report.entries == {2: EntryOutcome(passes=3), 8: EntryOutcome(frames=(4,))}
    assert report.stage is not None and report.stage.frame_bytes == 5
    assert (report.death, report.refusal, report.is_cancelled) == ("", "", False) and process.is_alive


def test_a_refusal_is_an_answer_without_a_stage(start) -> None:
    report = start(answer({"refusal": "it is full"})).render(CHUNK, lambda _: None, lambda: False, 0)
    assert report.refusal == "it is full" and report.stage is None and report.costs == {} == report.entries


@pytest.mark.parametrize(
    ("end", "sentence"),
    [
        ("os._exit(0)", "ended by itself (exit code 0)"),
        ("os._exit(3)", "ended by itself (exit code 3)"),
        ("os.kill(os.getpid(), 9)", "was ended by SIGKILL"),
        ("os.kill(os.getpid(), 37)", "was ended by signal 37"),
    ],
)
def test_it_is_said_how_a_process_has_ended(start, end: str, sentence: str) -> None:
    given = start(f"sys.stdin.readline(); {end}").ask("{}", print, lambda: False, NO_LIMITS)
    assert given.death == f"its process {sentence}" and not given.is_cancelled and not given.facts


def test_a_chunk_that_nobody_needs_any_more_ends_its_process(start) -> None:
    process = start("sys.stdin.read(); time.sleep(60)")
    begun = time.monotonic()
    given = process.ask("{}", print, lambda: True, NO_LIMITS)
    assert given.is_cancelled and not given.death and not process.is_alive and time.monotonic() - begun < 30.0


@pytest.mark.parametrize(("limit", "ends"), [(1 << 20, True), (1 << 40, False), (0, False)])
def test_a_process_that_takes_more_than_its_worker_may_have_is_ended(start, limit: int, ends: bool) -> None:
    process = start("sys.stdin.readline(); time.sleep(0.4); print('{}', flush=True); time.sleep(60)")
    given = process.ask("{}", print, lambda: False, ProcessLimits(0.0, resident=limit))
    assert given.death == ("it takes more than the 0.0 GiB of its worker" if ends else "")
    assert process.is_alive is not ends


def test_a_process_that_ignores_being_told_is_killed(start, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(render_process, "_PATIENCE", 0.2)
    process = start("import signal; signal.signal(15, signal.SIG_IGN); print('{}', flush=True); time.sleep(10**6)")
    assert process.ask("{}", print, lambda: False, NO_LIMITS).facts == {} and process.is_alive
    process.stop()
    process.stop()  # as often as one likes
    assert not process.is_alive


def test_what_it_says_is_passed_on_but_for_its_being_told_to_end(start, capfd: pytest.CaptureFixture[str]) -> None:
    process = start("print('halation: interrupted', file=sys.stderr); print('a driver', file=sys.stderr)")
    assert process.ask("{}", print, lambda: False, NO_LIMITS).death
    said, end = "", time.monotonic() + 30.0
    while "a driver" not in said and time.monotonic() < end:
        said += capfd.readouterr().err
        time.sleep(0.01)
    assert said == "a driver\n"


@pytest.mark.parametrize(("own", "threads"), [(None, "3"), ("7", "7")])
def test_its_rasterizer_has_so_many_threads_unless_the_user_says_how_many(
    start, monkeypatch: pytest.MonkeyPatch, own: str | None, threads: str
) -> None:
    for name in ("LP_NUM_THREADS", "OPENIMAGEIO_THREADS"):
        monkeypatch.delenv(name, raising=False)
        if own is not None:
            monkeypatch.setenv(name, own)
    values = "os.environ['LP_NUM_THREADS'], os.environ['OPENIMAGEIO_THREADS'], *sys.argv[1:]"
    process = start(f"print(json.dumps([{values}]), flush=True); sys.stdin.read()", 3)
    assert process.number == process._process.pid != os.getpid()  # pyright: ignore[reportPrivateUsage]
    given = process.ask("{}", print, lambda: False, NO_LIMITS)
    assert given.facts == [threads, threads, "--chunks"]


@pytest.mark.parametrize(
    ("address", "machine"), [("tcp://farm-1:8786", "farm-1"), ("tls://10.0.0.7:1", "10.0.0.7"), ("inproc://1/2/3", "")]
)
def test_the_machine_of_a_worker(address: str, machine: str) -> None:
    assert find_machine(address) == machine


def test_processes_on_one_machine_share_its_cores(monkeypatch) -> None:
    monkeypatch.setattr(render_process, "available_cores", lambda: 16)
    near = "tcp://near:1"
    shares = [share_cores({"near": slots}, near) for slots in (1, 2, 3, 16, 40, 0)]
    assert shares == [16, 8, 5, 1, 1, 16] and share_cores({"far": 8}, near) == 16
    assert share_cores({"": 4}, "inproc://1/2") == 4


def test_jobs_that_need_one_device_are_of_one_kind() -> None:
    job = RenderJob(sandbox=UNRESTRICTED)
    assert find_kind(job) == find_kind(RenderJob(sandbox=UNRESTRICTED, frames=(1, 2), graph="a.json", resume=True))
    others = (
        RenderJob(sandbox=Sandbox("/show")), RenderJob(sandbox=UNRESTRICTED, memory=1),
        RenderJob(sandbox=UNRESTRICTED, deterministic=True), RenderJob(sandbox=UNRESTRICTED, form="fragment"),
    )  # fmt: skip
    assert len({find_kind(job), *map(find_kind, others)}) == 5


class Process:
    """Stands in for a process that renders; `log` says what became of all of them."""

    log: list[tuple[str, Any]] = []  # noqa: RUF012 - each test empties it

    def __init__(self, threads: int) -> None:
        self.threads, self.is_alive = threads, True
        self.log.append(("start", threads))

    def open_device(self, job: RenderJob) -> None:
        self.log.append(("open", job.memory))

    def finish(self) -> None:
        self.log.append(("finish", self.threads))

    def stop(self) -> None:
        self.log.append(("stop", self.threads))


@pytest.fixture
def pool(monkeypatch) -> RenderProcessPool:
    Process.log.clear()
    monkeypatch.setattr(render_process, "RenderProcess", Process)
    monkeypatch.setattr(render_process, "available_cores", lambda: 8)
    return RenderProcessPool()


KINDS = [find_kind(RenderJob(sandbox=UNRESTRICTED, memory=memory)) for memory in (1, 2)]


def test_a_process_is_lent_again_for_jobs_of_its_kind_to_one_chunk_at_a_time(pool: RenderProcessPool) -> None:
    with pool.lend_process(KINDS[0], 4) as first, pool.lend_process(KINDS[0], 5) as second:
        assert second is not first
    with pool.lend_process(KINDS[1], 6) as other:
        assert other not in (first, second)
    with pool.lend_process(KINDS[0], 7) as again, pool.lend_process(KINDS[0], 7) as both:
        assert {again, both} == {first, second}
    assert Process.log == [("start", 4), ("start", 5), ("start", 6)]
    pool.close()
    ended = [("finish", 6), ("finish", 4), ("finish", 5), ("stop", 6), ("stop", 4), ("stop", 5)]
    assert sorted(Process.log[3:6]) == sorted(ended[:3]) and sorted(Process.log[6:]) == sorted(ended[3:])
    pool.close()
    assert len(Process.log) == 9


def test_a_process_that_has_ended_or_whose_chunk_was_broken_off_is_not_lent_again(pool: RenderProcessPool) -> None:
    with pool.lend_process(KINDS[0], 1) as process:
        process.is_alive = False  # pyright: ignore[reportAttributeAccessIssue]
    with pytest.raises(KeyboardInterrupt), pool.lend_process(KINDS[0], 2):
        raise KeyboardInterrupt
    with pool.lend_process(KINDS[0], 3) as idle:
        pass
    idle.is_alive = False  # pyright: ignore[reportAttributeAccessIssue] - it ends while nobody needs it
    with pool.lend_process(KINDS[0], 4):
        pass
    assert Process.log == [(word, threads) for threads in (1, 2, 3) for word in ("start", "stop")] + [("start", 4)]


@pytest.mark.parametrize(("count", "processes", "threads"), [(1, 1, 8), (3, 3, 2), (8, 8, 1), (20, 8, 1)])
def test_processes_are_warmed_before_there_are_chunks(
    pool: RenderProcessPool, count: int, processes: int, threads: int
) -> None:
    pool.warm(RenderJob(sandbox=UNRESTRICTED, memory=1), count)
    assert Process.log == [("start", threads)] * processes + [("open", 1)] * processes
    with pool.lend_process(KINDS[0], 99):
        pass
    assert len(Process.log) == 2 * processes


def test_a_device_is_not_opened_ahead_where_a_chunk_tells_the_folder(pool: RenderProcessPool) -> None:
    pool.warm(RenderJob(sandbox=Sandbox("/show")), 1)
    assert Process.log == [("start", 8)]
