"""Last stage: formats, keys, lives and slots; the plan."""

from __future__ import annotations

from collections.abc import Mapping
from hashlib import blake2b
from types import MappingProxyType

from ...nodes import Size
from ..errors import DeviceError
from .emit import Emitted, emit
from .fuse import Fused, kept_refs
from .ir import Call, Foreign, Gather, History, Memory, Op, Program, Raster, Read, Ref, Shape
from .library import Library
from .plan import Depth, Pass, Plan, Surface, Upload, texel, texture_bytes
from .target import Precision, Target


def schedule(
    program: Program, passes: tuple[Fused, ...], library: Library, target: Target, precision: Precision
) -> Plan:
    """Write the program of every pass, and find a texture for everything it makes."""
    needed = check_limits(program, passes, target)
    texels = {ref: _texel(program, ref, precision) for ref in needed}
    emitted = [emit(program, fused, library, target, texels) for fused in passes]
    keys = _keys(program, passes, emitted, needed)
    first, last = _lives(program, passes)
    slots, sizes = _slots(program, needed, texels, first, last)
    numbers = {ref: number for number, ref in enumerate(needed)}
    surfaces = tuple(
        Surface(
            keys[ref], program.ops[ref.op].owner, (shape := _shape(program, ref)).size, shape.channels,
            _depth(texels[ref]), slots[ref], first[ref], last[ref],
        )
        for ref in needed
    )
    return Plan(
        target, surfaces, tuple(_uploads(program, numbers)),
        tuple(_pass(program, fused, item, numbers, library) for fused, item in zip(passes, emitted, strict=True)),
        MappingProxyType({name: numbers[ref] for name, ref in program.outputs.items()}),
        MappingProxyType({port: numbers[ref] for port, ref in program.results.items() if ref in numbers}),
        program.cameras,
        MappingProxyType({
            node: Memory(keys[ref], _shape(program, ref), texels[ref].endswith("16f"))
            for node, ref in program.memories.items()
        }),
        sizes,
    )


def check_limits(program: Program, passes: tuple[Fused, ...], target: Target) -> dict[Ref, None]:
    """Raise DeviceError for what the target cannot hold. Returns all that needs a texture."""
    needed = dict.fromkeys(ref for fused in passes for ref in (*fused.reads, *fused.writes))
    needed |= dict.fromkeys(kept_refs(program))
    for ref in needed:
        _check_size(program.ops[ref.op].shapes[ref.output].size, program.ops[ref.op].owner, target)
    for fused in passes:
        _check_outputs(len(fused.writes), program.ops[fused.root], target)
    return needed


def _shape(program: Program, ref: Ref) -> Shape:
    return program.ops[ref.op].shapes[ref.output]


def _check_size(size: Size, owner: str, target: Target) -> None:
    if max(size) > target.max_size:
        raise DeviceError(
            f"node '{owner}': {size[0]}x{size[1]} pixels is more than the {target.max_size} that {target.renderer} "
            "can hold on a side; render smaller with --scale or --size", node=owner,
        )


def _check_outputs(count: int, op: Op, target: Target) -> None:
    by_image = target.form == "compute" and not isinstance(op, Foreign | Raster)
    most = target.max_images if by_image else target.max_targets
    if count > most:
        raise DeviceError(
            f"node '{op.owner}': {target.renderer} writes {most} pictures at once, not {count}; "
            "link fewer of its outputs", node=op.owner,
        )


def _texel(program: Program, ref: Ref, precision: Precision) -> str:
    """As narrow as the data allows: data keeps 32 bits, a file of halves stays half, color follows the precision."""
    op, shape = program.ops[ref.op], _shape(program, ref)
    half = op.half if isinstance(op, (Read, History)) else precision == "half" and not shape.data
    return texel(shape.channels, half)


def _depth(format: str) -> Depth:
    return "f2" if format.endswith("16f") else "f4"


