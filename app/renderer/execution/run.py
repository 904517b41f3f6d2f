"""Runs of plans, one pass at a time."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Container, Generator, Iterable
from itertools import islice
from types import TracebackType

from ...compiler import Pass, Plan
from ...errors import HalationError
from .decoding import Array, DecodeQueue, DecodeRequest
from .executor import Executor
from .texture_pool import TextureLease

PassTimings = list[tuple[Pass, float]]
"""Passes and the seconds that each took on the device."""

RowsReceiver = Callable[[str, int, Array], None]
"""Receives rows of an output: its name, the first row, and [rows, width, channels], an array that is reused after."""

QueueStarter = Callable[[Iterable[DecodeRequest]], DecodeQueue]


class Run(ABC):
    """A plan that is being executed, one pass per `next`. Several runs may take turns. A dropped run must be closed."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self.passes_done = 0
        """Passes executed."""
        self.has_ended = False
        self.receive_rows: RowsReceiver | None = None
        """Receives the outputs that the plan makes by rows; without it they become whole arrays like all others."""

    @property
    @abstractmethod
    def total(self) -> int:
        """Passes that it executes."""
        ...

    @property
    @abstractmethod
    def is_ready(self) -> bool:
        """False while the next step would wait for a file, a trial of a program, or the processor."""
        ...

    def __iter__(self) -> Run:
        return self

    @abstractmethod
    def __next__(self) -> Pass:
        """Execute the next pass. Raises the errors of `app.errors`, which end the run."""
        ...

    def step(self, seconds: float) -> bool:
        """Execute the next pass, or about so many seconds of it where it can be divided; False at the end.

        Raises what `__next__` raises.
        """
        return next(self, None) is not None

    def __enter__(self) -> Run:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @abstractmethod
    def close(self) -> None:
        """Release what this run still holds."""
        ...


class WholeRun(Run):
    """Executes a plan that fits on the device; at the end `outputs_lease` holds the `requested` surfaces.

    Surfaces that are on the device under their keys are not computed again.
    """

    def __init__(
        self,
        executor: Executor,
        plan: Plan,
        outputs_lease: TextureLease,
        start_decoding: QueueStarter,
        requested: Iterable[int],
        timings: PassTimings | None,
    ) -> None:
        super().__init__(plan)
        self._executor, self._outputs_lease, self._timings = executor, outputs_lease, timings
        textures = executor.textures
        self._requested = tuple(dict.fromkeys(requested))
        self._needed_passes = find_needed_passes(plan, self._requested, textures)
        executor.counters.skipped += len(plan.passes) - len(self._needed_passes)
        self._readers = _count_readers(plan, self._needed_passes, self._requested)
        self._decode_queue = start_decoding(find_needed_uploads(plan, self._needed_passes, self._requested, textures))
        self._lease = TextureLease(textures)
        self._bands: Generator[None, None, None] | None = None
        """The bands of the current pass that are still to be computed."""
        executor.begin_programs(plan, (plan.passes[index] for index in self._needed_passes))
        for key in self._readers:
            if key in textures:
                self._lease.add(key)

    @property
    def total(self) -> int:
        """Passes that this run executes, of those of the plan."""
        return len(self._needed_passes)

    @property
    def is_ready(self) -> bool:
        if self.has_ended:
            return True
        ends = self.passes_done == self.total
        if not ends:
            render_pass = self.plan.passes[self._needed_passes[self.passes_done]]
            if not self._executor.has_program(self.plan, render_pass):
                return False
        numbers = self._requested if ends else self.plan.passes[self._needed_passes[self.passes_done]].textures
        if not all(self._is_uploaded(number) or self._decode_queue.is_ready(number) for number in numbers):
            return False
        return ends or self._is_done_on_host()

    def __next__(self) -> Pass:
        passes_done = self.passes_done
        while self.step(math.inf):
            if self.passes_done > passes_done:
                return self.plan.passes[self._needed_passes[passes_done]]
        raise StopIteration

    def step(self, seconds: float) -> bool:
        if self.has_ended:
            return False
        try:
            with self._executor.device.make_current():
                if self.passes_done < self.total:
                    self._execute_next(seconds)
                    return True
                self._finish()
        except BaseException:
            self.close()
            raise
        self.close()
        return False

    def close(self) -> None:
        if self.has_ended:
            return
        self.has_ended = True
        if self._bands is not None and not self._executor.closed:
            with self._executor.device.make_current():
                self._bands.close()
        self._decode_queue.cancel()
        if self.passes_done < self.total:
            self._executor.abandon_host_job(self.plan, self.plan.passes[self._needed_passes[self.passes_done]])
        if not self._executor.closed:
            self._lease.close()
            with self._executor.device.make_current():
                self._executor.textures.next_round()

    # --- parts -------------------------------------------------------------------------------------------------------

    def _execute_next(self, seconds: float) -> None:
        """Execute the next pass, or a band of it; one that is timed is not divided."""
        render_pass = self.plan.passes[self._needed_passes[self.passes_done]]
        if self._bands is None:
            self._compile_meanwhile(render_pass.textures)
            self._upload(render_pass.textures)
        if self._timings is None:
            if self._bands is None:
                self._bands = self._executor.execute_in_bands(self.plan, render_pass, self._lease, seconds)
            if any(True for _ in islice(self._bands, 1)):
                return
            self._bands = None
        else:
            self._timings.append((render_pass, self._executor.measure(self.plan, render_pass, self._lease)))
        for number in render_pass.textures:
            key = self.plan.surfaces[number].key
            self._readers[key] -= 1
            if self._readers[key] == 0:
                self._lease.release(key)
        self.passes_done += 1

    def _compile_meanwhile(self, numbers: Iterable[int]) -> None:
        """Compile programs, or load them from the driver's cache, for as long as these pictures are being decoded."""
        awaited = [number for number in numbers if not self._is_uploaded(number)]
        for index in self._needed_passes[self.passes_done :]:
            render_pass = self.plan.passes[index]
            if all(map(self._decode_queue.is_ready, awaited)):
                return
            if render_pass.host is None and self._executor.has_program(self.plan, render_pass):
                self._executor.compile(render_pass)

    def _is_done_on_host(self) -> bool:
        """False while the next pass works on the processor. Begins that work."""
        render_pass = self.plan.passes[self._needed_passes[self.passes_done]]
        if render_pass.host is None:
            return True
        with self._executor.device.make_current():
            self._upload(render_pass.textures)
            job = self._executor.begin_host_job(self.plan, render_pass)
        return job is None or job.is_done

    def _finish(self) -> None:
        self._upload(self._requested)
        for number in self._requested:
            self._outputs_lease.add(self.plan.surfaces[number].key)

    def _is_uploaded(self, number: int) -> bool:
        return number not in self._decode_queue or self.plan.surfaces[number].key in self._executor.textures

    def _upload(self, numbers: tuple[int, ...]) -> None:
        for number in numbers:
            if number not in self._decode_queue:
                continue
            if self._is_uploaded(number):  # another run was quicker
                self._decode_queue.skip(number)
                self._lease.add(self.plan.surfaces[number].key)
                continue
            upload = self._decode_queue.find_upload(number)
            try:
                self._executor.upload(self.plan, upload, self._decode_queue.take(number), self._lease)
            except HalationError as error:
                error.node = error.node or upload.node
                raise


