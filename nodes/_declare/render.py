"""What the file of a render turns out to hold."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from msgspec import Struct, field

from .camera import CameraModel


class Meaning(Struct, frozen=True):
    """How numbers of a layer are meant: times `scale` plus `offset`, channel by channel, they are of this kind.

    Depth is "planar", "radial", "inverse", "negative" or "normalized"; vectors refer to "world", "camera" (x right, y
    up, z toward the viewer) or "camera_ahead" axes; motion is "from_previous" or "to_next", in pixels, y down.
    """

    kind: str
    scale: tuple[float, ...] = (1.0,)
    offset: tuple[float, ...] = (0.0,)


class Matte(Struct, frozen=True):
    """A cryptomatte: what it tells apart ("object", "material", "asset" or ""), its layers, the most covering first.

    `ids` are those of its manifest by name, empty where the file has none: bits of the floats in the layers.
    """

    kind: str
    layers: tuple[str, ...]
    ids: Mapping[str, int]


class Render(Struct, frozen=True):
    """Names of layers and their meanings by role ("depth", "normal", ...), and the camera if anything tells it."""

    layers: Mapping[str, str]
    channels: Mapping[str, int]
    meanings: Mapping[str, Meaning] = field(default_factory=lambda: MappingProxyType[str, Meaning]({}))
    camera: CameraModel | None = None
    mattes: tuple[Matte, ...] = ()
    light_groups: Mapping[str, str] = field(default_factory=lambda: MappingProxyType[str, str]({}))
    """The layer of each group of lights, by the name of the group."""
