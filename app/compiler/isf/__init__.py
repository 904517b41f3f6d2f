"""Graphs as shaders in the Interactive Shader Format."""

from __future__ import annotations

from .export import IsfExport, export_isf

__all__ = ["IsfExport", "export_isf"]
