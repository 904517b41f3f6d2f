"""Sends the frames of a job to the workers of a cluster, and hears what comes of them."""

from __future__ import annotations

import contextlib
import json
import time
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Any, cast
from uuid import uuid4

from msgspec.structs import replace

from ..errors import RenderError, rebuild_fault
from ..renderer.jobs.shared_results import remove_shared_folder
from ..resources.typed_data import convert_data
from .assignments import MAX_ATTEMPTS, Assignment, AssignmentQueue, WaitingAssignments
from .campaign_report import CampaignListener, CampaignReport
from .chunk import ChunkReport, EntryOutcome, FileMark, FrameChunk, StageReport
from .staged_assignments import StagedAssignments
from .worker_task import read_version, remove_results, render_chunk
from .workers import WorkerRoster, is_here

if TYPE_CHECKING:
    from distributed import Client, Future

_WAVES = 2
"""Chunks that are sent for each place where one is rendered: while a worker renders one, it has the next. See
`sends_ahead` of the queues."""

_LOOK_INTERVAL = 1.0
"""Seconds between two questions which workers there are: a choice."""

_POLL = 0.1
"""Seconds that this waits for a message at most, so that Ctrl-C is heard."""

_LOST_SECONDS = 3.0
"""Seconds without a connection after which the scheduler has gone: a choice; Dask tries again meanwhile."""

_POINTLESS = frozenset({"UsageError", "GraphError", "DocumentError"})
"""Errors that every worker has alike."""


