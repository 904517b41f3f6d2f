"""What the compiler is asked for: outputs, bindings, size, frame and region."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

from halation.nodes import Size
from msgspec import Struct, field

from ..errors import UsageError
from ..graph import Port
from ..resources.picture import Picture
from .areas import Region
from .ir import Memory


class Request(Struct, frozen=True):
    """Which outputs of a graph to compile, at which size and frame, and with which pictures.

    `targets` are outputs of nodes or of the graph, each by the name of its result; empty means every graph output.
    `bindings` fill graph inputs by name. `size` replaces the canvas and every picture's size; `scale` below one is a
    proxy: everything, lengths in pixels too, shrinks by it. Raises UsageError for a size or scale of nothing.
    """

    targets: Mapping[str, Port] = field(default_factory=lambda: MappingProxyType({}))
    bindings: Mapping[str, Picture] = field(default_factory=lambda: MappingProxyType({}))
    size: Size | None = None
    scale: float = 1.0
    frame: int = 1
    memories: Mapping[Port, Memory] = field(default_factory=lambda: MappingProxyType({}))
    """What temporal nodes stored in the frame before, by node and name; empty for the first frame of a sequence."""
    halves: frozenset[str] = frozenset()
    """Targets, or outputs, that will be rounded to half floats: if nothing else reads them, the device rounds them."""

    region: Region | None = None
    """The part of every output to make, in pixels as they are rendered; None for all: see `focus_program`."""
    by_rows: frozenset[str] = frozenset()
    """Targets, or outputs, that are handed over by rows, from the top down, if they are rendered in tiles."""
    whole: frozenset[str] = frozenset()
    """Targets, or outputs, of which all pixels are made, also those beyond the frame."""

    def __post_init__(self) -> None:
        if not 0.0 < self.scale < math.inf:
            raise UsageError(f"scale {self.scale:g}: give a number above 0; 0.5 renders at half size")
        if self.size is not None and (len(self.size) != 2 or min(self.size) < 1):
            raise UsageError(f"size {'x'.join(map(str, self.size))}: give width and height in pixels, at least 1")
