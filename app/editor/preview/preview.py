"""Pictures for panels: compiled, run step by step, kept until better ones are ready."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import TYPE_CHECKING

from ....nodes import Camera, Kind, Size
from ...compiler import Library, Plan
from ...errors import HalationError
from ...graph import Graph, Port
from ...renderer import Display, Handle, Lease, Renderer, Run, Wanted
from ..services.renders import Pending
from .thumbnails import Subject, Thumbnails
from .timing import Timing, key_of, timings_of
from .wishes import Wish, kind_of, path_of

if TYPE_CHECKING:
    from ...compiler import Pass
    from ...media.pictures import Binding

PATIENCE = 0.3
"""Seconds that a run may go on after the graph has changed: during a long drag, pictures would never come otherwise."""

MOST_SECONDS = 4096
"""Passes whose times are remembered."""


@dataclass(frozen=True)
class Shown:
    """A finished picture: it stays as it is until another takes its place. `texture` is scene-linear."""

    port: Port
    texture: Handle
    size: Size
    full_size: Size
    """Its size at scale 1."""
    scale: float
    kind: Kind
    channels: int
    key: str
    revision: int
    """Greater for every picture that is not the one before."""


@dataclass(eq=False)
class _Job:
    """A plan under way for some of the wanted ports."""

    ports: Mapping[str, Port]
    plan: Plan
    run: Run
    kept: Lease
    timings: list[tuple[Pass, float]] | None

    def close(self) -> None:
        self.run.close()
        self.kept.close()


@dataclass(eq=False)
class _Picture:
    """What a panel shows, and the lease that keeps it."""

    shown: Shown
    lease: Lease


@dataclass(eq=False)
class _Round:
    """The work on one wish: what is still to be compiled, and what went wrong so far."""

    wish: Wish
    queue: list[Mapping[str, Port]]
    began: float
    passes: int = 0
    faults: dict[str, str] = field(default_factory=dict[str, str])
    pending: Pending | None = None
    """The render that the first of the queue waits for."""
    broken: dict[str, str] = field(default_factory=dict[str, str])
    """Why panels cannot show what they want, by name."""
    timings: dict[str, Timing] = field(default_factory=dict[str, Timing])


class Preview:
    """Computes what is wanted, keeps what is shown.

    `timed` measures passes as they run. While `paused` nothing is computed; wants are remembered. `thumbnailing` draws
    small pictures of nodes whose results happen to be there.
    """

    def __init__(self, renderer: Renderer, display: Display) -> None:
        self.renderer, self._runner = renderer, renderer.runner
        self._thumbnails = Thumbnails(renderer, display)
        self._wish: Wish | None = None
        self._round: _Round | None = None
        self._job: _Job | None = None
        self._pictures: dict[str, _Picture] = {}
        self._revision = 0
        self._seen: Graph | None = None
        """The last graph that was wanted: it may differ from the wish in its layout."""
        self._seconds: dict[str, float] = {}
        self._timings: dict[str, Timing] = {}
        self._full_sizes: dict[Port, Size] = {}
        self._cameras: dict[Port, Camera] = {}
        self.faults: Mapping[str, str] = MappingProxyType({})
        """What is wrong, by path of the node or input (`glow/bloom`, `inputs.beauty`); "" where no node is at fault."""
        self.paused = False
        self.timed = False
        self.thumbnailing = True
        self.patience = PATIENCE

    # --- what the editor says ----------------------------------------------------------------------------------------

    def want(
        self, graph: Graph, ports: Mapping[str, Port], *, bindings: Mapping[str, Binding] | None = None,
        scale: float = 1.0, frame: int = 1, size: Size | None = None,
    ) -> None:
        """What panels want to show, by their names. Costs nothing when it is the same as before."""
        before = self._wish
        wish = Wish(graph, dict(ports), dict(bindings or {}), scale, frame, size)
        if before is not None:
            if graph is self._seen and before.equals(replace(wish, graph=before.graph)):
                return
            self._seen = graph
            if before.equals(wish):
                return
            wish.world = before.world + (not before.same_world(wish))
            wish.known = before.known
        self._wish, self._seen = wish, graph
        for name in self._pictures.keys() - wish.ports.keys():
            self._pictures.pop(name).lease.close()

    def work(self, seconds: float) -> bool:
        """Compute for about so long, one pass at least; True while there is more to do.

        Returns early where a file is still being decoded. A user's mistake becomes one of `faults`.
        """
        if self.paused:
            return False
        deadline, worked = time.perf_counter() + seconds, False
        while self._advance():
            worked = True
            if time.perf_counter() >= deadline:
                return self._has_more
        while self._has_more and not self.busy and not (worked and time.perf_counter() >= deadline):
            self._thumbnails.draw_next()
            worked = True
        return self._has_more

    def refresh(self) -> None:
        """Look again at all files: what has changed on disk is computed anew."""
        if self._wish is not None:
            self._wish = replace(self._wish, world=self._wish.world + 1)
        self._restart()

    def reload(self, library: Library) -> None:
        """Use these shaders from now on. What a broken one would draw stays as it is."""
        self.renderer.library = library
        self._restart()

    def clear(self) -> None:
        """Forget every result, picture and thumbnail; all is computed anew."""
        self._restart()
        for picture in self._pictures.values():
            picture.lease.close()
        self._pictures.clear()
        self._thumbnails.clear()
        self._seconds.clear()
        self._timings = {}
        self._cameras.clear()
        self._runner.textures.forget()

    def close(self) -> None:
        """Give back all that is kept. The renderer stays open."""
        self.clear()
        self._wish = None
        self._thumbnails.close()

    # --- what the editor asks ----------------------------------------------------------------------------------------

    def shown(self, name: str) -> Shown | None:
        """What a panel shows: the last good picture, until the new one is ready."""
        picture = self._pictures.get(name)
        return picture and picture.shown

    def fault(self, name: str) -> str | None:
        """Why a panel cannot show what it wants."""
        return self._round.broken.get(name) if self._round else None

    def thumbnail(self, path: str) -> tuple[Handle, bool] | None:
        """The last small picture of a node, and whether it is what the node shows now."""
        return self._thumbnails.find(path, self._wish.mark) if self._wish else None

    def camera(self, port: Port) -> Camera | None:
        """The camera that an input of a node was given when pictures were computed last, by the node's path."""
        return self._cameras.get(port)

    @property
    def thumbnails(self) -> frozenset[str]:
        """Paths of all nodes and inputs that have a small picture; the same object until that changes."""
        return self._thumbnails.paths

    @property
    def busy(self) -> bool:
        """True while a wanted picture is not ready."""
        return self._is_behind() or self._job is not None or bool(self._round and self._round.queue)

    @property
    def progress(self) -> tuple[int, int]:
        """Passes done, and passes to do in all, as far as they are known."""
        before = self._round.passes if self._round else 0
        run = self._job.run if self._job else None
        return (before + run.done, before + run.total) if run else (before, before)

    @property
    def timings(self) -> Mapping[str, Timing]:
        """What the nodes of the pictures that are shown took when they ran last, by path."""
        return self._timings

    @property
    def memory(self) -> tuple[int, int]:
        """Bytes of textures on the device, and how many of results may stay there."""
        return self._runner.textures.allocated, self._runner.textures.budget

    # --- one step after the other ------------------------------------------------------------------------------------

    @property
    def _has_more(self) -> bool:
        return self.busy or (self.thumbnailing and self._thumbnails.waiting)

    def _is_behind(self) -> bool:
        return self._wish is not None and (self._round is None or self._round.wish is not self._wish)

    def _restart(self) -> None:
        if self._job is not None:
            self._job.close()
        self._job = self._round = None

    def _advance(self) -> bool:
        """Do the next thing; False if there is nothing to do now."""
        if self._wish is not None and self._is_behind() and self._may_restart(self._wish):
            self._restart()
            ports = self._wish.ports
            self._round = _Round(self._wish, [ports] if ports else [], time.perf_counter())
            self._settle(self._round)
        if self._round is None:
            return False
        if self._job is None:
            return self._compile(self._round)
        if not self._job.run.ready:
            return False
        self._step(self._round, self._job)
        return True

    def _may_restart(self, wish: Wish) -> bool:
        """Let a run that was begun for the same panels come to its end if that is soon."""
        now = self._round
        if now is None or self._job is None or now.wish.ports != wish.ports or now.wish.scale != wish.scale:
            return True
        return time.perf_counter() - now.began > self.patience

    def _compile(self, now: _Round) -> bool:
        """Begin with the next ports; False if there are none."""
        if not now.queue or (now.pending is not None and not now.pending.ready()):
            return False
        now.pending = None
        ports, wish = now.queue.pop(0), now.wish
        wanted = Wanted(wish.bindings, ports, wish.size, wish.scale, wish.frame)
        timings: list[tuple[Pass, float]] | None = [] if self.timed else None
        kept = self._runner.lease()
        try:
            plan = self.renderer.compile(wish.graph, wanted)
            self._cameras |= plan.cameras
            self._job = _Job(ports, plan, self._runner.steps(plan, kept, timings=timings), kept, timings)
        except Pending as pending:
            now.queue.insert(0, ports)
            now.pending = pending
            kept.close()
            return False
        except HalationError as error:
            self._failed(now, ports, error)
        return True

    def _step(self, now: _Round, job: _Job) -> None:
        try:
            done = next(job.run, None) is None
            with self.renderer.device.current():
                self.renderer.device.context.finish()
        except HalationError as error:
            job.close()
            self._job = None
            self._failed(now, job.ports, error)
            return
        if done:
            now.passes += job.run.total
            self._job = None
            self._finished(now, job)
            self._settle(now)

    def _failed(self, now: _Round, ports: Mapping[str, Port], error: HalationError) -> None:
        """One fault must not hide what else can be shown: try every port alone."""
        if len(ports) > 1:
            now.queue = [{name: port} for name, port in ports.items()] + now.queue
            return
        now.broken |= dict.fromkeys(ports, str(error))
        now.faults |= {node: str(error) for node in error.node.split(", ")}
        self._settle(now)

    def _settle(self, now: _Round) -> None:
        """What was wrong before is known to be over only when all has been tried."""
        known = self.faults if now.queue else {}
        self.faults = MappingProxyType({**known, **now.faults})

    def _finished(self, now: _Round, job: _Job) -> None:
        for name, port in job.ports.items():
            self._show(name, port, now.wish, job.plan)
        job.kept.close()
        if job.timings is not None:
            self._seconds |= {key_of(job.plan, one): seconds for one, seconds in job.timings}
            while len(self._seconds) > MOST_SECONDS:
                self._seconds.pop(next(iter(self._seconds)))
            now.timings |= timings_of(job.plan, self._seconds)
            self._timings = now.timings
        subjects: dict[str, Subject] = {}
        for port, number in job.plan.results.items() if self.thumbnailing else ():
            path, surface = path_of(port), job.plan.surfaces[number]
            kind = kind_of(now.wish.graph, port, surface.channels)
            subjects.setdefault(path, Subject(path, surface.key, kind, surface.channels, now.wish.mark(path)))
        self._thumbnails.offer(subjects)

    def _show(self, name: str, port: Port, wish: Wish, plan: Plan) -> None:
        surface = plan.surfaces[plan.outputs[name]]
        before = self._pictures.get(name)
        same = before is not None and before.shown.key == surface.key
        lease = self._runner.lease()
        lease.take(surface.key)
        texture = self._runner.texture(surface.key)
        assert texture is not None
        self._revision += not same
        shown = Shown(
            port, texture.handle, surface.size, self._full_size(port, wish, plan, surface.size), wish.scale,
            kind_of(wish.graph, port, surface.channels), surface.channels, surface.key,
            before.shown.revision if before is not None and same else self._revision,
        )
        self._pictures[name] = _Picture(shown, lease)
        if before is not None:
            before.lease.close()

    def _full_size(self, port: Port, wish: Wish, plan: Plan, size: Size) -> Size:
        """The size at scale 1 of what was rounded at this one: as before, or that of a picture or the canvas."""
        known = [self._full_sizes.get(port), wish.size, wish.graph.settings.size]
        known += [plan.surfaces[upload.surface].size for upload in plan.uploads]
        found = (round(size[0] / wish.scale), round(size[1] / wish.scale))
        for full in known:
            if full and (max(1, round(full[0] * wish.scale)), max(1, round(full[1] * wish.scale))) == size:
                found = full
                break
        found = size if wish.scale == 1.0 or size == (1, 1) else found
        self._full_sizes[port] = found
        return found
