"""Jobs that go on without the process that has sent them.

A job that is detached is a task itself: a campaign that runs on a worker, beside the frames that the worker renders.
The scheduler keeps it as a published data set under the name of the job, so that others can list, follow and cancel it.
If the worker with the campaign goes, Dask runs it again on another one, and finished frames are kept as by `--resume`.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, cast
from uuid import uuid4

import msgspec
from msgspec import Struct, field
from msgspec.structs import replace

from ..errors import UsageError
from ..resources.struct_json import read_struct, write_struct
from ..resources.typed_data import convert_data
from .campaign import FrameCampaign
from .campaign_report import CampaignReport
from .chunk import FileMark, FrameChunk
from .worker_task import make_cancel_check, read_version
from .workers import WorkerRoster

if TYPE_CHECKING:
    from distributed import Client, Future, Worker

_POLL_SECONDS = 0.01
"""Between two looks at what the scheduler has answered: short for the user, and hardly any work."""

JOB_PREFIX = "halation-job-"
_REPORT_INTERVAL = 0.5
"""Seconds between two messages about a job as a whole: a choice."""

_ANSWER_SECONDS = 0.3
"""Seconds within which a scheduler says that a job has ended: many times what it takes."""

JobState = Literal["rendering", "finished", "failed"]


class DetachedCampaign(Struct, frozen=True):
    """What a campaign on a worker needs. `files` are those that each frame reads, which `chunk` has the marks of."""

    name: str
    chunk: FrameChunk
    files: Mapping[int, Sequence[str]] = field(default_factory=dict[int, Sequence[str]])
    priority: int = 0


class JobStatus(Struct, frozen=True):
    """How far a detached job is. `faults` are sentences by frame, or by file where it has many."""

    name: str
    graph: str
    state: JobState
    done: int
    total: int
    workers: int = 0
    seconds: float = 0.0
    slowest: Mapping[str, float] = field(default_factory=dict[str, float])
    faults: Mapping[str, str] = field(default_factory=dict[str, str])
    notes: tuple[str, ...] = ()
    unit: Literal["frame", "file"] = "frame"


def run_campaign(text: str) -> str:
    """Have the frames of a `DetachedCampaign` rendered by the workers here; its `JobStatus`. Both are JSON."""
    from distributed import get_worker, worker_client

    campaign = read_struct(text, DetachedCampaign, strict=False)
    worker, marks = get_worker(), campaign.chunk.marks
    is_cancelled = make_cancel_check(worker)
    listener = _EventWriter(worker, campaign)

    def mark_files(frames: tuple[int, ...]) -> dict[str, FileMark]:
        return {path: marks[path] for frame in frames for path in campaign.files.get(frame, ())}

    with worker_client(separate_thread=True) as client:
        frames = FrameCampaign(
            cast("Client", client),
            worker.scheduler.address,
            replace(campaign.chunk, marks={}),
            mark_files,
            listener,
            campaign.priority,
            is_cancelled,
        )
        report = frames.run()
    faults = {_name_part(campaign.chunk, part): str(facts["message"]) for part, facts in sorted(report.faults.items())}
    state: JobState = "failed" if faults else "finished"
    return write_struct(listener.describe(report.seconds, state, faults))


def _name_part(chunk: FrameChunk, part: int) -> str:
    """The number of a frame, or the name of a file."""
    return dict(zip(chunk.numbers, chunk.job.entries, strict=True))[part].file if chunk.numbers else str(part)


def send_campaign(client: Client, campaign: DetachedCampaign, graph: str) -> str:
    """Hand a campaign to a cluster, and return the name of the job. Raises UsageError if none can take it."""
    roster = WorkerRoster(wants_gpu=False)
    roster.update(cast("Mapping[str, Mapping[str, Any]]", client.scheduler_info(n_workers=-1)["workers"]))
    list(roster.check_versions(cast("Mapping[str, object]", client.run(read_version, on_error="return"))))
    if not roster.usable and not roster.is_empty:  # without any it waits for one
        reasons = "; ".join(f"{address}: {reason}" for address, reason in roster.refusals.items())
        raise UsageError(f"--detach: no worker can take the job: {reasons}")
    name = f"{JOB_PREFIX}{uuid4().hex[:6]}"
    campaign = replace(campaign, name=name)
    text = write_struct(campaign)
    places = roster.usable if roster.refusals else None
    future = client.submit(run_campaign, text, key=name, pure=False, workers=places, priority=campaign.priority)
    client.set_metadata(
        [name],
        {"graph": graph, "parts": len(campaign.chunk.parts), "unit": "file" if campaign.chunk.numbers else "frame"},
    )
    client.publish_dataset(future, name=name)
    return name


class JobBoard:
    """The detached jobs of a cluster."""

    def __init__(self, client: Client) -> None:
        self._client = client

    def list_jobs(self) -> Iterator[JobStatus]:
        """How far each job is."""
        names = cast("Sequence[object]", self._client.list_datasets())
        for name in sorted(str(name) for name in names if str(name).startswith(JOB_PREFIX)):
            yield self.find_job(name)

    def find_job(self, name: str) -> JobStatus:
        """How far one job is. Raises UsageError for a name that no job has."""
        future = self._find_future(name)
        deadline = time.monotonic() + _ANSWER_SECONDS
        while future.status == "pending" and time.monotonic() < deadline:  # the scheduler answers a moment later
            time.sleep(_POLL_SECONDS)
        facts = cast("Mapping[str, Any]", self._client.get_metadata([name], {"graph": "", "parts": 0, "unit": "frame"}))
        if future.status == "finished":
            return replace(read_struct(future.result(), JobStatus), graph=facts["graph"])
        events = cast("Sequence[tuple[float, Any]]", self._client.get_events(name))
        status = convert_data(events[-1][1], JobStatus) if events else None
        status = status or JobStatus(name, facts["graph"], "rendering", 0, facts["parts"], unit=facts["unit"])
        status = replace(status, graph=facts["graph"])
        if future.status in ("error", "cancelled", "lost"):
            reason = str(future.exception()) if future.status == "error" else "it was cancelled"
            return replace(status, state="failed", faults={"": reason})
        return status

    def cancel(self, name: str) -> None:
        """End a job, and forget it; finished frames stay. Raises UsageError for a name that no job has."""
        future = self._find_future(name)
        with contextlib.suppress(Exception):  # it may have ended meanwhile
            self._client.cancel([future], asynchronous=False, force=True)
        self._client.unpublish_dataset(name)

    def _find_future(self, name: str) -> Future[str]:
        try:
            return cast("Future[str]", self._client.get_dataset(name))
        except KeyError:
            raise UsageError(f"{name}: the cluster has no such job; 'halation jobs' lists them") from None


class _EventWriter:
    """Says on the scheduler how far a campaign is, for those who ask."""

    def __init__(self, worker: Worker, campaign: DetachedCampaign) -> None:
        self._worker, self._campaign = worker, campaign
        self._started, self._sent_at, self._workers = time.monotonic(), 0.0, 0
        self._notes: list[str] = []

    def report_progress(self, report: CampaignReport, workers: int) -> None:
        """Send a message from time to time."""
        self._workers = workers
        if time.monotonic() - self._sent_at > _REPORT_INTERVAL:
            self._sent_at = time.monotonic()
            status = self.describe(report.seconds, "rendering", {})
            cast("Any", self._worker).log_event(self._campaign.name, msgspec.to_builtins(status))

    def report_note(self, sentence: str) -> None:
        """Keep a sentence for whoever asks."""
        self._notes.append(sentence)

    def describe(self, frames: Mapping[int, float], state: JobState, faults: Mapping[str, str]) -> JobStatus:
        """How far the campaign is."""
        slowest = sorted(frames.items(), key=lambda pair: -pair[1])[:3]
        return JobStatus(
            self._campaign.name,
            "",
            state,
            len(frames),
            len(self._campaign.chunk.parts),
            self._workers,
            round(time.monotonic() - self._started, 3),
            {_name_part(self._campaign.chunk, part): seconds for part, seconds in slowest},
            faults,
            tuple(self._notes),
            "file" if self._campaign.chunk.numbers else "frame",
        )
