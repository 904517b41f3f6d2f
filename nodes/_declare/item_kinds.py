"""The kinds of named items that nodes of Halation have: lamps, shapes, strokes and the like.

`_declare` loads this file when one of these names is first asked for: the declarations of all their fields take a
twentieth of the time of `halation check`.
"""

from __future__ import annotations

from .curve_pairs import CurvePair, CurvePairSet, curve_pairs_of, name_curve_pairs
from .light_groups import LightGroup, LightGroupSet, light_groups_of, name_light_groups
from .lights import (
    LIGHTS,
    MAX_LIGHTS,
    Light,
    LightKind,
    LightSet,
    item_of,
    light_of,
    lights_of,
    name_lights,
    number_lights,
)
from .paint_strokes import (
    MAX_STROKES,
    PAINT_STROKES,
    PaintStroke,
    PaintStrokeSet,
    PaintTool,
    name_paint_strokes,
    paint_strokes_of,
    simplify_stroke,
)
from .roto_shapes import (
    MAX_ROTO_SHAPES,
    ROTO_SHAPES,
    PlacedRotoShape,
    RotoMode,
    RotoShape,
    RotoShapeSet,
    RotoTrack,
    RotoTransform,
    make_ellipse,
    name_roto_shapes,
    place_roto_shapes,
    roto_shapes_of,
)

__all__ = [
    "LIGHTS",
    "MAX_LIGHTS",
    "MAX_ROTO_SHAPES",
    "MAX_STROKES",
    "PAINT_STROKES",
    "ROTO_SHAPES",
    "CurvePair",
    "CurvePairSet",
    "Light",
    "LightGroup",
    "LightGroupSet",
    "LightKind",
    "LightSet",
    "PaintStroke",
    "PaintStrokeSet",
    "PaintTool",
    "PlacedRotoShape",
    "RotoMode",
    "RotoShape",
    "RotoShapeSet",
    "RotoTrack",
    "RotoTransform",
    "curve_pairs_of",
    "item_of",
    "light_groups_of",
    "light_of",
    "lights_of",
    "make_ellipse",
    "name_curve_pairs",
    "name_light_groups",
    "name_lights",
    "name_paint_strokes",
    "name_roto_shapes",
    "number_lights",
    "paint_strokes_of",
    "place_roto_shapes",
    "roto_shapes_of",
    "simplify_stroke",
]
