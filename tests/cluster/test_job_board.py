"""What a scheduler knows of detached jobs and what is said of them, with stand-ins for Dask."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import msgspec
import pytest
from halation.cluster import detached
from halation.cluster.campaign_report import CampaignReport
from halation.cluster.chunk import FrameChunk
from halation.cluster.detached import DetachedCampaign, JobBoard, JobStatus, send_campaign
from halation.errors import UsageError
from halation.renderer.jobs.render_entry import RenderEntry
from halation.renderer.jobs.render_job import RenderJob
from halation.resources.sandbox import UNRESTRICTED
from halation.resources.struct_json import write_struct
from halation.version import VERSION

FRAMES = FrameChunk(RenderJob(sandbox=UNRESTRICTED, frames=(1, 2, 5, 9)), "/show")
FILES = FrameChunk(
    RenderJob(sandbox=UNRESTRICTED, entries=tuple(RenderEntry(name) for name in ("a.exr", "b.exr"))),
    "/show",
    numbers=(1, 2),
)
NEAR, FAR = "tcp://near:1", "tcp://far:1"


class Client:
    """Stands in for a client of Dask: a scheduler that keeps data sets, facts and events, and workers of versions."""

    def __init__(self, **versions: object) -> None:
        self.versions = {f"tcp://{name}:1": version for name, version in versions.items()}
        self.jobs: dict[Any, Any] = {}
        self.metadata: dict[str, Any] = {}
        self.events: dict[str, list[tuple[float, Any]]] = {}
        self.sent: list[tuple[tuple[Any, ...], dict[str, Any]]] = []
        self.cancelled: list[Any] = []

    def scheduler_info(self, n_workers: int) -> dict[str, Any]:
        assert n_workers == -1, "all of them"
        return {"workers": {address: {"nthreads": 1} for address in self.versions}}

    def run(self, function: Any, on_error: str) -> dict[str, object]:
        assert function() == VERSION and on_error == "return"
        return self.versions

    def submit(self, *words: Any, **options: Any) -> str:
        self.sent.append((words, options))
        return "future"

    def set_metadata(self, keys: list[str], facts: Any) -> None:
        (self.metadata[keys[0]],) = (facts,)

    def get_metadata(self, keys: list[str], default: Any) -> Any:
        return self.metadata.get(keys[0], default)

    def publish_dataset(self, future: Any, name: str) -> None:
        self.jobs[name] = future

    def unpublish_dataset(self, name: str) -> None:
        del self.jobs[name]

    def list_datasets(self) -> tuple[Any, ...]:
        return tuple(self.jobs)

    def get_dataset(self, name: str) -> Any:
        return self.jobs[name]

    def get_events(self, name: str) -> Any:
        return tuple(self.events.get(name, ()))

    def cancel(self, futures: list[Any], *, asynchronous: bool, force: bool) -> None:
        assert force and not asynchronous
        self.cancelled += futures
        raise RuntimeError("it has ended meanwhile")


def send(client: Any, chunk: FrameChunk, priority: int = 0) -> str:
    return send_campaign(client, DetachedCampaign("", chunk, priority=priority), "shot.json")


@pytest.mark.parametrize(("chunk", "parts", "unit"), [(FRAMES, 4, "frame"), (FILES, 2, "file")])
def test_a_job_is_sent_to_any_worker_and_published_by_a_name_of_its_own(
    chunk: FrameChunk, parts: int, unit: str
) -> None:
    client = Client(near=VERSION)
    name = send(client, chunk, priority=3)
    assert name.startswith("halation-job-") and len(name) == len("halation-job-") + 6 and send(client, chunk) != name
    (function, text), options = client.sent[0]
    assert function is detached.run_campaign and msgspec.json.decode(text)["name"] == name
    assert options == {"key": name, "pure": False, "workers": None, "priority": 3}
    assert (
        client.metadata[name] == {"graph": "shot.json", "parts": parts, "unit": unit} and client.jobs[name] == "future"
    )


def test_a_job_goes_to_workers_of_its_version_and_is_refused_without_any() -> None:
    client = Client(near=VERSION, far="0.0.1")
    send(client, FRAMES)
    assert client.sent[0][1]["workers"] == [NEAR]
    send(empty := Client(), FRAMES)
    assert empty.sent[0][1]["workers"] is None, "it waits for one"
    with pytest.raises(UsageError, match=f"no worker can take the job: {FAR}: it has Halation 0.0.1"):
        send(client := Client(far="0.0.1"), FRAMES)
    assert not client.sent and not client.jobs


def add_job(client: Client, name: str, states: list[str], **facts: Any) -> None:
    """A job whose future has these states, one after the other."""

    class Future:
        @property
        def status(self) -> str:
            return states.pop(0) if len(states) > 1 else states[0]

    future: Any = Future()
    for key, value in facts.items():
        setattr(future, key, value)
    client.jobs[name] = future
    client.metadata[name] = {"graph": f"{name}.json", "parts": 9, "unit": "file"}


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    clock = SimpleNamespace(now=50.0, slept=0.0)

    def sleep(seconds: float) -> None:
        clock.now += seconds
        clock.slept += seconds

    monkeypatch.setattr(detached, "time", SimpleNamespace(monotonic=lambda: clock.now, sleep=sleep))
    return clock


STATUS = JobStatus("job", "", "rendering", 3, 9, 2, 1.5, {"4": 0.5}, unit="file")


def test_what_is_said_of_a_job_is_what_it_said_last(clock: SimpleNamespace) -> None:
    client: Any = Client()
    board = JobBoard(client)
    add_job(client, "job", ["pending"])
    assert board.find_job("job") == JobStatus("job", "job.json", "rendering", 0, 9, unit="file")
    assert 0.3 <= clock.slept < 0.35
    old = msgspec.structs.replace(STATUS, done=1)
    client.events["job"] = [(1.0, msgspec.to_builtins(old)), (2.0, msgspec.to_builtins(STATUS))]
    assert board.find_job("job") == msgspec.structs.replace(STATUS, graph="job.json")
    clock.slept = 0.0
    end = msgspec.structs.replace(STATUS, state="finished", done=9)
    add_job(client, "job", ["pending", "pending", "finished"], result=lambda: write_struct(end))
    assert board.find_job("job") == msgspec.structs.replace(end, graph="job.json") and 0.0 < clock.slept < 0.05


@pytest.mark.parametrize(
    ("state", "reason"), [("error", "no memory"), ("cancelled", "it was cancelled"), ("lost", "it was cancelled")]
)
def test_a_job_that_has_ended_without_an_answer_has_failed(clock: SimpleNamespace, state: str, reason: str) -> None:
    client: Any = Client()
    add_job(client, "job", [state], exception=lambda: MemoryError("no memory"))
    client.events["job"] = [(2.0, msgspec.to_builtins(STATUS))]
    expected = msgspec.structs.replace(STATUS, graph="job.json", state="failed", faults={"": reason})
    assert JobBoard(client).find_job("job") == expected and clock.slept == 0.0


def test_only_jobs_of_halation_are_listed_in_order_and_forgotten_when_cancelled(clock: SimpleNamespace) -> None:
    client: Any = Client()
    for name in ("halation-job-b", "halation-job-a", "other"):
        add_job(client, name, ["running"])
    client.jobs[7] = None  # a data set may have any name
    board = JobBoard(client)
    assert [job.name for job in board.list_jobs()] == ["halation-job-a", "halation-job-b"]
    future = client.jobs["halation-job-a"]
    board.cancel("halation-job-a")
    assert client.cancelled == [future] and [job.name for job in board.list_jobs()] == ["halation-job-b"]
    for ask in (board.cancel, board.find_job):
        with pytest.raises(UsageError, match="halation-job-a: the cluster has no such job"):
            ask("halation-job-a")


@pytest.mark.parametrize(("chunk", "names"), [(FRAMES, ["9", "2", "1"]), (FILES, ["b.exr", "a.exr"])])
def test_a_campaign_says_twice_a_second_how_far_it_is(
    clock: SimpleNamespace, chunk: FrameChunk, names: list[str]
) -> None:
    sent: list[tuple[str, Any]] = []
    worker: Any = SimpleNamespace(log_event=lambda topic, event: sent.append((topic, event)))
    writer = detached._EventWriter(worker, DetachedCampaign("job", chunk))  # pyright: ignore[reportPrivateUsage]
    seconds = {1: 0.5, 2: 1.0, 5: 0.25, 9: 2.0} if chunk is FRAMES else {1: 0.5, 2: 1.0}
    writer.report_note("a worker has gone")
    for wait in (0.1, 0.4, 0.05, 0.06):
        clock.now += wait
        writer.report_progress(CampaignReport(seconds), 3)
    assert [(topic, event["seconds"]) for topic, event in sent] == [("job", 0.1), ("job", 0.61)]
    first = msgspec.convert(sent[0][1], JobStatus)
    assert (first.state, first.done, first.total, first.workers) == ("rendering", len(seconds), len(chunk.parts), 3)
    assert list(first.slowest) == names and list(first.slowest.values()) == sorted(seconds.values())[::-1][:3]
    assert first.notes == ("a worker has gone",) and first.unit == ("file" if chunk is FILES else "frame")
    last = writer.describe(seconds, "failed", {"5": "no"})
    assert (last.state, last.faults, last.workers) == ("failed", {"5": "no"}, 3)
