from typing import Annotated

from .._declare import Doc, Fraction, Image, Pointwise, ProxyNote, Slider, Trait


class FilmGrain(Pointwise):
    """Add the grain of photographic film: none in black and white, strongest in the midtones, new in every frame.

    Of the silver grains that light L meets, the share u = L / (L + 0.18) is developed (a logistic characteristic
    curve). Each grain is developed or not, so that the density varies as sqrt(u (1 - u)), as in the Boolean model of
    film (Newson, Delon and Galerne, 2017), separately for each layer of color. Density is logarithmic: light is
    multiplied by 2^grain. It is then divided by the average of that factor, so that the average light stays. Pixels
    that hold several clumps average them (Selwyn, 1935).
    """

    aliases = (
        "grain", "add grain", "noise", "film noise", "scanned grain", "match grain", "iso noise", "film stock",
        "noise hls", "add noise", "sensor noise", "se grain",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR,)
    proxy_notes = (ProxyNote(("out",), "its pattern is as fine as pixels of the proxy"),)

    image = Image()
    amount: Annotated[
        float,
        Slider(
            0.0,
            1.0,
            unit="EV",
            minimum=0.0,
            maximum=8.0,
            doc="The standard deviation of middle gray, in stops. Clumps that are smaller than a pixel vary less.",
        ),
    ] = 0.2
    size: Annotated[float, Slider(0.5, 8.0, unit="px", minimum=0.01, doc="Size of a clump of grains.")] = 1.5
    color: Annotated[
        Fraction, Doc("0 is silver, the same grain for all colors; 1 is dye, another grain for each layer.")
    ] = 0.4
    shadows: Annotated[
        float, Slider(0.0, 2.0, unit="ratio", minimum=0.0, maximum=16.0, doc="Factor on the grain of dark tones.")
    ] = 1.0
    midtones: Annotated[
        float, Slider(0.0, 2.0, unit="ratio", minimum=0.0, maximum=16.0, doc="Factor on the grain around middle gray.")
    ] = 1.0
    highlights: Annotated[
        float, Slider(0.0, 2.0, unit="ratio", minimum=0.0, maximum=16.0, doc="Factor on the grain of bright tones.")
    ] = 1.0
    seed: Annotated[int, Slider(0, 1000, unit="count", doc="Another number gives another grain.")] = 0
    animate: Annotated[bool, Doc("Another grain for each frame, as film has.")] = True

    def identity(self) -> str | None:
        return "image" if self.amount == 0.0 or self.shadows == self.midtones == self.highlights == 0.0 else None
