"""Two or three versions of a graph: what differs between them, and one graph that holds what both sides did."""

from __future__ import annotations

from .aligning import Renamed
from .conflicts import SIDES, Conflict, Side, conflicts_of, resolved
from .difference import Change, Difference, applied, difference
from .merging import Merged, merged
from .parts import ABSENT, At, path_of, plain
from .telling import Line, facts, told

__all__ = [
    "ABSENT",
    "SIDES",
    "At",
    "Change",
    "Conflict",
    "Difference",
    "Line",
    "Merged",
    "Renamed",
    "Side",
    "applied",
    "conflicts_of",
    "difference",
    "facts",
    "merged",
    "path_of",
    "plain",
    "resolved",
    "told",
]
