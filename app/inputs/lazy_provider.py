"""A provider of resources that loads media libraries only when a file is needed."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING

from ..resources.sandbox import Sandbox

if TYPE_CHECKING:
    from halation.nodes import ColorChange, ColorSettings, Missing, Render, Scene, TextBlock, TypesetText

    from ..graph import Graph
    from ..resources.color_program import ColorProgram
    from ..resources.mesh import Mesh
    from ..resources.picture import Picture
    from ..resources.provider import FrameFile, PictureProbe
    from ..resources.working_space import WorkingSpace
    from .provider import Binding, MediaProvider


class LazyResourceProvider:
    """A `ResourceProvider` for graphs that may read no file: media libraries are imported with the first one."""

    def __init__(self, sandbox: Sandbox) -> None:
        self.sandbox = sandbox

    @cached_property
    def pictures(self) -> MediaProvider:
        """The provider that reads files."""
        from .provider import MediaProvider

        return MediaProvider(sandbox=self.sandbox)

    def bind(self, graph: Graph, inputs: Mapping[str, Binding]) -> dict[str, Picture]:
        """Pictures for graph inputs by name. Raises UsageError for a name that the graph does not have."""
        return self.pictures.bind(graph, inputs) if inputs else {}

    def find_frames(self, graph: Graph, inputs: Mapping[str, Binding]) -> tuple[int, int]:
        """The first and last frame of a graph, without reading a file if its settings name them."""
        from ..compiler import find_named_files
        from ..graph import find_key_range

        if graph.settings.frames:
            return graph.settings.frames
        if not inputs and not find_named_files(graph, {}):
            return find_key_range(graph)
        return self.pictures.find_frames(graph, self.bind(graph, inputs))

    def check_frames(self, graph: Graph, frames: range) -> None:
        """Raise InputError for a missing file of a sequence."""
        from ..compiler import find_named_files

        if find_named_files(graph, {}):
            self.pictures.check_frames(graph, frames)

    def find_frame_file(self, path: str, frame: int, missing: Missing) -> FrameFile:
        """The file of a frame."""
        return self.pictures.find_frame_file(path, frame, missing)

    def probe_picture(self, picture: Picture) -> PictureProbe:
        """Size and precision of a picture."""
        return self.pictures.probe_picture(picture)

    def write_color_program(self, change: ColorChange) -> ColorProgram:
        """The program of a color change."""
        return self.pictures.write_color_program(change)

    def find_working_space(self, color: ColorSettings) -> WorkingSpace | None:
        """The constants of the working space for shaders."""
        return self.pictures.find_working_space(color)

    def describe_render(self, path: str, named: Mapping[str, str]) -> Render:
        """The layers of a render's file."""
        return self.pictures.describe_render(path, named)

    def load_mesh(self, scene: Scene) -> Mesh:
        """The triangles of a scene."""
        return self.pictures.load_mesh(scene)

    def typeset(self, block: TextBlock) -> TypesetText:
        """The outlines of a text."""
        return self.pictures.typeset(block)

    def read_attributes(self, path: str) -> Mapping[str, str]:
        """What the header of a picture says about it."""
        return self.pictures.read_attributes(path)
