"""The stages and tiles in which a program is run: see `tiling`."""

from __future__ import annotations

from collections.abc import Mapping

from msgspec import Struct

from ..areas import Region
from ..fusion.fuse import PassGroup
from ..ir import LoweredProgram, Ref
from ..library import Library
from ..target import Precision, Target


class TileStage(Struct, frozen=True):
    """Pictures of one size that are made together, and their passes, which read results of earlier stages.

    `windows` has, for each of the `tiles`, the regions of all pictures that are not whole.
    """

    outputs: Mapping[str, Ref]
    passes: tuple[PassGroup, ...]
    tiles: tuple[Region, ...]
    windows: tuple[Mapping[Ref, Region], ...]


class Tiling(Struct, frozen=True):
    """The stages of a program: first pictures that some operation may read anywhere, then the outputs.

    `nbytes` are the bytes that textures and pictures take at once, at most. `why` says in a sentence what does not fit.
    Outputs in `by_rows` are handed over whenever all tiles of some rows are made.
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
