"""Runs plans. It knows nothing of graphs and nodes: only passes, surfaces and keys."""

from __future__ import annotations

from collections.abc import Iterable
from concurrent.futures import Future, ThreadPoolExecutor

from ..compiler import Plan, Upload
from ..errors import UsageError
from .decoding import AHEAD, Array, Decoding, Loader
from .device import Device
from .executor import Executor
from .run import Run, Timings, needed_passes, needed_uploads
from .textures import Lease, Texture


class Runner:
    """Executes plans on one device, keeping programs, textures and results between them."""

    def __init__(self, device: Device, load: Loader, budget: int) -> None:
        self.device, self._load = device, load
        self._executor = Executor(device, budget)
        self.programs, self.textures = self._executor.programs, self._executor.textures
        self.counters = self._executor.counters
        self._begun: dict[str, Future[Array]] = {}
        self._threads = ThreadPoolExecutor(max_workers=2, thread_name_prefix="decode")

    def run(self, plan: Plan) -> dict[str, Array]:
        """Run to the end; the outputs as [height, width, channels]."""
        kept = self.lease()
        try:
            with self.steps(plan, kept) as steps:
                for _ in steps:
                    pass
            return self.download(plan)
        finally:
            kept.close()

    def steps(
        self, plan: Plan, kept: Lease, wanted: Iterable[int] | None = None, *, timings: Timings | None = None
    ) -> Run:
        """Run one pass per step, so that a caller can stop in between.

        At the end `kept` leases the surfaces `wanted`, by default the outputs. With `timings`, every pass is waited for
        and what it took is added to them.
        """
        if self._executor.closed:
            raise UsageError("this renderer is closed: make another one")
        surfaces = plan.outputs.values() if wanted is None else wanted
        with self.device.current():
            return Run(self._executor, plan, kept, self._decode, surfaces, timings)

    def prepare(self, plan: Plan, wanted: Iterable[int] | None = None) -> None:
        """Begin to decode what a plan will want soon."""
        surfaces = tuple(plan.outputs.values() if wanted is None else wanted)
        passes = needed_passes(plan, surfaces, self.textures)
        for upload, key in needed_uploads(plan, passes, surfaces, self.textures)[:AHEAD]:
            if key not in self._begun:
                self._begun[key] = self._threads.submit(self._load, upload.picture)

    def download(self, plan: Plan) -> dict[str, Array]:
        """The outputs of a plan that has run, while they are leased, as [height, width, channels]."""
        with self.device.current():
            return {name: self._executor.download(plan, number) for name, number in plan.outputs.items()}

    def lease(self) -> Lease:
        """Keeps pixels on the device, none as yet."""
        return Lease(self.textures)

    def texture(self, key: str) -> Texture | None:
        """The texture that holds these pixels, if any does."""
        return self.textures.find(key)

    def close(self) -> None:
        """Give everything back. Runs that are under way end here."""
        if self._executor.closed:
            return
        self._threads.shutdown(cancel_futures=True)
        with self.device.current():
            self._executor.close()

    def _decode(self, uploads: Iterable[tuple[Upload, str]]) -> Decoding:
        return Decoding(self._threads, self._load, uploads, self._begun)
