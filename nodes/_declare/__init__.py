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
from .masking import INVERT_MASK, MASK, MASKED, MIX
from .mattes import float_bits, format_names, matte_of, murmur3, pick_ids, pick_names, toggle_name
from .node import Filter, Node, Pointwise, Reader, Source, Temporal
from .recolor import WORKING_SPACE, ColorChange, ColorSettings, LookupFile, SpaceChange
from .render import Matte, Meaning, Render
from .scene import BuiltInScene, Motion, Scene, SceneFile, StageName
from .sockets import CameraSocket, Color, Edge, Field, Image, Number, OutputSocket, Size, Socket, Vector, glsl_type
from .traits import ProxyNote, Trait
from .values import (
    RGBA,
    ColorRamp,
    Curve,
    Dial,
    Doc,
    File,
    FilePath,
    Fraction,
    Handle,
    Holds,
    ItemKind,
    Items,
    Kernel3x3,
    Missing,
    OfLayer,
    OfSpace,
    Picks,
    Plain,
    Points,
    Position,
    RenderPath,
    ScenePath,
    Slider,
    Stops,
    Swatch,
    TablePath,
    Uniform,
    Unit,
    Value,
)

__all__ = [
    "INVERT_MASK",
    "KINDS",
    "LIGHTS",
    "MASK",
    "MASKED",
    "MAX_LIGHTS",
    "MAX_POINTS",
    "MAX_REFERENCE_HEIGHT",
    "MIX",
    "REFERENCE_HEIGHT",
    "RGBA",
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
    "Curve",
    "Dial",
    "Doc",
    "Draw",
    "Drawn",
    "Edge",
    "Field",
    "File",
    "FilePath",
    "Filter",
    "Fraction",
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
    "Light",
    "LightKind",
    "LightSet",
    "LookupFile",
    "Matte",
    "Meaning",
    "Missing",
    "Motion",
    "NamedItem",
    "Node",
    "Number",
    "OfLayer",
    "OfSpace",
    "OutputSocket",
    "Overlap",
    "Picks",
    "Pixels",
    "Plain",
    "Points",
    "Pointwise",
    "Position",
    "ProxyNote",
    "Reach",
    "Reader",
    "Render",
    "RenderPath",
    "Resampling",
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
    "StageName",
    "Stops",
    "Swatch",
    "TablePath",
    "Temporal",
    "Trait",
    "Uniform",
    "Unit",
    "Value",
    "Vector",
    "convert_length",
    "curve_at",
    "curve_knots",
    "float_bits",
    "format_names",
    "glsl_type",
    "is_length",
    "item_of",
    "length_unit_fault",
    "light_of",
    "lights_of",
    "look_at",
    "matte_of",
    "murmur3",
    "name_lights",
    "name_reference",
    "natural_order",
    "number_lights",
    "orbit_camera",
    "pick_ids",
    "pick_names",
    "ramp_at",
    "ramp_knots",
    "read_reference",
    "resolve_length_unit",
    "space_pixels",
    "toggle_name",
    "unit_factor",
]
