"""A document that a person works on: every thing that can be done to it is a method of `Session`."""

from __future__ import annotations

from ..state.history import History
from .session import Session

__all__ = ["History", "Session"]
