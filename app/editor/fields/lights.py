"""Lists of lights as their editor changes them. Nothing here draws."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

from halation.nodes import LIGHT_NUMBERS, MAX_LIGHTS, Light, LightKind, Plain, Value, lights_of
from msgspec import structs

Numbers = tuple[float, ...]

KINDS: tuple[str, ...] = tuple(kind.name.capitalize() for kind in LightKind)
"""What the kinds are called, by their number."""

_POINT, _SPOT, _SUN, _SPHERE = LightKind
_SUNLIGHT = 3.0
"""W/m^2 of a new sun: a white floor below it has a luminance of about 1."""


@dataclass(frozen=True)
class LightProperty:
    """One thing about a light: its name in `Light`, how it is edited, and the kinds of light that have it."""

    name: str
    declaration: Value
    kinds: tuple[LightKind, ...] = tuple(LightKind)

    def read_from(self, light: Light) -> Plain:
        """What it is; a color with an alpha of 1, as all fields of colors have it."""
        plain: Plain = getattr(light, self.name)
        return (*plain, 1.0) if self.name == "color" and isinstance(plain, tuple) else plain

    def apply_to(self, light: Light, plain: Plain) -> Light:
        """The light with another one. It always shines somewhere, and its inner angle is never the wider one."""
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
        """What stands behind the number, where that is no unit of values."""
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
"""What can be set of lights, in the order in which it is shown."""


@cache
def parts_of(kind: LightKind) -> tuple[LightProperty, ...]:
    """What a light of that kind has; each declares as its default what a new one has."""
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
    """The light as one of another kind; an intensity that was never touched becomes that of a new one."""
    untouched = light.intensity == make_light(light.kind).intensity
    return structs.replace(light, kind=kind, intensity=make_light(kind).intensity if untouched else light.intensity)


def count_lights(numbers: Numbers) -> int:
    """How many lights there are."""
    return len(numbers) // LIGHT_NUMBERS


def describe_count(numbers: Numbers) -> str:
    """The same in words."""
    count = count_lights(numbers)
    return "no lights" if not count else "1 light" if count == 1 else f"{count} lights"


def light_at(numbers: Numbers, index: int) -> Light:
    """One of the lights."""
    return lights_of(numbers[index * LIGHT_NUMBERS : (index + 1) * LIGHT_NUMBERS])[0]


def light_title(light: Light, index: int) -> str:
    """What a light is called: its kind, and which of the list it is."""
    return f"{KINDS[light.kind]} {index + 1}"


def describe_intensity(light: Light) -> str:
    """The intensity in few digits."""
    size = abs(light.intensity)
    return f"{light.intensity:.0f}" if 1e3 <= size < 1e6 else f"{light.intensity:.3g}"


def replace_light(numbers: Numbers, index: int, light: Light) -> Numbers:
    """The list with another light at a place."""
    return (*numbers[: index * LIGHT_NUMBERS], *light.numbers, *numbers[(index + 1) * LIGHT_NUMBERS :])


def insert_light(numbers: Numbers, index: int, light: Light) -> tuple[Numbers, int]:
    """The list with one more light behind a place (-1 is before all), and where that is; as it was if it is full."""
    if count_lights(numbers) >= MAX_LIGHTS:
        return numbers, index
    at = (index + 1) * LIGHT_NUMBERS
    return (*numbers[:at], *light.numbers, *numbers[at:]), index + 1


def remove_light(numbers: Numbers, index: int) -> tuple[Numbers, int]:
    """The list with one light less, and the one that is selected then: that behind it, else the last."""
    remaining = (*numbers[: index * LIGHT_NUMBERS], *numbers[(index + 1) * LIGHT_NUMBERS :])
    return remaining, min(index, count_lights(remaining) - 1)


def move_light(numbers: Numbers, index: int, by: int) -> tuple[Numbers, int]:
    """The list with one light further on, as far as that goes, and where it is then."""
    light, (rest, _) = light_at(numbers, index), remove_light(numbers, index)
    return insert_light(rest, min(max(index + by, 0), count_lights(rest)) - 1, light)
