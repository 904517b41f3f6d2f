"""The document that the user works on, and the one way to change it."""

from __future__ import annotations

from .session import Session

__all__ = ["Session"]
