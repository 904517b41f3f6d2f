"""Compiles a graph to a plan: runs all stages, and reuses results of earlier plans.

A planner remembers its last plans with the records of each stage. The next plan follows one of them if nothing but the
graph, the frame and the region differ. Then each stage first tries to change the record of before: lowering lowers only
the nodes that changed (`lowering.incremental`), and scheduling rewrites only the passes whose numbers changed
(`scheduling.reschedule`). A stage that cannot do that starts again. The result is the same in any case.
"""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence

from halation.nodes import Size
from msgspec import Struct
from msgspec.structs import replace

from ..graph import Graph, Port, color_settings
from ..resources.collection import pause_collection
from ..resources.picture import Picture
from ..resources.provider import ResourceProvider
from .areas import Region
from .fusion.fuse import PassGroup, fuse
from .fusion.limits import operations_fit
from .fusion.rewrites import rewrite_passes
from .ir import LoweredProgram
from .library import Library, load_library
from .lowering.expand import find_custom_texts
from .lowering.incremental import lower_again
from .lowering.lower import lower
from .lowering.samples import lower_samples
from .lowering.steps import LoweringRecord
from .plan import Plan
from .request import Request
from .scheduling.differences import find_changed_numbers
from .scheduling.schedule import ScheduleRecord, choose_formats, reschedule, schedule
from .target import NULL, Precision, Target
from .tiling.regions import focus_program
from .tiling.tiles import Tiling
from .tiling.tiling import plan_tiling

MAX_REMEMBERED_PLANS = 4
"""Plans that a planner remembers, one for each set of options: the viewer's two pictures, the thumbnails and a region.
Chosen by judgement; with fewer, two viewers that take turns would compile everything each time."""


class PlanOptions(Struct, frozen=True):
    """What a plan depends on besides the graph, the frame, the region and the bindings."""

    targets: Mapping[str, Port]
    size: Size | None
    scale: float
    halves: frozenset[str]
    by_rows: frozenset[str]
    whole: frozenset[str]
    target: Target
    precision: Precision
    fusion: bool


class PlanRecord(Struct, frozen=True):
    """A plan of whole pictures, the records of its stages, and the plan of the last region."""

    options: PlanOptions
    lowered: LoweringRecord
    scheduled: ScheduleRecord
    may_need_tiles: bool
    """False if it is known to fit."""
    region: ScheduleRecord | None


class Planner:
    """Compiles graphs one after the other and reuses results of earlier plans.

    The plan is always the same as that of `compile_graph`. Bound pixels are not kept.
    """

    def __init__(self) -> None:
        self._records: list[PlanRecord] = []

    @pause_collection()
    def plan(
        self,
        graph: Graph,
        request: Request,
        provider: ResourceProvider,
        *,
        target: Target = NULL,
        precision: Precision | None = None,
        library: Library | None = None,
        fusion: bool = True,
        cached_keys: Container[str] = (),
    ) -> Plan:
        """Compile what `request` asks of `graph` for `target`: see `compile_graph`.

        `cached_keys` are keys of pictures on the device: a plan for a region reads them whole.

        Each stage first tries to follow the plan before, and starts again if that fails. Whether a plan needs tiles
        depends only on sizes and formats, so a plan that fitted before still fits if only numbers changed.
        """
        library, precision = graph_library(graph, provider, library), precision or target.precision
        options = PlanOptions(
            dict(request.targets),
            request.size,
            request.scale,
            request.halves,
            request.by_rows,
            request.whole,
            target,
            precision,
            fusion,
        )
        before, lowered = self._lower(options, graph, request, provider, library)
        program = lowered.program
        if graph.settings.overscan:
            program = _add_data_windows(program, graph.settings.overscan, request.whole)
        scheduled = _schedule_again(options, before.scheduled, program, library) if before else None
        may_need_tiles = before.may_need_tiles if before and scheduled else True
        scheduled = scheduled or _schedule(options, program, library)
        region = before.region if before else None
        chosen = scheduled
        if request.region is not None:
            region = chosen = _schedule_region(options, region, scheduled, request.region, cached_keys, library)
        tiling = None
        if may_need_tiles or chosen is not scheduled:
            tiling = _plan_tiling(options, chosen, library)
        if chosen is scheduled:
            may_need_tiles = tiling is not None
        record = PlanRecord(options, lowered, scheduled, may_need_tiles, region)
        self._records = [record, *self._records][:MAX_REMEMBERED_PLANS]
        return _fill_pixels(replace(chosen.plan, tiling=tiling), request.bindings)

    def _lower(
        self, options: PlanOptions, graph: Graph, request: Request, provider: ResourceProvider, library: Library
    ) -> tuple[PlanRecord | None, LoweringRecord]:
        """The record of the plan that this one follows, or None, and the lowered graph. The record is removed."""
        for record in self._records:
            if record.options == options and record.lowered.library is library:
                lowered = lower_again(record.lowered, graph, request, provider)
                if lowered is not None:
                    self._records.remove(record)
                    return record, lowered
        return None, lower(graph, request, library, provider)


