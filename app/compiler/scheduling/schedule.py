"""Last stage: finds formats, keys, lifetimes and textures of pictures, and makes the plan."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType

from halation.nodes import Size
from msgspec import Struct
from msgspec.structs import replace

from ...errors import DeviceError, describe_owner
from ...graph import Port
from ..areas import Region
from ..codegen.emit import EmittedProgram, emit
from ..fusion.fuse import PassGroup
from ..ir import HostCall, LoweredProgram, Memory, Op, Read, Ref, SourceOp
from ..ir.pixel_aspects import find_pixel_aspects
from ..library import Library
from ..plan import Depth, HostTask, Pass, Plan, Surface, Upload, texture_bytes, texture_format
from ..target import Precision, Target
from .differences import find_changed_numbers
from .fingerprints import Fingerprint, PassFingerprints, find_keys, update_keys


class ScheduleRecord(Struct, frozen=True):
    """A plan, and the results of scheduling that the next plan may use."""

    program: LoweredProgram
    passes: tuple[PassGroup, ...]
    texels: Mapping[Ref, str]
    """Formats, in the order of the surfaces."""
    fingerprints: tuple[tuple[Fingerprint, ...], ...]
    descriptions: Mapping[int, str]
    """What the fingerprints say of operations, by their numbers: see `PassFingerprints`."""
    keys: Mapping[Ref, str]
    plan: Plan


def schedule(
    program: LoweredProgram,
    passes: tuple[PassGroup, ...],
    library: Library,
    target: Target,
    precision: Precision,
    halves: frozenset[str] = frozenset(),
) -> ScheduleRecord:
    """Write the program of every pass, and assign a texture to every picture.

    `halves` are outputs that will be rounded to half floats.
    """
    texels = choose_formats(program, passes, target, precision, halves)
    emitted = [emit(program, fused, library, target, texels) for fused in passes]
    described = PassFingerprints(program, library, target, texels)
    fingerprints = tuple(map(described.of, passes))
    keys = find_keys(program, fingerprints, texels)
    first, last = _find_lifetimes(program, passes)
    slots, sizes = _assign_slots(program, texels, texels, first, last)
    numbers = {ref: number for number, ref in enumerate(texels)}
    pixel_aspects = find_pixel_aspects(program.ops)

    def make_surface(ref: Ref) -> Surface:
        return Surface(
            keys[ref],
            program.ops[ref.op].owner,
            program.size_on_device(ref),
            program.shape(ref).channels,
            _find_depth(texels[ref]),
            slots[ref],
            first[ref],
            last[ref],
            program.window(ref),
            program.shape(ref).data,
            program.shape(ref).size,
            pixel_aspects.get(ref, 1.0),
        )

    plan = Plan(
        target,
        tuple(map(make_surface, texels)),
        tuple(_find_uploads(program, numbers)),
        tuple(_make_pass(program, fused, item, numbers, library) for fused, item in zip(passes, emitted, strict=True)),
        MappingProxyType({name: numbers[ref] for name, ref in program.outputs.items()}),
        MappingProxyType({port: numbers[ref] for port, ref in program.results.items() if ref in numbers}),
        program.cameras,
        _find_memories(program, keys, texels),
        sizes,
    )
    return ScheduleRecord(program, passes, texels, fingerprints, described.descriptions, keys, plan)


def reschedule(before: ScheduleRecord, program: LoweredProgram, library: Library) -> ScheduleRecord | None:
    """The plan of a program that differs from that of `before` only in numbers; None if it differs in more.

    The same passes make the same pictures in the same textures. Only passes with changed numbers are written again, and
    new keys are found for everything after them.
    """
    changed = find_changed_numbers(before.program, program)
    if changed is None:
        return None
    plan, target = before.plan, before.plan.target
    numbers = {ref: number for number, ref in enumerate(before.texels)}
    frame_changed = program.frame != before.program.frame
    known = (
        {} if frame_changed else {index: text for index, text in before.descriptions.items() if index not in changed}
    )
    described = PassFingerprints(program, library, target, before.texels, known)
    passes, fingerprints = [*plan.passes], [*before.fingerprints]
    surfaces, keys = [*plan.surfaces], dict(before.keys)
    changed_passes = [
        number
        for number, fused in enumerate(before.passes)
        if not changed.isdisjoint(fused.members)
        or (frame_changed and any(name == "frame" for name, _ in passes[number].uniforms))
    ]
    for number in changed_passes:
        fused = before.passes[number]
        item = emit(program, fused, library, target, before.texels)
        passes[number] = _make_pass(program, fused, item, numbers, library)
        fingerprints[number] = described.renew(fingerprints[number])
    sources = [ref for ref in numbers if ref.op in changed]
    for ref in update_keys(keys, program, sources, fingerprints, changed_passes):
        if ref in numbers:
            surfaces[numbers[ref]] = replace(surfaces[numbers[ref]], key=keys[ref])
    plan = replace(
        plan,
        surfaces=tuple(surfaces),
        uploads=tuple(_find_uploads(program, numbers)),
        passes=tuple(passes),
        cameras=program.cameras,
        memories=_find_memories(program, keys, before.texels),
    )
    return ScheduleRecord(
        program, before.passes, before.texels, tuple(fingerprints), described.descriptions, keys, plan
    )


def _find_memories(
    program: LoweredProgram, keys: Mapping[Ref, str], texels: Mapping[Ref, str]
) -> Mapping[Port, Memory]:
    return MappingProxyType(
        {
            node: Memory(keys[ref], program.shape(ref), texels[ref].endswith("16f"), program.extents.get(ref))
            for node, ref in program.memories.items()
        }
    )


def choose_formats(
    program: LoweredProgram, passes: Sequence[PassGroup], target: Target, precision: Precision, halves: frozenset[str]
) -> dict[Ref, str]:
    """The format of everything that needs a texture. Raises DeviceError for a pass that writes too many at once."""
    for fused in passes:
        _check_outputs(len(fused.writes), program.ops[fused.root], target)
    rounded = _find_rounded(program, passes, target, halves)
    return {
        ref: _choose_format(program, ref, "half" if ref in rounded else precision)
        for ref in _find_textures(program, passes)
    }


def _find_textures(program: LoweredProgram, passes: Sequence[PassGroup]) -> dict[Ref, None]:
    """The pictures that passes read and write, and those that are kept at the end."""
    needed = dict.fromkeys(ref for fused in passes for ref in (*fused.reads, *fused.writes))
    return needed | dict.fromkeys(program.kept_refs)


def count_peak_bytes(program: LoweredProgram, passes: Sequence[PassGroup], texels: Mapping[Ref, str]) -> int:
    """Bytes of all textures that passes need at the same time."""
    first, last = _find_lifetimes(program, passes)
    return sum(_assign_slots(program, _find_textures(program, passes), texels, first, last)[1])


def _check_outputs(count: int, op: Op, target: Target) -> None:
    as_images = target.form == "compute" and not op.is_fragment_only
    most = target.max_images if as_images else target.max_targets
    if count > most:
        raise DeviceError(
            f"{describe_owner(op.owner)}: {target.name_in_sentences} writes {most} of its outputs at once, not "
            f"{count}; link fewer of its outputs",
            node=op.owner,
        )


def _choose_format(program: LoweredProgram, ref: Ref, precision: Precision) -> str:
    """As narrow as the data allows: data keeps 32 bits, a file of halves stays half, color follows the precision."""
    op, shape = program.ops[ref.op], program.shape(ref)
    half = op.is_half(ref.output) if isinstance(op, SourceOp) else precision == "half" and not shape.data
    return texture_format(shape.channels, half)


def _find_rounded(
    program: LoweredProgram, passes: Sequence[PassGroup], target: Target, halves: frozenset[str]
) -> frozenset[Ref]:
    """Outputs that are stored as half floats because nothing reads more of them, neither a pass nor the next frame."""
    if not target.rounds_halves:
        return frozenset()
    rounded = {ref for name, ref in program.outputs.items() if name in halves}
    rounded -= {ref for name, ref in program.outputs.items() if name not in halves}
    rounded -= {ref for fused in passes for ref in fused.reads}
    rounded = {ref for ref in rounded if program.ops[ref.op].rounds_halves}
    return frozenset(rounded.difference(program.memories.values()))


def _find_depth(format: str) -> Depth:
    return "f2" if format.endswith("16f") else "f4"


def _find_lifetimes(program: LoweredProgram, passes: Sequence[PassGroup]) -> tuple[dict[Ref, int], dict[Ref, int]]:
    """The pass that makes each surface, or that reads an upload first; and the pass that reads it last.

    Memories of the frame before exist from the first pass to the last.
    """
    first: dict[Ref, int] = {}
    last: dict[Ref, int] = {}
    for index, fused in enumerate(passes):
        for ref in (*fused.writes, *fused.reads):
            first.setdefault(ref, index)
            last[ref] = index
    for ref in first:
        if program.ops[ref.op].is_memory:
            first[ref], last[ref] = 0, len(passes)
    for ref in program.kept_refs:
        first.setdefault(ref, len(passes))
        last[ref] = len(passes)
    return first, last


def _assign_slots(
    program: LoweredProgram,
    needed: Iterable[Ref],
    texels: Mapping[Ref, str],
    first: Mapping[Ref, int],
    last: Mapping[Ref, int],
) -> tuple[dict[Ref, int], tuple[int, ...]]:
    """Give each surface a texture; one is free for another of its size and format after its last reader.

    As registers are given to variables by a linear scan (Poletto and Sarkar 1999): surfaces are visited by their first
    use, and those that have ended before give their textures back.
    """
    slots: dict[Ref, int] = {}
    bytes_: list[int] = []
    free: dict[tuple[Size, str], list[int]] = {}
    by_start = sorted(needed, key=lambda ref: (first[ref], ref.op, ref.output))
    by_end = sorted(needed, key=lambda ref: (last[ref], ref.op, ref.output))
    ended = 0
    for ref in by_start:
        while ended < len(by_end) and last[by_end[ended]] < first[ref]:
            ended_ref = by_end[ended]
            if ended_ref in slots:
                free.setdefault((program.size_on_device(ended_ref), texels[ended_ref]), []).append(slots[ended_ref])
            ended += 1
        kind = (program.size_on_device(ref), texels[ref])
        if free.get(kind):
            slots[ref] = free[kind].pop()
            continue
        slots[ref] = len(bytes_)
        bytes_.append(texture_bytes(*kind))
    return slots, tuple(bytes_)


def _find_uploads(program: LoweredProgram, numbers: Mapping[Ref, int]) -> list[Upload]:
    uploads: list[Upload] = []
    for ref, number in numbers.items():
        op = program.ops[ref.op]
        picture = op.find_upload(ref.output)
        if picture is not None:
            frame = Region.whole(program.shape(ref).size)
            whole = op.data_window if isinstance(op, Read) else None
            uploads.append(Upload(number, picture, op.owner, whole or frame))
    return uploads


def _make_pass(
    program: LoweredProgram, fused: PassGroup, item: EmittedProgram, numbers: Mapping[Ref, int], library: Library
) -> Pass:
    ops = [program.ops[index] for index in fused.members]
    return Pass(
        tuple(dict.fromkeys(owner for op in ops for owner in op.owners)),
        tuple(op.label for op in ops),
        item.shader,
        tuple(numbers[ref] for ref in fused.reads),
        tuple(numbers[ref] for ref in fused.writes),
        item.uniforms,
        item.weights,
        item.groups,
        tuple(dict.fromkeys(table for op in ops for table in op.tables)),
        next(filter(None, (op.mesh_drawn for op in ops)), None),
        _find_writers(ops, library),
        _find_host_task(program, fused),
    )


def _find_host_task(program: LoweredProgram, fused: PassGroup) -> HostTask | None:
    root = program.ops[fused.root]
    if not isinstance(root, HostCall):
        return None
    return HostTask(root.program, tuple((name, fused.reads.index(ref)) for name, ref in root.pictures))


def _find_writers(ops: list[Op], library: Library) -> dict[str, str]:
    """The nodes behind code that users wrote, by what messages call its file."""
    return {file: op.owner for op in ops for file in op.find_user_files(library)}
