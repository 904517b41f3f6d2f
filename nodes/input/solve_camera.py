from collections.abc import Mapping
from typing import Annotated

from .._declare import CameraModel, CameraSocket, Doc, Draw, OutputSocket, Reader, RenderPath


class SolveCamera(Reader):
    """Find the camera that a render was made with: solved from its positions, or read from its header.

    The projection is fitted to the position of every pixel by linear least squares, in double precision. `halation info
    FILE` says how exact the fit is, in pixels.
    """

    aliases = ("camera from position", "match camera", "camera solve", "camera tracker", "extract camera")

    path: Annotated[RenderPath, Doc("A render with a position layer, or with a camera in its header.")] = ""

    camera = OutputSocket(CameraSocket())

    def passes(self, draw: Draw) -> Mapping[str, CameraModel]:
        camera = draw.render(self.path).camera
        return {"camera": camera} if camera else {}
