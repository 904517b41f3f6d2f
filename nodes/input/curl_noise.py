from typing import Annotated

from .._declare import Doc, Field, OutputSocket, PatternLoop, PatternOffset, PatternPeriod, Pointwise, Slider, Vector


class CurlNoise(Pointwise):
    """A random flow with eddies, like smoke or water, without sources or sinks. A vector map for Displace.

    Curl noise (Bridson, Hourihan and Nordenstam, 2007) in two dimensions: (d/dy, -d/dx) of a stream function, with
    exact derivatives. The stream function is simplex noise (Perlin, 2001; Gustavson and McEwan, 2022) in layers (fBm).
    """

    aliases = ("flow field", "turbulence", "vector noise", "swirl noise", "flow")

    size: Annotated[float, Slider(1.0, 512.0, unit="px", minimum=0.01, doc="Size of the largest eddies.")] = 128.0
    octaves: Annotated[
        int, Slider(1, 10, unit="count", minimum=1, maximum=16, doc="How many layers, each finer than the one before.")
    ] = 3
    lacunarity: Annotated[
        float, Slider(1.5, 4.0, unit="ratio", minimum=1.0, maximum=16.0, doc="How many times finer each layer is.")
    ] = 2.0
    gain: Annotated[
        float,
        Slider(
            0.0,
            1.0,
            unit="ratio",
            minimum=0.0,
            maximum=4.0,
            doc="How far each layer moves compared to the one before. At 1 / lacunarity all layers "
            "have the same speed.",
        ),
    ] = 0.4
    strength: Annotated[
        float,
        Slider(
            0.0,
            4.0,
            unit="ratio",
            doc="Factor on the vectors. At 1 no vector is longer than 1, and few are longer than 0.5.",
        ),
    ] = 1.0
    seed: Annotated[int, Slider(0, 1000, unit="count", doc="Another number gives another flow.")] = 0
    evolution: Annotated[float, Slider(0.0, 10.0, unit="ratio", doc="Changes the flow smoothly.")] = 0.0
    offset: PatternOffset = (0.0, 0.0)
    period: Annotated[
        PatternPeriod,
        Doc(
            "After how many pixels the pattern repeats, across and down; 0 never does. "
            "The size changes so that a multiple of six eddies fits."
        ),
    ] = (0.0, 0.0)
    loop: Annotated[
        PatternLoop,
        Doc("After how much evolution the pattern is the same again; 0 is never. A multiple of six is best."),
    ] = 0.0

    vector = OutputSocket(Vector(width=2, doc="The flow: x points right and y down."))
    stream = OutputSocket(
        Field(doc="The stream function: the flow runs along its contour lines. Its slope is per size.")
    )
