"""What lights share to shade pixels that several surfaces share: see shaders/lib/coverage.glsl and normal_turn.glsl."""

from __future__ import annotations

COVERAGE_REACH = 2
"""How many pixels away a surface of a pixel is looked for."""

COVERAGE_AROUND = COVERAGE_REACH + 1
"""How many pixels away normals and nearness are read: the pixel behind one tells how its surface turns."""

TURN_REACH = 1
"""How many pixels beside a surface normals are read to know how it turns."""
