"""Lights as named items: the kinds of light, and their fields."""

import math
from collections.abc import Iterable, Mapping
from enum import StrEnum
from typing import Annotated, Any, cast, get_type_hints

from msgspec import Struct
from msgspec.structs import fields as fields_of
from msgspec.structs import replace

from .items import ItemSet, NamedItem
from .values import Doc, ItemKind, Items, Slider, Swatch, Value, read_value

Triple = tuple[float, float, float]

MAX_LIGHTS = 1024
"""Lights of a node. Chosen by judgement: tiles leave out those that cannot reach a pixel, but each is looked at."""

MAX_COOKIES = 4
"""Pictures through which lights of a node can fall: as many as it has inputs for."""

_UPRIGHT = 1e-6
"""Below this horizontal part, a direction counts as straight up or down, where no side is level by itself."""

_OLD_NUMBERS = 16
"""The numbers of a light in files of the first version."""


class LightKind(StrEnum):
    """What a light is like."""

    POINT = "point"
    SPOT = "spot"
    SUN = "sun"
    SPHERE = "sphere"
    RECTANGLE = "rectangle"
    DISC = "disc"
    TUBE = "tube"


_Place = Annotated[Triple, Slider(-10.0, 10.0, unit="scene", doc="Where the light is in the world.")]
_Way = Annotated[
    Triple,
    Slider(-1.0, 1.0, unit="ratio", doc="The direction of the light in the world. Its length has no effect."),
]
_Reach = Annotated[
    float,
    Slider(0.0, 20.0, unit="scene", minimum=0.0, doc="The distance at which its light has faded out; 0: no limit."),
]
Temperature = Annotated[
    float,
    Slider(
        0.0,
        12000.0,
        unit="K",
        minimum=0.0,
        maximum=15000.0,
        doc="The color of a lamp in kelvin, which is multiplied by the color: candle 1850, bulb 2850, noon 5500, "
        "shade 8000. 0: the color alone.",
    ),
]


