"""What of an operation is but a number: a uniform, which decides neither what passes there are nor their text."""

from __future__ import annotations

from functools import singledispatch

from msgspec.structs import replace

from ..ir import (
    Accessor,
    Call,
    Constant,
    Convolve,
    ExternalProgram,
    Gather,
    History,
    Op,
    Operand,
    Parameter,
    Program,
    Raster,
    Read,
)
from ..lowering.transforms import Placed


def differing(before: Program, after: Program) -> set[int] | None:
    """The operations that are others, where two programs differ in numbers alone; None where they differ in more."""
    same = (
        len(before.ops) == len(after.ops)
        and before.outputs == after.outputs
        and before.memories == after.memories
        and before.scale == after.scale
        and (before.results is after.results or before.results == after.results)
    )
    found = (
        {at for at, (old, new) in enumerate(zip(before.ops, after.ops, strict=True)) if old is not new and old != new}
        if same
        else set[int]()
    )
    return found if same and all(alike(before.ops[at], after.ops[at]) for at in found) else None


def alike(one: Op, other: Op) -> bool:
    """True if two operations differ in numbers alone."""
    return type(one) is type(other) and one.owners == other.owners and without(one) == without(other)


@singledispatch
def without(op: Op) -> Op:
    """An operation without its numbers. Which picture or memory it brings in from outside is but a number too."""
    return op


@without.register
def _(op: Call) -> Op:
    return replace(op, parameters=_parameters(op.parameters))


@without.register
def _(op: Gather) -> Op:
    return replace(op, accessors=_accessors(op), parameters=_parameters(op.parameters))


@without.register
def _(op: Placed) -> Op:
    return replace(op, accessors=_accessors(op), parameters=_parameters(op.parameters), matrix=(0.0,) * 6)


@without.register
def _(op: Convolve) -> Op:
    return replace(op, weights=(), origin=0)


@without.register
def _(op: ExternalProgram) -> Op:
    return replace(op, uniforms=tuple((name, Constant((0.0,) * item.channels)) for name, item in op.uniforms))


@without.register
def _(op: Raster) -> Op:
    return replace(op, cameras=(), motions=(), near=0.0)


@without.register
def _(op: Read) -> Op:
    return replace(op, picture=replace(op.picture, path="", layer="", frame=1, space="", within=""), fingerprint="")


@without.register
def _(op: History) -> Op:
    return replace(op, key="")


def _accessors(op: Gather) -> tuple[Accessor, ...]:
    return tuple(Accessor(item.name, item.glsl, _blank(item.operand)) for item in op.accessors)


def _parameters(found: tuple[Parameter, ...]) -> tuple[Parameter, ...]:
    return tuple(
        replace(item, operand=_blank(item.operand)) if isinstance(item.operand, Constant) else item for item in found
    )


def _blank(item: Operand) -> Operand:
    """Only how many channels a constant has may decide anything."""
    return Constant((0.0,) * item.channels) if isinstance(item, Constant) else item
