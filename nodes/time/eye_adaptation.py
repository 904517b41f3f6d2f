from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Image, Number, OutputSocket, ProxyNote, Slider, Temporal, Trait, Vector


class EyeAdaptation(Temporal):
    """Get used to light and dark as eyes do: blinded out of a tunnel, blind in a dark room, until the eye has followed.

    The luminance that the eye is adapted to follows that of the picture (its logarithmic average, Reinhard et al. 2002)
    by `A += (L - A) (1 - exp(-dt / T))`, the same at any frame rate, and becomes the key. Natural: T goes from 0.1 s of
    cones to 0.4 s of rods, by `s = 0.04 / (0.04 + L)` of L in cd/m2, and the key is `1.03 - 2 / (2 + log10(L + 1))`
    (Krawczyk et al. 2005). Before the first frame, the eye was used to that.
    """

    aliases = ("auto exposure", "adaptation", "auto gain", "hdr adaptation", "eye adaption")
    traits = (Trait.NEEDS_COLOR, Trait.NEEDS_SCENE_LIGHT)
    proxy_notes = (ProxyNote(("out",), "it measures the logarithm of light, which of averages is more"),)

    image = Image()
    luminance = Number(0.0, doc="What the eye follows instead: a spot, a histogram's middle. See Auto Exposure.")
    model: Annotated[Literal["custom", "natural"], Doc("How fast the eye is, and what it makes of what it knows.")] = (
        "custom"
    )
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
            "What follows evenly: stops, as things look, or light itself, as published, which is quick towards the "
            "bright."
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
        Slider(
            -16.0, 0.0, unit="EV", minimum=-32.0, maximum=32.0, doc="The exposure is never less, before compensation."
        ),
    ] = -8.0
    maximum: Annotated[
        float,
        Slider(
            0.0, 16.0, unit="EV", minimum=-32.0, maximum=32.0, doc="The exposure is never more, before compensation."
        ),
    ] = 8.0
    compensation: Annotated[float, Slider(-4.0, 4.0, unit="EV", doc="Brighter or darker than the eye makes it.")] = 0.0

    out = OutputSocket()
    exposure = OutputSocket(Number(doc="In stops."))
    adapted = OutputSocket(Number(doc="The luminance that the eye is used to."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
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
