"""Choices of a rendering that the compiler, the writers of files and render jobs share."""

from __future__ import annotations

from typing import Literal

Form = Literal["fragment", "compute"]
"""How passes run: as fragment shaders, or as compute shaders."""

Precision = Literal["half", "float"]
"""The bits of a number: 16 or 32."""

Dither = Literal["blue", "none"]
"""How colors are rounded to 8 or 10 bits: with blue noise, which prevents bands, or to the nearest code."""

DEFAULT_TIMEOUT = 60.0
"""Seconds that a pass of code in a graph may take: a choice, not a measurement. It is long enough for a slow machine,
and short enough to wait for."""
