"""Lights as named items: the kinds of light, and their fields."""

from __future__ import annotations

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

_OLD_NUMBERS = 16
"""The numbers of a light in files of the first version."""


class LightKind(StrEnum):
    """What a light is like."""

    POINT = "point"
    SPOT = "spot"
    SUN = "sun"
    SPHERE = "sphere"


_Place = Annotated[Triple, Slider(-10.0, 10.0, unit="scene", doc="Where it is in the world.")]
_Way = Annotated[
    Triple,
    Slider(-1.0, 1.0, unit="ratio", doc="The direction in which it shines, in the world; its length is of no account."),
]
_Reach = Annotated[
    float, Slider(0.0, 20.0, unit="scene", minimum=0.0, doc="The distance at which it has faded out; 0: no limit.")
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
            doc="How strong it is. In W/sr: the light at a distance d is the intensity / d². Of a sun in W/m², the "
            "same everywhere. Below 0 it takes light away.",
        ),
    ] = 10.0
    reach: _Reach = 0.0
    inner: Annotated[
        float,
        Slider(0.0, 90.0, unit="deg", minimum=0.0, maximum=180.0, doc="Half the angle of the cone of full intensity."),
    ] = 20.0
    outer: Annotated[
        float, Slider(0.0, 90.0, unit="deg", minimum=0.0, maximum=180.0, doc="Half the angle of the whole cone.")
    ] = 30.0
    size: Annotated[
        float,
        Slider(0.0, 2.0, unit="scene", minimum=0.0, doc="The radius. A larger one has wider reflections."),
    ] = 0.1
    on: Annotated[bool, Doc("Whether it shines.")] = True
    temperature: Annotated[
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
    ] = 0.0
    exposure: Annotated[float, Slider(-6.0, 6.0, unit="EV", doc="Doubles the intensity with each stop.")] = 0.0
    solo: Annotated[bool, Doc("While any light is solo, only those shine.")] = False

    @property
    def gain(self) -> float:
        """The intensity with the exposure."""
        return self.intensity * 2.0**self.exposure


_ORDER = (
    "on", "solo", "color", "temperature", "intensity", "exposure",
    "place", "direction", "size", "inner", "outer", "reach",
)  # fmt: skip
"""The fields in the order of the editor."""

_LOCAL = ("place", "reach")
_FIELDS: Mapping[LightKind, tuple[str, ...]] = {
    LightKind.POINT: _LOCAL,
    LightKind.SPOT: (*_LOCAL, "direction", "inner", "outer"),
    LightKind.SUN: ("direction",),
    LightKind.SPHERE: (*_LOCAL, "size"),
}
_SHARED = ("color", "temperature", "intensity", "exposure", "on", "solo")
_DOCS = {
    LightKind.POINT: "Shines from one point in all directions.",
    LightKind.SPOT: "Shines from one point in a cone.",
    LightKind.SUN: "Shines from far away, everywhere in the same direction.",
    LightKind.SPHERE: "Shines from the surface of a ball.",
}
_DEFAULTS: Mapping[LightKind, Mapping[str, Any]] = {LightKind.SUN: {"intensity": 3.0}}
"""Defaults that differ from those of `Light`. Below a sun of 3 W/m² a white floor has a luminance of about 1."""


def _declare_kinds() -> tuple[ItemKind, ...]:
    hints = get_type_hints(Light, include_extras=True)
    declared = {
        field.name: read_value(field.name, hints[field.name], field.default)
        for field in fields_of(Light)
        if field.name != "kind"
    }

    def declare(kind: LightKind, name: str) -> Value:
        defaults = _DEFAULTS.get(kind, {})
        return replace(declared[name], default=defaults[name]) if name in defaults else declared[name]

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
    kinds = tuple(LightKind)
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