class Light(Struct, frozen=True):
    """One light with all of its fields. Places and directions are in the world.

    A field that the kind of light does not have is at its default here. Angles are in degrees in files and in the
    editor, and in radians in `passes`.
    """

    kind: LightKind = LightKind.POINT
    place: _Place = (0.0, 0.0, 2.0)
    direction: _Way = (0.0, 0.0, -1.0)
    color: Annotated[Triple, Swatch(), Doc("Scene-linear. Multiplied by the intensity.")] = (1.0, 1.0, 1.0)
    intensity: Annotated[
        float,
        Slider(
            -50.0,
            50.0,
            unit="scene",
            doc="How strong the light is. In W/sr: the light at a distance d is the intensity / d². Of a sun in W/m², "
            "the same everywhere. Below 0 it takes light away.",
        ),
    ] = 10.0
    reach: _Reach = 0.0
    inner: Annotated[
        float,
        Slider(
            0.0,
            90.0,
            unit="deg",
            minimum=0.0,
            maximum=180.0,
            doc="Half the angle of the cone of full intensity.",
        ),
    ] = 20.0
    outer: Annotated[
        float, Slider(0.0, 90.0, unit="deg", minimum=0.0, maximum=180.0, doc="Half the angle of the whole cone.")
    ] = 30.0
    size: Annotated[
        float,
        Slider(0.0, 2.0, unit="scene", minimum=0.0, doc="The radius of the light. A larger one has wider reflections."),
    ] = 0.1
    on: Annotated[bool, Doc("Whether the light shines.")] = True
    temperature: Temperature = 0.0
    exposure: Annotated[float, Slider(-6.0, 6.0, unit="EV", doc="Doubles the intensity with each stop.")] = 0.0
    solo: Annotated[bool, Doc("While any light is solo, only solo lights shine.")] = False
    width: Annotated[float, Slider(0.0, 5.0, unit="scene", minimum=0.0, doc="From left edge to right edge.")] = 1.0
    height: Annotated[float, Slider(0.0, 5.0, unit="scene", minimum=0.0, doc="From lower edge to upper edge.")] = 1.0
    length: Annotated[float, Slider(0.0, 5.0, unit="scene", minimum=0.0, doc="From one end to the other.")] = 1.0
    roll: Annotated[
        float, Slider(-180.0, 180.0, unit="deg", doc="Turns the light around its direction. At 0 its width is level.")
    ] = 0.0
    angle: Annotated[
        float,
        Slider(0.0, 20.0, unit="deg", minimum=0.0, maximum=90.0, doc="How large the light looks: softens its shadows."),
    ] = 0.5
    shadow: Annotated[bool, Doc("Casts shadows of what the picture shows, which are soft if the light has a size.")] = (
        False
    )
    matte: Annotated[
        int,
        Slider(
            -4,
            4,
            unit="count",
            minimum=-4,
            maximum=4,
            doc="Lights only what is in this matte, 1 to 4; below 0 only what is outside of it. 0: everything.",
        ),
    ] = 0
    cookie: Annotated[
        int,
        Slider(
            0,
            MAX_COOKIES,
            unit="count",
            minimum=0,
            maximum=MAX_COOKIES,
            doc="The picture through which the light falls, 1 to 4; 0: none.",
        ),
    ] = 0
    cookie_width: Annotated[
        float,
        Slider(0.0, 10.0, unit="scene", minimum=1e-6, doc="How wide the picture lies across the light. It repeats."),
    ] = 4.0

    @property
    def gain(self) -> float:
        """The intensity with the exposure."""
        return self.intensity * 2.0**self.exposure

    @property
    def aim(self) -> Triple:
        """The direction with length 1: down, where there is none."""
        size = math.hypot(*self.direction)
        x, y, z = self.direction
        return (x / size, y / size, z / size) if size > 0.0 else (0.0, 0.0, -1.0)

    @property
    def sides(self) -> tuple[Triple, Triple]:
        """Two directions of length 1 across the light, turned by `roll`: level and to the left for what looks along
        with the light, and upward."""
        x, y, z = self.aim
        level = math.hypot(x, y)
        side = (-y / level, x / level, 0.0) if level > _UPRIGHT else (1.0, 0.0, 0.0)
        up = (y * side[2] - z * side[1], z * side[0] - x * side[2], x * side[1] - y * side[0])
        cosine, sine = math.cos(self.roll), math.sin(self.roll)
        return (
            cast("Triple", tuple(cosine * first + sine * second for first, second in zip(side, up, strict=True))),
            cast("Triple", tuple(cosine * second - sine * first for first, second in zip(side, up, strict=True))),
        )

    @property
    def half_axes(self) -> tuple[Triple, Triple]:
        """From the middle to an edge, both ways across: half the width and the height of a rectangle, radii of a disc;
        half the length and the radius of a tube."""
        along, across = self.sides
        if self.kind is LightKind.TUBE:
            return _scale(self.aim, self.length / 2.0), _scale(along, self.size)
        sizes = (self.size, self.size) if self.kind is LightKind.DISC else (self.width / 2.0, self.height / 2.0)
        return _scale(along, sizes[0]), _scale(across, sizes[1])


def _scale(direction: tuple[float, ...], length: float) -> Triple:
    """A half axis. None is shorter than 1e-4, so that light stays finite."""
    x, y, z = (max(length, _THINNEST) * part for part in direction)
    return x, y, z


_THINNEST = 1e-4
"""The least half axis, that of the radius of a sphere."""


_ORDER = (
    "on", "solo", "color", "temperature", "intensity", "exposure",
    "place", "direction", "roll", "width", "height", "length", "size", "inner", "outer", "angle", "reach", "shadow",
    "matte", "cookie", "cookie_width",
)  # fmt: skip
"""The fields in the order of the editor."""

_LOCAL = ("place", "reach")
_FIELDS: Mapping[LightKind, tuple[str, ...]] = {
    LightKind.POINT: (*_LOCAL, "cookie"),
    LightKind.SPOT: (*_LOCAL, "direction", "inner", "outer", "roll", "cookie"),
    LightKind.SUN: ("direction", "angle", "roll", "cookie", "cookie_width"),
    LightKind.SPHERE: (*_LOCAL, "size", "cookie"),
    LightKind.RECTANGLE: (*_LOCAL, "direction", "roll", "width", "height"),
    LightKind.DISC: (*_LOCAL, "direction", "size"),
    LightKind.TUBE: (*_LOCAL, "direction", "length", "size"),
}
_SHARED = ("color", "temperature", "intensity", "exposure", "on", "solo", "shadow", "matte")
_DOCS = {
    LightKind.POINT: "Shines from one point in all directions.",
    LightKind.SPOT: "Shines from one point in a cone.",
    LightKind.SUN: "Shines from far away, everywhere in the same direction.",
    LightKind.SPHERE: "Shines from the surface of a ball.",
    LightKind.RECTANGLE: "Shines from one side of a rectangle, as a window or a soft box.",
    LightKind.DISC: "Shines from one side of a disc.",
    LightKind.TUBE: "Shines from the surface of a tube with closed ends.",
}
_COOKIE_ROLL = "Turns the cookie clockwise, seen along with the light. At 0 it stands upright."
_DIFFERENCES: Mapping[LightKind, Mapping[str, Mapping[str, Any]]] = {
    LightKind.SPOT: {"roll": {"doc": _COOKIE_ROLL}},
    LightKind.SUN: {"intensity": {"default": 3.0}, "roll": {"doc": _COOKIE_ROLL}},
    LightKind.DISC: {"size": {"default": 0.5, "doc": "The radius."}},
    LightKind.TUBE: {
        "size": {"default": 0.05, "doc": "The radius."},
        "direction": {"default": (1.0, 0.0, 0.0), "doc": "The direction of its length, in the world."},
    },
}
"""What fields of a kind declare otherwise than `Light`. Below a sun of 3 W/m² a white floor has a luminance of about 1;
a tube is like a fluorescent lamp of 1 m."""


