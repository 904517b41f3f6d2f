"""Socket kinds: what travels on links. One table declares everything that the rest of the code needs of a kind.

A kind is carried in one of three ways, which decides how it is lowered:

- `pixels`: a texture of the picture's size. GLSL reads it; sizes are made to fit.
- `value`: one value for the whole picture, a constant or a texture of one pixel. GLSL reads it as a parameter.
- `plan`: an object that is known while the plan is made and that never becomes a texture. Only `Filter.passes` sees it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import StrEnum
from types import MappingProxyType
from typing import Literal

from msgspec import Struct

from .camera import read_camera


class Kind(StrEnum):
    """What travels on a link. The value is the name of the type in graph files."""

    IMAGE = "Image"
    FIELD = "Field"
    VECTOR = "Vector"
    NUMBER = "Number"
    COLOR = "Color"
    CAMERA = "Camera"

    @property
    def facts(self) -> KindFacts:
        """The declaration of the kind."""
        return KINDS[self]

    @property
    def is_color(self) -> bool:
        """True for color and light, to which views and color spaces apply. The numbers of all other kinds are data."""
        return self.facts.is_color

    @property
    def is_single(self) -> bool:
        """True for one value for the whole picture instead of one per pixel."""
        return self.facts.carried != "pixels"

    @property
    def is_planned(self) -> bool:
        """True for an object that is known while the plan is made, and is never drawn."""
        return self.facts.carried == "plan"


class KindFacts(Struct, frozen=True):
    """The declaration of a kind."""

    carried: Literal["pixels", "value", "plan"]
    channels: int
    """How many numbers it is per pixel, and as a `default` in a graph file; those of a Vector vary."""
    doc: str
    """What the editor's legend says."""
    is_color: bool = False
    """Whether it is color or light, to which views and color spaces apply, and not data."""
    fits: frozenset[Kind] = frozenset()
    """The kinds of other inputs that it may be linked to, because nothing is lost."""
    noun: str = "picture"
    """What messages call it."""
    read: Callable[[tuple[float, ...]], object | None] | None = None
    """For a planned kind: the object that its numbers in a graph file stand for; None where they stand for nothing."""


KINDS: Mapping[Kind, KindFacts] = MappingProxyType(
    {
        Kind.IMAGE: KindFacts("pixels", 4, "a picture: red, green, blue, alpha", is_color=True),
        Kind.FIELD: KindFacts(
            "pixels", 1, "one channel: depth, mask, occlusion", fits=frozenset({Kind.IMAGE, Kind.VECTOR})
        ),
        Kind.VECTOR: KindFacts("pixels", 4, "data of 2 to 4 channels: normal, velocity"),
        Kind.NUMBER: KindFacts(
            "value",
            1,
            "one number for the whole picture",
            fits=frozenset({Kind.IMAGE, Kind.FIELD, Kind.VECTOR, Kind.COLOR}),
        ),
        Kind.COLOR: KindFacts(
            "value", 4, "one color for the whole picture", is_color=True, fits=frozenset({Kind.IMAGE})
        ),
        Kind.CAMERA: KindFacts("plan", 12, "the camera that a picture was taken with", noun="camera", read=read_camera),
    }
)
"""Every kind and its declaration."""
