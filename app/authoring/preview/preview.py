"""The preview: compiles and runs what panels want to show, step by step."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Set
from types import MappingProxyType
from typing import TYPE_CHECKING

from halation.nodes import CameraModel, Size
from msgspec.structs import replace

from ...compiler import Library, Plan
from ...errors import HalationError, NoFileError
from ...graph import Graph, Port, color_settings
from ...renderer import DeviceTexture, Display, Renderer
from ..background.render_overviews import OverviewPending
from .code_check import CodeCheck
from .displayed_images import DisplayedImage, DisplayedImages
from .frame_cache import FrameCache, FrameImage
from .picture_job import PictureJob, begin_visible_part
from .request import PreviewRequest
from .thumbnails import Thumbnails, list_thumbnail_sources
from .timing import NodeTiming, PassTimes
from .visible_region import VisibleRegion
from .work import PreviewWork

if TYPE_CHECKING:
    from ...inputs.provider import Binding

PATIENCE = 0.3
"""Seconds that a run may go on after the graph has changed: otherwise a long drag would never show a picture."""


class Preview:
    """Computes the pictures that panels request, and keeps those that they show.

    `errors` are those of the last request by the path of the node or input, "" where none is at fault; `faults` are
    their sentences, without files that are still to be chosen. `timed` measures passes. While `paused`, nothing is
    computed; while it `skims`, only cached frames are shown. `thumbnailing` draws small pictures of nodes whose results
    exist. `ahead` is the frame to compute when nothing else is left to do. What a `glimpse` shows is computed first;
    the rest follows when the `clock` says that the graph rests. The last frame took `seconds`, its nodes `timings`.
    """

    def __init__(self, renderer: Renderer, display: Display) -> None:
        self.renderer, self._runner = renderer, renderer.runner
        self._thumbnails, self._code = Thumbnails(renderer, display), CodeCheck(renderer)
        self._request: PreviewRequest | None = None
        self._work: PreviewWork | None = None
        self._job: PictureJob | None = None
        self._images = DisplayedImages(renderer.runner, renderer.pictures)
        self._seen: Graph | None = None
        """The last requested graph: it may differ from the request in its layout."""
        self._stopwatch = PassTimes()
        self.timings: Mapping[str, NodeTiming] = MappingProxyType({})
        self._cameras: dict[Port, CameraModel] = {}
        self.faults: Mapping[str, str] = MappingProxyType({})
        self.errors: Mapping[str, HalationError] = MappingProxyType({})
        self.paused = self.timed = self.skims = False
        self.thumbnailing = True
        self.ahead: int | None = None
        self.glimpse: VisibleRegion | None = None
        self.clock: Callable[[], float] = time.perf_counter
        self.patience, self.seconds = PATIENCE, 0.0
        self._caches: list[FrameCache] = []

    # --- what the editor says ----------------------------------------------------------------------------------------

    def want(
        self,
        graph: Graph,
        ports: Mapping[str, Port],
        *,
        bindings: Mapping[str, Binding] | None = None,
        scale: float = 1.0,
        frame: int = 1,
        size: Size | None = None,
        whole: Set[str] = frozenset(),
    ) -> None:
        """Say what panels want to show, by their names; those in `whole` beyond the frame. The same again is free."""
        before = self._request
        request = PreviewRequest(graph, dict(ports), dict(bindings or {}), scale, frame, size, whole=whole)
        if before is not None:
            if graph is self._seen and before.wants_same_pixels(replace(request, graph=before.graph)):
                return
            self._seen = graph
            if before.wants_same_pixels(request):
                return
            request.outside_version = before.outside_version + (not before.has_same_outside(request))
            request.upstream = before.upstream
            request.frame_cache = before.frame_cache if request.has_same_frames(before) else request.frame_cache
        self._request, self._seen = request, graph
        if request.frame_cache not in self._caches:
            self._caches.append(request.frame_cache)
        self._images.keep(request.ports)

    def work(self, seconds: float, urgent: float = 0.0) -> bool:
        """Compute for about `seconds`, at least one pass, or `urgent` while a wanted picture is not ready; True while
        there is more to do. Returns early where a file is being decoded. A user's mistake becomes one of `faults`.
        """
        if self.paused:
            return False
        began, worked = time.perf_counter(), False
        deadline, latest = began + seconds, began + max(seconds, urgent)
        while self._advance():
            worked = True
            if time.perf_counter() >= (latest if self.busy else deadline):
                return self._has_more
        while self._draws and not self.busy and not (worked and time.perf_counter() >= deadline):
            self._thumbnails.draw_next()
            worked = True
        if self._checks_code and self._work is not None and self._code.add_faults(self._work):
            self._settle(self._work)
        return self._has_more

    def refresh(self) -> None:
        """Check all files again: what has changed on disk is computed again."""
        if self._request is not None:
            self._request = replace(self._request, outside_version=self._request.outside_version + 1)
        self._forget()

    def reload(self, library: Library) -> None:
        """Use these shaders from now on. What a broken one would draw stays as it is."""
        self.renderer.library = library
        self._forget()

    def clear(self) -> None:
        """Drop every result, picture and thumbnail; everything is computed again."""
        self._forget()
        self._images.keep(())
        self._thumbnails.clear()
        self._stopwatch.clear()
        self.timings = {}
        self._cameras.clear()
        self._runner.release_idle()

    def close(self) -> None:
        """Release everything. The renderer stays open."""
        self.clear()
        self._request = None
        self._thumbnails.close()

    # --- what the editor asks ----------------------------------------------------------------------------------------

    def find_whole_image(self, name: str) -> DisplayedImage | None:
        """The last whole picture for a panel."""
        return self._images.find(name)

    def find_visible_image(self, name: str) -> DisplayedImage | None:
        """The last picture for a panel: whole, or the visible part of a newer one."""
        return self._images.find_part(name) or self._images.find(name)

    def fault(self, name: str) -> str | None:
        """Why a panel cannot show what it wants."""
        return self._work.broken.get(name) if self._work else None

    def thumbnail(self, path: str) -> tuple[DeviceTexture, bool] | None:
        """The last thumbnail of a node, and whether it is up to date."""
        return self._thumbnails.find(path, self._request.node_mark) if self._request else None

    def camera(self, port: Port) -> CameraModel | None:
        """The camera that an input of a node was given when pictures were computed last, by the node's path."""
        return self._cameras.get(port)

    @property
    def thumbnails(self) -> frozenset[str]:
        """Paths of all nodes and inputs that have a thumbnail; the same object until that changes."""
        return self._thumbnails.paths

    @property
    def busy(self) -> bool:
        """True while a wanted picture is not ready."""
        working = self._job is not None and not self._job.ahead
        return self._is_behind() or working or bool(self._work and self._work.queue)

    @property
    def completing(self) -> bool:
        """True while the visible part is ready, but not the whole picture."""
        work, peeks = self._work, self._job is not None and self._job.part is not None
        return work is not None and work.part is not None and self.busy and not (peeks or self._is_behind())

    @property
    def remembers(self) -> bool:
        """True if frames need the ones before them."""
        return self._request is not None and self._request.frame_cache.needs_history

    @property
    def under_way(self) -> int | None:
        """The frame that is being computed, to show it now or later."""
        return self._job.frame if self._job else None

    @property
    def frames(self) -> tuple[int, ...]:
        """The frames of the current graph that can be shown at once."""
        return self._request.frame_cache.list_frames(self._request.ports, self.renderer) if self._request else ()

    @property
    def frames_bytes(self) -> int:
        """The bytes of these frames on the device."""
        return self._request.frame_cache.nbytes if self._request else 0

    @property
    def progress(self) -> tuple[int, int]:
        """Passes done, and passes in all, as far as they are known."""
        return self._work.count_passes(self._job) if self._work else (0, 0)

    @property
    def lead(self) -> tuple[str, int, int] | None:
        """What of the history is under way for a frame: "plan" or "pre-roll", how many frames are done, and of all."""
        return self._job.preroll_progress if self._job and not self._job.ahead else None

    @property
    def memory(self) -> tuple[int, int]:
        """Bytes of textures on the device, and the memory budget."""
        return self._runner.textures.allocated, self._runner.textures.budget

    @property
    def is_decoding(self) -> bool:
        """True while a picture waits for a file that a thread decodes."""
        return self._job is not None and not self._job.is_ready

    # --- one step after the other ------------------------------------------------------------------------------------

    @property
    def _has_more(self) -> bool:
        skimmed = self._work is not None and self._work.from_cache_only and not self.skims
        return self.busy or self._draws or skimmed or self._job is not None or self._looks_ahead or self._checks_code

    @property
    def _checks_code(self) -> bool:
        """True while there is code that no picture needed, and time to try it."""
        return bool(self._work and not self.busy and not self.skims and self._code.is_behind(self._work))

    @property
    def _draws(self) -> bool:  # thumbnails, if there is time left
        return self.thumbnailing and self._thumbnails.waiting and not self.skims

    def _is_behind(self) -> bool:
        return self._request is not None and (self._work is None or self._work.request is not self._request)

    def _restart(self) -> None:
        if self._job is not None:
            self._job.close()
        self._job = self._work = None

    def _forget(self) -> None:
        """Start again, without any frames."""
        self._restart()
        self._code.clear()
        for cache in self._caches:
            cache.close()
        self._caches = []
        if self._request is not None:
            self._request = replace(self._request, frame_cache=FrameCache())
            self._caches.append(self._request.frame_cache)

    @property
    def _looks_ahead(self) -> bool:
        """True if a frame should be computed ahead."""
        work, frame = self._work, self.ahead
        if frame is None or work is None or self._job is not None or not work.is_finished:
            return False
        cache = work.request.frame_cache
        return frame not in cache.failed_frames and cache.find(frame, work.request.ports, self.renderer) is None

    def _advance(self) -> bool:
        """Do the next step; False if there is nothing to do now."""
        if self._request is not None and self._is_behind() and self._may_restart(self._request):
            self._begin(self._request)
        if self._work is None:
            return False
        if self._work.from_cache_only and not self.skims and self._job is None:
            self._work.from_cache_only, self._work.queue = False, [self._work.request.ports]
        if self._work.may_show_part_first(self.glimpse) and not self.skims and self._peek(self._work):
            return True
        if self._job is None:
            return self._compile(self._work)
        if not self._job.is_ready:
            return False
        self._step(self._work, self._job)
        return True

    def _begin(self, request: PreviewRequest) -> None:
        """Start to work on a request, with the results that are there already."""
        job, ports = self._job, request.ports
        if job is not None and job.is_ahead_of(request):
            job.ahead, job.request = False, request
            self._work = PreviewWork(request, [], self.clock())
            self._settle(self._work)
            return
        self._restart()
        for cache in self._caches:
            if cache is not request.frame_cache:
                cache.close()
        self._caches = [request.frame_cache]
        images = (request.frame_cache.find(request.frame, ports, self.renderer) if ports else None) or {}
        for name in filter(ports.__contains__, images):
            self._images.show(name, ports[name], request, images[name])
        skimmed = bool(images and self.skims)
        queue = [ports] if ports and not skimmed else []
        self._work = PreviewWork(request, queue, self.clock(), from_cache_only=skimmed)
        self._settle(self._work)

    def _may_restart(self, request: PreviewRequest) -> bool:
        """Let a run for the same panels finish if that is soon."""
        work, job = self._work, self._job
        if work is None or job is None or work.is_replaced(request, job):
            return True
        return self.clock() - work.started_at > self.patience

    def _peek(self, work: PreviewWork) -> bool:
        """Start with the visible part, if it is less than what is still to be computed."""
        job, glimpse = self._job, self.glimpse
        if glimpse is None or (job is not None and (job.ahead or job.part is not None)) or not (job or work.queue):
            return False
        work.tried_region, glimpse_job = glimpse, begin_visible_part(self.renderer, work.request, glimpse)
        if glimpse_job is None or glimpse_job.plan is None:
            return False
        if job is not None:
            job.close()
            work.queue.insert(0, job.ports)
        self._job, self._cameras = glimpse_job, {**self._cameras, **glimpse_job.plan.cameras}
        return True

    def _compile(self, work: PreviewWork) -> bool:
        """Compile the next ports; False if there are none."""
        if self._looks_ahead and self.ahead is not None:
            ports, frame, ahead = work.request.ports, self.ahead, True
        elif not work.queue or work.must_wait(self.clock()):
            return False
        else:
            ports, frame, ahead = work.queue.pop(0), work.request.frame, False
        work.pending = None
        try:
            self._job = PictureJob(self.renderer, work.request, ports, frame, self.timed, ahead)
        except HalationError as error:
            return self._add_fault(work, ports, frame if ahead else None, error)
        if self._job.plan is not None and not ahead:
            self._cameras |= self._job.plan.cameras
        return True

    def _step(self, work: PreviewWork, job: PictureJob) -> None:
        try:
            is_complete = job.step()
            if job.run is not None:
                with self.renderer.device.make_current():
                    self.renderer.device.finish()
        except HalationError as error:
            job.close()
            self._job = None
            self._add_fault(work, job.ports, job.frame if job.ahead else None, error)
            return
        if is_complete and job.plan is not None:
            self._job = None
            work.passes += 0 if job.ahead else job.finished_passes
            if job.part is not None:
                self._images.show_part(job.request, job.ports, job.plan, job.part)
                work.part = job.part
                job.lease.close()
                return
            self.seconds = time.perf_counter() - job.started_at
            self._publish_images(work, job, job.plan)
            self._settle(work)

    def _add_fault(self, work: PreviewWork, ports: Mapping[str, Port], ahead: int | None, error: HalationError) -> bool:
        """Handle an error: wait for a file, try the ports one by one, or report it. False if it must wait."""
        if ahead is not None:
            work.request.frame_cache.failed_frames.add(ahead)
        elif isinstance(error, OverviewPending):
            work.queue.insert(0, ports)
            work.pending = error
            return False
        else:
            work.note_failure(ports, error)
            self._settle(work)
        return True

    def _settle(self, work: PreviewWork) -> None:
        """Report errors when everything was tried: only then it is known which earlier ones are over."""
        self.errors = MappingProxyType({**(self.errors if work.queue else {}), **work.faults})
        mistakes = {path: error for path, error in self.errors.items() if not isinstance(error, NoFileError)}
        self.faults = MappingProxyType({path: str(error) for path, error in mistakes.items()})

    def _publish_images(self, work: PreviewWork, job: PictureJob, plan: Plan) -> None:
        request, frame_images = job.request, dict[str, FrameImage]()
        for name, port in job.ports.items():
            surface = plan.surfaces[plan.outputs[name]]
            frame_images[name] = self._images.describe(name, port, request, plan, surface.frame_size)
            if not job.ahead:
                self._images.show(name, port, request, frame_images[name])
        request.frame_cache.add_frame(job.frame, frame_images, self.renderer, work.request.frame)
        job.lease.close()
        if job.ahead:
            return
        self._cameras |= plan.cameras
        if job.timings is not None:
            work.timings |= self._stopwatch.note(plan, job.timings)
            self.timings = work.timings
        subjects = list_thumbnail_sources(work.request, plan) if self.thumbnailing and not self.skims else {}
        self._thumbnails.offer(subjects, color_settings(work.request.graph))
