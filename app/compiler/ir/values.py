"""What operations are made of: references to pictures, numbers, choices, and what pictures look like."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from halation.nodes import Size
from msgspec import Struct
from msgspec.structs import force_setattr

from ..areas import Neighborhood, Region


class PictureShape(Struct, frozen=True, gc=False):
    """Size and channels of a picture. `data` (depth, ids, measurements) always keeps 32 bits.

    `data` is a part of the identity of an operation, though no pixel depends on it where colors have 32 bits as well:
    equal keys then mean equal operations, and two results of one pass never share a texture.
    """

    size: Size
    channels: int
    data: bool


class Memory(Struct, frozen=True):
    """A picture that a node keeps for the next frame: its key, its shape, and whether it is in half floats."""

    key: str
    shape: PictureShape
    half: bool
    data_window: Region | None = None
    """The pixels that it has, where they are more than its frame."""


class Ref(Struct, frozen=True):
    """One output of one operation."""

    op: int
    output: int = 0


class UniformConstant(Struct, frozen=True):
    """A number or vector that becomes a uniform: it never changes the shader's text."""

    value: float | int | bool | tuple[float, ...]

    def __post_init__(self) -> None:
        # Operations that are equal must compute the same: -0.0 == 0.0, but not to a shader. Adding 0 leaves one zero.
        plain = self.value
        if isinstance(plain, tuple):
            force_setattr(self, "value", tuple(part + 0 for part in plain))
        elif not plain or plain is True:
            force_setattr(self, "value", plain + 0)

    @property
    def channels(self) -> int:
        return len(self.value) if isinstance(self.value, tuple) else 1

    @property
    def blank(self) -> UniformConstant:
        """Zeros in its place: passes depend on how many channels a constant has, and on nothing else of it."""
        return UniformConstant((0.0,) * self.channels)


class PlannedObject(UniformConstant, frozen=True, kw_only=True):
    """An object of a planned kind, such as a camera, for the `passes` of nodes; None if there is none.

    It reaches no shader as it is: the number is never read.
    """

    content: object | None = None
    value: float | int | bool | tuple[float, ...] = 0.0


class Choice(Struct, frozen=True):
    """An index that is part of the shader's text: another choice is another program."""

    index: int


Operand = Ref | UniformConstant


class Parameter(Struct, frozen=True, gc=False):
    """One argument of a GLSL function. A wired value is clamped to its hard range, then brought to working units."""

    glsl: str
    operand: Ref | UniformConstant | Choice
    factor: float = 1.0
    low: float = float("-inf")
    high: float = float("inf")


class Accessor(Struct, frozen=True, gc=False):
    """A picture that a function reads anywhere, or only `around` a place, through `<name>_at` and `<name>_near`."""

    name: str
    glsl: str
    operand: Ref | UniformConstant
    around: Neighborhood | None = None

    identity_exclude: ClassVar[Mapping[str, str]] = {
        "around": "it says which part of a picture must be there, and never what is read of it"
    }
