from typing import Annotated

from .._declare import Dial, Field, Image, OutputSocket, PatternOffset, PatternPeriod, Pointwise, Slider


class GaborNoise(Pointwise):
    """Random waves of one length, along one direction or along all: for brushed metal, water, wood, fur and cloth.

    Gabor noise (Lagae et al. 2009, "Procedural Noise using Sparse Gabor Convolution"), with a random phase for each
    kernel and equally many in each cell, so that the noise is as strong everywhere (Tavernier et al. 2019, "Making
    Gabor Noise Fast and Normalized"). A kernel is a wave within a Gaussian of which a constant is taken away, so that
    it ends at its radius R. Its spectrum is about a Gaussian around the wave, with a standard deviation of 0.30 / R.
    """

    aliases = (
        "gabor", "gabor texture", "anisotropic noise", "directional noise", "band-pass noise", "brushed metal",
        "fibers", "wood grain", "water ripples", "fur", "sparse convolution",
    )  # fmt: skip

    wavelength: Annotated[
        float, Slider(2.0, 256.0, unit="px", minimum=0.01, doc="From one crest of a wave to the next.")
    ] = 24.0
    radius: Annotated[
        float,
        Slider(
            0.5,
            8.0,
            unit="ratio",
            minimum=0.1,
            maximum=64.0,
            doc="How far a wave reaches, in wavelengths. A larger radius keeps more closely to wavelength and angle.",
        ),
    ] = 2.0
    angle: Annotated[
        float,
        Slider(-180.0, 180.0, unit="deg", doc="The direction in which crests follow each other."),
        Dial("clockwise"),
    ] = 0.0
    spread: Annotated[
        float,
        Slider(
            0.0,
            180.0,
            unit="deg",
            minimum=0.0,
            maximum=180.0,
            doc="How far directions vary around the angle; 180 is all.",
        ),
    ] = 20.0
    waves: Annotated[
        int,
        Slider(1, 16, unit="count", minimum=1, maximum=64, doc="How many waves start in each cell of one radius."),
    ] = 4
    contrast: Annotated[
        float,
        Slider(
            0.0,
            4.0,
            unit="ratio",
            minimum=0.0,
            maximum=64.0,
            doc="At 1, black and white lie three standard deviations from the middle; values beyond them are clipped.",
        ),
    ] = 1.5
    seed: Annotated[int, Slider(0, 1000, unit="count", doc="Another number gives another pattern.")] = 0
    evolution: Annotated[
        float,
        Slider(0.0, 10.0, unit="ratio", doc="Moves each wave through its place; whole numbers give the same picture."),
    ] = 0.0
    offset: PatternOffset = (0.0, 0.0)
    period: PatternPeriod = (0.0, 0.0)

    out = OutputSocket(Image(doc="The value as an opaque gray."))
    value = OutputSocket(Field(doc="The value, 0..1. The average is 0.5."))
