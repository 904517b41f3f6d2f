"""The rewrites of passes after fusion. Each takes passes and returns others that make the same pixels.

A later rewrite never reverses an earlier one: `recompute` removes pictures, and `merge` only joins the passes that
remain.
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
"""All rewrites, in the order in which they run."""


def rewrite_passes(
    program: LoweredProgram, passes: tuple[PassGroup, ...], target: Target, library: Library
) -> tuple[PassGroup, ...]:
    """Apply all rewrites: the result has fewer passes, or passes that read and write less."""
    for rewrite in REWRITES:
        passes = rewrite(program, passes, target, library)
    return passes
