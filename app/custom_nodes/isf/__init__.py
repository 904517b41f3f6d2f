"""Shaders in the Interactive Shader Format as nodes."""

from __future__ import annotations

from .node import make_isf_class

__all__ = ["make_isf_class"]
