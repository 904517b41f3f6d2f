from collections.abc import Mapping
from math import ceil
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Filter, Image, Number, OutputSocket, Reach, Slider, Vector

_BLOCK = 16
"""The pixels across and down that one pixel of a count stands for."""

_STEPS = 24
"""How often the range of a percentile is halved: then it is known to five digits, whatever its size."""


class Histogram(Filter):
    """Measure how the light of a channel is distributed: three percentiles, the mean and the standard deviation.

    A percentile is the least value that so many percent of the pixels do not exceed, without interpolation (inverted
    cumulative distribution), to five digits. It is found by halving a range, on a scale that is logarithmic except near
    0. All pixels count alike, as they are (premultiplied); those that are not finite are left out. The numbers stay on
    the GPU and can be linked to any value, such as the black and white point of `levels`.
    """

    aliases = (
        "percentile", "percentiles", "median value", "quantile", "standard deviation", "variance", "auto levels",
        "auto contrast", "contrast stretch", "levels", "image statistics", "curve tool", "normalize",
    )  # fmt: skip

    image = Image()
    channel: Annotated[
        Literal["luminance", "red", "green", "blue", "alpha"], Doc("What is measured: a channel, or the luminance.")
    ] = "luminance"
    low_percentile: Annotated[
        float, Slider(0.0, 100.0, unit="ratio", minimum=0.0, maximum=100.0, doc="The percents of pixels up to `low`.")
    ] = 1.0
    middle_percentile: Annotated[
        float,
        Slider(
            0.0, 100.0, unit="ratio", minimum=0.0, maximum=100.0,
            doc="The percents of pixels up to `middle`; 50 is the median.",
        ),
    ] = 50.0  # fmt: skip
    high_percentile: Annotated[
        float, Slider(0.0, 100.0, unit="ratio", minimum=0.0, maximum=100.0, doc="The percents of pixels up to `high`.")
    ] = 99.0

    low = OutputSocket(Number(doc="The low percentile."))
    middle = OutputSocket(Number(doc="The middle percentile."))
    high = OutputSocket(Number(doc="The high percentile."))
    mean = OutputSocket(Number(doc="The average."))
    deviation = OutputSocket(Number(doc="The standard deviation of all pixels, not of a sample."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        pair, number = Vector(width=2), Number()
        light = draw.point("histogram_light", self.image, result=pair, channel=self.channel)
        sums = draw.reduce(light, "sum")
        mean = draw.point("histogram_mean", result=number, sums=sums)
        squares = draw.reduce(draw.point("histogram_squares", result=pair, light=light, mean=mean), "sum")
        places = self._find_percentiles(draw, light, sums)
        return {
            "low": draw.point("histogram_low", result=number, places=places),
            "middle": draw.point("histogram_middle", result=number, places=places),
            "high": draw.point("histogram_high", result=number, places=places),
            "mean": mean,
            "deviation": draw.point("histogram_deviation", result=number, squares=squares),
        }

    def _find_percentiles(self, draw: Draw, light: Drawn, sums: Drawn) -> Drawn:
        """The codes of three percentiles, as one pixel."""
        triple = Vector(width=3)
        ends = draw.reduce(draw.point("histogram_ends", result=Vector(width=2), light=light), "max")
        below = draw.point("histogram_least", result=triple, ends=ends)
        above = draw.point("histogram_most", result=triple, ends=ends)
        shares = tuple(0.01 * part for part in (self.low_percentile, self.middle_percentile, self.high_percentile))
        size = (ceil(light.size[0] / _BLOCK), ceil(light.size[1] / _BLOCK))
        for _ in range(_STEPS):
            counts = draw(
                "histogram_count", size=size, overlap=Reach.block(_BLOCK, _BLOCK), result=triple,
                light=light, below=below, above=above, block=_BLOCK,
            )  # fmt: skip
            counts = draw.reduce(counts, "sum")
            ranks = {"below": below, "above": above, "counts": counts, "sums": sums}
            below, above = (
                draw.point(function, result=triple, **ranks, shares=shares)
                for function in ("histogram_raise", "histogram_lower")
            )
        return above
