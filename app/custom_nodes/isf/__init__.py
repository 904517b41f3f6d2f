"""Shaders in the Interactive Shader Format as nodes."""

from __future__ import annotations

from .node import isf_node

__all__ = ["isf_node"]
