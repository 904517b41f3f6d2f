"""Why drivers draw some pictures otherwise than llvmpipe: each cause was looked for node by node.

A picture that differs and is not listed here is a fault, of the driver or of ours, that nobody has looked into.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Cause:
    """Why pictures differ on drivers whose name has a word in it."""

    why: str
    word: str
    pictures: frozenset[str]


def _name(nodes: str = "", presets: str = "") -> frozenset[str]:
    return frozenset([*(f"node.{id}" for id in nodes.split()), *(f"preset.{name}" for name in presets.split())])


CAUSES = (
    Cause(
        "softpipe writes an element of an array at the index that the first of four pixels beside each other has",
        "softpipe",
        _name(
            "canny geometry_edges light_shafts oil",
            "day_for_night hazy_lamp power_windows toon_ink x_ray",
        ),
    ),
    Cause(
        "after a hundred pictures a program goes on with a number that its uniform had before; alone it is right",
        "zink, lavapipe",
        _name("", "shallow_focus turntable"),
    ),
    Cause(
        "where shadows and reflections begin, rays along a surface hit it or not: 15 numbers differ by up to .007",
        "zink, lavapipe",
        _name("", "still_life"),
    ),
    Cause(
        "an edge runs through the middle of a pixel, or a corner is between two sixteenths: either face may be drawn",
        "SwiftShader",
        _name("", "city_lights clay_city dolly_zoom"),
    ),
    Cause(
        "a ray along a surface hits it in one pixel and misses it in another",
        "SwiftShader",
        _name("", "still_life"),
    ),
)
"""The causes of all differences above 1/255."""


def find_unexplained(driver: str, differing: Mapping[str, float]) -> dict[str, float]:
    """The pictures that differ for no known cause."""
    known = frozenset[str]().union(*(cause.pictures for cause in CAUSES if cause.word in driver))
    return {name: difference for name, difference in differing.items() if name not in known}
