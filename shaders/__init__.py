"""GLSL only."""

from __future__ import annotations

from pathlib import Path


def folder() -> Path:
    """Where it lies."""
    return Path(__file__).parent
