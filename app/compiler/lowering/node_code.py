"""Runs the code of a node, and says whose fault it is if that fails."""

from __future__ import annotations

from collections.abc import Mapping

from halation.nodes import CameraModel, Draw, Drawn, Filter, Pointwise, Reach, Socket, find_fault_place

from ...errors import DeviceError, GraphError, HalationError, describe_owner

PassNode = Filter | Pointwise
"""A node that is drawn in passes."""


def run_passes(node: PassNode, recorder: Draw, path: str) -> Drawn | Mapping[str, Drawn | CameraModel]:
    """What a node draws.

    Raises GraphError where the code of a plug-in fails, as users cannot tell it from ours, and DeviceError with the
    name of the node for what would take too much memory.
    """
    try:
        return node.passes(recorder)
    except DeviceError as fault:
        if fault.node:
            raise
        raise DeviceError(f"{describe_owner(path)}: {fault}", node=path) from fault
    except HalationError:
        raise
    except Exception as fault:
        place = find_fault_place(fault, type(node))
        if not node.required_package or not place:
            raise
        sentence = f"its plug-in {node.required_package} fails at {place}: {type(fault).__name__}: {fault}"
        raise GraphError(sentence, node=path) from fault


def check_options(size: object, edge: object, result: object, overlap: object) -> None:
    """Raise TypeError where an option of a draw is meant to be the parameter of the GLSL function of that name."""
    options: dict[str, tuple[object, type | tuple[type, ...], str]] = {
        "size": (size, tuple, "a width and a height"),
        "edge": (edge, str, "an edge mode"),
        "result": (result, Socket, "the type of the picture"),
        "overlap": (overlap, (int, tuple, Reach, Mapping), "how far the function reads"),
    }
    for name, (argument, expected_type, meaning) in options.items():
        if argument is not None and not isinstance(argument, expected_type):
            raise TypeError(
                f"'{name}' is an option of the draw itself, {meaning}: give the parameter of the GLSL function another "
                "name"
            )