class FrameCampaign:
    """The frames of one job on their way through a cluster. `chunk` is what all chunks share.

    `mark_files` describes the files that frames read. `priority` is Dask's: chunks of a higher one go first. The
    campaign ends early once it `is_cancelled`. `report` is that of an earlier campaign, which this one continues.
    """

    def __init__(
        self,
        client: Client,
        address: str,
        chunk: FrameChunk,
        mark_files: Callable[[tuple[int, ...]], Mapping[str, FileMark]],
        listener: CampaignListener,
        priority: int = 0,
        is_cancelled: Callable[[], bool] = lambda: False,
        report: CampaignReport | None = None,
    ) -> None:
        self._client, self._address, self._listener, self._priority = client, address, listener, priority
        self._is_cancelled = is_cancelled
        self._name = f"halation-{uuid4().hex[:8]}"
        self._chunk, self._mark_files = replace(chunk, topic=self._name), mark_files
        self._frames = _open_assignments(self._chunk)
        self._workers = WorkerRoster(wants_gpu=not chunk.job.deterministic)
        self._inbox = SimpleQueue["Future[str] | Mapping[str, Any]"]()
        self._sent: dict[str, tuple[Future[str], Assignment, list[str] | None]] = {}
        self._looked_at = self._heard_at = 0.0
        self._is_waiting = False
        self._waiting = WaitingAssignments(self._workers)
        self.report = report or CampaignReport()
        self.has_lost_scheduler = False

    def run(self) -> CampaignReport:
        """Have all frames rendered.

        Raises HalationError for what no frame can be rendered with, and RenderError where the scheduler or all workers
        are gone; finished frames stay.
        """
        self._client.subscribe_topic(self._name, lambda event: self._inbox.put(event[1]))
        try:
            while (len(self._frames) or self._sent or self._waiting) and not self._is_cancelled():
                self._look_at_workers()
                self._send_chunks()
                self._receive()
        finally:
            self._cancel()
            if self._chunk.stage:
                self._remove_results(self._chunk.stage.folder)
        return self.report

    # --- sending -----------------------------------------------------------------------------------------------------

    def _send_chunks(self) -> None:
        slots = self._workers.slots
        most = _WAVES * slots if self._frames.sends_ahead else slots
        while len(self._frames) and len(self._sent) < most and self._workers.usable:
            assignment = self._frames.take(slots)
            if assignment is None:
                return
            if assignment.fault is None or self._workers.has_others(assignment.tried):
                self._send(assignment)
            else:
                self._hold(assignment)

    def _hold(self, assignment: Assignment) -> None:
        """Have frames wait for another worker than those that could not render them."""
        if not self._waiting and assignment.fault is not None:
            self._listener.report_note(f"{assignment.fault['message']}: frames wait for another worker")
        self._waiting.add(assignment)

    def _send(self, assignment: Assignment) -> None:
        """Hand a chunk to Dask."""
        kind = assignment.stage.kind if assignment.stage else "frames"
        # The frames of a stage may be none of those whose files are written.
        parts = assignment.frames if kind in ("frames", "check") else self._chunk.parts[:1]
        chunk = replace(
            self._chunk.take_parts(parts),
            marks=self._mark_files(assignment.frames),
            stage=assignment.stage,
            slots=self._workers.count_slots_by_machine(),
        )
        places = self._workers.choose(assignment.tried)
        self.report.chunks += 1
        key = f"{self._name}-{self.report.chunks}"
        future = self._client.submit(
            render_chunk,
            chunk.to_json(),
            key=key,
            pure=False,
            workers=places,
            priority=self._priority,
            resources={"GPU": 1} if self._workers.needs_gpu else None,
        )
        self._sent[key] = future, assignment, places
        future.add_done_callback(self._inbox.put)

    def _cancel(self) -> None:
        """Have no more rendered of this job."""
        with contextlib.suppress(Exception):  # without a scheduler there is nothing to cancel
            self._client.unsubscribe_topic(self._name)
            if self._sent:
                self._client.cancel([future for future, _, _ in self._sent.values()], asynchronous=False, force=True)
        self._sent.clear()

    def _remove_results(self, folder: str) -> None:
        """Remove what workers have shared, here or where the folder is mapped to."""
        with contextlib.suppress(Exception):  # a later job in that folder removes it
            if Path(folder).is_dir():
                remove_shared_folder(Path(folder))
            elif self._chunk.path_map and self._workers.usable:
                pairs = json.dumps([folder, self._chunk.path_map])
                self._client.submit(remove_results, pairs, pure=False).result(timeout=_LOST_SECONDS)

    # --- hearing -----------------------------------------------------------------------------------------------------

    def _receive(self) -> None:
        """Take in the messages that are there; wait a moment for the first one."""
        with contextlib.suppress(Empty):
            message = self._inbox.get(timeout=_POLL)
            while True:
                if isinstance(message, Mapping):
                    self._note_events(message["frames"])
                else:
                    self._take_in(message)
                message = self._inbox.get_nowait()

    def _note_events(self, events: Iterable[Mapping[str, Any]]) -> None:
        """Take in what a worker says of frames while it renders others."""
        for event in events:
            if event["kept"]:
                self.report.kept.add(event["frame"])
            if "entry" in event:
                self.report.entries[event["frame"]] = convert_data(event["entry"], EntryOutcome)
        self._note_frames({event["frame"]: event["seconds"] for event in events})

    def _take_in(self, future: Future[str]) -> None:
        """What has come of a chunk."""
        if future.key not in self._sent:
            return
        _, assignment, _ = self._sent.pop(str(future.key))
        report = fault = None
        with contextlib.suppress(Exception):  # worker or connection have gone: finished frames are kept
            if future.status == "finished":
                report = ChunkReport.from_json(future.result(timeout=_LOST_SECONDS))
            elif future.status == "error":
                fault = cast("BaseException | None", future.exception(timeout=_LOST_SECONDS))
        if report is not None:
            self._judge(report, assignment)
        elif fault is not None:
            self._judge_loss(fault, assignment)
        else:
            self._frames.put_back(assignment)

    def _judge(self, report: ChunkReport, assignment: Assignment) -> None:
        """Count what is finished, and decide who tries the rest again."""
        if report.refusal:
            if report.worker not in self._workers.refusals:
                self._refuse(report.worker, report.refusal)
            self._frames.put_back(assignment)
            return
        if report.stage is not None and assignment.stage is not None:
            self._judge_stage(report, report.stage, assignment)
            return
        self.report.kept.update(report.kept)
        self.report.entries.update(report.entries)
        self._note_frames(report.seconds)
        is_first = report.worker not in self.report.workers
        self.report.workers.add(report.worker)
        self.report.costs += [report.costs] if report.costs else []
        costs = [cost for frame, cost in report.seconds.items() if frame not in report.kept]
        self._frames.note_cost(costs, is_first=is_first)
        missing = self._list_missing(report, assignment)
        if report.death:
            is_stage = assignment.stage is not None and assignment.stage.kind != "frames"
            lost = self._frames.put_suspects(assignment.frames if is_stage else missing, assignment, report.worker)
            self._give_up(lost, f"on {MAX_ATTEMPTS} tries, the last on {report.worker}: {report.death}")
            return
        if missing and self._chunk.is_chain:
            self._judge_chain(missing, report, assignment)
        else:
            for frame in missing:
                self._judge_fault(frame, report, assignment)
        if report.faults and not report.seconds:
            sentence = str(next(iter(report.faults.values()))["message"])
            if self._workers.note_failure(report.worker, report.faults, sentence):
                self._refuse(report.worker, self._workers.refusals[report.worker])
        else:
            self._workers.note_success(report.worker)

    def _judge_stage(self, report: ChunkReport, stage: StageReport, assignment: Assignment) -> None:
        """Take in a stage, and try the rest of it again, or give up the frames that need it."""
        frames = self._frames
        assert isinstance(frames, StagedAssignments) and assignment.stage is not None
        self.report.stages = frames.stage_frames
        if kept := frames.finish_stage(stage, assignment):
            self.report.kept |= kept
            self._note_frames(dict.fromkeys(kept, 0.0))
        if not report.faults or assignment.stage.kind == "check":
            return
        frame, facts = next(iter(report.faults.items()))
        if facts["kind"] in _POINTLESS:
            raise rebuild_fault(facts)
        self._try_elsewhere(frames.take_rest(assignment, frame), facts, report.worker)

    def _judge_fault(self, frame: int, report: ChunkReport, assignment: Assignment) -> None:
        """Try a frame on another worker that cannot be rendered on one, or give it up."""
        facts, alone = report.faults.get(frame), replace(assignment, frames=(frame,))
        if facts is None:
            self._frames.put_back(alone)
        elif facts["kind"] in _POINTLESS and self._chunk.numbers:
            self._note_faults({frame: facts})
        elif facts["kind"] in _POINTLESS:
            raise rebuild_fault(facts)
        else:
            self._try_elsewhere(alone, facts, report.worker)

    def _judge_chain(self, missing: list[int], report: ChunkReport, assignment: Assignment) -> None:
        """Try the rest of a chain on another worker, or give it up: none of it can be rendered without the first."""
        facts, rest = report.faults.get(missing[0]), replace(assignment, frames=tuple(missing))
        if facts is not None and facts["kind"] in _POINTLESS:
            raise rebuild_fault(facts)
        if facts is None:
            self._frames.put_back(rest)
        else:
            self._try_elsewhere(rest, facts, report.worker)

    def _try_elsewhere(self, assignment: Assignment, facts: Mapping[str, Any], worker: str) -> None:
        """Try frames on another worker that one cannot render, or give them up."""
        attempts, tried = assignment.attempts + 1, assignment.tried | {worker}
        again = replace(assignment, attempts=attempts, tried=tried, fault=facts)
        if attempts < MAX_ATTEMPTS and (self._workers.has_others(tried) or self._workers.expects_others(tried)):
            self._frames.put_back(again)
            return
        for address in self._workers.pardon(assignment.frames) if len(tried) > 1 else ():
            self._listener.report_note(f"worker {address}: others fail with the same frames: it gets frames again")
        self._give_up_fault(again, facts)

    def _give_up_fault(self, assignment: Assignment, facts: Mapping[str, Any]) -> None:
        """Render frames no more that cannot be rendered, nor those that need them."""
        frames, queue = assignment.frames, self._frames
        if isinstance(queue, StagedAssignments) and assignment.stage is not None and assignment.stage.kind != "frames":
            self._note_faults(dict.fromkeys(queue.give_up_stage(assignment, frames[0]), facts))
        elif self._chunk.is_chain:
            at_fault = int(facts.get("frame", frames[0]))
            sentence = f"one worker renders all frames, and frame {at_fault} cannot be rendered"
            self._note_faults({frame: {**facts, "message": sentence} for frame in frames} | {at_fault: facts})
        else:
            self._note_faults(dict.fromkeys(frames, facts))

    def _list_missing(self, report: ChunkReport, assignment: Assignment) -> list[int]:
        """The frames of a chunk that are not finished. Of a video that is all of them, until it is complete."""
        frames = assignment.frames
        if not (self._chunk.is_chain and self._chunk.job.videos):
            return list(self.report.list_missing(frames))
        if all(frame in report.seconds for frame in frames) and not report.faults and not report.death:
            return []
        for frame in frames:
            self.report.seconds.pop(frame, None)
        return list(frames)

    def _judge_loss(self, fault: BaseException, assignment: Assignment) -> None:
        """Decide about a chunk that Dask has given up: its workers ended, one after the other."""
        name = type(fault).__name__
        if name == "KilledWorker":
            lost = self._frames.put_suspects(assignment.frames, assignment, "")
            self._give_up(lost, "the worker that renders it is ended each time")
        elif isinstance(fault, ImportError):
            self._frames.put_back(assignment)
        else:
            raise RenderError(f"--cluster {self._address}: a worker reports {name}: {fault}")

    def _give_up(self, frames: tuple[int, ...], reason: str) -> None:
        facts = {"kind": "RenderError", "exit_code": 1, "message": self._frames.explain_loss(frames, reason)}
        self._note_faults(dict.fromkeys(frames, facts))

    def _note_faults(self, faults: Mapping[int, Mapping[str, Any]]) -> None:
        self.report.faults |= faults
        self._frames.finish(faults)
        self._listener.report_progress(self.report, len(self._workers.usable))

    def _note_frames(self, seconds: Mapping[int, float]) -> None:
        self.report.seconds |= seconds
        self._frames.finish(seconds)
        self._listener.report_progress(self.report, len(self._workers.usable))

    # --- workers -----------------------------------------------------------------------------------------------------

    def _look_at_workers(self) -> None:
        """Ask the scheduler for its workers, try the new ones, and take chunks from those that have gone."""
        now = time.monotonic()
        if now - self._looked_at < _LOOK_INTERVAL:
            return
        self._looked_at = now
        if self._client.status == "running":
            with contextlib.suppress(Exception):  # a connection that breaks just now is noticed below
                facts: Mapping[str, Any] = self._client.scheduler_info(n_workers=-1)["workers"]
                self._heard_at = now
                self._check_new(self._workers.update(facts))
        if self._heard_at and now - self._heard_at > _LOST_SECONDS:
            self.has_lost_scheduler = True
            raise RenderError(
                f"--cluster {self._address}: the scheduler has gone; {len(self.report.seconds)} frames are finished: "
                "start it again, and run the same command with --resume"
            )
        for key, (future, assignment, places) in list(self._sent.items()):
            if places is not None and not any(place in self._workers for place in places):
                del self._sent[key]
                with contextlib.suppress(Exception):
                    future.cancel(force=True)
                self._frames.put_back(assignment)
        self._look_at_waiting()
        self._explain_waiting()

    def _look_at_waiting(self) -> None:
        """Try frames that wait as soon as there is another worker, and give them up if none has come."""
        for assignment in self._waiting.take_ready():
            self._frames.put_back(assignment)
        for assignment in self._waiting.take_hopeless():
            self._give_up_fault(assignment, assignment.fault or {})

    def _check_new(self, addresses: list[str]) -> None:
        if remote := [address for address in addresses if not is_here(address)]:
            versions = self._client.run(read_version, workers=remote, on_error="return")
            for address in self._workers.check_versions(cast("Mapping[str, object]", versions)):
                self._listener.report_note(f"worker {address}: {self._workers.refusals[address]}: it gets no frames")

    def _refuse(self, address: str, reason: str) -> None:
        self._workers.refusals[address] = reason
        self._listener.report_note(f"worker {address}: {reason}: it gets no frames")

    def _explain_waiting(self) -> None:
        """Raise RenderError where no worker can render; say once that none is there yet."""
        if self._workers.usable:
            self._is_waiting = False
        elif self._workers.is_empty:
            if not self._is_waiting:
                self._listener.report_note(
                    f"no worker is connected to {self._address}: start one with 'dask worker {self._address}'; "
                    "frames are sent as soon as one is there"
                )
            self._is_waiting = True
        elif not (self._workers.expects_others(()) and (self._waiting or self._workers.has_changed)):
            reasons = "; ".join(f"{address}: {reason}" for address, reason in self._workers.refusals.items())
            raise RenderError(f"--cluster {self._address}: no worker can render these frames: {reasons}")


def _open_assignments(chunk: FrameChunk) -> AssignmentQueue | StagedAssignments:
    """The frames of a job, with their stages if it has some."""
    if chunk.stage is None:
        return AssignmentQueue(chunk.parts, is_chain=chunk.is_chain, is_whole=bool(chunk.job.videos))
    return StagedAssignments(chunk.job.frames, chunk.stage.frame_before, chunk.stage.folder, checks=chunk.job.resume)
