"""Changes of color that OpenColorIO knows how to compute."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class SpaceChange:
    """From one color space to another, by the names of OpenColorIO's built-in config or their aliases."""

    source: str
    target: str


@dataclass(frozen=True)
class LookupFile:
    """A table or list of operations in a file: .cube, .3dl, .csp, .spi1d, .spi3d, .clf, .cc, .icc and others."""

    path: str
    inverse: bool = False


ColorChange = SpaceChange | LookupFile
