"""Rules about graphs that render, a family in each file. Each looks at a `Sheet` and says what it finds."""

from __future__ import annotations

from . import data, filtering, light, paths, unused

CHECKS = (*filtering.CHECKS, *light.CHECKS, *data.CHECKS, *unused.CHECKS, *paths.CHECKS)
"""Every rule of this folder, with what finds it."""
