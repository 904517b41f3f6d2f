"""Finds out whether a picture of a graph is a function of the color of one input, pixel by pixel."""

from __future__ import annotations

from collections.abc import Iterator

from ..compiler.ir import Call, ColorCall, Convolve, Gather, HistoryRead, LoweredProgram, Op, Raster, Reduce, Ref
from ..compiler.library import Library
from ..errors import GraphError, describe_owner

_PLACES = frozenset({"pixel", "extent", "grid"})
"""The words by which a pointwise function knows where its pixel is."""

_REASONS: dict[type[Op], str] = {
    Gather: "reads other pixels",
    Convolve: "reads other pixels",
    Reduce: "measures the whole picture",
    HistoryRead: "remembers earlier frames",
    Raster: "draws meshes",
}


def find_color_input(program: LoweredProgram, target: Ref, library: Library) -> str:
    """The input of the graph whose color alone decides `target`.

    Raises GraphError that names the node, and says why it is no function of color.
    """
    inputs: set[str] = set()
    for number in _list_upstream(program, target):
        op = program.ops[number]
        picture = op.find_upload(0)
        if picture and op.owner.startswith("inputs.") and picture.in_memory:
            inputs.add(op.owner.removeprefix("inputs."))
        elif reason := _find_reason(op, library):
            raise GraphError(
                f"{describe_owner(op.owner)} {reason}, and a table holds a function of color alone: mute the node, or "
                "export only nodes of color with --select",
                node=op.owner,
            )
    if len(inputs) != 1:
        names = f"inputs {', '.join(sorted(inputs))}" if inputs else "no input"
        raise GraphError(f"the picture depends on {names}: a table needs exactly one picture that it changes")
    return inputs.pop()


def _list_upstream(program: LoweredProgram, target: Ref) -> list[int]:
    """The operations that a picture is made of, the first one first."""
    needed, pending = set[int](), [target.op]
    while pending:
        number = pending.pop()
        if number not in needed:
            needed.add(number)
            pending += [ref.op for ref in program.ops[number].reads()]
    return sorted(needed)


def _find_reason(op: Op, library: Library) -> str:
    """Why an operation is no function of color; "" if it is one."""
    for kind, reason in _REASONS.items():
        if isinstance(op, kind):
            return reason
    if isinstance(op, ColorCall):
        return ""
    if not isinstance(op, Call):
        picture = op.find_upload(0)
        return f"reads the file '{picture.path}'" if picture and not picture.in_memory else "reads another picture"
    words = frozenset(_list_words(op, library))
    if "frame" in words:
        return "changes with every frame"
    return "depends on the place in the picture" if words & _PLACES else ""


def _list_words(op: Call, library: Library) -> Iterator[str]:
    yield from library.find_words(op.shader, op.function, op.owner)
