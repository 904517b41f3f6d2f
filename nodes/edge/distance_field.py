from math import ceil, log2

from .._declare import Draw, Drawn, Field, Filter, Output, Vector


class DistanceField(Filter):
    """Measure how far every pixel is from the edge of a mask: in pixels, below 0 inside the mask.

    By jump flooding (Rong and Tan 2006) with three steps more, within 0.15 pixels of the exact distance of a hard mask.
    Where the border pixels of a mask are soft, the edge lies between pixels: exact along rows and columns, within 0.7
    pixels where it is slanted. A mask without an edge is as far away as the picture's diagonal.
    """

    mask = Field()

    distance = Output(Field(doc="In pixels at full size: 0 on the edge, below 0 inside."))

    def passes(self, draw: Draw) -> Drawn:
        seeds = draw.point("distance_field_seeds", self.mask, result=Vector(width=4))
        halvings = ceil(log2(max(*draw.size_of(self.mask), 2)))
        for reach in (1, *(2**level for level in reversed(range(halvings))), 2, 1):
            seeds = draw("distance_field_jump", seeds=seeds, result=Vector(width=4), reach=reach)
        return draw("distance_field", self.mask, seeds=seeds, result=Field())
