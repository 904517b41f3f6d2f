"""A world for compiling: pictures are headers of one size, colors and meshes are real."""

from __future__ import annotations

from halation.inputs.provider import MediaProvider
from halation.nodes import Missing
from halation.resources.picture import Picture
from halation.resources.provider import FrameFile, PictureProbe
from halation.resources.sandbox import UNRESTRICTED


class Headers(MediaProvider):
    """Every picture has the same size; no file is read for it."""

    def __init__(self, size: tuple[int, int]) -> None:
        super().__init__(sandbox=UNRESTRICTED)
        self.size = size

    def find_frame_file(self, path: str, frame: int, missing: Missing) -> FrameFile:
        return FrameFile(path)

    def probe_picture(self, picture: Picture) -> PictureProbe:
        return PictureProbe(self.size, False, picture.path)
