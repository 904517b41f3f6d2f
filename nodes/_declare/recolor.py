"""Changes of color that OpenColorIO knows how to compute."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

WORKING_SPACE: Literal["working"] = "working"
"""The name of the space that pictures are in between nodes, whichever that is."""


@dataclass(frozen=True)
class ColorSettings:
    """How a graph manages color.

    `config`: a file of OpenColorIO, or one of its own such as `ocio://default`; without any it is what the environment
    variable OCIO names, else the built-in one. `working`: the space between nodes, by name or role; by default linear
    Rec.709.
    """

    config: str = ""
    working: str = ""


@dataclass(frozen=True)
class SpaceChange:
    """From one color space to another, by names of the config or of OpenColorIO's own studio config."""

    source: str
    target: str
    color: ColorSettings = field(default_factory=ColorSettings)


@dataclass(frozen=True)
class LookupFile:
    """A table or list of operations in a file: .cube, .3dl, .csp, .spi1d, .spi3d, .clf, .cc, .icc and others."""

    path: str
    inverse: bool = False


ColorChange = SpaceChange | LookupFile
