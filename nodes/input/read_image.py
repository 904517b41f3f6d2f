from collections.abc import Mapping
from typing import Annotated

from .._declare import Doc, Draw, Drawn, Field, File, Output, Reader, Vector


class ReadImage(Reader):
    """Read one layer of an image file.

    `out` is the layer as color, `field` its first channel as data (depth, a mask), `vector` its first three channels
    as data (normals, positions). Files: whatever OpenImageIO reads; a layer may be named in any of the usual ways
    (`Depth`, `Depth.Z`, `ViewLayer.Combined`).
    """

    path: Annotated[str, File(layer="layer"), Doc("Image file, relative to the graph's folder.")] = ""
    layer: Annotated[str, Doc("Name of the layer; empty for the file's first color layer.")] = ""

    out = Output()
    field = Output(Field())
    vector = Output(Vector(width=3))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        return {name: draw.read(self.path, self.layer, output.socket) for name, output in self.outputs.items()}
