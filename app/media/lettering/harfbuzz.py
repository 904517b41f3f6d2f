"""HarfBuzz, which states no types: its names are made while it is imported."""

from __future__ import annotations

from typing import Any

import uharfbuzz

hb: Any = uharfbuzz
