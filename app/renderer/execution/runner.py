"""Runs plans. It knows nothing of graphs and nodes: only passes, surfaces and keys."""

from __future__ import annotations

from collections.abc import Container, Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from weakref import WeakValueDictionary

from msgspec import Struct

from ...compiler import Pass, Plan
from ...errors import DeviceError, UsageError
from ..device import Device
from .array_pool import ArrayPool
from .decoding import Array, DecodedPicture, DecodeQueue, Loader, decode, limit_lookahead
from .decoding import DecodeRequest as Awaited
from .executor import Executor
from .run import Run, Timings, WholeRun, find_needed_passes, find_needed_uploads
from .texture_pool import Lease, PooledTexture
from .tiles import TiledRun
from .trials import Trials


class TiledOutputs(Struct, frozen=True, eq=False, weakref=True):
    """Pixels by name that are not on the device."""

    pixels: dict[str, Array]


class Runner:
    """Executes plans on one device, keeping programs, textures and results between them."""

    def __init__(self, device: Device, load: Loader, budget: int, trials: Trials | None = None) -> None:
        self.device, self._load = device, load
        self._executor = Executor(device, budget, trials)
        self.programs, self.textures = self._executor.programs, self._executor.textures
        self.counters = self._executor.counters
        self._begun: dict[str, Future[DecodedPicture]] = {}
        self._whole: WeakValueDictionary[tuple[str, ...], TiledOutputs] = WeakValueDictionary()
        """What was made tile by tile, by the keys of the outputs, as long as somebody leases it."""
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
        and what it took is added to them. A plan that does not fit is run tile by tile: `kept` holds its outputs
        in memory, and it is not timed. Raises DeviceError for that.
        """
        if self._executor.closed:
            raise UsageError("this renderer is closed: make another one")
        if plan.tiling is not None:
            if timings is not None:
                raise DeviceError(f"{plan.tiling.why}; render smaller with --scale or --size")
            return TiledRun(self, self._load, plan, partial(self._keep, plan, kept))
        surfaces = plan.outputs.values() if wanted is None else wanted
        with self.device.make_current():
            return WholeRun(self._executor, plan, kept, self._decode, surfaces, timings)

    def measure(self, plan: Plan) -> Timings:
        """Run to the end, waiting for every pass, and say what each took. The pixels are not kept."""
        kept, taken = self.lease(), Timings()
        try:
            with self.steps(plan, kept, timings=taken) as run:
                for _ in run:
                    pass
        finally:
            kept.close()
        return taken

    def compile(self, render_pass: Pass) -> None:
        """Have the program of a pass at hand. Raises ShaderError."""
        self._executor.compile(render_pass)

    def prepare(self, plan: Plan, given: Container[str] = ()) -> None:
        """Begin to decode what a plan will want soon; `given` are the keys of what will be there by then."""
        if plan.tiling is not None:
            return
        there = {one.key for one in plan.surfaces if one.key in self.textures or one.key in given}
        surfaces = tuple(plan.outputs.values())
        passes = find_needed_passes(plan, surfaces, there)
        for upload, surface in limit_lookahead(find_needed_uploads(plan, passes, surfaces, there)):
            if surface.key not in self._begun:
                self._begun[surface.key] = self._threads.submit(decode, self._load, upload.picture)

    def download(self, plan: Plan, arrays: ArrayPool | None = None) -> dict[str, Array]:
        """The outputs of a plan that has run, while they are leased, as [height, width, channels].

        They are float16 where the plan keeps halves. `arrays` lend what they are written to, to be given back.
        """
        if plan.tiling is not None:
            return dict(self._whole[_list_output_keys(plan)].pixels)
        arrays = arrays or ArrayPool()
        with self.device.make_current():
            return {name: self._executor.download(plan, number, arrays) for name, number in plan.outputs.items()}

    def lease(self) -> Lease:
        """Keeps pixels on the device, none as yet."""
        return Lease(self.textures)

    def release_idle(self) -> None:
        """Give back to the driver what nobody leases."""
        with self.device.make_current():
            self.textures.release_idle()

    def texture(self, key: str) -> PooledTexture | None:
        """The texture that holds these pixels, if any does."""
        return self.textures.find(key)

    def close(self) -> None:
        """Give everything back. Runs that are under way end here."""
        if self._executor.closed:
            return
        self._threads.shutdown(cancel_futures=True)
        with self.device.make_current():
            self._executor.close()

    def _keep(self, plan: Plan, kept: Lease, pixels: dict[str, Array]) -> None:
        """Have a lease hold what was made tile by tile."""
        outputs = self._whole[_list_output_keys(plan)] = TiledOutputs(pixels)
        kept.hold(outputs)

    def _decode(self, wanted: Iterable[Awaited]) -> DecodeQueue:
        return DecodeQueue(self._threads, self._load, wanted, self._begun)


def _list_output_keys(plan: Plan) -> tuple[str, ...]:
    """The keys of the outputs."""
    return tuple(plan.surfaces[number].key for number in plan.outputs.values())
