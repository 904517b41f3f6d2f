"""The preview: compiles and runs what panels want to show, step by step."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING

from halation.nodes import CameraModel, Size

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
    """Computes what is wanted, keeps what is shown.

    `errors` went wrong, by path of the node or input, "" where none is at fault; `faults` are their sentences, without
    files that are only not chosen yet. `timed` measures passes as they run. While `paused` nothing is computed.
    `thumbnailing` draws small pictures of nodes whose results happen to be there. While it `skims`, frames that are
    there are only shown. `ahead` is a frame that is wanted soon, for when nothing else is to be done. What a `glimpse`
    shows is computed first; the rest follows when the graph has rested for a moment, by the `clock`.
    """

    def __init__(self, renderer: Renderer, display: Display) -> None:
        self.renderer, self._runner = renderer, renderer.runner
        self._thumbnails, self._code = Thumbnails(renderer, display), CodeCheck(renderer)
        self._wish: PreviewRequest | None = None
        self._round: PreviewWork | None = None
        self._job: PictureJob | None = None
        self._shelf = DisplayedImages(renderer.runner, renderer.pictures)
        self._seen: Graph | None = None
        """The last requested graph: it may differ from the request in its layout."""
        self._stopwatch = PassTimes()
        self._timings: dict[str, NodeTiming] = {}
        self._cameras: dict[Port, CameraModel] = {}
        self.faults: Mapping[str, str] = MappingProxyType({})
        self.errors: Mapping[str, HalationError] = MappingProxyType({})
        self.paused = self.timed = self.skims = False
        self.thumbnailing = True
        self.ahead: int | None = None
        self.glimpse: VisibleRegion | None = None
        self.patience = PATIENCE
        self.clock: Callable[[], float] = time.perf_counter
        self.seconds = 0.0
        """How long the frame took that was finished last."""
        self._takes: list[FrameCache] = []

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
    ) -> None:
        """Say what panels want to show, by their names. Costs nothing if it is the same as before."""
        before = self._wish
        wish = PreviewRequest(graph, dict(ports), dict(bindings or {}), scale, frame, size)
        if before is not None:
            if graph is self._seen and before.wants_same_pixels(replace(wish, graph=before.graph)):
                return
            self._seen = graph
            if before.wants_same_pixels(wish):
                return
            wish.outside_version = before.outside_version + (not before.has_same_outside(wish))
            wish.upstream = before.upstream
            wish.frame_cache = before.frame_cache if wish.differs_only_in_frame(before) else wish.frame_cache
        self._wish, self._seen = wish, graph
        if wish.frame_cache not in self._takes:
            self._takes.append(wish.frame_cache)
        self._shelf.keep(wish.ports)

    def work(self, seconds: float) -> bool:
        """Compute for about `seconds`, at least one pass; True while there is more to do.

        Returns early where a file is still being decoded. A user's mistake becomes one of `faults`.
        """
        if self.paused:
            return False
        deadline, worked = time.perf_counter() + seconds, False
        while self._advance():
            worked = True
            if time.perf_counter() >= deadline:
                return self._has_more
        while self._draws and not self.busy and not (worked and time.perf_counter() >= deadline):
            self._thumbnails.draw_next()
            worked = True
        if self._checks_code and self._round is not None and self._code.add_faults(self._round):
            self._settle(self._round)
        return self._has_more

    def refresh(self) -> None:
        """Check all files again: what has changed on disk is computed again."""
        if self._wish is not None:
            self._wish = replace(self._wish, outside_version=self._wish.outside_version + 1)
        self._forget()

    def reload(self, library: Library) -> None:
        """Use these shaders from now on. What a broken one would draw stays as it is."""
        self.renderer.library = library
        self._forget()

    def clear(self) -> None:
        """Drop every result, picture and thumbnail; everything is computed again."""
        self._forget()
        self._shelf.keep(())
        self._thumbnails.clear()
        self._stopwatch.clear()
        self._timings = {}
        self._cameras.clear()
        self._runner.release_idle()

    def close(self) -> None:
        """Release everything. The renderer stays open."""
        self.clear()
        self._wish = None
        self._thumbnails.close()

    # --- what the editor asks ----------------------------------------------------------------------------------------

    def find_whole_image(self, name: str) -> DisplayedImage | None:
        """The last whole picture for a panel."""
        return self._shelf.find(name)

    def find_visible_image(self, name: str) -> DisplayedImage | None:
        """The last picture for a panel: whole, or the visible part of a newer one."""
        return self._shelf.find_part(name) or self._shelf.find(name)

    def fault(self, name: str) -> str | None:
        """Why a panel cannot show what it wants."""
        return self._round.broken.get(name) if self._round else None

    def thumbnail(self, path: str) -> tuple[DeviceTexture, bool] | None:
        """The last thumbnail of a node, and whether it is up to date."""
        return self._thumbnails.find(path, self._wish.node_mark) if self._wish else None

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
        return self._is_behind() or working or bool(self._round and self._round.queue)

    @property
    def completing(self) -> bool:
        """True while the visible part is ready, but not the whole picture."""
        work, peeks = self._round, self._job is not None and self._job.part is not None
        return work is not None and work.part is not None and self.busy and not (peeks or self._is_behind())

    @property
    def remembers(self) -> bool:
        """True if frames need the ones before them."""
        return self._wish is not None and self._wish.frame_cache.needs_history

    @property
    def under_way(self) -> int | None:
        """The frame that is being computed, to show it now or later."""
        return self._job.frame if self._job else None

    @property
    def frames(self) -> tuple[int, ...]:
        """The frames of the current graph that can be shown at once."""
        return self._wish.frame_cache.list_frames(self._wish.ports, self.renderer) if self._wish else ()

    @property
    def frames_bytes(self) -> int:
        """The bytes of these frames on the device."""
        return self._wish.frame_cache.nbytes if self._wish else 0

    @property
    def progress(self) -> tuple[int, int]:
        """Passes done, and passes in all, as far as they are known."""
        return self._round.count_passes(self._job) if self._round else (0, 0)

    @property
    def lead(self) -> tuple[str, int, int] | None:
        """What of the history is under way for a frame: "plan" or "pre-roll", how many frames are done, and of all."""
        return self._job.preroll_progress if self._job and not self._job.ahead else None

    @property
    def timings(self) -> Mapping[str, NodeTiming]:
        """The time and memory of each displayed node when it ran last, by path."""
        return self._timings

    @property
    def memory(self) -> tuple[int, int]:
        """Bytes of textures on the device, and the memory budget."""
        return self._runner.textures.allocated, self._runner.textures.budget

    # --- one step after the other ------------------------------------------------------------------------------------

    @property
    def _has_more(self) -> bool:
        skimmed = self._round is not None and self._round.from_cache_only and not self.skims
        return self.busy or self._draws or skimmed or self._job is not None or self._looks_ahead or self._checks_code

    @property
    def _checks_code(self) -> bool:
        """True while there is code that no picture needed, and time to try it."""
        return bool(self._round and not self.busy and not self.skims and self._code.is_behind(self._round))

    @property
    def _draws(self) -> bool:  # thumbnails, if there is time left
        return self.thumbnailing and self._thumbnails.waiting and not self.skims

    def _is_behind(self) -> bool:
        return self._wish is not None and (self._round is None or self._round.wish is not self._wish)

    def _restart(self) -> None:
        if self._job is not None:
            self._job.close()
        self._job = self._round = None

    def _forget(self) -> None:
        """Start again, without any frames."""
        self._restart()
        self._code.clear()
        for take in self._takes:
            take.close()
        self._takes = []
        if self._wish is not None:
            self._wish = replace(self._wish, frame_cache=FrameCache())
            self._takes.append(self._wish.frame_cache)

    @property
    def _looks_ahead(self) -> bool:
        """True if a frame should be computed ahead."""
        work, frame = self._round, self.ahead
        if frame is None or work is None or self._job is not None or work.queue or work.broken or not work.wish.ports:
            return False
        take = work.wish.frame_cache
        return frame not in take.failed_frames and take.find(frame, work.wish.ports, self.renderer) is None

    def _advance(self) -> bool:
        """Do the next step; False if there is nothing to do now."""
        if self._wish is not None and self._is_behind() and self._may_restart(self._wish):
            self._begin(self._wish)
        if self._round is None:
            return False
        if self._round.from_cache_only and not self.skims and self._job is None:
            self._round.from_cache_only, self._round.queue = False, [self._round.wish.ports]
        if self._round.may_show_part_first(self.glimpse) and not self.skims and self._peek(self._round):
            return True
        if self._job is None:
            return self._compile(self._round)
        if not self._job.is_ready:
            return False
        self._step(self._round, self._job)
        return True

    def _begin(self, wish: PreviewRequest) -> None:
        """Start to work on a request, with the results that are there already."""
        job, ports = self._job, wish.ports
        if job is not None and job.ahead and job.frame == wish.frame and job.wish.frame_cache is wish.frame_cache:
            job.ahead, job.wish = False, wish
            self._round = PreviewWork(wish, [], self.clock())
            self._settle(self._round)
            return
        self._restart()
        for take in self._takes:
            if take is not wish.frame_cache:
                take.close()
        self._takes = [wish.frame_cache]
        images = (wish.frame_cache.find(wish.frame, ports, self.renderer) if ports else None) or {}
        for name in filter(ports.__contains__, images):
            self._shelf.show(name, ports[name], wish, images[name])
        skimmed = bool(images and self.skims)
        self._round = PreviewWork(wish, [ports] if ports and not skimmed else [], self.clock(), from_cache_only=skimmed)
        self._settle(self._round)

    def _may_restart(self, wish: PreviewRequest) -> bool:
        """Let a run for the same panels finish if that is soon."""
        work, job = self._round, self._job
        if work is None or job is None or work.is_replaced(wish, job):
            return True
        return self.clock() - work.started_at > self.patience

    def _peek(self, work: PreviewWork) -> bool:
        """Start with the visible part, if it is less than what is still to be computed."""
        job, glimpse = self._job, self.glimpse
        if glimpse is None or (job is not None and (job.ahead or job.part is not None)) or not (job or work.queue):
            return False
        work.tried_region, glimpse_job = glimpse, begin_visible_part(self.renderer, work.wish, glimpse)
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
            ports, frame, ahead = work.wish.ports, self.ahead, True
        elif not work.queue or work.must_wait(self.clock()):
            return False
        else:
            ports, frame, ahead = work.queue.pop(0), work.wish.frame, False
        work.pending = None
        try:
            self._job = PictureJob(self.renderer, work.wish, ports, frame, self.timed, ahead)
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
                self._shelf.show_part(job.wish, job.ports, job.plan, job.part)
                work.part = job.part
                job.lease.close()
                return
            self.seconds = time.perf_counter() - job.started_at
            self._publish_images(work, job, job.plan)
            self._settle(work)

    def _add_fault(self, work: PreviewWork, ports: Mapping[str, Port], ahead: int | None, error: HalationError) -> bool:
        """Handle an error: wait for a file, try the ports one by one, or report it. False if it must wait."""
        if ahead is not None:
            work.wish.frame_cache.failed_frames.add(ahead)
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
        wish, faces = job.wish, dict[str, FrameImage]()
        for name, port in job.ports.items():
            surface = plan.surfaces[plan.outputs[name]]
            faces[name] = self._shelf.describe(name, port, wish, plan, surface.size)
            if not job.ahead:
                self._shelf.show(name, port, wish, faces[name])
        wish.frame_cache.add_frame(job.frame, faces, self.renderer, work.wish.frame)
        job.lease.close()
        if job.ahead:
            return
        self._cameras |= plan.cameras
        if job.timings is not None:
            work.timings |= self._stopwatch.note(plan, job.timings)
            self._timings = work.timings
        subjects = list_thumbnail_sources(work.wish, plan) if self.thumbnailing and not self.skims else {}
        self._thumbnails.offer(subjects, color_settings(work.wish.graph))
