"""GLSL as text: what can be known of shader code without a driver.

The compiler needs little from GLSL: which functions a file has, their signatures, and which words it uses (`text`). So
there is no full parser, only regular expressions over text whose comments are blanked, with all lines in their places.

Code of users needs more, because a driver may hang, crash or run out of memory over it. It goes through these steps,
each of which keeps the number of lines, so that messages name the user's own: macros and conditions are expanded
(`macros`, `conditions`), sizes and nesting are bounded (`bounds`, `constants`), loops count their rounds (`loops`), and
divisions of whole numbers are guarded (`divisions`, `operands`). These steps work on tokens (`tokens`).
"""

from __future__ import annotations

from .text import COMMENT, GlslFunction, GlslText, blank_comments, macro_name, parse, unify_lines, words

__all__ = ["COMMENT", "GlslFunction", "GlslText", "blank_comments", "macro_name", "parse", "unify_lines", "words"]
