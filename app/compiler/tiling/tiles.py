"""How a program is run tile by tile: see `tiling`."""

from __future__ import annotations

from collections.abc import Mapping

from msgspec import Struct

from ..areas import Region
from ..fusion.fuse import PassGroup
from ..ir import LoweredProgram, Ref
from ..library import Library
from ..target import Precision, Target


class TileStage(Struct, frozen=True):
    """Pictures of one size that are made together, and the passes that make them of what the stages before made.

    `windows` are the regions of everything for each of the `tiles`; what is not there is whole.
    """

    outputs: Mapping[str, Ref]
    passes: tuple[PassGroup, ...]
    tiles: tuple[Region, ...]
    windows: tuple[Mapping[Ref, Region], ...]


class Tiling(Struct, frozen=True):
    """What is made before, because something may read all of it for one pixel, and at last the outputs.

    `nbytes` is what textures and pictures take at once, at most. `why` says in a sentence what does not fit. Outputs
    `by_rows` are handed over whenever all tiles of some rows are made.
    """

    program: LoweredProgram
    library: Library
    target: Target
    precision: Precision
    halves: frozenset[str]
    keys: Mapping[Ref, str]
    before: tuple[TileStage, ...]
    last: tuple[TileStage, ...]
    nbytes: int
    why: str
    by_rows: frozenset[str] = frozenset()

    @property
    def stages(self) -> tuple[TileStage, ...]:
        """All of them, in order."""
        return (*self.before, *self.last)

    @property
    def total(self) -> int:
        """How many passes run."""
        return sum(len(stage.passes) * len(stage.tiles) for stage in self.stages)
