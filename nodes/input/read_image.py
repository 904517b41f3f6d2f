from collections.abc import Mapping
from typing import Annotated

from .._declare import Doc, Draw, Drawn, Field, File, OfSpace, OutputSocket, Reader, Vector


class ReadImage(Reader):
    """Read one layer of an image file.

    `out` is the layer as color, `field` its first channel as data (depth, a mask), `vector` its first three channels
    as data (normals, positions). Files: whatever OpenImageIO reads; a layer may be named in any of the usual ways
    (`Depth`, `Depth.Z`, `ViewLayer.Combined`).
    """

    aliases = (
        "read", "load", "loader", "image", "open", "import", "file", "footage", "input", "media", "image sequence",
        "movie", "movie clip", "video", "picture", "plate", "texture file", "media in",
    )  # fmt: skip

    path: Annotated[str, File(layer="layer"), Doc("Image file, relative to the graph's folder.")] = ""
    layer: Annotated[str, Doc("Name of the layer; empty for the file's first color layer.")] = ""
    color_space: Annotated[
        str,
        OfSpace(),
        Doc(
            "The color space of `out`, by a name or role of the color config, such as ACEScg; empty "
            "recognizes it. Data is never converted."
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
