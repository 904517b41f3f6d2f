from collections.abc import Mapping
from typing import Annotated

from .._declare import Doc, Draw, Drawn, Filter, Image, Number, OutputSocket, Slider, Vector


class LuminanceStatistics(Filter):
    """Measure how bright the picture is: average, logarithmic average, maximum and minimum of its luminance.

    The measurement is exact over all pixels at any size; pixels that are not finite are left out. The results stay on
    the GPU and can be linked to any value. The logarithmic average is exp(mean(ln(delta + L))) (Reinhard et al. 2002).
    """

    aliases = (
        "levels", "sampler", "curve tool", "average", "mean", "min max color", "measure", "analyze",
        "image stats", "statistics", "auto levels", "min color", "normalize",
    )  # fmt: skip

    image = Image()
    delta: Annotated[
        float,
        Slider(
            1e-6, 1e-2, unit="scene", minimum=1e-12, doc="Keeps black pixels from dominating the logarithmic average."
        ),
    ] = 1e-5
    alpha_weighted: Annotated[
        bool, Doc("Count each pixel by its alpha, with its color unpremultiplied, so that empty areas do not darken.")
    ] = False

    average = OutputSocket(Number())
    log_average = OutputSocket(Number())
    maximum = OutputSocket(Number())
    minimum = OutputSocket(Number())

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        terms = draw.point(
            "luminance_statistics_terms",
            self.image,
            result=Vector(width=3),
            delta=self.delta,
            alpha_weighted=self.alpha_weighted,
        )
        ends = draw.point(
            "luminance_statistics_ends", self.image, result=Vector(width=2), alpha_weighted=self.alpha_weighted
        )
        sums, ends = draw.reduce(terms, "sum"), draw.reduce(ends, "max")
        number = Number()
        return {
            "average": draw.point("luminance_statistics_average", result=number, sums=sums),
            "log_average": draw.point("luminance_statistics_log_average", result=number, sums=sums),
            "maximum": draw.point("luminance_statistics_maximum", result=number, ends=ends),
            "minimum": draw.point("luminance_statistics_minimum", result=number, ends=ends),
        }
