from collections.abc import Mapping
from typing import Annotated

from .._declare import Doc, Draw, Drawn, Field, File, OfSpace, OutputSocket, Reader, Vector


class ReadImage(Reader):
    """Read one layer of a picture file.

    `out` is the layer as color, `field` its first channel as data (depth, a mask), `vector` its first three channels as
    data (normals, positions). It reads all files that OpenImageIO reads. A layer can be named in any of the usual ways
    (`Depth`, `Depth.Z`, `ViewLayer.Combined`).
    """

    aliases = (
        "read", "load", "loader", "image", "open", "import", "file", "footage", "input", "media", "image sequence",
        "movie", "movie clip", "video", "picture", "plate", "texture file", "media in", "movie file in",
    )  # fmt: skip

    path: Annotated[str, File(layer="layer"), Doc("Image file, relative to the graph's folder.")] = ""
    layer: Annotated[str, Doc("Name of the layer. If empty, it is the first color layer of the file.")] = ""
    color_space: Annotated[
        str,
        OfSpace(),
        Doc(
            "The color space of `out`, by a name or role of the color config, such as ACEScg. If "
            "empty, it is recognized. Data is never converted."
        ),
    ] = ""

    out = OutputSocket()
    field = OutputSocket(Field())
    vector = OutputSocket(Vector(width=3))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        return {
            name: draw.read(self.path, self.layer, output.socket, self.color_space)
            for name, output in self.outputs.items()
        }
