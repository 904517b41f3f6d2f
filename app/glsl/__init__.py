"""GLSL as text: what can be known of shader code without a driver."""

from __future__ import annotations

from .text import COMMENT, GlslFunction, Text, blanked, parse, unified, words

__all__ = ["COMMENT", "GlslFunction", "Text", "blanked", "parse", "unified", "words"]
