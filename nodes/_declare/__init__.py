"""The vocabulary of nodes: a class body declares an effect, an instance holds its values.

    class Exposure(Pointwise):
        \"\"\"Brighten or darken in photographic stops.\"\"\"

        image = Image()
        stops: Annotated[float, Slider(-10.0, 10.0, unit="EV")] = 0.0

- *Sockets* (`Image`, `Field`, `Vector`, `Number`, `Color`) are inputs that a link fills; one with a
  `default` may stay unlinked. `OutputSocket(...)` declares outputs; without any there is one Image, `out`.
- *Values* are annotated attributes with a default. Numbers carry a `Slider`, choices are `Literal`s.
- `Pointwise` is one GLSL function of its own pixel; its numbers, colors and vectors can be wired too.
- `Filter` records draws symbolically in `passes`, `Source` makes pixels, `Reader` of files, `Temporal`
  keeps history.

`traits` tell the rules of `halation check` what sockets and values do not show.

Values reach `passes` and GLSL in working units (see `Slider.unit`), so no node converts any itself.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .camera import CameraModel, look_at, orbit_camera
from .curves import MAX_POINTS, curve_at, curve_knots, ramp_at, ramp_knots
from .draw import Affine, Argument, Draw, Drawn, Kernel, Overlap, Pixels, Reach, Resampling, ShaderStage, ShaderText
from .host import HostProgram
from .items import ItemSet, NamedItem, Scalar, natural_order
from .kinds import KINDS, Kind, KindFacts
from .lengths import (
    MAX_REFERENCE_HEIGHT,
    REFERENCE_HEIGHT,
    LengthUnits,
    Spacing,
    convert_length,
    is_length,
    length_unit_fault,
    name_reference,
    read_reference,
    resolve_length_unit,
    space_pixels,
    unit_factor,
)
from .lettering import (
    MAX_TEXT,
    Contour,
    Curve4,
    GlyphPlace,
    TextAlign,
    TextBlock,
    TextDirection,
    Typeface,
    TypesetText,
)
from .listed_names import find_number, is_number
from .masking import INVERT_MASK, MASK, MASKED, MIX
from .mattes import float_bits, format_names, matte_of, murmur3, pick_ids, pick_names, toggle_name
from .node import Filter, Node, Pointwise, Reader, Source, Temporal
from .outlines import OutlineFill, OutlinePlace
from .recolor import WORKING_SPACE, ColorChange, ColorSettings, LookupFile, SpaceChange
from .render import Matte, Meaning, Render
from .rows import ROWS, SPLINE_ROWS, STROKE_ROWS, Row, RowLayout
from .scene import BuiltInScene, Motion, Scene, SceneFile, StageName
from .sockets import CameraSocket, Color, Edge, Field, Image, Number, OutputSocket, Size, Socket, Vector, glsl_type
from .splines import (
    CubicCurve,
    curve_point,
    insert_point,
    join_points,
    list_curves,
    list_rows,
    read_rows,
    split_curve,
    split_points,
    trace_spline,
)
from .traits import ProxyNote, Trait
from .values import (
    RGBA,
    ColorRamp,
    Curve,
    Dial,
    Doc,
    File,
    FilePath,
    FontPath,
    Fraction,
    Handle,
    Holds,
    ItemKind,
    Items,
    Kernel3x3,
    Missing,
    OfItem,
    OfLayer,
    OfSpace,
    OneOf,
    PatternLoop,
    PatternOffset,
    PatternPeriod,
    Picks,
    Plain,
    Points,
    Position,
    Prose,
    RenderPath,
    ScenePath,
    Slider,
    Spline,
    SplinePoints,
    Stops,
    Stroke,
    StrokePoints,
    Swatch,
    TablePath,
    Uniform,
    Unit,
    Value,
    Wheel,
)

if TYPE_CHECKING:
    from .item_kinds import *  # noqa: F403  (`item_kinds.__all__` names them)

__all__ = [
    "INVERT_MASK",
    "KINDS",
    "MASK",
    "MASKED",
    "MAX_POINTS",
    "MAX_REFERENCE_HEIGHT",
    "MAX_TEXT",
    "MIX",
    "REFERENCE_HEIGHT",
    "RGBA",
    "ROWS",
    "SPLINE_ROWS",
    "STROKE_ROWS",
    "WORKING_SPACE",
    "Affine",
    "Argument",
    "BuiltInScene",
    "CameraModel",
    "CameraSocket",
    "Color",
    "ColorChange",
    "ColorRamp",
    "ColorSettings",
    "Contour",
    "CubicCurve",
    "Curve",
    "Curve4",
    "Dial",
    "Doc",
    "Draw",
    "Drawn",
    "Edge",
    "Field",
    "File",
    "FilePath",
    "Filter",
    "FontPath",
    "Fraction",
    "GlyphPlace",
    "Handle",
    "Holds",
    "HostProgram",
    "Image",
    "ItemKind",
    "ItemSet",
    "Items",
    "Kernel",
    "Kernel3x3",
    "Kind",
    "KindFacts",
    "LengthUnits",
    "LookupFile",
    "Matte",
    "Meaning",
    "Missing",
    "Motion",
    "NamedItem",
    "Node",
    "Number",
    "OfItem",
    "OfLayer",
    "OfSpace",
    "OneOf",
    "OutlineFill",
    "OutlinePlace",
    "OutputSocket",
    "Overlap",
    "PatternLoop",
    "PatternOffset",
    "PatternPeriod",
    "Picks",
    "Pixels",
    "Plain",
    "Points",
    "Pointwise",
    "Position",
    "Prose",
    "ProxyNote",
    "Reach",
    "Reader",
    "Render",
    "RenderPath",
    "Resampling",
    "Row",
    "RowLayout",
    "Scalar",
    "Scene",
    "SceneFile",
    "ScenePath",
    "ShaderStage",
    "ShaderText",
    "Size",
    "Slider",
    "Socket",
    "Source",
    "SpaceChange",
    "Spacing",
    "Spline",
    "SplinePoints",
    "StageName",
    "Stops",
    "Stroke",
    "StrokePoints",
    "Swatch",
    "TablePath",
    "Temporal",
    "TextAlign",
    "TextBlock",
    "TextDirection",
    "Trait",
    "Typeface",
    "TypesetText",
    "Uniform",
    "Unit",
    "Value",
    "Vector",
    "Wheel",
    "convert_length",
    "curve_at",
    "curve_knots",
    "curve_point",
    "find_number",
    "float_bits",
    "format_names",
    "glsl_type",
    "insert_point",
    "is_length",
    "is_number",
    "join_points",
    "length_unit_fault",
    "list_curves",
    "list_rows",
    "look_at",
    "matte_of",
    "murmur3",
    "name_reference",
    "natural_order",
    "orbit_camera",
    "pick_ids",
    "pick_names",
    "ramp_at",
    "ramp_knots",
    "read_reference",
    "read_rows",
    "resolve_length_unit",
    "space_pixels",
    "split_curve",
    "split_points",
    "toggle_name",
    "trace_spline",
    "unit_factor",
]


def __getattr__(name: str) -> Any:
    """Kinds of named items are loaded when the first of them is asked for, since few graphs have any."""
    if not name.startswith("__"):
        kinds = import_module(".item_kinds", __name__)
        if name in kinds.__all__:
            return getattr(kinds, name)
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
