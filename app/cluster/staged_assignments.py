"""Cuts a job into stages whose results workers share, where a node remembers earlier frames.

`renderer.jobs.shared_results` says what the stages are. Here is decided what is next: a piece of the history, which
only one worker renders at a time; else frames whose history is there; else what lies ahead of the history. Each piece
of the history is short, so that another worker can go on where one was killed, and so that frames can follow soon.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Collection, Iterable, Sequence

from msgspec.structs import replace

from ..renderer.jobs.shared_results import StoredMemory
from .assignments import MAX_ATTEMPTS, Assignment, average_cost, count_chunk, split_suspects
from .chunk import ChunkStage, StageReport

MAX_SHARED_BYTES = 8 << 30
"""Bytes of results that a job may have in its folder at a time: 258 pictures of 1920x1080 in floats. A choice."""

_SURVEY_FRAMES = 2
"""The first frame has no history, so only the second one tells what a history costs."""


class StagedAssignments:
    """The frames of a job that nobody renders yet, with the stages before them. `first` is where the history begins."""

    sends_ahead = False
    """A worker gets no second chunk while it renders one: the history must not wait behind frames that others could
    render."""

    def __init__(self, frames: Sequence[int], first: int, folder: str, *, checks: bool) -> None:
        self._first, self._folder = first, folder
        self._targets = sorted(set(frames))
        self._unfinished = set(frames)
        self._history = range(first, max(frames))
        self._next = first
        """The frame that the history has come to."""
        self._is_history_busy, self._is_checked = False, not checks
        self._careful_until = first - 1
        """Up to here the history is rendered frame by frame, to find the one that ends its process."""
        self._culprit: int | None = None
        """The frame of the history that ends its process each time."""
        self._has_ahead, self._ahead_done = False, set[int]()
        self._ahead_first = self._ahead_next = first
        self._memories: dict[int, tuple[StoredMemory, ...]] = {}
        self._names: dict[int, set[str]] = {}
        self._repeated: list[Assignment] = []
        self._costs = dict[str, float]()
        self._frame_bytes = {"ahead": 0, "history": 0}
        self._drops: list[str] = []
        self.stage_frames = {"ahead": 0, "history": 0}
        """How many frames each stage has rendered."""

    def __len__(self) -> int:
        return len(self._unfinished)

    def note_cost(self, seconds: Sequence[float], *, is_first: bool = False) -> None:
        """Take in what frames of a chunk have cost, the first one of its worker or a later one."""
        self._note_cost("frames", seconds[1:] if is_first and len(seconds) > 1 else seconds)

    def take(self, slots: int) -> Assignment | None:
        """The next work for one of `slots` workers; None where other work must be finished first."""
        if self._repeated:
            return self._fill_in(self._repeated.pop(0))
        if not self._is_checked:
            if self._is_history_busy:
                return None
            self._is_history_busy = True
            return self._fill_in(Assignment(tuple(self._targets), stage=ChunkStage("check", self._folder)))
        return self._take_history() or self._take_targets(slots) or self._take_ahead(slots)

    def put_back(self, assignment: Assignment) -> None:
        """Have work done by somebody, whoever it was that did not finish it."""
        self._repeated.append(assignment)

    def put_suspects(self, frames: Sequence[int], before: Assignment, worker: str) -> tuple[int, ...]:
        """Try work again whose process ended, and return the frames that have ended too many processes."""
        attempts, tried, stage = before.attempts + 1, before.tried | {worker}, before.stage
        kind = stage.kind if stage else "frames"
        if kind == "history" and len(before.frames) > 1:
            self._careful_until, self._is_history_busy = before.frames[-1], False
            return ()
        if kind != "frames":
            if attempts < MAX_ATTEMPTS:
                self.put_back(replace(before, attempts=attempts, tried=tried))
                return ()
            self._culprit = min(before.frames)
            return self.give_up_stage(before, self._culprit)
        if len(frames) == 1 and attempts >= MAX_ATTEMPTS:
            return tuple(frames)
        for assignment in split_suspects(frames, before, worker):
            self.put_back(assignment)
        return ()

    def finish(self, frames: Iterable[int]) -> None:
        """Note frames that are finished or given up, and which files nobody needs any more."""
        for frame in frames:
            self._unfinished.discard(frame)
            for number in (frame - 1, frame):
                self._drop(number)

    def explain_loss(self, frames: Collection[int], reason: str) -> str:
        """Why frames are given up whose processes have ended for a `reason`: they may need another one."""
        if self._culprit is None or min(frames, default=self._culprit) <= self._culprit:
            return reason
        return f"it needs what frame {self._culprit} stores: {reason}"

    def finish_stage(self, report: StageReport, assignment: Assignment) -> set[int]:
        """Take in what came of a stage; the frames that a check has found to be up to date."""
        assert assignment.stage is not None
        kind, is_survey = assignment.stage.kind, assignment.stage.is_survey
        if kind == "check":
            self._is_history_busy, self._is_checked = False, True
            self._leave_out(set(report.seconds))
            return set(report.seconds)
        self._note_cost(kind, list(report.seconds.values()))
        self.stage_frames[kind] += len(report.seconds)
        self._frame_bytes[kind] = max(self._frame_bytes[kind], report.frame_bytes)
        for frame, names in report.names.items():
            self._names.setdefault(frame, set()).update(names)
        if kind == "ahead":
            self._ahead_done |= set(report.seconds)
        else:
            self._memories |= report.memories
            self._next = max((self._next, *(frame + 1 for frame in report.memories)))
            self._is_history_busy = False
            self._has_ahead = self._has_ahead or report.ahead_pays
            if is_survey:
                self._ahead_first = self._ahead_next = self._next
            for frame in report.memories:
                self._drop(frame - 1)
                self._drop(frame)
        return set()

    def take_rest(self, assignment: Assignment, frame: int) -> Assignment:
        """The rest of a stage, from a frame on that could not be rendered: it is put back or given up later.

        Until then nobody renders the history.
        """
        rest = tuple(other for other in assignment.frames if other >= frame)
        self._is_history_busy = self._is_history_busy or assignment.stage is None or assignment.stage.kind != "ahead"
        return replace(assignment, frames=rest)

    def give_up_stage(self, assignment: Assignment, frame: int) -> tuple[int, ...]:
        """The frames that cannot be rendered because a stage cannot.

        What lies ahead of the history is computed with the history then, which says what is wrong.
        """
        assert assignment.stage is not None
        if assignment.stage.kind == "ahead":
            self._ahead_done |= set(assignment.frames)
            return ()
        self._is_history_busy = False
        if assignment.stage.kind == "check":
            self._is_checked = True
            return ()
        self._history = range(self._first, frame)
        lost = tuple(target for target in self._targets if target > frame)
        self._targets = [target for target in self._targets if target <= frame]
        return lost

    # --- what is next ------------------------------------------------------------------------------------------------

    @property
    def _window(self) -> int:
        """How many frames may have results in the folder, which take a limited part of the disk."""
        frame_bytes = sum(self._frame_bytes.values())
        return max(4, MAX_SHARED_BYTES // frame_bytes) if frame_bytes else _SURVEY_FRAMES

    def _take_history(self) -> Assignment | None:
        """The next piece of the history."""
        if self._is_history_busy or self._next not in self._history:
            return None
        is_survey = self._next == self._first
        count = _SURVEY_FRAMES if is_survey else count_chunk(self._costs.get("history", 0.0))
        count = 1 if self._next <= self._careful_until else count
        frames, horizon = list[int](), min(self._unfinished, default=self._next) + self._window
        for frame in self._history[self._next - self._first :][:count]:
            if frame >= horizon or (self._has_ahead and frame >= self._ahead_first and frame not in self._ahead_done):
                break
            frames.append(frame)
        if not frames:
            return None
        self._is_history_busy = True
        stage = ChunkStage("history", self._folder, is_survey=is_survey)
        return self._fill_in(Assignment(tuple(frames), stage=stage))

    def _take_targets(self, slots: int) -> Assignment | None:
        """Frames whose history is stored, in a row so that each reads what the frame before has stored."""
        if self._next == self._first and self._history:  # the survey comes first
            return None
        ready = bisect_right(self._targets, self._next)
        if not ready:
            return None
        share = max(1, len(self._targets) // (2 * max(1, slots)))
        count = min(ready, share, count_chunk(self._costs.get("frames", 0.0)))
        frames, self._targets = self._targets[:count], self._targets[count:]
        return self._fill_in(Assignment(tuple(frames), stage=ChunkStage("frames", self._folder)))

    def _take_ahead(self, slots: int) -> Assignment | None:
        """Frames for which what lies ahead of the history is computed."""
        start = self._ahead_next
        stop = min(self._history.stop, self._next + self._window)
        if not self._has_ahead or start >= stop:
            return None
        share = max(1, (self._history.stop - start) // (2 * max(1, slots)))
        count = min(share, stop - start, count_chunk(self._costs.get("ahead", 0.0)))
        self._ahead_next = start + count
        return self._fill_in(Assignment(tuple(range(start, start + count)), stage=ChunkStage("ahead", self._folder)))

    def _fill_in(self, assignment: Assignment) -> Assignment:
        """The assignment with what workers have to know now."""
        assert assignment.stage is not None
        kind, first = assignment.stage.kind, assignment.frames[0]
        # Of what lies ahead, only the shape of memories counts: that of any frame.
        before = self._first if kind == "ahead" else first - 1
        drops, self._drops = tuple(self._drops), []
        stage = replace(
            assignment.stage,
            frames=() if kind == "frames" else assignment.frames,
            frame_before=before,
            memories=self._memories.get(before, ()),
            drops=(*assignment.stage.drops, *drops),
        )
        return replace(assignment, stage=stage)

    def _leave_out(self, kept: set[int]) -> None:
        """Render no frames that are up to date, and no history that only they need."""
        self._targets = [frame for frame in self._targets if frame not in kept]
        self._history = range(self._first, max(self._targets, default=self._first))

    def _note_cost(self, kind: str, seconds: Sequence[float]) -> None:
        self._costs[kind] = average_cost(self._costs.get(kind, 0.0), seconds)

    def _drop(self, frame: int) -> None:
        """Have the files of a frame removed if the frames that read them are finished, and the history is past them."""
        if frame + 1 < self._next and frame not in self._unfinished and frame + 1 not in self._unfinished:
            self._drops += self._names.pop(frame, ())
            if frame != self._first:
                self._memories.pop(frame, None)
