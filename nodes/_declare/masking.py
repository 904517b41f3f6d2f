"""The mask that every node has which changes one picture in its place: where, how much, and the opposite."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from .kinds import Kind
from .sockets import Field, OutputSocket, Socket
from .values import Doc, Folded, Slider

MASKED = "image"
"""The input that shows where the mask is 0."""

MASK = "mask"
"""The input for the mask."""

MIX, INVERT_MASK = "mix", "invert_mask"
"""The values of the mask."""


def make_mask() -> Field:
    """The input for the mask; without a link the node changes the whole picture."""
    mask = Field(1.0, doc="Where the node changes the picture, 0..1. Elsewhere the picture stays.", folded=True)
    mask.__set_name__(Field, MASK)
    return mask


def list_mask_values() -> dict[str, tuple[Any, float | bool]]:
    """The annotations and defaults of the values with which a change is mixed with the picture, by name."""
    mix = Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0, doc="How much of the change is seen; 0 is none.")
    invert = Doc("Change the picture where the mask is 0 instead.")
    return {MIX: (Annotated[float, mix, Folded()], 1.0), INVERT_MASK: (Annotated[bool, invert, Folded()], False)}


def list_own_names(cls: type, inputs: Mapping[str, Socket], outputs: Mapping[str, OutputSocket]) -> tuple[str, ...]:
    """Those names of the mask that a class declares itself, as sockets or values.

    `mask` and `invert_mask` belong together, and nobody but the node knows what a mask of its own does. So one of these
    names keeps both from being added. `mix` is added unless the class declares it.
    """
    names = {*inputs, *outputs, *getattr(cls, "__annotations__", ())}
    return tuple(name for name in (MASK, *list_mask_values()) if name in names)


def is_maskable(cls: type, inputs: Mapping[str, Socket], outputs: Mapping[str, OutputSocket], base: type) -> bool:
    """True for a class whose first output is its picture `image`, changed, at the same size."""
    image, first = inputs.get(MASKED), next(iter(outputs.values()), None)
    return (
        image is not None
        and image.kind is Kind.IMAGE
        and not image.optional
        and (first is None or first.socket.kind is Kind.IMAGE)
        and all("output_size" not in vars(parent) for parent in cls.__mro__[: cls.__mro__.index(base)])
    )
