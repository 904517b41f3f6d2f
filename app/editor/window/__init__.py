"""The window that hosts the panels."""

from __future__ import annotations

from .opening import open_window

__all__ = ["open_window"]
