"""JSON <-> Graph: strict reading, canonical writing, whole-or-nothing saving."""

from __future__ import annotations

from .migrations import FORMAT, MIGRATIONS
from .reading import load, loads
from .writing import dump_readable, dumps, find_first_difference, save

__all__ = ["FORMAT", "MIGRATIONS", "dump_readable", "dumps", "find_first_difference", "load", "loads", "save"]
