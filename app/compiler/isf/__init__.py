"""Graphs as shaders in the Interactive Shader Format."""

from __future__ import annotations

from .export import Exported, export_isf

__all__ = ["Exported", "export_isf"]
