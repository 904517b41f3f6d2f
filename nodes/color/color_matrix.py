from collections.abc import Mapping
from types import MappingProxyType
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Filter, Image, Kernel3x3, Slider

_IDENTITY: Kernel3x3 = (1, 0, 0, 0, 1, 0, 0, 0, 1)

_MATRICES: Mapping[str, Kernel3x3] = MappingProxyType(
    {
        "sepia": (0.393, 0.769, 0.189, 0.349, 0.686, 0.168, 0.272, 0.534, 0.131),
        "rec709 to rec2020": (
            0.6274038959,
            0.3292830384,
            0.0433130657,
            0.0690972894,
            0.9195403951,
            0.0113623156,
            0.0163914389,
            0.0880133079,
            0.8955952532,
        ),
        "rec709 to p3": (
            0.8224619687,
            0.1775380313,
            0.0,
            0.0331941989,
            0.9668058011,
            0.0,
            0.0170826307,
            0.0723974407,
            0.9105199286,
        ),
        "rec709 to acescg": (
            0.6130974024,
            0.3395231462,
            0.0473794514,
            0.0701937225,
            0.9163538791,
            0.0134523985,
            0.0206155929,
            0.1095697729,
            0.8698146342,
        ),
        "rec709 to xyz": (
            0.4123907993,
            0.3575843394,
            0.1804807884,
            0.2126390059,
            0.7151686788,
            0.0721923154,
            0.0193308187,
            0.1191947798,
            0.9505321522,
        ),
    }
)
"""Conversions follow the primaries that the node names; sepia is that of the W3C's Filter Effects."""

_SINGULAR = 1e-12
"""A determinant that is 0 but for the rounding of doubles."""


class ColorMatrix(Filter):
    """Multiply colors by a 3 x 3 matrix: a conversion between primaries, a look, or nine numbers of your own.

    out = matrix * rgb, with one row per output channel. The offset is added as far as alpha covers the pixel.
    Conversions follow the primaries of ITU-R BT.709, BT.2020, SMPTE EG 432 (P3, D65), ACES S-2014-004 (Bradford from
    D65) and CIE 1931 XYZ. Alpha stays.
    """

    aliases = ("matrix", "rgb matrix", "color transform matrix", "matrix color")

    image = Image()
    preset: Annotated[
        Literal[
            "custom",
            "sepia",
            "rec709 to rec2020",
            "rec709 to p3",
            "rec709 to acescg",
            "rec709 to xyz",
        ],
        Doc("A well-known matrix; `custom` uses the nine numbers below."),
    ] = "sepia"
    matrix: Annotated[Kernel3x3, Doc("Nine numbers row by row, for the preset `custom`.")] = _IDENTITY
    direction: Annotated[
        Literal["forward", "inverse"],
        Doc("Inverse undoes what forward did. A matrix that has no inverse is used as it is."),
    ] = "forward"
    offset: Annotated[
        tuple[float, float, float],
        Slider(-1.0, 1.0, unit="scene", doc="Light added to red, green and blue after the matrix."),
    ] = (0.0, 0.0, 0.0)

    def resolve_matrix(self) -> Kernel3x3:
        """The matrix that is applied: preset and direction resolved."""
        matrix = _MATRICES.get(self.preset, self.matrix)
        return _inverse(matrix) if self.direction == "inverse" else matrix

    def identity(self) -> str | None:
        return "image" if self.resolve_matrix() == _IDENTITY and self.offset == (0.0, 0.0, 0.0) else None

    def passes(self, draw: Draw) -> Drawn:
        return draw.point("color_matrix", self.image, matrix=self.resolve_matrix(), offset=self.offset)


def _inverse(matrix: Kernel3x3) -> Kernel3x3:
    """By cofactors; the matrix itself where its determinant is 0."""
    a, b, c, d, e, f, g, h, i = matrix
    first, second, third = e * i - f * h, f * g - d * i, d * h - e * g
    whole = a * first + b * second + c * third
    if abs(whole) < _SINGULAR:
        return matrix
    return (
        first / whole,
        (c * h - b * i) / whole,
        (b * f - c * e) / whole,
        second / whole,
        (a * i - c * g) / whole,
        (c * d - a * f) / whole,
        third / whole,
        (b * g - a * h) / whole,
        (a * e - b * d) / whole,
    )
