"""What a compilation asks of the world beyond the graph."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from halation.nodes import ColorChange, ColorSettings, Missing, Render, Scene, Size, TextBlock, TypesetText
from msgspec import Struct

from .color_program import ColorProgram
from .mesh import Mesh
from .picture import Picture, PixelRectangle
from .working_space import WorkingSpace


class PictureProbe(Struct, frozen=True):
    """What is known of a picture before it is read."""

    size: Size
    half: bool
    fingerprint: str
    by_rows: bool = False
    """Whether rows of it can be read alone."""
    overscan: PixelRectangle | None = None
    """Its frame and all pixels that it has around it; None where there are none."""
    pixel_aspect: float = 1.0
    """The width of a pixel over its height."""
    finite: bool = False
    """Whether reading it leaves neither NaN nor infinity."""


class FrameFile(Struct, frozen=True):
    """The file that a frame shows. `black`: it has none, this one is as large, and black is to be seen.

    `number` is the frame of a video that is to be shown; of a picture it is 1.
    """

    path: str
    black: bool = False
    number: int = 1


class ResourceProvider(Protocol):
    """Files, color libraries and meshes. Every method raises InputError for a file that cannot be read."""

    def find_frame_file(self, path: str, frame: int, missing: Missing) -> FrameFile:
        """Find the file of a frame, where a path stands for a sequence."""
        ...

    def probe_picture(self, picture: Picture) -> PictureProbe:
        """Look at a picture's header."""
        ...

    def write_color_program(self, change: ColorChange) -> ColorProgram:
        """Write the program of a change of color. Raises UsageError for a space that nobody knows."""
        ...

    def find_working_space(self, color: ColorSettings) -> WorkingSpace | None:
        """Look up the working space; None is linear Rec.709. Raises GraphError for one that nobody knows."""
        ...

    def describe_render(self, path: str, named: Mapping[str, str]) -> Render:
        """Find out which layer of a file is what, how its numbers are meant, and where the camera was.

        `named` are layers that are to have a role, by that.
        """
        ...

    def load_mesh(self, scene: Scene) -> Mesh:
        """Get the triangles of a scene."""
        ...

    def typeset(self, block: TextBlock) -> TypesetText:
        """Get the outlines of a text. Raises InputError for a font that cannot be used."""
        ...

    def read_attributes(self, path: str) -> Mapping[str, str]:
        """Get what the header of a picture says about it, as texts by name."""
        ...
