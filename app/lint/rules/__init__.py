"""Rules about graphs without errors, a family in each file. Each reads the facts of a graph and yields problems."""

from __future__ import annotations

from . import data, filtering, light, paths, unused

CHECKS = (*filtering.CHECKS, *light.CHECKS, *data.CHECKS, *unused.CHECKS, *paths.CHECKS)
"""Every rule of this folder, with the function that finds its problems."""
