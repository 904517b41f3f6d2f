"""Lights as a value: a flat list of numbers, equally many for every light."""

from __future__ import annotations

from enum import IntEnum

from msgspec import Struct

Triple = tuple[float, float, float]

LIGHT_NUMBERS = 16
MAX_LIGHTS = 1024


class LightKind(IntEnum):
    """What a light is like. Its number is the first of a light's."""

    POINT = 0
    SPOT = 1
    SUN = 2
    SPHERE = 3


class Light(Struct, frozen=True):
    """One light. Places are in the world; `direction` is where a spot or sun shines to.

    `intensity` is W/sr for point, spot and sphere (the light at a distance d is intensity / d^2), W/m^2 for a sun;
    below 0 it takes light away. `reach` is the distance at which it has faded to nothing, 0 for none. `inner` and
    `outer` are the half angles in degrees within which a spot shines fully and at all. `size` is a sphere's radius.
    """

    kind: LightKind = LightKind.POINT
    place: Triple = (0.0, 0.0, 2.0)
    direction: Triple = (0.0, 0.0, -1.0)
    color: Triple = (1.0, 1.0, 1.0)
    intensity: float = 10.0
    reach: float = 0.0
    inner: float = 20.0
    outer: float = 30.0
    size: float = 0.1
    on: bool = True

    @property
    def numbers(self) -> tuple[float, ...]:
        """As a value holds it."""
        return (
            float(self.kind),
            *self.place,
            *self.direction,
            *self.color,
            self.intensity,
            self.reach,
            self.inner,
            self.outer,
            self.size,
            float(self.on),
        )


def lights_of(numbers: tuple[float, ...]) -> tuple[Light, ...]:
    """The lights that a value holds."""
    return tuple(_light(numbers[at : at + LIGHT_NUMBERS]) for at in range(0, len(numbers), LIGHT_NUMBERS))


def numbers_of(lights: tuple[Light, ...]) -> tuple[float, ...]:
    """The value that holds these lights."""
    return tuple(part for light in lights for part in light.numbers)


def _light(numbers: tuple[float, ...]) -> Light:
    kind, px, py, pz, dx, dy, dz, red, green, blue, intensity, reach, inner, outer, size, on = numbers
    return Light(
        LightKind(int(kind)),
        (px, py, pz),
        (dx, dy, dz),
        (red, green, blue),
        intensity,
        reach,
        inner,
        outer,
        size,
        on > 0.5,
    )