def _keys(
    program: Program, passes: tuple[Fused, ...], emitted: list[Emitted], needed: Mapping[Ref, None]
) -> dict[Ref, str]:
    """Equal keys mean equal pixels: everything that they depend on is hashed, and nothing else."""
    keys: dict[Ref, str] = {}
    for ref in needed:
        op = program.ops[ref.op]
        if isinstance(op, Read):
            keys[ref] = _hash("read", op.fingerprint, op.picture, op.half)
        elif isinstance(op, History):
            keys[ref] = op.key
    for fused, item in zip(passes, emitted, strict=True):
        inputs = [keys[ref] for ref in fused.reads]
        made = _hash(item.shader.source, item.uniforms, item.weights, inputs, _digest(program.ops[fused.root]))
        for number, ref in enumerate(fused.writes):
            keys[ref] = f"{made}.{number}"
    return keys


def _digest(op: Op) -> str:
    """What is drawn, where that is neither text nor a picture."""
    if isinstance(op, Foreign):
        return repr(op.text.vertex)
    return op.mesh.digest if isinstance(op, Raster) else ""


def _hash(*parts: object) -> str:
    return blake2b("\0".join(str(part) for part in parts).encode(), digest_size=16).hexdigest()


def _lives(program: Program, passes: tuple[Fused, ...]) -> tuple[dict[Ref, int], dict[Ref, int]]:
    """The pass that makes each surface, or that reads an upload first; and the pass that reads it last."""
    first: dict[Ref, int] = {}
    last: dict[Ref, int] = {}
    for index, fused in enumerate(passes):
        for ref in (*fused.writes, *fused.reads):
            first.setdefault(ref, index)
            last[ref] = index
    for ref in kept_refs(program):
        first.setdefault(ref, len(passes))
        last[ref] = len(passes)
    return first, last


def _slots(
    program: Program, needed: Mapping[Ref, None], texels: Mapping[Ref, str],
    first: Mapping[Ref, int], last: Mapping[Ref, int],
) -> tuple[dict[Ref, int], tuple[int, ...]]:
    """Give each surface a texture; one is free for another of its size and format after its last reader."""
    slots: dict[Ref, int] = {}
    bytes_: list[int] = []
    free: dict[tuple[Size, str], list[int]] = {}
    by_start = sorted(needed, key=lambda ref: (first[ref], ref.op, ref.output))
    by_end = sorted(needed, key=lambda ref: (last[ref], ref.op, ref.output))
    ended = 0
    for ref in by_start:
        while ended < len(by_end) and last[by_end[ended]] < first[ref]:
            gone = by_end[ended]
            if gone in slots:
                free.setdefault((_shape(program, gone).size, texels[gone]), []).append(slots[gone])
            ended += 1
        kind = (_shape(program, ref).size, texels[ref])
        if free.get(kind):
            slots[ref] = free[kind].pop()
            continue
        slots[ref] = len(bytes_)
        bytes_.append(texture_bytes(*kind))
    return slots, tuple(bytes_)


def _uploads(program: Program, numbers: Mapping[Ref, int]) -> list[Upload]:
    found: list[Upload] = []
    for ref, number in numbers.items():
        op = program.ops[ref.op]
        if isinstance(op, Read):
            found.append(Upload(number, op.picture, op.owner))
    return found


def _pass(
    program: Program, fused: Fused, item: Emitted, numbers: Mapping[Ref, int], library: Library
) -> Pass:
    ops = [program.ops[index] for index in fused.members]
    return Pass(
        tuple(dict.fromkeys(owner for op in ops for owner in op.owners)), tuple(op.label for op in ops), item.shader,
        tuple(numbers[ref] for ref in fused.reads), tuple(numbers[ref] for ref in fused.writes),
        item.uniforms, item.weights, item.groups,
        tuple(dict.fromkeys(table for op in ops if isinstance(op, Call) for table in op.tables)),
        next((op.mesh for op in ops if isinstance(op, Raster)), None), _writers(ops, library),
    )


def _writers(ops: list[Op], library: Library) -> dict[str, str]:
    """The nodes behind code that users wrote, by what messages call its file."""
    calls = (op for op in ops if isinstance(op, (Call, Gather)))
    found = {library.file(op.shader): op.owner for op in calls if op.shader.startswith("written/")}
    for op in ops:
        if isinstance(op, Foreign):
            found |= {stage.file: op.owner for stage in (op.text.fragment, op.text.vertex) if stage}
    return found
