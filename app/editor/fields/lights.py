"""Edits of lists of lights. Nothing here draws."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

from halation.nodes import LIGHT_NUMBERS, MAX_LIGHTS, Light, LightKind, Plain, Value, lights_of
from msgspec import structs

Numbers = tuple[float, ...]

KINDS: tuple[str, ...] = tuple(kind.name.capitalize() for kind in LightKind)
"""The names of the kinds of light, by their number."""

_POINT, _SPOT, _SUN, _SPHERE = LightKind
_SUNLIGHT = 3.0
"""W/m^2 of a new sun: a white floor below it has a luminance of about 1."""


@dataclass(frozen=True)
class LightProperty:
    """A property of lights: its name in `Light`, its declaration, and the kinds of light that have it."""

    name: str
    declaration: Value
    kinds: tuple[LightKind, ...] = tuple(LightKind)

    def read_from(self, light: Light) -> Plain:
        """The property of a light; a color gets an alpha of 1, as color fields take it."""
        plain: Plain = getattr(light, self.name)
        return (*plain, 1.0) if self.name == "color" and isinstance(plain, tuple) else plain

    def apply_to(self, light: Light, plain: Plain) -> Light:
        """The light with the property set. The direction never gets zero, nor the inner angle wider than the outer."""
        if self.name == "color" and isinstance(plain, tuple):
            return structs.replace(light, color=plain[:3])
        if self.name == "direction" and isinstance(plain, tuple) and not any(plain):
            return light
        changed_light = structs.replace(light, **{self.name: plain})
        if self.name == "inner":
            return structs.replace(changed_light, outer=max(changed_light.inner, changed_light.outer))
        return (
            structs.replace(changed_light, inner=min(changed_light.inner, changed_light.outer))
            if self.name == "outer"
            else changed_light
        )

    def unit(self, kind: LightKind) -> str | None:
        """The unit behind the number, if it is not a unit of values."""
        return None if self.name != "intensity" else "W/m²" if kind is _SUN else "W/sr"


_ANGLE = Value("", "float", 0.0, low=0.0, high=90.0, minimum=0.0, maximum=180.0, unit="deg")
_LENGTH = Value("", "float", 0.0, low=0.0, high=20.0, minimum=0.0, unit="scene")

PARTS = (
    LightProperty(
        "place",
        Value(
            "place",
            "vector",
            (),
            3,
            low=-10.0,
            high=10.0,
            unit="scene",
            doc="Its position in the scene.",
        ),
        (_POINT, _SPOT, _SPHERE),
    ),
    LightProperty(
        "direction",
        Value(
            "direction",
            "vector",
            (),
            3,
            low=-1.0,
            high=1.0,
            doc="The direction in which it shines, in the scene. The length does not matter.",
        ),
        (_SPOT, _SUN),
    ),
    LightProperty("color", Value("color", "color", (), 4, doc="Scene-linear. It is multiplied by the intensity.")),
    LightProperty(
        "intensity",
        Value(
            "intensity",
            "float",
            0.0,
            low=-50.0,
            high=50.0,
            doc="How strong it is: W/sr, so that the light at a distance "
            "d is the intensity / d²; W/m² for a sun, the same everywhere. Below 0 it takes light away.",
        ),
    ),
    LightProperty(
        "reach",
        structs.replace(
            _LENGTH,
            name="reach",
            doc="The distance at which it has faded to nothing. 0: no limit.",
        ),
        (_POINT, _SPOT, _SPHERE),
    ),
    LightProperty(
        "inner",
        structs.replace(
            _ANGLE,
            name="inner angle",
            doc="Half the angle of the cone of full intensity.",
        ),
        (_SPOT,),
    ),
    LightProperty(
        "outer",
        structs.replace(
            _ANGLE,
            name="outer angle",
            doc="Half the angle of the whole cone.",
        ),
        (_SPOT,),
    ),
    LightProperty(
        "size",
        structs.replace(
            _LENGTH,
            name="size",
            high=2.0,
            doc="The radius of the sphere. A larger one has wider reflections.",
        ),
        (_SPHERE,),
    ),
)
"""The properties of lights, in the order of their rows."""


@cache
def parts_of(kind: LightKind) -> tuple[LightProperty, ...]:
    """The properties of a kind of light; their defaults are those of a new light."""
    new = make_light(kind)
    return tuple(
        replace(part, declaration=structs.replace(part.declaration, default=part.read_from(new)))
        for part in PARTS
        if kind in part.kinds
    )


def make_light(kind: LightKind) -> Light:
    """A new light."""
    return Light(kind, intensity=_SUNLIGHT) if kind is _SUN else Light(kind)


def change_kind(light: Light, kind: LightKind) -> Light:
    """The light as another kind; an unchanged intensity becomes the default of that kind."""
    untouched = light.intensity == make_light(light.kind).intensity
    return structs.replace(light, kind=kind, intensity=make_light(kind).intensity if untouched else light.intensity)


def count_lights(numbers: Numbers) -> int:
    """The number of lights in a list."""
    return len(numbers) // LIGHT_NUMBERS


def describe_count(numbers: Numbers) -> str:
    """The number of lights in words: `no lights`, `1 light`, `3 lights`."""
    count = count_lights(numbers)
    return "no lights" if not count else "1 light" if count == 1 else f"{count} lights"


def light_at(numbers: Numbers, index: int) -> Light:
    """The light at an index."""
    return lights_of(numbers[index * LIGHT_NUMBERS : (index + 1) * LIGHT_NUMBERS])[0]


def light_title(light: Light, index: int) -> str:
    """The title of a light: its kind and its number in the list."""
    return f"{KINDS[light.kind]} {index + 1}"


def describe_intensity(light: Light) -> str:
    """The intensity as a short text."""
    size = abs(light.intensity)
    return f"{light.intensity:.0f}" if 1e3 <= size < 1e6 else f"{light.intensity:.3g}"


def replace_light(numbers: Numbers, index: int, light: Light) -> Numbers:
    """The list with the light at an index replaced."""
    return (*numbers[: index * LIGHT_NUMBERS], *light.numbers, *numbers[(index + 1) * LIGHT_NUMBERS :])


def insert_light(numbers: Numbers, index: int, light: Light) -> tuple[Numbers, int]:
    """The list with a light inserted after an index (-1: at the front), and its index; unchanged if it is full."""
    if count_lights(numbers) >= MAX_LIGHTS:
        return numbers, index
    at = (index + 1) * LIGHT_NUMBERS
    return (*numbers[:at], *light.numbers, *numbers[at:]), index + 1


def remove_light(numbers: Numbers, index: int) -> tuple[Numbers, int]:
    """The list without one light, and the index selected next: that of the light after it, else the last."""
    remaining = (*numbers[: index * LIGHT_NUMBERS], *numbers[(index + 1) * LIGHT_NUMBERS :])
    return remaining, min(index, count_lights(remaining) - 1)


def move_light(numbers: Numbers, index: int, by: int) -> tuple[Numbers, int]:
    """The list with one light moved, and its new index."""
    light, (rest, _) = light_at(numbers, index), remove_light(numbers, index)
    return insert_light(rest, min(max(index + by, 0), count_lights(rest)) - 1, light)
