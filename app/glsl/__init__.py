"""GLSL as text: what can be known of shader code without a driver."""

from __future__ import annotations

from .text import COMMENT, GlslFunction, Text, blank_comments, macro_name, parse, unify_lines, words

__all__ = ["COMMENT", "GlslFunction", "Text", "blank_comments", "macro_name", "parse", "unify_lines", "words"]
