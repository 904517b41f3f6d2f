"""Runs plans. It knows nothing of graphs and nodes: only passes, surfaces and keys."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from weakref import WeakValueDictionary

import numpy as np
from msgspec import Struct

from ...compiler import Pass, Plan
from ...errors import DeviceError, UsageError
from ...resources.large_arrays import ArrayMaker
from ..device import Device
from .decoding import Array, DecodedPicture, DecodeQueue, DecodeRequest, PictureLoader, decode_picture, limit_lookahead
from .executor import Executor
from .run import PassTimings, Run, WholeRun, find_needed_passes, find_needed_uploads
from .texture_pool import TextureLease
from .tiles import TiledRun
from .trials import Trials


class TiledOutputs(Struct, frozen=True, eq=False, weakref=True):
    """Pixels by name that are not on the device."""

    pixels: dict[str, Array]


class PassTrace(Struct, frozen=True, eq=False):
    """A pass that has run: its seconds on the device, and the pixels of its surfaces by their numbers."""

    render_pass: Pass
    seconds: float
    pixels: dict[int, Array]


class Runner:
    """Executes plans on one device, keeping programs, textures and results between them."""

    def __init__(self, device: Device, load: PictureLoader, budget: int, trials: Trials | None = None) -> None:
        self.device, self._load = device, load
        self._executor = Executor(device, budget, trials)
        self.programs, self.textures = self._executor.programs, self._executor.textures
        self.counters = self._executor.counters
        self._leftovers: dict[str, Future[DecodedPicture]] = {}
        self._tiled_outputs: WeakValueDictionary[tuple[str, ...], TiledOutputs] = WeakValueDictionary()
        """Outputs of tiled plans by their keys, as long as somebody leases them."""
        self._threads = ThreadPoolExecutor(max_workers=2, thread_name_prefix="decode")

    def run(self, plan: Plan) -> dict[str, Array]:
        """Run to the end; the outputs as [height, width, channels]."""
        lease = self.create_lease()
        try:
            with self.start_run(plan, lease) as run:
                for _ in run:
                    pass
            return self.download(plan)
        finally:
            lease.close()

    def start_run(
        self,
        plan: Plan,
        outputs_lease: TextureLease,
        requested: Iterable[int] | None = None,
        *,
        timings: PassTimings | None = None,
    ) -> Run:
        """Run one pass per step, so that a caller can stop in between.

        At the end `outputs_lease` holds the `requested` surfaces, by default the outputs. With `timings`, every pass is
        waited for, and its seconds are added to them. A plan that does not fit is run tile by tile: `outputs_lease`
        holds its outputs in memory. Raises DeviceError if such a plan is to be timed.
        """
        if self._executor.closed:
            raise UsageError("this renderer is closed: create another one")
        if plan.tiling is not None:
            if timings is not None:
                raise DeviceError(f"{plan.tiling.why}; render smaller with --scale or --size")
            return TiledRun(self, self._load, plan, partial(self._keep_outputs, plan, outputs_lease))
        surfaces = plan.outputs.values() if requested is None else requested
        with self.device.make_current():
            return WholeRun(self._executor, plan, outputs_lease, self._create_queue, surfaces, timings)

    def measure(self, plan: Plan) -> PassTimings:
        """Run to the end, waiting for every pass; the seconds of each. The pixels are not kept."""
        lease, timings = self.create_lease(), PassTimings()
        try:
            with self.start_run(plan, lease, timings=timings) as run:
                for _ in run:
                    pass
        finally:
            lease.close()
        return timings

    def trace(self, plan: Plan) -> Iterator[PassTrace]:
        """Run a plan, and give what each pass has made as soon as it is done.

        Raises DeviceError for a plan that needs tiles.
        """
        lease, timings = self.create_lease(), PassTimings()
        try:
            with self.start_run(plan, lease, timings=timings) as run:
                for render_pass in run:
                    with self.device.make_current():
                        pixels = {number: self._executor.download(plan, number) for number in render_pass.targets}
                    yield PassTrace(render_pass, timings[-1][1], pixels)
        finally:
            lease.close()

    def compile(self, render_pass: Pass) -> None:
        """Have the program of a pass at hand. Raises ShaderError."""
        self._executor.compile(render_pass)

    def start_decoding(self, plan: Plan, coming: Container[str] = ()) -> None:
        """Begin to decode pictures for the next plan; `coming` are keys that will be on the device by then."""
        if plan.tiling is not None:
            return
        available = {surface.key for surface in plan.surfaces if surface.key in self.textures or surface.key in coming}
        surfaces = tuple(plan.outputs.values())
        passes = find_needed_passes(plan, surfaces, available)
        for upload, surface in limit_lookahead(find_needed_uploads(plan, passes, surfaces, available)):
            if surface.key not in self._leftovers:
                self._leftovers[surface.key] = self._threads.submit(decode_picture, self._load, upload.picture)

    def download(self, plan: Plan, create: ArrayMaker = np.empty) -> dict[str, Array]:
        """The outputs of a plan that has run, while they are leased, as [height, width, channels].

        They are float16 where the plan keeps halves. `create` makes the arrays.
        """
        if plan.tiling is not None:
            return dict(self._tiled_outputs[_list_output_keys(plan)].pixels)
        with self.device.make_current():
            return {name: self._executor.download(plan, number, create) for name, number in plan.outputs.items()}

    def download_surface(self, plan: Plan, number: int) -> Array:
        """The pixels of a surface that has a lease."""
        with self.device.make_current():
            return self._executor.download(plan, number)

    def upload(self, plan: Plan, number: int, pixels: Array, lease: TextureLease) -> None:
        """Put pixels that were computed elsewhere on the device, under the key of a surface. Raises DeviceError."""
        with self.device.make_current():
            self._executor.write_pixels(plan.surfaces[number], pixels, lease)

    def create_lease(self) -> TextureLease:
        """A new lease that holds no pixels yet."""
        return TextureLease(self.textures)

    def release_idle(self) -> None:
        """Release all textures without a lease."""
        with self.device.make_current():
            self.textures.release_idle()

    def release_unused(self) -> None:
        """Release textures that hold nothing, unless results are kept for later work, which would use them too."""
        if not self.textures.budget:
            with self.device.make_current():
                self.textures.release_idle()
                if self.counters.passes:  # the first program of a process takes 9 MiB
                    self.device.forget_bindings()

    def close(self) -> None:
        """Give everything back. Runs that are under way end here."""
        if self._executor.closed:
            return
        self._threads.shutdown(cancel_futures=True)
        with self.device.make_current():
            self._executor.close()

    def _keep_outputs(self, plan: Plan, outputs_lease: TextureLease, pixels: dict[str, Array]) -> None:
        """Let a lease hold the outputs of a tiled plan."""
        outputs = self._tiled_outputs[_list_output_keys(plan)] = TiledOutputs(pixels)
        outputs_lease.hold(outputs)

    def _create_queue(self, requests: Iterable[DecodeRequest]) -> DecodeQueue:
        return DecodeQueue(self._threads, self._load, requests, self._leftovers)


def _list_output_keys(plan: Plan) -> tuple[str, ...]:
    """The keys of the outputs."""
    return tuple(plan.surfaces[number].key for number in plan.outputs.values())
