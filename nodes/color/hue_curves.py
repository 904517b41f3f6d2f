from typing import Annotated

from .._declare import Curve, Doc, Image, Points, Pointwise, Trait

_TURN = (0.0, 0.0, 1.0, 0.0)
_FACTOR = (0.0, 1.0, 1.0, 1.0)


class HueCurves(Pointwise):
    """Change the hue, saturation or brightness of some hues only, by curves.

    From left to right: red, yellow, green, cyan, blue, magenta and red again (the hue of HSV). Colors are turned and
    saturated in OKLab (Ottosson 2020), where their lightness stays. Grays have no hue, and faint colors change little:
    as much as they are saturated. Give the first and the last point of a curve the same height.
    """

    aliases = (
        "hue curves", "hue vs hue", "hue vs sat", "hue vs lum", "sat vs sat", "hue correct", "hue shift", "hue curve",
        "color curves by hue", "secondary grade", "selective color", "color equalizer", "hsl curves", "hue saturation",
        "leave color", "change to color",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR,)

    image = Image()
    hue_by_hue: Annotated[
        Points,
        Curve(-0.25, 0.25, minimum=-1.0, maximum=1.0, cyclic=True),
        Doc("How far each hue turns, in full turns."),
    ] = _TURN
    saturation_by_hue: Annotated[
        Points, Curve(0.0, 2.0, minimum=0.0, maximum=16.0, cyclic=True), Doc("Factor on the saturation of each hue.")
    ] = _FACTOR
    light_by_hue: Annotated[
        Points, Curve(0.0, 2.0, minimum=0.0, maximum=16.0, cyclic=True), Doc("Factor on the light of each hue.")
    ] = _FACTOR
    saturation_by_saturation: Annotated[
        Points,
        Curve(0.0, 2.0, minimum=0.0, maximum=16.0),
        Doc("Factor on the saturation of faint colors at the left, and of pure ones at the right."),
    ] = _FACTOR

    def identity(self) -> str | None:
        factors = (self.saturation_by_hue, self.light_by_hue, self.saturation_by_saturation)
        return "image" if self.hue_by_hue == _TURN and all(curve == _FACTOR for curve in factors) else None
