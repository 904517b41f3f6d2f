from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Position, Resampling, Trait

_COUNT = 4
"""The points of the grid across, and down."""

_NAMES = tuple(tuple(f"point_{row}{column}" for column in range(1, _COUNT + 1)) for row in range(1, _COUNT + 1))
_REST = tuple(tuple((column / 3, row / 3) for column in range(_COUNT)) for row in range(_COUNT))
_STARTS = 2 * (_COUNT - 1) + 1
"""Places across, and down, of which the nearest one is where the search for a pixel's source starts."""

_INSIDE = (0.0, 1.6, -0.4, 0.0), (0.0, -3.6, 2.4, 0.0), (0.0, 2.4, -3.6, 0.0), (0.0, -0.4, 1.6, 0.0)
"""The second derivatives at the four points of a natural cubic spline through 1 at one of them and 0 at the others."""


class GridWarp(Filter):
    """Bend the picture by a grid of 4 x 4 points: for faces, cloth, labels on bottles and to line up two pictures.

    What lies at a point of the grid goes to where the point is dragged. In between, the grid is a natural cubic spline
    along both axes, which bends evenly, or bilinear. Beyond the grid it goes on straight. The source of each pixel is
    found by Newton's method; where the grid is folded over, one of the layers is shown.
    """

    aliases = (
        "mesh warp", "grid distort", "griddistort", "bezier warp", "warp", "puppet", "liquify", "lattice", "cage",
        "free form deformation", "bend", "bicubic warp", "smear", "grid warper",
    )  # fmt: skip
    traits = (Trait.WARPS,)

    image = Image()
    out = OutputSocket(follows="image")
    point_11: Annotated[Position, Doc("Where the point in row 1, column 1 goes.")] = (0.0, 0.0)
    point_12: Annotated[Position, Doc("Where the point in row 1, column 2 goes.")] = (1 / 3, 0.0)
    point_13: Annotated[Position, Doc("Where the point in row 1, column 3 goes.")] = (2 / 3, 0.0)
    point_14: Annotated[Position, Doc("Where the point in row 1, column 4 goes.")] = (1.0, 0.0)
    point_21: Annotated[Position, Doc("Where the point in row 2, column 1 goes.")] = (0.0, 1 / 3)
    point_22: Annotated[Position, Doc("Where the point in row 2, column 2 goes.")] = (1 / 3, 1 / 3)
    point_23: Annotated[Position, Doc("Where the point in row 2, column 3 goes.")] = (2 / 3, 1 / 3)
    point_24: Annotated[Position, Doc("Where the point in row 2, column 4 goes.")] = (1.0, 1 / 3)
    point_31: Annotated[Position, Doc("Where the point in row 3, column 1 goes.")] = (0.0, 2 / 3)
    point_32: Annotated[Position, Doc("Where the point in row 3, column 2 goes.")] = (1 / 3, 2 / 3)
    point_33: Annotated[Position, Doc("Where the point in row 3, column 3 goes.")] = (2 / 3, 2 / 3)
    point_34: Annotated[Position, Doc("Where the point in row 3, column 4 goes.")] = (1.0, 2 / 3)
    point_41: Annotated[Position, Doc("Where the point in row 4, column 1 goes.")] = (0.0, 1.0)
    point_42: Annotated[Position, Doc("Where the point in row 4, column 2 goes.")] = (1 / 3, 1.0)
    point_43: Annotated[Position, Doc("Where the point in row 4, column 3 goes.")] = (2 / 3, 1.0)
    point_44: Annotated[Position, Doc("Where the point in row 4, column 4 goes.")] = (1.0, 1.0)
    interpolation: Annotated[
        Literal["smooth", "linear"], Doc("Between points: smooth bends evenly, linear keeps cells apart.")
    ] = "smooth"
    kernel: Resampling = "triangle"
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "black"

    def identity(self) -> str | None:
        return "image" if self._points == _REST else None

    @property
    def _points(self) -> tuple[tuple[tuple[float, float], ...], ...]:
        return tuple(tuple(getattr(self, name) for name in row) for row in _NAMES)

    def passes(self, draw: Draw) -> Drawn:
        across, down = (tuple(point[axis] for row in self._points for point in row) for axis in (0, 1))
        return draw(
            "grid_warp", self.image, edge=self.edge, starts=draw.table(self._list_starts(), _STARTS * _STARTS),
            across=across, down=down, interpolation=self.interpolation, kernel=self.kernel,
        )  # fmt: skip

    def _list_starts(self) -> tuple[float, ...]:
        """Points at every half cell: where each is in the result, and on the grid."""
        places = [_weigh(0.5 * index, is_smooth=self.interpolation == "smooth") for index in range(_STARTS)]
        numbers = list[float]()
        for row, below in enumerate(places):
            for column, beside in enumerate(places):
                for axis in (0, 1):
                    terms = (
                        below[i] * beside[j] * point[axis]
                        for i, points in enumerate(self._points)
                        for j, point in enumerate(points)
                    )
                    numbers.append(sum(terms))
                numbers += (0.5 * column, 0.5 * row)
        return tuple(numbers)


def _weigh(t: float, *, is_smooth: bool) -> tuple[float, ...]:
    """What each of four points in a row counts at `t` from 0 to 3."""
    cell = min(int(t), _COUNT - 2)
    f = t - cell
    g = 1.0 - f
    weights = list[float]()
    for index, bends in enumerate(_INSIDE):
        weight = g * (index == cell) + f * (index == cell + 1)
        if is_smooth:
            weight += ((g * g * g - g) * bends[cell] + (f * f * f - f) * bends[cell + 1]) / 6.0
        weights.append(weight)
    return tuple(weights)
