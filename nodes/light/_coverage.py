"""What lights share to shade pixels that several surfaces share: see shaders/lib/coverage.glsl."""

from __future__ import annotations

COVERAGE_REACH = 2
"""How many pixels away a surface of a pixel is looked for."""