def find_needed_passes(plan: Plan, requested: Iterable[int], available: Container[str]) -> list[int]:
    """The passes that must run, in order, for the `requested` surfaces, if the keys in `available` need not be made."""
    makers = {number: index for index, render_pass in enumerate(plan.passes) for number in render_pass.targets}
    passes: set[int] = set()
    todo = list(requested)
    while todo:
        number = todo.pop()
        index = makers.get(number)
        if index is None or index in passes or plan.surfaces[number].key in available:
            continue
        passes.add(index)
        todo.extend(plan.passes[index].textures)
    return sorted(passes)


def _count_readers(plan: Plan, needed: list[int], requested: tuple[int, ...]) -> dict[str, int]:
    """How often each surface will be read; outputs are read once more, at the end."""
    counts: dict[str, int] = {}
    for number in (*(number for index in needed for number in plan.passes[index].textures), *requested):
        key = plan.surfaces[number].key
        counts[key] = counts.get(key, 0) + 1
    return counts


def find_needed_uploads(
    plan: Plan, needed: list[int], requested: tuple[int, ...], available: Container[str]
) -> list[DecodeRequest]:
    """The pictures that must be decoded, in the order in which passes read them, except keys in `available`."""
    uploads = {upload.surface: (upload, plan.surfaces[upload.surface]) for upload in plan.uploads}
    return [
        uploads[number]
        for number in _collect_reads(plan, needed, requested)
        if number in uploads and uploads[number][1].key not in available
    ]


def find_shared_surfaces(plan: Plan, following: Plan) -> tuple[int, ...]:
    """The surfaces of a plan that the next plan reads or has as outputs, so that it need not compute them again."""
    numbers_by_key = {surface.key: number for number, surface in enumerate(plan.surfaces)}
    requested = tuple(dict.fromkeys((*following.outputs.values(), *following.remembered)))
    needed = find_needed_passes(following, requested, numbers_by_key)
    keys = (following.surfaces[number].key for number in _collect_reads(following, needed, requested))
    return tuple(numbers_by_key[key] for key in keys if key in numbers_by_key)


def _collect_reads(plan: Plan, needed: list[int], requested: tuple[int, ...]) -> dict[int, None]:
    """The surfaces that passes read, then the `requested` ones, each once."""
    return dict.fromkeys((*(number for index in needed for number in plan.passes[index].textures), *requested))
