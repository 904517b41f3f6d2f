from math import ceil, log2

from .._declare import Draw, Drawn, Field, Filter, OutputSocket, ProxyNote, Vector


class DistanceField(Filter):
    """Measure the distance of every pixel from the edge of a mask: in pixels, below 0 inside the mask.

    Exact (Euclidean) for a hard mask: jump flooding (Rong and Tan 2006) finds the nearest pixel of the other kind in
    every column, then the nearest of those along the row. Where the border pixels of a mask are soft, the edge lies
    between pixels: the distance is then exact along rows and columns, and within 0.7 pixels where the edge is slanted.
    If a mask has no edge, the distance is the diagonal of the picture.
    """

    aliases = (
        "sdf", "erode", "dilate", "grow", "shrink", "choke", "matte choker", "simple choker", "dilate erode",
        "erode dilate", "spread", "expand mask", "offset mask", "grow bounds", "stroke", "minimax", "outer glow",
        "edge extend", "level set",
    )  # fmt: skip

    proxy_notes = (ProxyNote(("distance",), "its lines have hard edges, and a proxy averages small specks away"),)

    mask = Field()

    distance = OutputSocket(Field(doc="In pixels at full size: 0 on the edge, below 0 inside."))

    def passes(self, draw: Draw) -> Drawn:
        columns = draw.point("distance_field_seeds", self.mask, result=Vector(width=2))
        for level in reversed(range(ceil(log2(max(draw.size_of(self.mask)[1], 2))))):
            columns = draw("distance_field_columns", seeds=columns, result=Vector(width=2), reach=2**level)
        return draw("distance_field", self.mask, columns=columns, result=Field())
