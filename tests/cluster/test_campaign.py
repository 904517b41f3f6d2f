"""The way of frames through a cluster, with a stand-in for Dask: who gets which, and what is said."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from halation.cluster import campaign, workers
from halation.cluster.campaign import FrameCampaign
from halation.cluster.chunk import ChunkReport, ChunkStage, EntryOutcome, FileMark, FrameChunk, StageReport
from halation.errors import RenderError, UsageError
from halation.renderer.jobs import shared_results
from halation.renderer.jobs.render_entry import RenderEntry
from halation.renderer.jobs.render_job import RenderJob
from halation.resources.sandbox import UNRESTRICTED
from scripted_dask import A, B, Client, KilledWorker, Listener

FULL = {"kind": "OutputError", "exit_code": 1, "message": "the disk is full"}
WRONG = {"kind": "UsageError", "exit_code": 2, "message": "no such option"}


@pytest.fixture(autouse=True)
def clock(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """Each look at the clock takes a second, so that each turn looks at the workers."""
    clock = SimpleNamespace(now=100.0, step=1.0)

    def look() -> float:
        clock.now += clock.step
        return clock.now

    for module in (campaign, workers):
        monkeypatch.setattr(module, "time", SimpleNamespace(monotonic=look))
    monkeypatch.setattr(campaign, "_POLL", 0.0)
    return clock


def make_chunk(*frames: int, **more: Any) -> FrameChunk:
    options = {"deterministic": True, **more.pop("job", {})}
    return FrameChunk(RenderJob(sandbox=UNRESTRICTED, frames=frames, **options), "/show", **more)


def open_campaign(client: Any, chunk: FrameChunk, **more: Any) -> tuple[Any, Listener]:
    def mark(frames: tuple[int, ...]) -> dict[str, FileMark]:
        return {f"/show/{frame}.exr": FileMark(frame, "") for frame in frames}

    listener = Listener()
    return FrameCampaign(client, "tcp://farm:8786", chunk, mark, listener, **more), listener


def finish(address: str, chunk: FrameChunk, **more: Any) -> str:
    """A report of a chunk whose frames have taken a second each; without those with a fault."""
    frames = [frame for frame in chunk.parts if frame not in more.get("faults", {})]
    return ChunkReport(address, **{"seconds": dict.fromkeys(frames, 1.0), **more}).to_json()


def test_all_frames_are_rendered_and_each_chunk_has_what_it_needs() -> None:
    client = Client(lambda *pair: finish(*pair, costs={"passes": 1}), A, B)
    job, listener = open_campaign(client, make_chunk(*range(1, 31)), priority=4)
    report = job.run()
    assert report.seconds == dict.fromkeys(range(1, 31), 1.0) and report.workers == {A, B} and not report.faults
    assert report.chunks == len(client.sent) == len(report.costs) and not listener.notes and not report.kept
    assert sorted(frame for parts in client.parts for frame in parts) == [*range(1, 31)]
    for chunk, options, future in client.sent:
        assert chunk.marks == {f"/show/{frame}.exr": FileMark(frame, "") for frame in chunk.parts}
        assert chunk.slots == {"a": 1, "b": 1} and chunk.stage is None and future.key == options["key"]
        assert (options["workers"], options["priority"], options["resources"]) == (None, 4, None)
    assert len({options["key"] for _, options, _ in client.sent}) == report.chunks
    assert len(client.parts[0]) == 1 and len(client.parts[2]) > 1, "costs are known from the first chunks on"
    assert client.asked == [A, B] and not client.topics and not client.cancelled
    assert listener.progress[-1] == (30, 0, 2)


def test_a_worker_has_one_chunk_until_costs_are_known_and_two_then() -> None:
    client = Client(lambda *_: None, A, nthreads=3)
    job, _ = open_campaign(client, make_chunk(*range(1, 101)))
    job._look_at_workers()
    job._send_chunks()
    assert len(client.sent) == 3
    job._frames.note_cost([1.0])
    job._send_chunks()
    assert len(client.sent) == 6


def test_on_workers_with_a_gpu_each_chunk_takes_one() -> None:
    client = Client(finish, A, resources={"GPU": 1})
    job, _ = open_campaign(client, make_chunk(1, 2, job={"deterministic": False}))
    assert len(job.run().seconds) == 2 and all(options["resources"] == {"GPU": 1} for _, options, _ in client.sent)


def test_frames_that_were_kept_are_no_costs() -> None:
    """Nine of ten take no time: chunks are as long as the tenth of two seconds says."""
    job, _ = open_campaign(Client(finish, A), make_chunk(*range(100)))
    costs = list[Any]()
    job._frames.note_cost = lambda seconds, is_first: costs.append((seconds, is_first))
    for _ in range(2):
        job._judge(ChunkReport(A, {1: 0.0, 2: 2.0}, kept=(1,)), job._frames.take(1))
    assert costs == [([2.0], True), ([2.0], False)] and job.report.kept == {1}


def test_what_a_worker_says_while_it_renders_counts() -> None:
    job, listener = open_campaign(Client(finish, A), make_chunk(1, 2, 3))
    frame = {"seconds": 0.5, "kept": False}
    job._note_events([{"frame": 1, **frame}, {"frame": 2, "seconds": 0.0, "kept": True, "entry": {"passes": 3}}])
    assert job.report.seconds == {1: 0.5, 2: 0.0} and job.report.kept == {2}
    assert job.report.entries == {2: EntryOutcome(passes=3)} and listener.progress == [(2, 0, 0)]


def test_messages_of_workers_come_by_the_topic_of_the_job() -> None:
    def answer(address: str, chunk: FrameChunk) -> str:
        frames = [{"frame": frame, "seconds": 0.0, "kept": True} for frame in chunk.parts]
        client.topics[chunk.topic]((12.5, {"worker": address, "frames": frames}))
        return finish(address, chunk)

    client = Client(answer, A)
    job, _ = open_campaign(client, make_chunk(1, 2))
    report = job.run()
    assert report.kept == {1, 2} and not job.has_lost_scheduler
    assert [options["priority"] for _, options, _ in client.sent] == [0] * len(client.sent)


def test_a_scheduler_that_has_not_answered_yet_is_not_gone() -> None:
    client = Client(finish, A)
    client.status = "connecting"
    job, _ = open_campaign(client, make_chunk(1))
    for _ in range(9):
        job._look_at_workers()
    client.status = "running"
    assert job.run().seconds == {1: 1.0}


def test_a_worker_that_refuses_gets_no_more_and_is_named_once() -> None:
    def answer(address: str, chunk: FrameChunk) -> str:
        return finish(address, chunk, seconds={}, refusal="it is odd") if address == A else finish(address, chunk)

    client = Client(answer, A, B, nthreads=2)
    job, listener = open_campaign(client, make_chunk(*range(12)))
    assert len(job.run().seconds) == 12 and listener.notes == [f"worker {A}: it is odd: it gets no frames"]
    assert client.sent[-1][1]["workers"] == [B]


def test_a_worker_of_another_version_gets_no_frames() -> None:
    client = Client(finish, A, B)
    client.versions[A] = "0.0.1"
    job, listener = open_campaign(client, make_chunk(1, 2, 3))
    assert len(job.run().seconds) == 3 and len(listener.notes) == 1 and f"worker {A}: it has" in listener.notes[0]
    assert {tuple(options["workers"]) for _, options, _ in client.sent} == {(B,)}
    inside = Client(finish, "inproc://1/2/3")
    assert len(open_campaign(inside, make_chunk(1))[0].run().seconds) == 1 and not inside.asked


def test_a_frame_that_a_worker_cannot_render_is_tried_by_another_one() -> None:
    def answer(address: str, chunk: FrameChunk) -> str:
        return finish(address, chunk, faults={frame: FULL for frame in chunk.parts if address == A})

    client = Client(answer, A, B)
    job, listener = open_campaign(client, make_chunk(*range(1, 9)))
    report = job.run()
    assert len(report.seconds) == 8 and not report.faults
    assert listener.notes in ([], [f"worker {A}: it has failed 3 times in a row: the disk is full: it gets no frames"])


def test_a_frame_that_two_workers_cannot_render_is_given_up_and_costs_nobody_his_place() -> None:
    def answer(address: str, chunk: FrameChunk) -> str:
        return finish(address, chunk, faults={frame: FULL for frame in chunk.parts if frame == 3})

    client = Client(answer, A, B)
    job, listener = open_campaign(client, make_chunk(*range(1, 6)))
    report = job.run()
    assert report.faults == {3: FULL} and sorted(report.seconds) == [1, 2, 4, 5] and not listener.notes
    assert sum(3 in parts for parts in client.parts) == 2, "they agree: a third would too"


@pytest.mark.parametrize("is_chain", [False, True])
def test_what_all_workers_find_wrong_alike_ends_the_job(is_chain: bool) -> None:
    client = Client(lambda address, chunk: finish(address, chunk, seconds={}, faults={1: WRONG}), A, B)
    job, _ = open_campaign(client, make_chunk(1, is_chain=is_chain))
    with pytest.raises(UsageError, match="no such option"):
        job.run()
    assert not client.topics and len(client.sent) == 1


def test_of_many_files_a_wrong_one_is_a_fault_of_its_own() -> None:
    def answer(address: str, chunk: FrameChunk) -> str:
        return finish(address, chunk, faults={number: WRONG for number in chunk.parts if number == 2})

    entries = tuple(RenderEntry(name) for name in ("a.exr", "b.exr", "c.exr"))
    job, _ = open_campaign(Client(answer, A), make_chunk(job={"entries": entries}, numbers=(1, 2, 3)))
    report = job.run()
    assert report.faults == {2: WRONG} and sorted(report.seconds) == [1, 3]


def test_frames_that_nobody_has_said_anything_of_are_sent_again() -> None:
    tries = list[tuple[int, ...]]()

    def answer(address: str, chunk: FrameChunk) -> str:
        tries.append(chunk.parts)
        return finish(address, chunk, **({"seconds": {}} if len(tries) == 1 else {}))

    job, _ = open_campaign(Client(answer, A), make_chunk(1, 2))
    assert sorted(job.run().seconds) == [1, 2] and sum(1 in parts for parts in tries) == 2


def test_a_video_is_all_there_or_begins_anew_and_a_chain_of_files_goes_on() -> None:
    for destination, second in (("f.mp4", (1, 2, 3, 4)), ("f.####.exr", (3, 4))):
        tries = list[tuple[int, ...]]()

        def answer(address: str, chunk: FrameChunk, tries: list[tuple[int, ...]] = tries) -> str:
            tries.append(chunk.parts)
            return finish(address, chunk, **({"seconds": {1: 1.0, 2: 1.0}} if len(tries) == 1 else {}))

        chunk = make_chunk(1, 2, 3, 4, is_chain=True, job={"destinations": (("", f"/show/{destination}"),)})
        assert sorted(open_campaign(Client(answer, A), chunk)[0].run().seconds) == [1, 2, 3, 4]
        assert tries == [(1, 2, 3, 4), second]


def test_frames_of_a_chain_are_given_up_with_the_one_that_they_need() -> None:
    def answer(address: str, chunk: FrameChunk) -> str:
        faults = {frame: {**FULL, "frame": 3} for frame in chunk.parts if frame >= 3}
        return finish(address, chunk, faults=faults)

    job, _ = open_campaign(Client(answer, A, B), make_chunk(1, 2, 3, 4, 5, is_chain=True))
    report = job.run()
    sentence = "one worker renders all frames, and frame 3 cannot be rendered"
    assert sorted(report.seconds) == [1, 2]
    assert {frame: facts["message"] for frame, facts in report.faults.items()} == {
        3: FULL["message"],
        4: sentence,
        5: sentence,
    }


def test_a_frame_that_ends_its_process_is_tried_three_times() -> None:
    def answer(address: str, chunk: FrameChunk) -> str:
        return finish(address, chunk, seconds={}, death="it ends") if 2 in chunk.parts else finish(address, chunk)

    client = Client(answer, A, B)
    report = open_campaign(client, make_chunk(1, 2, 3))[0].run()
    assert sorted(report.seconds) == [1, 3] and sum(parts == (2,) for parts in client.parts) == 3
    assert report.faults[2]["kind"] == "RenderError" and report.faults[2]["exit_code"] == 1
    assert (
        report.faults[2]["message"].startswith("on 3 tries, the last on tcp://")
        and ": it ends" in report.faults[2]["message"]
    )


def test_what_dask_says_of_a_chunk_decides_what_becomes_of_it() -> None:
    def run(*outcomes: Exception) -> Any:
        left = [*outcomes]
        client = Client(lambda *pair: left.pop(0) if left else finish(*pair), A, B)
        return open_campaign(client, make_chunk(1))[0].run()

    assert run(ImportError("not yet")).seconds == run(KilledWorker("once")).seconds == {1: 1.0}
    killed = run(*[KilledWorker("again")] * 3)
    assert killed.faults[1]["message"] == "the worker that renders it is ended each time" and not killed.seconds
    with pytest.raises(RenderError, match="--cluster tcp://farm:8786: a worker reports ValueError: odd"):
        run(ValueError("odd"))


def test_chunks_of_a_worker_that_has_gone_are_sent_to_others() -> None:
    def answer(address: str, chunk: FrameChunk) -> str | None:
        return None if address == A else finish(address, chunk)

    client = Client(answer, A, B)
    job, _ = open_campaign(client, make_chunk(1))
    job._workers.refusals[B] = "not yet"
    job._look_at_workers()
    job._send_chunks()
    assert client.sent[0][1]["workers"] == [A] and not len(job._frames)
    job._look_at_workers()
    assert len(job._sent) == 1 and not client.sent[0][2].is_cancelled
    del client.workers[A], job._workers.refusals[B]
    assert job.run().seconds == {1: 1.0} and client.sent[0][2].is_cancelled and not client.cancelled


def test_a_scheduler_that_has_gone_is_waited_for_three_seconds(clock: SimpleNamespace) -> None:
    client = Client(lambda *_: None, A)
    job, _ = open_campaign(client, make_chunk(1, 2))
    clock.step = 0.0
    job._look_at_workers()
    client.status = "connecting"
    for seconds in (1.0, 1.0, 1.0):
        clock.now += seconds
        job._look_at_workers()
    clock.now += 1.0
    with pytest.raises(RenderError, match="the scheduler has gone; 0 frames are finished: start it again"):
        job._look_at_workers()
    assert job.has_lost_scheduler


def test_workers_are_looked_at_once_a_second(clock: SimpleNamespace) -> None:
    client = Client(finish, A)
    job, _ = open_campaign(client, make_chunk(1))
    clock.step = 0.0
    job._look_at_workers()
    client.workers[B] = {"nthreads": 1}
    for seconds, known in ((0.9, [A]), (0.1, [A, B])):
        clock.now += seconds
        job._look_at_workers()
        assert job._workers.usable == known


def test_it_is_said_once_that_no_worker_is_there() -> None:
    client = Client(finish)
    turns = iter(range(100))

    def is_cancelled() -> bool:
        if next(turns) == 5:
            client.workers[A] = {"nthreads": 1}
        return False

    job, listener = open_campaign(client, make_chunk(1), is_cancelled=is_cancelled)
    assert job.run().seconds == {1: 1.0}
    assert len(listener.notes) == 1 and listener.notes[0].startswith("no worker is connected to tcp://farm:8786: start")


def test_where_all_workers_refuse_the_job_ends() -> None:
    client = Client(lambda address, chunk: finish(address, chunk, seconds={}, refusal="it is odd"), A)
    job, _ = open_campaign(client, make_chunk(1))
    with pytest.raises(RenderError, match=f"no worker can render these frames: {A}: it is odd"):
        job.run()


def test_frames_wait_for_another_worker_than_one_with_a_full_disk() -> None:
    def answer(address: str, chunk: FrameChunk) -> str:
        client.workers[B] = {"nthreads": 1}  # it comes a moment later
        return finish(address, chunk, faults={frame: FULL for frame in chunk.parts if address == A})

    client = Client(answer, A)
    job, listener = open_campaign(client, make_chunk(1, 2))
    assert sorted(job.run().seconds) == [1, 2]
    assert listener.notes in ([], ["the disk is full: frames wait for another worker"])
    alone = Client(lambda address, chunk: finish(address, chunk, faults=dict.fromkeys(chunk.parts, FULL)), A)
    job, listener = open_campaign(alone, make_chunk(1, 2))
    assert job.run().faults == {1: FULL, 2: FULL}
    assert listener.notes == ["the disk is full: frames wait for another worker"], "once for all"


def test_a_job_that_is_cancelled_leaves_nothing_on_the_cluster() -> None:
    client, turns = Client(lambda *_: None, A, B), iter([False, False, True])
    job, _ = open_campaign(client, make_chunk(1, 2, 3), is_cancelled=lambda: next(turns))
    assert job.run().seconds == {} and client.cancelled == [future for _, _, future in client.sent] != []
    assert not client.topics and not job._sent


def test_shared_results_are_removed_here_or_where_they_are_mapped_to(tmp_path: Path) -> None:
    folder = tmp_path / f"{shared_results.FOLDER_PREFIX}1"
    folder.mkdir()
    for place, pairs in ((folder, ()), ("/farm/x", ()), ("/farm/x", (("/farm", "/there"),))):
        client = Client(finish, A)
        stage = ChunkStage(folder=str(place), frame_before=1)
        job, _ = open_campaign(client, make_chunk(1, 2, stage=stage, path_map=pairs), is_cancelled=lambda: True)
        job._workers.update(client.workers)
        job.run()
        assert not folder.exists() and [json.loads(text) for text in client.removed] == (
            [["/farm/x", [["/farm", "/there"]]]] if pairs else []
        )


def test_the_history_of_a_node_is_rendered_by_one_worker_at_a_time_and_frames_by_all(tmp_path: Path) -> None:
    def answer(address: str, chunk: FrameChunk) -> str:
        assert chunk.stage is not None
        if chunk.stage.kind == "frames":
            return finish(address, chunk)
        seconds = dict.fromkeys(chunk.stage.frames, 1.0)
        report = StageReport(seconds, memories=dict.fromkeys(seconds, ()), frame_bytes=8)
        return finish(address, chunk, seconds={}, stage=report)

    client = Client(answer, A, B)
    stage = ChunkStage(folder=str(tmp_path / "none"), frame_before=1)
    report = open_campaign(client, make_chunk(1, 2, 3, 4, stage=stage))[0].run()
    assert sorted(report.seconds) == [1, 2, 3, 4] and report.stages == {"ahead": 0, "history": 3} and not report.faults
    kinds = [chunk.stage.kind for chunk, _, _ in client.sent if chunk.stage]
    assert kinds[0] == "history" and set(kinds) == {"history", "frames"}
