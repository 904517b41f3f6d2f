"""Changes of color that OpenColorIO computes."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct, field

WORKING_SPACE: Literal["working"] = "working"
"""The name of the space that pictures are in between nodes, whichever that is."""


class ColorSettings(Struct, frozen=True):
    """How a graph manages color.

    `config`: a file of OpenColorIO, or one of its own such as `ocio://default`; without any it is what the environment
    variable OCIO names, else the built-in one. `working`: the space between nodes, by name or role; by default linear
    Rec.709.
    """

    config: str = ""
    working: str = ""


class SpaceChange(Struct, frozen=True):
    """From one color space to another, by names of the config or of OpenColorIO's own studio config."""

    source: str
    target: str
    color: ColorSettings = field(default_factory=ColorSettings)


class LookupFile(Struct, frozen=True):
    """A table or list of operations in a file: .cube, .3dl, .csp, .spi1d, .spi3d, .clf, .cc, .icc and others."""

    path: str
    inverse: bool = False


ColorChange = SpaceChange | LookupFile