def _add_data_windows(program: LoweredProgram, overscan: float, whole: frozenset[str]) -> LoweredProgram:
    from .data_windows import add_data_windows  # few graphs have pictures that go on beyond their frame

    return add_data_windows(program, overscan, whole)


def _add_extents(program: LoweredProgram, passes: Sequence[PassGroup], whole: frozenset[str]) -> LoweredProgram:
    from .data_windows import add_extents

    return add_extents(program, passes, whole)


def _schedule(options: PlanOptions, program: LoweredProgram, library: Library) -> ScheduleRecord:
    target = options.target
    passes = fuse(program, target, enabled=options.fusion)
    passes = rewrite_passes(program, passes, target, library) if options.fusion else passes
    program = _add_extents(program, passes, options.whole) if program.data_windows else program
    return schedule(program, passes, library, target, options.precision, options.halves)


def _schedule_again(
    options: PlanOptions, before: ScheduleRecord, program: LoweredProgram, library: Library
) -> ScheduleRecord | None:
    """The plan of a program that differs from that of `before` only in numbers; None if it differs in more.

    Which pixels are made beyond the frame may depend on numbers, so it is found each time.
    """
    if program.data_windows != before.program.data_windows:
        return None
    if program.data_windows:
        if find_changed_numbers(before.program, program) is None:
            return None
        program = _add_extents(program, before.passes, options.whole)
        if program.extents != before.program.extents:
            return None
    return reschedule(before, program, library)


def _schedule_region(
    options: PlanOptions,
    before: ScheduleRecord | None,
    whole: ScheduleRecord,
    region: Region,
    cached_keys: Container[str],
    library: Library,
) -> ScheduleRecord:
    """Schedule a region of a plan. Which part of a picture is read may depend on numbers, so it is found each time."""
    cached_refs = {ref for ref, key in whole.keys.items() if key in cached_keys}
    program = focus_program(whole.program, whole.passes, region, cached_refs)
    has_same_windows = before and before.passes is whole.passes and before.program.windows == program.windows
    rescheduled = reschedule(before, program, library) if before and has_same_windows else None
    return rescheduled or schedule(program, whole.passes, library, options.target, options.precision, options.halves)


def _plan_tiling(options: PlanOptions, scheduled: ScheduleRecord, library: Library) -> Tiling | None:
    return plan_tiling(
        scheduled.program,
        scheduled.passes,
        scheduled.texels,
        library,
        options.target,
        options.precision,
        options.halves,
        scheduled.keys,
        options.by_rows,
    )


def compile_graph(
    graph: Graph,
    request: Request,
    provider: ResourceProvider,
    *,
    target: Target = NULL,
    precision: Precision | None = None,
    library: Library | None = None,
    fusion: bool = True,
) -> Plan:
    """Compile the requested outputs of `graph` for `target`.

    Raises GraphError for a graph that cannot be rendered, InputError (from `outside`) for a file that cannot
    be read, DeviceError for one that is too large, ShaderError for a node and its GLSL that do not agree.
    """
    return Planner().plan(graph, request, provider, target=target, precision=precision, library=library, fusion=fusion)


def examine(graph: Graph, request: Request, provider: ResourceProvider, target: Target = NULL) -> None:
    """Raise the errors of `compile_graph` in a fraction of its time: no program is written.

    After lowering only sizes can be at fault. Where no operation is too large for a device by itself, no pass is.
    """
    library = graph_library(graph, provider)
    samples = lower_samples(graph, request, library, provider)
    for op in samples.ops:
        library.closure(op.files, op.owner)
    if operations_fit(samples, target):
        return
    program = lower(graph, request, library, provider).program
    passes, precision = rewrite_passes(program, fuse(program, target), target, library), target.precision
    texels = choose_formats(program, passes, target, precision, request.halves)
    plan_tiling(program, passes, texels, library, target, precision, request.halves)


def graph_library(graph: Graph, provider: ResourceProvider, library: Library | None = None) -> Library:
    """The shaders that a graph can use: the installed ones for its working space, and those of its custom nodes."""
    working = provider.find_working_space(color_settings(graph)) if graph.settings.color.working else None
    return (library or load_library()).with_working_space(working).with_texts(find_custom_texts(graph))


def _fill_pixels(plan: Plan, bindings: Mapping[str, Picture]) -> Plan:
    """The plan with the arrays that are bound to inputs."""
    pixels = {item.path: item.pixels for item in bindings.values() if item.in_memory}

    def fill_picture(picture: Picture) -> Picture:
        there = not picture.in_memory or picture.pixels is not None
        return picture if there else replace(picture, pixels=pixels.get(picture.path))

    uploads = tuple(replace(item, picture=fill_picture(item.picture)) for item in plan.uploads)
    if plan.tiling is None:
        return replace(plan, uploads=uploads)
    program = plan.tiling.program
    ops = tuple(op.with_pictures(fill_picture) for op in program.ops)
    tiling = replace(plan.tiling, program=replace(program, ops=ops))
    return replace(plan, uploads=uploads, tiling=tiling)
