"""The window that hosts the panels."""

from __future__ import annotations

from .starting import start_editor

__all__ = ["start_editor"]
