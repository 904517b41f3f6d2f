"""Which workers of a cluster may render the frames of a job."""

from __future__ import annotations

import math
import time
from collections import Counter
from collections.abc import Collection, Iterable, Mapping
from typing import Any

from ..version import VERSION
from .render_process import find_machine

FAILURES = 3
"""Chunks in a row that a worker may fail with before it gets no more: its disk may be full. A choice."""


PATIENCE_SECONDS = 30.0
"""Seconds since a worker has come or gone, in which another one may still come: a choice. Supervisors such as systemd
start one again within a second, a container within ten or twenty."""


class WorkerRoster:
    """The workers that are connected, and those that cannot render, with the reason.

    Where workers have a resource "GPU" and the job `wants_gpu`, only these render: frames of one job come from one kind
    of device.
    """

    def __init__(self, *, wants_gpu: bool) -> None:
        self._wants_gpu = wants_gpu
        self._facts: dict[str, Mapping[str, Any]] = {}
        self._checked: set[str] = set()
        """The workers whose version is known."""
        self._failures: dict[str, list[frozenset[int]]] = {}
        """The frames of each chunk with which a worker has failed, since it has last finished one."""
        self._bad_frames: set[int] = set()
        """Frames that were given up after several workers had failed with them: these say nothing about a worker."""
        self._changed_at = -math.inf
        """When a worker has come or gone last."""
        self.has_changed = False
        """True if workers have come or gone since the first ones were there."""
        self.refusals: dict[str, str] = {}

    def update(self, facts_by_address: Mapping[str, Mapping[str, Any]]) -> list[str]:
        """Take in what the scheduler says of its workers; those whose version is to be checked."""
        if facts_by_address.keys() != self._facts.keys():
            self.has_changed = self._changed_at > -math.inf
            self._changed_at = time.monotonic()
        self._facts = dict(facts_by_address)
        return [address for address in facts_by_address if address not in self._checked]

    def __contains__(self, address: str) -> bool:
        return address in self._facts

    @property
    def is_empty(self) -> bool:
        """True if no worker is connected at all."""
        return not self._facts

    @property
    def needs_gpu(self) -> bool:
        """True if only workers with a GPU render."""
        return self._wants_gpu and any(self._count_gpus(address) for address in self._facts)

    @property
    def usable(self) -> list[str]:
        """The workers that may get frames."""
        return [
            address
            for address in self._facts
            if address not in self.refusals and (not self.needs_gpu or self._count_gpus(address))
        ]

    @property
    def slots(self) -> int:
        """How many chunks can be rendered at the same time."""
        return sum(map(self._count_slots, self.usable))

    def count_slots_by_machine(self) -> dict[str, int]:
        """How many chunks each machine can render at the same time."""
        counts = Counter[str]()
        for address in self.usable:
            counts[find_machine(address)] += self._count_slots(address)
        return dict(counts)

    def choose(self, tried: Collection[str]) -> list[str] | None:
        """The workers that a chunk is sent to, other ones than it was tried on, if there are any; None for all."""
        usable = self.usable
        if not self.refusals and not tried:
            return None
        return [address for address in usable if address not in tried] or usable

    def has_others(self, tried: Collection[str]) -> bool:
        """True if there is a worker that has not tried a chunk yet."""
        return any(address not in tried for address in self.usable)

    def expects_others(self, tried: Collection[str]) -> bool:
        """True if another worker may come soon, and may render what these workers could not.

        At the start of a job workers come one by one, and one that has ended is started again. Of a full disk or a
        folder that is missing, one worker says nothing about others. If two agree, it is the frame.
        """
        if not self._facts:  # without any worker a job waits
            return True
        if all(map(is_here, self._facts)) or time.monotonic() - self._changed_at > PATIENCE_SECONDS:
            return False
        return len(tried) < 2 or self.has_changed

    def check_versions(self, versions: Mapping[str, object]) -> Iterable[str]:
        """Refuse workers with another version of Halation, or without it; their addresses.

        One that could not be asked is asked again.
        """
        self._checked |= {address for address, version in versions.items() if isinstance(version, str | ImportError)}
        for address, version in versions.items():
            if isinstance(version, ImportError):
                self.refusals[address] = f"it has no Halation that takes frames: pip install 'halation=={VERSION}'"
            elif isinstance(version, str) and version != VERSION:
                self.refusals[address] = f"it has Halation {version}, and the job was sent by {VERSION}"
            else:
                continue
            yield address

    def note_success(self, address: str) -> None:
        """Note that a worker has finished frames."""
        self._failures.pop(address, None)

    def note_failure(self, address: str, frames: Iterable[int], sentence: str) -> bool:
        """Note frames of a chunk of which a worker has finished none; True if it gets no more because of that.

        The only worker goes on: the frames may be at fault, and others can still be rendered.
        """
        frames = frozenset(frames) - self._bad_frames
        if frames:
            self._failures.setdefault(address, []).append(frames)
        if len(self._failures.get(address, ())) < FAILURES or address in self.refusals:
            return False
        if not self.has_others((address,)):
            return False
        self.refusals[address] = f"it has failed {FAILURES} times in a row: {sentence}"
        return True

    def pardon(self, frames: Iterable[int]) -> list[str]:
        """Take frames for bad ones, which several workers have failed with; the workers that may render again."""
        self._bad_frames.update(frames)
        pardoned: list[str] = []
        for address, failures in self._failures.items():
            was_refused = len(failures) >= FAILURES and address in self.refusals
            failures[:] = [rest for chunk in failures if (rest := chunk - self._bad_frames)]
            if was_refused and len(failures) < FAILURES:
                del self.refusals[address]
                pardoned.append(address)
        return pardoned

    def _count_gpus(self, address: str) -> int:
        return int(self._facts[address].get("resources", {}).get("GPU", 0))

    def _count_slots(self, address: str) -> int:
        threads = int(self._facts[address].get("nthreads", 1))
        return min(threads, self._count_gpus(address)) if self.needs_gpu else threads


def is_here(address: str) -> bool:
    """True for a worker inside of the sending process, which starts no other one."""
    return address.startswith("inproc")
