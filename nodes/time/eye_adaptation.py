from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Image, Number, OutputSocket, ProxyNote, Slider, Temporal, Trait, Vector


class EyeAdaptation(Temporal):
    """Adapt to light and dark as eyes do: they need time after a tunnel, and longer in the dark.

    The adapted luminance A follows the luminance L of the picture (its logarithmic average, Reinhard et al. 2002) by `A
    += (L - A) (1 - exp(-dt / T))`, which is the same at any frame rate. The picture is then exposed so that A becomes
    the key. Natural: T goes from 0.1 s of cones to 0.4 s of rods, by `s = 0.04 / (0.04 + L)` with L in cd/m2, and the
    key is `1.03 - 2 / (2 + log10(L + 1))` (Krawczyk et al. 2005). In the first frame, the eye is already adapted.
    """

    aliases = ("auto exposure", "adaptation", "auto gain", "hdr adaptation", "eye adaption")
    traits = (Trait.NEEDS_COLOR, Trait.NEEDS_SCENE_LIGHT)
    proxy_notes = (ProxyNote(("out",), "the logarithm of an average is larger than the average of the logarithms"),)

    image = Image()
    luminance = Number(0.0, doc="The luminance that the eye follows instead, such as that of Auto Exposure.")
    model: Annotated[Literal["custom", "natural"], Doc("How fast the eye adapts, and to which key.")] = "custom"
    to_bright: Annotated[
        float,
        Slider(0.05, 5.0, unit="s", minimum=0.0, maximum=1e4, doc="Custom: how long the eye needs in more light."),
    ] = 0.4
    to_dark: Annotated[
        float,
        Slider(0.05, 10.0, unit="s", minimum=0.0, maximum=1e4, doc="Custom: how long the eye needs in less light."),
    ] = 1.2
    scale: Annotated[
        Literal["stops", "light"],
        Doc(
            "What changes evenly. Stops are as the eye perceives. Light is as published, and "
            "adapts faster to bright scenes."
        ),
    ] = "stops"
    key: Annotated[
        float, Slider(0.045, 0.72, unit="scene", minimum=1e-3, doc="Custom: what the adapted luminance becomes.")
    ] = 0.18
    nits: Annotated[
        float, Slider(0.01, 1000.0, unit="ratio", minimum=0.0, doc="Natural: cd/m2 of a luminance of 1 in the scene.")
    ] = 100.0
    minimum: Annotated[
        float,
        Slider(-16.0, 0.0, unit="EV", minimum=-32.0, maximum=32.0, doc="The smallest exposure, before compensation."),
    ] = -8.0
    maximum: Annotated[
        float,
        Slider(0.0, 16.0, unit="EV", minimum=-32.0, maximum=32.0, doc="The largest exposure, before compensation."),
    ] = 8.0
    compensation: Annotated[float, Slider(-4.0, 4.0, unit="EV", doc="Brighter or darker than adapted.")] = 0.0

    out = OutputSocket()
    exposure = OutputSocket(Number(doc="The exposure that is applied, in stops."))
    adapted = OutputSocket(Number(doc="The luminance to which the eye is adapted."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        """Follow the average of the picture: the one number that is remembered is the light to which the eye is
        adapted.
        """
        number, natural = Number(), self.model == "natural"
        if draw.is_linked(self.luminance):
            average = draw.point("eye_adaptation_given", self.luminance, result=number)
        else:
            terms = draw.point("eye_adaptation_terms", self.image, result=Vector(width=2))
            average = draw.point("eye_adaptation_average", sums=draw.reduce(terms, "sum"), result=number)
        adapted = draw.point(
            "eye_adaptation_follow",
            seen=average,
            before=draw.history(average),
            passed=1.0 / draw.rate,
            model=self.model,
            times=(self.to_bright, self.to_dark),
            scale=self.scale,
            nits=self.nits,
            result=number,
        )
        draw.remember(adapted)
        exposure = draw.point(
            "eye_adaptation_stops",
            adapted=adapted,
            key=self.key,
            natural=natural,
            nits=self.nits,
            minimum=min(self.minimum, self.maximum),
            maximum=self.maximum,
            compensation=self.compensation,
            result=number,
        )
        return {
            "out": draw.point("eye_adaptation", self.image, exposure=exposure),
            "exposure": exposure,
            "adapted": adapted,
        }
