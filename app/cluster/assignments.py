"""Cuts the frames of a job into chunks by what frames have cost so far."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any

from msgspec import Struct

from .chunk import ChunkStage
from .workers import WorkerRoster

_NEWEST = 0.1
"""How much the newest frame counts in the mean cost: about the last ten frames count, so that one slow frame does not
make chunks short. Chosen by judgement."""

CHUNK_SECONDS = 4.0
"""Seconds that a chunk is meant to take. The last frame of a chunk is written while nothing else is rendered, which
takes some hundredths of a second: about 1 % of this time. Chosen so, and short enough for an even end."""

MAX_CHUNK = 1000
"""Frames of a chunk at most: of frames that cost nothing, since a message must stay small. A choice."""

DISPATCH_SECONDS = 0.005
"""Seconds that sender and scheduler take for a chunk, the slower of both, rounded up: `tests/bench/cluster.py check`
measures it. Half of it lets a thousand workers wait for the scheduler, twice of it makes the end less even."""

MAX_ATTEMPTS = 3
"""How often a frame may end its process: once, and on two other workers."""

SUSPECTS = 3
"""Frames that a process works on at the same time: one is planned, one rendered, one written."""


class Assignment(Struct, frozen=True):
    """Frames that one worker is to render. `tried` are the workers that failed with them, in `attempts` tries.

    `fault` is the last error of these, where another worker is needed.
    """

    frames: tuple[int, ...]
    attempts: int = 0
    tried: frozenset[str] = frozenset()
    stage: ChunkStage | None = None
    fault: Mapping[str, Any] | None = None


def count_chunk(cost: float) -> int:
    """How many frames of a `cost` in seconds are a chunk; one while that is not known."""
    return max(1, min(int(CHUNK_SECONDS / cost) if cost > 0.0 else 1, MAX_CHUNK))


def count_least_chunk(cost: float, slots: int) -> int:
    """How many frames of a `cost` keep a worker busy while every other one is handed a chunk too."""
    return min(math.ceil(slots * DISPATCH_SECONDS / cost), MAX_CHUNK) if cost > 0.0 else 1


def average_cost(cost: float, seconds: Sequence[float]) -> float:
    """The mean cost of frames, where newer ones count more, with those of another chunk."""
    for frame_cost in seconds:
        cost = frame_cost if cost == 0.0 else (1.0 - _NEWEST) * cost + _NEWEST * frame_cost
    return cost


def split_suspects(frames: Sequence[int], before: Assignment, worker: str) -> list[Assignment]:
    """The assignments of frames whose process ended: each that it may have worked on alone, the others together."""
    tried = before.tried | {worker}
    alone = [Assignment((frame,), before.attempts + 1, tried, before.stage) for frame in frames[:SUSPECTS]]
    rest = tuple(frames[SUSPECTS:])
    return [*alone, *([Assignment(rest, before.attempts, before.tried, before.stage)] if rest else ())]


class AssignmentQueue:
    """The frames that nobody renders yet. Those of a chain need the ones before; `is_whole` if all are in one file."""

    def __init__(self, frames: Sequence[int], *, is_chain: bool, is_whole: bool = False) -> None:
        self._fresh = deque(frames)
        self._repeated: deque[Assignment] = deque()
        self._is_chain, self._is_whole = is_chain, is_whole
        self._cost = 0.0
        """Seconds of a frame: the mean of those that were measured, where newer ones count more."""
        self._is_sure = False
        """True if a frame was measured that does not take the start of a process too."""
        self.sends_ahead = False
        """True if a worker gets its next chunk while it renders one: not before a first chunk tells what frames cost.
        """
        self._suspects_left, self._tried = 0, frozenset[str]()
        """How many frames of a chain are still rendered one by one, and who has tried them, since a process ended."""
        self._suspect: int | None = None
        """The frame of a chain that is rendered alone; those after it wait."""
        self._culprit: int | None = None
        """The frame of a chain that was given up, until one after it is finished."""

    def __len__(self) -> int:
        return len(self._fresh) + sum(len(assignment.frames) for assignment in self._repeated)

    def note_cost(self, seconds: Sequence[float], *, is_first: bool = False) -> None:
        """Take in what frames of a chunk have cost; none that were kept.

        In the first chunk of a worker, its first frame takes the start of a process too: it counts only until others
        are known.
        """
        later = seconds[1:] if is_first else seconds
        if later and not self._is_sure:
            self._cost, self._is_sure = 0.0, True
        self._cost = average_cost(self._cost, later if self._is_sure else seconds)
        self.sends_ahead = True

    def take(self, slots: int) -> Assignment | None:
        """The next frames for a worker, of which `slots` render side by side. Towards the end chunks are smaller, but
        no faster than they can be handed out.

        None where frames must be finished first.
        """
        if self._repeated:
            return self._repeated.popleft()
        if self._suspect is not None:
            return None
        if self._suspects_left:
            self._suspects_left -= 1
            self._suspect = self._fresh.popleft()
            return Assignment((self._suspect,), 1, self._tried)
        if self._is_chain:
            count = len(self._fresh)
        else:
            even = min(count_chunk(self._cost), len(self._fresh) // (2 * max(1, slots)))
            count = max(even, count_least_chunk(self._cost, slots))
        return Assignment(tuple(self._fresh.popleft() for _ in range(min(count, len(self._fresh)))))

    def put_back(self, assignment: Assignment) -> None:
        """Have frames rendered by somebody, whoever it was that did not finish them."""
        self._repeated.append(assignment)

    def put_suspects(self, frames: Sequence[int], before: Assignment, worker: str) -> tuple[int, ...]:
        """Try frames again whose process ended: those that it may have worked on alone, the others together.

        Returns the frames that have ended too many processes.
        """
        attempts, tried = before.attempts + 1, before.tried | {worker}
        if self._is_chain and not self._is_whole:
            return self._put_chain_back(frames, before, attempts, tried)
        if self._is_chain:
            if attempts >= MAX_ATTEMPTS:
                return tuple(frames)
            self.put_back(Assignment(tuple(frames), attempts, tried))
            return ()
        if len(before.frames) == 1 and attempts >= MAX_ATTEMPTS:
            return tuple(frames)
        for assignment in split_suspects(frames, before, worker):
            self.put_back(assignment)
        return ()

    def finish(self, frames: Iterable[int]) -> None:
        """Note frames that are finished or given up."""
        for frame in frames:
            self._suspect = None if frame == self._suspect else self._suspect
            self._culprit = None if self._culprit is not None and frame > self._culprit else self._culprit

    def explain_loss(self, frames: Collection[int], reason: str) -> str:
        """Why frames are given up whose processes have ended for a `reason`: they may need another one."""
        if self._culprit is None or self._culprit in frames:
            return reason
        return f"one worker renders all frames, and frame {self._culprit} cannot be rendered"

    def _put_chain_back(
        self, frames: Sequence[int], before: Assignment, attempts: int, tried: frozenset[str]
    ) -> tuple[int, ...]:
        """Try frames of a chain again: first those alone that the process may have worked on, one after the other.

        The frames after one that ends all its processes are tried together: if not even one of them is finished, they
        need that one.
        """
        if not frames:
            return ()
        if len(before.frames) == 1:
            if attempts < MAX_ATTEMPTS:
                self.put_back(Assignment(before.frames, attempts, tried))
                return ()
            self._culprit, self._suspects_left = before.frames[0], 0
            return before.frames
        if self._culprit is not None:
            return tuple(frames)
        self._fresh.extendleft(reversed(frames))
        self._suspects_left, self._tried = min(SUSPECTS, len(frames)), tried
        return ()


class WaitingAssignments:
    """Frames that wait for another one of the `workers` than those that could not render them."""

    def __init__(self, workers: WorkerRoster) -> None:
        self._workers = workers
        self._assignments: list[Assignment] = []

    def __len__(self) -> int:
        return len(self._assignments)

    def add(self, assignment: Assignment) -> None:
        """Have frames wait."""
        self._assignments.append(assignment)

    def take_ready(self) -> list[Assignment]:
        """Those that another worker can try now; they wait no more."""
        return self._take([item for item in self._assignments if self._workers.has_others(item.tried)])

    def take_hopeless(self) -> list[Assignment]:
        """Those for which no other worker is expected any more; they wait no more."""
        return self._take([item for item in self._assignments if not self._workers.expects_others(item.tried)])

    def _take(self, assignments: list[Assignment]) -> list[Assignment]:
        self._assignments = [item for item in self._assignments if item not in assignments]
        return assignments
