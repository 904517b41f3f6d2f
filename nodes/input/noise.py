from typing import Annotated, Literal

from .._declare import (
    Doc,
    Field,
    Image,
    OutputSocket,
    PatternLoop,
    PatternOffset,
    PatternPeriod,
    Pointwise,
    Slider,
    Vector,
)


class Noise(Pointwise):
    """Random but repeatable texture in layers (octaves), from integer hashes: the same on every device.

    Hash: pcg3d (Jarzynski and Olano, 2020). Gradient noise: Perlin (2002); simplex: Perlin (2001), Gustavson and McEwan
    (2022). Layers: fBm (Mandelbrot and van Ness, 1968), ridged (Musgrave, 1994), turbulence (Perlin, 1985), warped
    (Quilez, 2002). Layers are divided by the sum of their strengths, so that every output keeps its range.
    """

    aliases = (
        "fractal noise", "perlin", "fast noise", "clouds", "turbulent noise", "plasma", "fbm", "noise texture",
        "simplex", "turbulence", "cloud", "fractal", "musgrave", "magic texture", "smoke", "se noise", "tileable noise",
        "seamless noise", "looping noise", "white noise texture", "noise alpha",
    )  # fmt: skip

    kind: Annotated[
        Literal["gradient", "value", "white", "simplex"],
        Doc(
            "Gradient is smooth and even (Perlin). Value is smooth and blotchy. White has no "
            "relation between neighbors. Simplex is like gradient with more contrast, which stays"
            " the same at every evolution."
        ),
    ] = "gradient"
    size: Annotated[float, Slider(1.0, 512.0, unit="px", minimum=0.01, doc="Size of the largest features.")] = 64.0
    octaves: Annotated[
        int, Slider(1, 10, unit="count", minimum=1, maximum=16, doc="How many layers, each finer than the one before.")
    ] = 4
    lacunarity: Annotated[
        float, Slider(1.5, 4.0, unit="ratio", minimum=1.0, maximum=16.0, doc="How many times finer each layer is.")
    ] = 2.0
    gain: Annotated[
        float,
        Slider(
            0.0, 1.0, unit="ratio", minimum=0.0, maximum=4.0, doc="How strong each layer is compared to the one before."
        ),
    ] = 0.5
    contrast: Annotated[
        float,
        Slider(
            0.0,
            4.0,
            unit="ratio",
            minimum=0.0,
            maximum=64.0,
            doc="1 keeps the range of the noise, whose ends it rarely reaches. Above 1, values beyond"
            " the ends are clipped.",
        ),
    ] = 2.0
    seed: Annotated[int, Slider(0, 1000, unit="count", doc="Another number gives another pattern.")] = 0
    evolution: Annotated[
        float,
        Slider(0.0, 10.0, unit="ratio", doc="Changes the pattern smoothly; white noise is new at every whole number."),
    ] = 0.0
    fractal: Annotated[
        Literal["fbm", "ridged", "turbulence", "warped"],
        Doc(
            "How layers are added. Fbm: as they are, for clouds. Ridged: sharp crests, with fine "
            "ones only on coarse ones, for mountains and lightning. Turbulence: sharp creases, "
            "for smoke. Warped: fbm distorted by fbm, for marble."
        ),
    ] = "fbm"
    warp: Annotated[
        float, Slider(0.0, 8.0, unit="ratio", doc="How far warped noise is distorted, as a factor on the size.")
    ] = 2.0
    offset: PatternOffset = (0.0, 0.0)
    period: Annotated[
        PatternPeriod,
        Doc(
            "After how many pixels the pattern repeats, across and down; 0 never does. "
            "The size changes so that a whole number of cells fits, of simplex noise a multiple of six."
        ),
    ] = (0.0, 0.0)
    loop: Annotated[
        PatternLoop,
        Doc(
            "After how much evolution the pattern is the same again; 0 is never. "
            "A whole number is best, for simplex noise a multiple of six."
        ),
    ] = 0.0

    out = OutputSocket(Image(doc="The value as an opaque gray."))
    value = OutputSocket(Field(doc="The value, 0..1. The average of fbm is 0.5."))
    vector = OutputSocket(
        Vector(
            width=2,
            doc="Two more noises, each -1..1: an offset for Displace. The average of fbm is 0. See also Curl Noise.",
        )
    )
