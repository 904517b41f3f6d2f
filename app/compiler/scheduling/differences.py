"""Tells whether two programs differ only in numbers: uniforms, on which neither the passes nor their texts depend."""

from __future__ import annotations

from ..ir import LoweredProgram, Op


def find_changed_numbers(before: LoweredProgram, after: LoweredProgram) -> set[int] | None:
    """The operations that changed, if two programs differ only in numbers; None if they differ in more."""
    same_structure = (
        len(before.ops) == len(after.ops)
        and before.outputs == after.outputs
        and before.memories == after.memories
        and before.scale == after.scale
        and (before.results is after.results or before.results == after.results)
    )
    if not same_structure:
        return None
    pairs = enumerate(zip(before.ops, after.ops, strict=True))
    changed = {index for index, (old, new) in pairs if old is not new and old != new}
    return changed if all(differ_in_numbers(before.ops[index], after.ops[index]) for index in changed) else None


def differ_in_numbers(first: Op, second: Op) -> bool:
    """True if two operations differ only in numbers."""
    return (
        type(first) is type(second)
        and first.owners == second.owners
        and first.without_numbers() == second.without_numbers()
    )
