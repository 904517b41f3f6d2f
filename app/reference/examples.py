"""Values with which pages show a node whose defaults change nothing."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from halation.nodes import PaintStroke, name_paint_strokes

EXAMPLES: Mapping[str, Mapping[str, Any]] = MappingProxyType(
    {
        "cdl": {"slope": (1.2, 1.0, 0.8, 1.0), "power": (1.1, 1.0, 0.9, 1.0)},
        "channel_mixer": {"red": (0.5, 0.5, 0.0), "green": (0.2, 0.6, 0.2), "blue": (0.0, 0.3, 0.5)},
        "channel_shuffle": {"red": "blue", "blue": "red"},
        "color_balance": {"lift": (0.85, 0.95, 1.1, 1.0), "gain": (1.2, 1.0, 0.8, 1.0)},
        "crop": {"top_left": (0.25, 0.2), "bottom_right": (0.75, 0.8), "resize": False},
        "curves": {"master": (0.0, 0.0, 0.25, 0.12, 0.75, 0.88, 1.0, 1.0)},
        "dither": {"levels": 4.0},
        "exposure": {"stops": 1.5},
        "grade": {"lift": (0.03, 0.03, 0.05, 0.0), "gain": (1.4, 1.2, 0.9, 1.0)},
        "grid_warp": {"point_22": (0.45, 0.45), "point_33": (0.55, 0.55)},
        "hue_curves": {"hue_by_hue": (0.0, 0.12, 1.0, 0.12), "saturation_by_saturation": (0.0, 1.8, 1.0, 0.8)},
        "hue_saturation": {"hue": 60.0},
        "levels": {"black": 0.02, "white": 0.5},
        "math": {"operation": "multiply", "b": 0.4},
        "paint": {"strokes": name_paint_strokes(stroke=PaintStroke(color=(0.9, 0.3, 0.05)))},
        "resize": {"scale": (0.25, 0.25)},
        "saturation": {"saturation": 0.2},
        "transform": {"rotation": 15.0, "scale": (0.8, 0.8)},
        "white_balance": {"temperature": 4000.0},
    }
)
"""Type of node -> values that differ from its defaults. Chosen by eye."""