def _declare_kinds() -> tuple[ItemKind, ...]:
    hints = get_type_hints(Light, include_extras=True)
    declared = {
        field.name: read_value(field.name, hints[field.name], field.default)
        for field in fields_of(Light)
        if field.name != "kind"
    }

    def declare(kind: LightKind, name: str) -> Value:
        return replace(declared[name], **_DIFFERENCES.get(kind, {}).get(name, {}))

    return tuple(
        ItemKind(kind.value, tuple(declare(kind, name) for name in _ORDER if name in (*_SHARED, *names)), _DOCS[kind])
        for kind, names in _FIELDS.items()
    )


def name_old_lights(setting: object) -> Mapping[str, Any] | None:
    """Lights of the first version, 16 numbers each, as `lamp_1`, `lamp_2`, ...; None for what is no such list."""
    if not isinstance(setting, list | tuple):
        return None
    numbers = cast("tuple[Any, ...]", tuple(setting))  # pyright: ignore[reportUnknownArgumentType]
    if len(numbers) % _OLD_NUMBERS or any(
        isinstance(part, bool) or not isinstance(part, int | float) for part in numbers
    ):
        return None
    starts = range(0, len(numbers), _OLD_NUMBERS)
    kinds = tuple(LightKind)[:4]
    if any(numbers[at] not in range(len(kinds)) for at in starts):
        return None
    return {
        f"lamp_{number}": _name_numbers(kinds[int(numbers[at])], numbers[at : at + _OLD_NUMBERS])
        for number, at in enumerate(starts, 1)
    }


def _name_numbers(kind: LightKind, numbers: tuple[float, ...]) -> dict[str, Any]:
    _, px, py, pz, dx, dy, dz, red, green, blue, intensity, reach, inner, outer, size, on = numbers
    fields = {
        "place": (px, py, pz),
        "direction": (dx, dy, dz),
        "color": (red, green, blue),
        "intensity": intensity,
        "reach": reach,
        "inner": inner,
        "outer": outer,
        "size": size,
        "on": on > 0.5,
    }
    names = (*_SHARED, *_FIELDS[kind])
    return {"kind": kind.value, **{name: setting for name, setting in fields.items() if name in names}}


LIGHTS = Items(_declare_kinds(), "light", MAX_LIGHTS, name_old_lights)
"""What a value of lights can hold."""

LightSet = Annotated[ItemSet, LIGHTS]


def lights_of(items: ItemSet) -> tuple[Light, ...]:
    """The lights that a value holds, in the order of their names."""
    return tuple(light_of(item) for item in items.values())


def light_of(item: NamedItem) -> Light:
    """The light that an item describes."""
    return Light(LightKind(item.kind), **LIGHTS.settings(item))


def item_of(light: Light) -> NamedItem:
    """The item that describes a light."""
    kind = LIGHTS.by_name[light.kind]
    fields = {name: getattr(light, name) for name in kind.fields}
    return NamedItem.of(light.kind.value, {name: part for name, part in fields.items() if part != kind.defaults[name]})


def name_lights(**lights: Light) -> ItemSet:
    """The value that holds these lights under these names."""
    return ItemSet({name: item_of(light) for name, light in lights.items()})


def number_lights(lights: Iterable[Light]) -> ItemSet:
    """The value that holds these lights, called `lamp_1`, `lamp_2`, ..."""
    return name_lights(**{f"lamp_{number}": light for number, light in enumerate(lights, 1)})
