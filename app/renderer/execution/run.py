"""Plans under way, pass by pass."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Container, Iterable
from types import TracebackType

from ...compiler import Pass, Plan
from ...errors import HalationError
from .decoding import Array, DecodeQueue
from .decoding import DecodeRequest as Awaited
from .executor import Executor
from .texture_pool import Lease

Timings = list[tuple[Pass, float]]
"""Passes and the seconds that each took on the device."""

Rows = Callable[[str, int, Array], None]
"""Takes rows of an output: its name, the first row, and [rows, width, channels], which is used again afterwards."""

Decode = Callable[[Iterable[Awaited]], DecodeQueue]


class Run(ABC):
    """A plan under way: one pass per `next`. Several may be, step by step. One that is dropped must be closed."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self.done = 0
        """Passes executed."""
        self.ended = False
        self.rows: Rows | None = None
        """Takes the outputs that the plan makes by rows; without it they are put together as all others are."""

    @property
    @abstractmethod
    def total(self) -> int:
        """Passes that it executes."""
        ...

    @property
    @abstractmethod
    def ready(self) -> bool:
        """False while the next step would wait for a file to be decoded, or for the trial of a program."""
        ...

    def __iter__(self) -> Run:
        return self

    @abstractmethod
    def __next__(self) -> Pass:
        """Execute the next pass. Raises the errors of `app.errors`, which end the run."""
        ...

    def __enter__(self) -> Run:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @abstractmethod
    def close(self) -> None:
        """Hand back what this run still holds."""
        ...


class WholeRun(Run):
    """Executes a plan that fits; when it ends, `kept` leases the textures of the surfaces `wanted`.

    What others have computed already is not computed again.
    """

    def __init__(
        self,
        executor: Executor,
        plan: Plan,
        kept: Lease,
        decode: Decode,
        wanted: Iterable[int],
        timings: Timings | None,
    ) -> None:
        super().__init__(plan)
        self._executor, self._kept, self._timings = executor, kept, timings
        textures = executor.textures
        self._wanted = tuple(dict.fromkeys(wanted))
        self._needed = find_needed_passes(plan, self._wanted, textures)
        executor.counters.skipped += len(plan.passes) - len(self._needed)
        self._readers = _count_readers(plan, self._needed, self._wanted)
        self._decoding = decode(find_needed_uploads(plan, self._needed, self._wanted, textures))
        self._lease = Lease(textures)
        for index in self._needed:
            executor.begin_trial(plan, plan.passes[index])
        for key in self._readers:
            if key in textures:
                self._lease.take(key)

    @property
    def total(self) -> int:
        """Passes that this run executes, of those of the plan."""
        return len(self._needed)

    @property
    def ready(self) -> bool:
        if self.ended:
            return True
        ends = self.done == self.total
        if not ends and not self._executor.is_tried(self.plan, self.plan.passes[self._needed[self.done]]):
            return False
        numbers = self._wanted if ends else self.plan.passes[self._needed[self.done]].textures
        return all(self._is_here(number) or self._decoding.ready(number) for number in numbers)

    def __next__(self) -> Pass:
        if self.ended:
            raise StopIteration
        try:
            with self._executor.device.make_current():
                if self.done < self.total:
                    return self._step()
                self._finish()
        except BaseException:
            self.close()
            raise
        self.close()
        raise StopIteration

    def close(self) -> None:
        if self.ended:
            return
        self.ended = True
        self._decoding.cancel()
        if not self._executor.closed:
            self._lease.close()
            with self._executor.device.make_current():
                self._executor.textures.next_round()

    # --- parts -------------------------------------------------------------------------------------------------------

    def _step(self) -> Pass:
        one = self.plan.passes[self._needed[self.done]]
        self._upload(one.textures)
        if self._timings is None:
            self._executor.execute(self.plan, one, self._lease)
        else:
            self._timings.append((one, self._executor.measure(self.plan, one, self._lease)))
        for number in one.textures:
            key = self.plan.surfaces[number].key
            self._readers[key] -= 1
            if self._readers[key] == 0:
                self._lease.give(key)
        self.done += 1
        return one

    def _finish(self) -> None:
        self._upload(self._wanted)
        for number in self._wanted:
            self._kept.take(self.plan.surfaces[number].key)

    def _is_here(self, number: int) -> bool:
        return number not in self._decoding or self.plan.surfaces[number].key in self._executor.textures

    def _upload(self, numbers: tuple[int, ...]) -> None:
        for number in numbers:
            if number not in self._decoding:
                continue
            if self._is_here(number):  # another run was quicker
                self._decoding.skip(number)
                self._lease.take(self.plan.surfaces[number].key)
                continue
            upload = self._decoding.upload(number)
            try:
                self._executor.upload(self.plan, upload, self._decoding.take(number), self._lease)
            except HalationError as error:
                error.node = error.node or upload.node
                raise


def find_needed_passes(plan: Plan, wanted: Iterable[int], given: Container[str]) -> list[int]:
    """The passes that must run for the surfaces `wanted`, since these keys are not `given`; in order."""
    makers = {number: index for index, one in enumerate(plan.passes) for number in one.targets}
    passes: set[int] = set()
    todo = list(wanted)
    while todo:
        number = todo.pop()
        index = makers.get(number)
        if index is None or index in passes or plan.surfaces[number].key in given:
            continue
        passes.add(index)
        todo.extend(plan.passes[index].textures)
    return sorted(passes)


def _count_readers(plan: Plan, needed: list[int], wanted: tuple[int, ...]) -> dict[str, int]:
    """How often each surface will be read; outputs are read once more, at the end."""
    found: dict[str, int] = {}
    for number in (*(number for index in needed for number in plan.passes[index].textures), *wanted):
        key = plan.surfaces[number].key
        found[key] = found.get(key, 0) + 1
    return found


def find_needed_uploads(plan: Plan, needed: list[int], wanted: tuple[int, ...], given: Container[str]) -> list[Awaited]:
    """What must be decoded, in the order in which passes want it, since these keys are not `given`."""
    uploads = {upload.surface: (upload, plan.surfaces[upload.surface]) for upload in plan.uploads}
    return [
        uploads[number]
        for number in _collect_reads(plan, needed, wanted)
        if number in uploads and uploads[number][1].key not in given
    ]


def find_shared_surfaces(plan: Plan, following: Plan) -> tuple[int, ...]:
    """The surfaces of a plan that the next one would read, so that it need not make them again, or has as outputs."""
    known = {surface.key: number for number, surface in enumerate(plan.surfaces)}
    wanted = tuple(dict.fromkeys((*following.outputs.values(), *following.remembered)))
    needed = find_needed_passes(following, wanted, known)
    keys = (following.surfaces[number].key for number in _collect_reads(following, needed, wanted))
    return tuple(known[key] for key in keys if key in known)


def _collect_reads(plan: Plan, needed: list[int], wanted: tuple[int, ...]) -> dict[int, None]:
    """The surfaces that passes read, and those that are `wanted`."""
    return dict.fromkeys((*(number for index in needed for number in plan.passes[index].textures), *wanted))
