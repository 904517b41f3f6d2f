from typing import Annotated, Literal

from .._declare import (
    Doc,
    Field,
    Fraction,
    Image,
    OutputSocket,
    PatternLoop,
    PatternOffset,
    PatternPeriod,
    Pointwise,
    ProxyNote,
    Slider,
    Vector,
)


class Worley(Pointwise):
    """Cells, as in stone, scales or foam: the distance of every pixel from the nearest of scattered points.

    Worley 1996, "A Cellular Texture Basis Function", with one point in every cell of a cubic lattice. The picture shows
    a slice of the lattice, and the 27 cells around each pixel are searched. Distances are counted in cells. Hash: pcg3d
    (Jarzynski and Olano 2020), the same on every device.
    """

    aliases = (
        "voronoi", "voronoi texture", "cell pattern", "cellular", "cells", "cell noise", "cells noise", "mosaic cells",
    )  # fmt: skip

    proxy_notes = (ProxyNote(("cell",), "its pattern is as fine as pixels of the proxy"),)

    feature: Annotated[
        Literal["f1", "f2", "f2-f1"],
        Doc(
            "F1 is the distance to the nearest point, F2 that to the second nearest; their difference draws the "
            "borders."
        ),
    ] = "f1"
    metric: Annotated[
        Literal["euclidean", "manhattan", "chebyshev"],
        Doc("Euclidean cells are round, Manhattan ones diamonds, Chebyshev ones square."),
    ] = "euclidean"
    size: Annotated[float, Slider(1.0, 512.0, unit="px", minimum=0.01, doc="Size of a cell.")] = 48.0
    jitter: Annotated[Fraction, Doc("How far points are from the middle of their cells; 0 is a regular grid.")] = 1.0
    seed: Annotated[int, Slider(0, 1000, unit="count", doc="Another number gives another pattern.")] = 0
    evolution: Annotated[float, Slider(0.0, 10.0, unit="ratio", doc="Moves the slice: changes the cells smoothly.")] = (
        0.0
    )
    offset: PatternOffset = (0.0, 0.0)
    period: Annotated[
        PatternPeriod,
        Doc(
            "After how many pixels the pattern repeats, across and down; 0 never does. The size changes so that a "
            "whole number of cells fits."
        ),
    ] = (0.0, 0.0)
    loop: Annotated[
        PatternLoop, Doc("After how much evolution the pattern is the same again; 0 is never. A whole number is best.")
    ] = 0.0

    out = OutputSocket(Image(doc="The distance as an opaque gray."))
    value = OutputSocket(Field(doc="The distance, in cells."))
    cell = OutputSocket(Vector(doc="Three random numbers 0..1 for each cell."))
