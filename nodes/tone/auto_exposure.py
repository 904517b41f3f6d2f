from collections.abc import Mapping
from math import ceil
from typing import Annotated, Literal

from .._declare import (
    Doc,
    Draw,
    Drawn,
    Field,
    Filter,
    Fraction,
    Image,
    Number,
    OutputSocket,
    Position,
    Reach,
    Slider,
    Trait,
    Vector,
)

_BINS = 128
"""A quarter stop each, for 32 stops."""
_FOLD = 32
"""Rows of a table that one draw adds up."""
_LEAST_SHARE = 0.001
"""Between the percentiles there is at least this part of the pixels, so that there is something to average."""
_LONGEST = 8192
"""Pixels of a row that one draw looks at: more may not be on the device."""


class AutoExposure(Filter):
    """Meter the picture and expose it, as automatic cameras do: the metered light becomes middle gray.

    Histogram meters the geometric mean of the luminances between two percentiles. It has 128 bins of a quarter stop,
    from 2^-16 to 2^16; a pixel counts for its two nearest bins by distance, so that their mean is exact. Average and
    log average (Reinhard et al. 2002) use all pixels. Maximum makes the brightest pixel 1. Pixels count by their alpha;
    NaN does not count. `exposure` is in stops, `average` is the metered luminance.
    """

    aliases = (
        "auto gain", "auto levels", "automatic exposure", "normalize", "auto brightness", "auto contrast",
        "exposure normalize", "metering", "match exposure",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.NEEDS_SCENE_LIGHT)

    image = Image()
    mask = Field(1.0, doc="How much each pixel counts.")
    metering: Annotated[
        Literal["histogram", "log average", "average", "maximum"],
        Doc("Histogram ignores extremes. Log average follows dark areas, average bright ones. Maximum clips nothing."),
    ] = "histogram"
    low: Annotated[Fraction, Doc("Histogram: this share of the pixels is too dark to count.")] = 0.1
    high: Annotated[Fraction, Doc("Histogram: pixels above this share are too bright to count.")] = 0.9
    key: Annotated[
        float,
        Slider(
            0.045,
            0.72,
            unit="scene",
            minimum=1e-3,
            doc="The luminance that the average becomes: low for night, high for snow.",
        ),
    ] = 0.18
    auto_key: Annotated[
        bool,
        Doc("Let the average decide the key: 1.03 - 2 / (2 + log10(1 + average in cd/m2)) (Krawczyk et al. 2005)."),
    ] = False
    nits: Annotated[
        float,
        Slider(0.01, 1000.0, unit="ratio", minimum=0.0, doc="For auto key: cd/m2 of a luminance of 1 in the scene."),
    ] = 100.0
    compensation: Annotated[float, Slider(-4.0, 4.0, unit="EV", doc="Brighter or darker than metered.")] = 0.0
    minimum: Annotated[
        float,
        Slider(-16.0, 0.0, unit="EV", minimum=-32.0, maximum=32.0, doc="The smallest exposure, before compensation."),
    ] = -8.0
    maximum: Annotated[
        float,
        Slider(0.0, 16.0, unit="EV", minimum=-32.0, maximum=32.0, doc="The largest exposure, before compensation."),
    ] = 8.0
    center_weight: Annotated[Fraction, Doc("How much more the center counts: 1 is a spot meter.")] = 0.0
    center: Annotated[Position, Doc("The point at which the camera meters.")] = (0.5, 0.5)
    radius: Annotated[
        float,
        Slider(0.02, 0.5, unit="height", minimum=1e-3, doc="Standard deviation of the weights around the center."),
    ] = 0.2

    out = OutputSocket()
    exposure = OutputSocket(Number(doc="In stops."))
    average = OutputSocket(Number(doc="The luminance that was metered."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        light = draw.point(
            "auto_exposure_light",
            self.image,
            self.mask,
            result=Vector(width=2),
            center_weight=self.center_weight,
            center=self.center,
            radius=self.radius,
        )
        average = self._histogram(draw, light) if self.metering == "histogram" else self._statistic(draw, light)
        exposure = draw.point(
            "auto_exposure_stops",
            result=Number(),
            average=average,
            metering=self.metering,
            key=self.key,
            auto_key=self.auto_key,
            nits=self.nits,
            compensation=self.compensation,
            minimum=min(self.minimum, self.maximum),
            maximum=self.maximum,
        )
        out = draw.point("auto_exposure", self.image, exposure=exposure)
        return {"out": out, "exposure": exposure, "average": average}

    def _statistic(self, draw: Draw, light: Drawn) -> Drawn:
        if self.metering == "maximum":
            peak = draw.reduce(draw.point("auto_exposure_peak", light=light, result=Field()), "max")
            return draw.point("auto_exposure_maximum", result=Number(), peak=peak)
        sums = draw.reduce(draw.point("auto_exposure_terms", light=light, result=Vector(width=3)), "sum")
        return draw.point("auto_exposure_mean", result=Number(), sums=sums, metering=self.metering)

    def _histogram(self, draw: Draw, light: Drawn) -> Drawn:
        """A table of bins by rows of the picture, four bins to a pixel; then its rows are added up."""
        place = draw.point("auto_exposure_place", light=light, result=Vector(width=2))
        bins, (width, rows) = Vector(width=4), light.size
        table: Drawn | None = None
        for first in range(0, width, _LONGEST):
            end = min(first + _LONGEST, width)
            piece = Reach((0.0, 0.0, 0.5 * (first + end), 0.0, 1.0, 0.0), (ceil(0.5 * (end - first)), 0))
            row = draw(
                "auto_exposure_row",
                place=place,
                size=(_BINS // 4, rows),
                overlap=piece,
                result=bins,
                first=first,
                end=end,
            )
            table = (
                row
                if table is None
                else draw("auto_exposure_both", one=table, other=row, size=row.size, overlap=0, result=bins)
            )
        assert table is not None
        part: Reach | None = Reach.block(1, _FOLD)
        while rows > 1:
            rows = ceil(rows / _FOLD)
            table = draw(
                "auto_exposure_fold",
                table=table,
                size=(_BINS // 4, rows),
                overlap=part,
                result=bins,
                count=_FOLD,
            )
            part = None  # what is left is made as a whole, so that not all rows are needed at once
        low = min(self.low, self.high, 1.0 - _LEAST_SHARE)
        return draw(
            "auto_exposure_percentiles",
            table=table,
            size=(1, 1),
            result=Number(),
            low=low,
            high=max(self.high, low + _LEAST_SHARE),
        )
