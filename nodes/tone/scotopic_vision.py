from math import degrees, pi, sqrt
from typing import Annotated

from .._declare import Doc, Draw, Drawn, Field, Filter, Fraction, Image, Number, Pixels, Slider, Trait

_DAY, _NIGHT = 17.25 * pi / 2.0 + 25.72, 2.0
"""Finest stripes that the eye can tell apart, in cycles per degree: in bright light, and where the fit ends."""

_FINEST, _STEP = 0.5, sqrt(2.0)
"""Sigma of the least blur in pixels, and from one to the next."""

_STRIPE_SIGMAS = 1.86
"""Sigmas in a period of stripes of which a Gaussian blur leaves 0.3 percent."""


class ScotopicVision(Filter):
    """See as eyes do at night: dark places lose color and sharpness, reds get darker, and the rest turns bluish.

    Rods replace cones by `0.04 / (0.04 + Y)` for a luminance of Y cd/m2. They see `V = Y (1.33 (1 + (Y + Z) / X) -
    1.68)` of CIE XYZ, which is scaled here so that white keeps its luminance (Ward Larson et al. 1997, Krawczyk et al.
    2005). Sharpness follows the finest stripes that are visible at Y, `17.25 atan(1.4 log10 Y + 0.35) + 25.72` cycles
    per degree, where that is less than in daylight. The picture does not get darker: lower its exposure yourself.
    """

    aliases = ("night vision", "day for night", "moonlight", "purkinje", "night", "rod vision", "moon light")
    traits = (Trait.NEEDS_COLOR, Trait.NEEDS_SCENE_LIGHT)

    image = Image()
    adaptation = Number(0.0, doc="The luminance to which the eye is adapted; without a link it is that of each pixel.")
    nits: Annotated[
        float,
        Slider(
            0.001,
            10.0,
            unit="ratio",
            minimum=0.0,
            doc="cd/m2 of a luminance of 1 in the scene. Moonlight is about 0.05.",
        ),
    ] = 0.1
    amount: Annotated[Fraction, Doc("0 leaves the picture as it is.")] = 1.0
    blue_shift: Annotated[
        float,
        Slider(
            0.0, 2.0, unit="ratio", minimum=0.0, maximum=4.0, doc="How bluish the night is: 0 gray, 1 as published."
        ),
    ] = 1.0
    brightness: Annotated[
        float,
        Slider(
            0.0, 2.0, unit="ratio", minimum=0.0, doc="Brightness of the rods' response: 1 keeps the luminance of white."
        ),
    ] = 1.0
    blur: Annotated[
        float,
        Slider(0.0, 3.0, unit="ratio", minimum=0.0, maximum=20.0, doc="Loss of sharpness: 0 none, 1 as an eye has it."),
    ] = 1.0
    field_of_view: Annotated[
        float,
        Slider(
            10.0,
            120.0,
            unit="deg",
            minimum=0.1,
            maximum=360.0,
            doc="The visual angle of the picture's width, for the sharpness.",
        ),
    ] = 50.0

    def identity(self) -> str | None:
        return "image" if self.amount == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        """Mix the blur of each pixel from a ladder of blurs of the whole picture, because its sigma depends on its
        light.
        """
        light = draw.point(
            "scotopic_vision_light",
            self.image,
            result=Field(),
            adaptation=self.adaptation,
            local=not draw.is_linked(self.adaptation),
            nits=self.nits,
        )
        night_view = draw.point(
            "scotopic_vision",
            self.image,
            light=light,
            amount=self.amount,
            blue_shift=self.blue_shift,
            brightness=self.brightness,
        )
        scale = self.amount * self.blur * draw.size[0] / degrees(self.field_of_view) / _STRIPE_SIGMAS
        widest = scale * sqrt(_NIGHT**-2 - _DAY**-2)
        if widest < _FINEST / 2.0:
            return night_view
        sigma = draw.point("scotopic_vision_sigma", result=Field(), light=light, scale=scale)
        sigmas = [min(_FINEST, widest)]
        while sigmas[-1] < widest:
            sigmas.append(min(sigmas[-1] * _STEP, widest))
        blurred: Pixels = night_view
        for low, high in zip([0.0, *sigmas], sigmas, strict=False):
            blurred = draw.point(
                "scotopic_vision_blur", sharp=blurred, soft=draw.blur(night_view, high), sigma=sigma, low=low, high=high
            )
        assert not isinstance(blurred, Image)
        return blurred
