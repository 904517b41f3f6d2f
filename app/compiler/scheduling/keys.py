"""Keys of pictures: equal keys mean equal pixels. Everything that they depend on is hashed, and nothing else."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence, Set
from hashlib import blake2b

from ..codegen.emit import EDGES, Emitted
from ..fusion.fuse import PassGroup
from ..fusion.rewrites import alone
from ..ir import (
    Call,
    Constant,
    Convolve,
    ExternalProgram,
    Gather,
    Held,
    History,
    Op,
    Parameter,
    Program,
    Raster,
    Read,
    Reduce,
    Ref,
)
from ..library import Library
from ..target import Target

Mark = tuple[PassGroup, str]
"""A pass that makes one thing, and a hash of all that decides it but the pictures that it reads."""


class Marks:
    """Finds what decides the pictures of passes: the functions that they call, with what, and what these read.

    Texts are hashed once for each function, not for each pass. Equal marks mean equal programs, set to equal values.
    """

    def __init__(self, program: Program, library: Library, target: Target, texels: Mapping[Ref, str]) -> None:
        self._program, self._library, self._texels = program, library, texels
        self._device = (target.form, target.rounds_halves)
        self._told: dict[int, str] = {}

    def of(self, fused: PassGroup, item: Emitted) -> tuple[Mark, ...]:
        """The marks of a pass, of which `item` is the program.

        Those of a merged pass have the keys that they would have alone: what changes one leaves the others as they are.
        """
        root = self._program.ops[fused.root]
        if isinstance(root, ExternalProgram | Raster):
            drawn = root.mesh.digest if isinstance(root, Raster) else root.text.vertex
            return ((fused, _hash(item.shader.source, item.uniforms, drawn, *self._texels_of(fused.writes))),)
        return tuple((one, self._mark(one)) for one in alone(self._program, fused))

    def _mark(self, one: PassGroup) -> str:
        ops, told, found = self._program.ops, self._told, list[object]()
        places = {ref: number for number, ref in enumerate(one.reads)}
        for index in one.members:
            op = ops[index]
            if index not in told:
                told[index] = repr(self._tell(op))
            found += (told[index], *(places[ref] for ref in op.reads()))
            for output in range(len(op.shapes)):
                places[Ref(index, output)] = len(places)
        return _hash(
            self._device,
            *found,
            *(places[ref] for ref in one.writes),
            *self._texels_of((*one.reads, *one.writes)),
        )

    def _texels_of(self, refs: Iterable[Ref]) -> list[object]:
        """What pictures look like on the device."""
        program, texels = self._program, self._texels
        return [(*program.shape(ref).size, texels[ref], *_window(program, ref)) for ref in refs]

    def _tell(self, op: Op) -> list[object]:
        """All that an operation is but the pictures that it reads."""
        found = [(*shape.size, shape.channels) for shape in op.shapes]
        if isinstance(op, Convolve):
            files = self._library.digest((EDGES,), op.owner)
            return [*found, files, op.axis, op.weights, op.stride, op.origin, op.edge]
        if isinstance(op, Reduce):
            return [*found, op.operation]
        assert isinstance(op, Call | Gather)
        found += [op.function, *(part for item in op.parameters for part in _parameter(item))]
        if isinstance(op, Gather):
            found += [self._library.digest((EDGES, op.shader), op.owner), op.edge]
            found += [
                (item.name, item.glsl, _plain(item.operand) if isinstance(item.operand, Constant) else None)
                for item in op.accessors
            ]
        elif op.program:
            return found
        else:
            found.append(self._library.digest((op.shader,), op.owner))
        asked = self._library.asked(op.shader, op.function, op.owner)
        numbers = {"proxy": self._program.scale, "frame": self._program.frame}
        return [*found, op.choices, *(numbers[name] for name in sorted(asked))]


def _parameter(item: Parameter) -> tuple[object, ...]:
    if isinstance(item.operand, Constant):
        return (item.glsl, _plain(item.operand))
    if isinstance(item.operand, Ref):
        return (item.glsl, item.factor, item.low, item.high)
    return ("choice", item.operand.index)


def _plain(item: Constant) -> object:
    """A number that is spelled as all are that equal it."""
    return tuple(map(float, item.value)) if isinstance(item.value, tuple) else float(item.value)


def keys_of(program: Program, marks: Sequence[tuple[Mark, ...]], needed: Iterable[Ref]) -> dict[Ref, str]:
    """The key of every picture. `marks` are those of all passes."""
    keys: dict[Ref, str] = {}
    update(keys, program, needed, marks, range(len(marks)))
    return keys


def update(
    keys: dict[Ref, str],
    program: Program,
    sources: Iterable[Ref],
    marks: Sequence[tuple[Mark, ...]],
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


def _hash(*parts: object) -> str:
    return blake2b("\0".join(str(part) for part in parts).encode(), digest_size=16).hexdigest()
