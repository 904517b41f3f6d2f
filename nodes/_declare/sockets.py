"""Sockets: the typed inputs and outputs of nodes."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import ClassVar, Literal

from .kinds import Kind

Size = tuple[int, int]
"""Width and height in pixels."""

Edge = Literal["clamp", "mirror", "reflect", "wrap", "panorama", "black"]
"""What is read outside of a picture, by the names of scipy: clamp (nearest), mirror, reflect, wrap. Panorama is for
pictures by longitude and latitude: it goes on around the world, and across a pole on its other side. Black is
transparent."""


@dataclass(frozen=True)
class Socket:
    """A typed input. With a `default` (one number per channel, or one for all) it may stay unlinked."""

    kind: ClassVar[Kind]
    default: float | tuple[float, ...] | None = None
    doc: str = dataclasses.field(default="", kw_only=True)
    own_size: bool = dataclasses.field(default=False, kw_only=True)
    """True if a picture keeps its size; pictures of other inputs are scaled to the size of the first one."""
    folded: bool = dataclasses.field(default=False, kw_only=True)
    """True for the mask that many nodes have: interfaces show it only where it is used."""
    name: str = dataclasses.field(default="", init=False, compare=False)

    def __set_name__(self, owner: type, name: str) -> None:
        object.__setattr__(self, "name", name)

    @property
    def channels(self) -> int:
        """Floats per pixel."""
        return self.kind.facts.channels

    @property
    def optional(self) -> bool:
        """True if the socket works without a link."""
        return self.default is not None

    @property
    def single(self) -> bool:
        """True if it carries one value for the whole picture instead of one per pixel."""
        return self.kind.is_single

    @property
    def glsl(self) -> str:
        """The GLSL type of one pixel."""
        return glsl_type(self.channels)


class Image(Socket):
    """RGBA, scene-linear, premultiplied."""

    kind = Kind.IMAGE


class Field(Socket):
    """One channel of data: depth, mask, occlusion."""

    kind = Kind.FIELD


@dataclass(frozen=True)
class Vector(Socket):
    """Two to four channels of data that is not color: normal, position, velocity, uv."""

    kind = Kind.VECTOR
    width: int = dataclasses.field(default=3, kw_only=True)

    @property
    def channels(self) -> int:
        return self.width


class Number(Socket):
    """One number for the whole picture; it may be measured on the GPU."""

    kind = Kind.NUMBER


class Color(Socket):
    """One scene-linear RGBA color for the whole picture."""

    kind = Kind.COLOR


class CameraSocket(Socket):
    """The camera of a picture, as a `CameraModel`. It is known before anything is drawn, and only filters take it."""

    kind = Kind.CAMERA


@dataclass(frozen=True)
class OutputSocket:
    """An output. `socket` is its type; with `follows` it is a Field where that input of the node is fed a Field.

    Readers of a Field then get one channel in 32 bits, which is computed as every channel of a picture is. Readers of
    an Image get what the node makes of the Field as an opaque gray picture, so that what it moves into the frame is
    transparent.
    """

    socket: Socket = dataclasses.field(default_factory=Image)
    follows: str = dataclasses.field(default="", kw_only=True)
    name: str = dataclasses.field(default="", init=False, compare=False)

    def __set_name__(self, owner: type, name: str) -> None:
        object.__setattr__(self, "name", name)
        object.__setattr__(self.socket, "name", name)


def glsl_type(channels: int) -> str:
    """The GLSL type that holds `channels` floats."""
    return ("float", "vec2", "vec3", "vec4")[channels - 1]
