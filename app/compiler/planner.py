"""From graph to plan: the stages in a row, and what of the last plans holds for the next."""

from __future__ import annotations

import gc
from collections.abc import Container, Generator, Mapping
from contextlib import contextmanager

from msgspec import Struct
from msgspec.structs import replace

from ..graph import Graph, color_settings
from ..resources.picture import Picture
from ..resources.provider import ResourceProvider
from .fusion.fuse import fuse
from .fusion.rewrites import rewrite_passes
from .library import Library, installed_library
from .lowering.expand import find_custom_texts
from .lowering.incremental import lower_again
from .lowering.lower import lower
from .lowering.steps import LoweringRecord
from .plan import Plan
from .request import Request
from .scheduling.schedule import ScheduleRecord, choose_formats, reschedule, schedule
from .target import NULL, Precision, Target
from .tiling.regions import focus_program
from .tiling.tiling import plan_tiling
from .working import library_for

MAX_REMEMBERED_PLANS = 4
"""Plans that a planner remembers: someone who works on a graph looks at few things in turn."""


class PlanRecord(Struct, frozen=True):
    """A plan of whole pictures, how it came to be, and what was asked for besides a frame, a region and bindings."""

    asked: tuple[object, ...]
    lowered: LoweringRecord
    scheduled: ScheduleRecord
    tiled: bool
    """False where it is known to fit."""
    part: ScheduleRecord | None
    """The plan of the last region."""


@contextmanager
def _pause_collection() -> Generator[None]:
    """Nobody looks for garbage meanwhile: most of what a plan is made of lives on, and all other plans with it."""
    before = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if before:
            gc.enable()


class Planner:
    """Compiles graphs one after the other. What holds of the plans before is not found out again.

    The plan is always the one that `compile_graph` makes. Bound pixels are not held on to.
    """

    def __init__(self) -> None:
        self._known: list[PlanRecord] = []

    @_pause_collection()
    def plan(
        self,
        graph: Graph,
        request: Request,
        outside: ResourceProvider,
        *,
        target: Target = NULL,
        precision: Precision | None = None,
        library: Library | None = None,
        fusion: bool = True,
        there: Container[str] = (),
    ) -> Plan:
        """Compile what `request` wants of `graph` for `target`: see `compile_graph`.

        `there` are the keys of pictures that need not be made: for a region they are read as they are.
        """
        library, precision = graph_library(graph, outside, library), precision or target.precision
        asked = (
            dict(request.targets),
            request.size,
            request.scale,
            request.halves,
            request.by_rows,
            target,
            precision,
            fusion,
        )
        lowered = scheduled = tiling = part = None
        tiled = True
        for known in self._known:
            if known.asked != asked or known.lowered.library is not library:
                continue
            lowered = lower_again(known.lowered, graph, request, outside)
            if lowered is not None:
                scheduled, tiled = reschedule(known.scheduled, lowered.program, library), known.tiled
                part = known.part
                self._known.remove(known)
                break
        lowered = lowered or lower(graph, request, library, outside)
        if scheduled is None:
            passes = fuse(lowered.program, target, enabled=fusion)
            passes = rewrite_passes(lowered.program, passes, target, library) if fusion else passes
            scheduled, tiled = schedule(lowered.program, passes, library, target, precision, request.halves), True
        wanted = scheduled
        if request.region is not None:  # which part of a picture is read may depend on numbers: it is found anew
            made = {ref for ref, key in scheduled.keys.items() if key in there}
            program = focus_program(lowered.program, scheduled.passes, request.region, made)
            same = part is not None and part.passes is scheduled.passes and part.program.windows == program.windows
            wanted = reschedule(part, program, library) if part is not None and same else None
            wanted = wanted or schedule(program, scheduled.passes, library, target, precision, request.halves)
            part = wanted
        if tiled or wanted is not scheduled:  # what fitted as it was still does if nothing but numbers changed
            tiling = plan_tiling(
                wanted.program,
                wanted.passes,
                wanted.texels,
                library,
                target,
                precision,
                request.halves,
                wanted.keys,
                request.by_rows,
            )
        tiled = tiling is not None if wanted is scheduled else tiled
        self._known = [PlanRecord(asked, lowered, scheduled, tiled, part), *self._known][:MAX_REMEMBERED_PLANS]
        return _with_pixels(replace(wanted.plan, tiling=tiling), request.bindings)


def compile_graph(
    graph: Graph,
    request: Request,
    outside: ResourceProvider,
    *,
    target: Target = NULL,
    precision: Precision | None = None,
    library: Library | None = None,
    fusion: bool = True,
) -> Plan:
    """Compile what `request` wants of `graph` for `target`.

    Raises GraphError for a graph that cannot be rendered, InputError (from `outside`) for a file that cannot
    be read, DeviceError for one that is too large, ShaderError for a node and its GLSL that do not agree.
    """
    return Planner().plan(graph, request, outside, target=target, precision=precision, library=library, fusion=fusion)


def examine(graph: Graph, request: Request, outside: ResourceProvider, target: Target = NULL) -> None:
    """Raise what `compile_graph` would raise, in half of the time: no program is written."""
    library = graph_library(graph, outside)
    program = lower(graph, request, library, outside).program
    passes, precision = fuse(program, target), target.precision
    texels = choose_formats(program, passes, target, precision, request.halves)
    plan_tiling(program, passes, texels, library, target, precision, request.halves)


def graph_library(graph: Graph, outside: ResourceProvider, library: Library | None = None) -> Library:
    """The shaders that a graph can use: the installed ones for its working space, and its own."""
    working = outside.working(color_settings(graph)) if graph.settings.color.working else None
    return library_for(library or installed_library(), working).with_texts(find_custom_texts(graph))


def _with_pixels(plan: Plan, bindings: Mapping[str, Picture]) -> Plan:
    """A plan that has the pixels that are bound to inputs."""
    pixels = {item.path: item.pixels for item in bindings.values() if item.in_memory}

    def fill_pixels(picture: Picture) -> Picture:
        there = not picture.in_memory or picture.pixels is not None
        return picture if there else replace(picture, pixels=pixels.get(picture.path))

    uploads = tuple(replace(item, picture=fill_pixels(item.picture)) for item in plan.uploads)
    if plan.tiling is None:
        return replace(plan, uploads=uploads)
    program = plan.tiling.program
    ops = tuple(op.with_pictures(fill_pixels) for op in program.ops)
    tiling = replace(plan.tiling, program=replace(program, ops=ops))
    return replace(plan, uploads=uploads, tiling=tiling)
