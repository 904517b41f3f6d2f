"""Keys of pictures: equal keys mean equal pixels. Everything that they depend on is hashed, and nothing else."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence, Set
from hashlib import blake2b

from .emit import Emitted, emit
from .fuse import Fused
from .ir import Foreign, Held, History, Op, Program, Raster, Read, Ref
from .library import Library
from .rewrites import alone
from .target import Target

Mark = tuple[Fused, str]
"""A pass that makes one thing, and a hash of all that decides it but the pictures that it reads."""


def marks_of(
    program: Program, fused: Fused, item: Emitted, library: Library, target: Target, texels: Mapping[Ref, str]
) -> tuple[Mark, ...]:
    """What decides the pictures of a pass.

    Those of a merged pass have the keys that they would have alone: what changes one leaves the others as they are.
    """
    found: list[Mark] = []
    for one in alone(program, fused):
        text = item if one is fused else emit(program, one, library, target, texels)
        drawn = _digest(program.ops[one.root])
        found.append((one, _hash(text.shader.source, text.uniforms, text.weights, drawn)))
    return tuple(found)


def keys_of(program: Program, marks: Sequence[tuple[Mark, ...]], needed: Iterable[Ref]) -> dict[Ref, str]:
    """The key of every picture. `marks` are those of all passes."""
    keys: dict[Ref, str] = {}
    update(keys, program, needed, marks, range(len(marks)))
    return keys


def update(
    keys: dict[Ref, str], program: Program, sources: Iterable[Ref], marks: Sequence[tuple[Mark, ...]],
    changed: Iterable[int],
) -> Set[Ref]:
    """Bring `keys` up to date where some `sources`, or the marks of the passes that `changed`, are others.

    Returns the pictures that have other keys than before.
    """
    fresh: set[Ref] = set()

    def enter(ref: Ref, key: str) -> None:
        if keys.get(ref) != key:
            keys[ref] = key
            fresh.add(ref)

    for ref in sources:
        op = program.ops[ref.op]
        if isinstance(op, Read):
            enter(ref, _hash("read", op.fingerprint, op.picture, op.half, *_window(program, ref)))
        elif isinstance(op, Held):
            enter(ref, _hash("held", op.keys[ref.output], *_window(program, ref)))
        elif isinstance(op, History):
            enter(ref, op.key)
    others = frozenset(changed)
    for number, found in enumerate(marks):
        for one, mark in found:
            if number in others or not fresh.isdisjoint(one.reads):
                made = _hash(mark, *(keys[ref] for ref in one.reads))
                for place, ref in enumerate(one.writes):
                    enter(ref, f"{made}.{place}")
    return fresh


def _window(program: Program, ref: Ref) -> tuple[object, ...]:
    """Which part of a picture it is, where it is not whole."""
    return (program.windows[ref],) if ref in program.windows else ()


def _digest(op: Op) -> str:
    """What is drawn, where that is neither text nor a picture."""
    if isinstance(op, Foreign):
        return repr(op.text.vertex)
    return op.mesh.digest if isinstance(op, Raster) else ""


def _hash(*parts: object) -> str:
    return blake2b("\0".join(str(part) for part in parts).encode(), digest_size=16).hexdigest()
