"""What is done to passes once operations are fused: each a function of passes that gives passes for the same pixels.

They are never undone by each other: what is computed again is not stored, so only what is stored is merged.
"""

from __future__ import annotations

from ..ir import LoweredProgram
from ..library import Library
from ..target import Target
from .fuse import PassGroup
from .merge import merge, split_by_result
from .recompute import recompute

__all__ = ["REWRITES", "rewrite_passes", "split_by_result"]

REWRITES = (recompute, merge)
"""In this order."""


def rewrite_passes(
    program: LoweredProgram, passes: tuple[PassGroup, ...], target: Target, library: Library
) -> tuple[PassGroup, ...]:
    """Fewer passes, or such that read and write less."""
    for rewrite in REWRITES:
        passes = rewrite(program, passes, target, library)
    return passes
