"""What a compilation asks of the world beyond the graph."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from ...nodes import ColorChange, Render, Scene, Size
from .ir import Picture
from .raster import Mesh
from .recolor import ColorProgram


@dataclass(frozen=True)
class Probed:
    """What is known of a picture before it is read."""

    size: Size
    half: bool
    fingerprint: str


class Outside(Protocol):
    """Files, color libraries and meshes. Every method raises InputError for a file that cannot be read."""

    def probe(self, picture: Picture) -> Probed:
        """Look at a picture's header."""
        ...

    def recolor(self, change: ColorChange) -> ColorProgram:
        """Write the program of a change of color. Raises UsageError for a space that nobody knows."""
        ...

    def render(self, path: str) -> Render:
        """Find out which layer of a file is what, how its numbers are meant, and where the camera was."""
        ...

    def mesh(self, scene: Scene) -> Mesh:
        """Get the triangles of a scene."""
        ...
