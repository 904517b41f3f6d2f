"""JSON <-> Graph: strict reading, canonical writing, whole-or-nothing saving."""

from __future__ import annotations

from .migrations import FORMAT, MIGRATIONS
from .reading import load, loads
from .writing import dumps, save

__all__ = ["FORMAT", "MIGRATIONS", "dumps", "load", "loads", "save"]
