import math
from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import (
    Dial,
    Doc,
    Draw,
    Drawn,
    Edge,
    Field,
    Filter,
    Fraction,
    Image,
    OutputSocket,
    ProxyNote,
    Size,
    Slider,
    Trait,
    Vector,
)

_NO_LIMIT = 65504.0
"""The largest half float: nothing that passes keep is brighter."""

_RINGS = 200.0
"""Half the height of an iris' pattern in units of its Fourier transform: its first dark ring lies at 2 percent."""

_BLUEST = 550.0 / 400.0
"""How much further than green light the pattern of an iris is read for violet."""

_FACTORS = {"full": (1, 1), "half": (2, 500), "quarter": (4, 250)}
"""How much smaller light is spread at most, and the lines to leave: proxies and small pictures lose no more."""

_DATA = Vector(width=4)


class KernelGlare(Filter):
    """Turn every light into a picture: a starburst, a heart, dirt on a lens.

    Convolves the light with the picture that is linked to `kernel`. The center of the kernel lies on the light, and its
    alpha is ignored. The kernel is scaled so that the luminance of its sum is 1: it colors the light but adds none.
    Without a link it is the starburst of an iris: Fraunhofer diffraction at a regular polygon, added up over all
    wavelengths. It has one ray for each blade, or two if the number of blades is odd. `glow` is the glare alone. Alpha
    is kept.
    """

    aliases = (
        "glare", "bokeh glare", "convolve", "image kernel", "convolution bloom", "starburst", "aperture glare",
        "diffraction",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.NEEDS_SCENE_LIGHT, Trait.NEEDS_HIGHLIGHTS)
    proxy_notes = (ProxyNote(("glow",), "the average of several pixels exceeds a threshold less often"),)

    image = Image()
    kernel = Image(0.0, own_size=True, doc="What a point of light becomes. Without a link, a starburst.")
    size: Annotated[float, Slider(0.01, 1.5, unit="height", minimum=0.0, maximum=4.0, doc="Height of the kernel.")] = (
        0.8
    )
    blades: Annotated[int, Slider(3, 12, unit="count", minimum=3, maximum=32, doc="Number of blades of the iris.")] = 6
    rotation: Annotated[
        float, Slider(-180.0, 180.0, unit="deg", doc="Turns the iris counterclockwise."), Dial("counterclockwise")
    ] = 15.0
    falloff: Annotated[
        float,
        Slider(
            0.3,
            1.0,
            unit="ratio",
            minimum=0.1,
            maximum=2.0,
            doc="How fast the rays of the iris fade: 1 is physical. Below 1, the rays of weak lamps are longer too.",
        ),
    ] = 0.7
    intensity: Annotated[
        float, Slider(0.0, 1.0, unit="ratio", minimum=0.0, doc="How much glare reaches the picture.")
    ] = 0.2
    mode: Annotated[
        Literal["mix", "add"], Doc("Mix moves light into the glare and keeps the sum; add puts the glare on top.")
    ] = "mix"
    threshold: Annotated[
        float, Slider(0.0, 10.0, unit="scene", minimum=0.0, doc="Only light above this luminance makes glare.")
    ] = 1.0
    knee: Annotated[Fraction, Doc("Softness of the threshold: the part of it over which light fades in.")] = 0.5
    limit: Annotated[
        float,
        Slider(
            1.0,
            1000.0,
            unit="scene",
            minimum=0.0,
            maximum=_NO_LIMIT,
            doc="The largest luminance that makes glare, to limit suns and noise; 65504 is no limit.",
        ),
    ] = _NO_LIMIT
    quality: Annotated[
        Literal["full", "half", "quarter"],
        Doc(
            "The size at which light is spread. Half is nearly four times as fast as full, and softens rays by a "
            "pixel; "
            "small pictures are always spread in full."
        ),
    ] = "half"
    edge: Annotated[
        Edge, Doc("What lies outside the picture. Wrap and panorama leave no seam in pictures that go on.")
    ] = "black"

    out = OutputSocket()
    glow = OutputSocket()

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        factor, lines = _FACTORS[self.quality]
        while factor > 1 and draw.size[1] < factor * lines:
            factor //= 2
        light = draw.point("kernel_glare_light", self.image, threshold=self.threshold, knee=self.knee, limit=self.limit)
        kernel = self._kernel(draw, self.size / factor)
        across, down = (factor * (length // 2 + 1) for length in draw.size_of(kernel))
        around = draw.pad(light, (across, down), self.edge) if self.edge != "black" else light
        if factor == 1:
            glare = draw.convolve_2d(around, kernel)
        else:
            full = draw.size_of(around)
            small = (math.ceil(full[0] / factor) + 2, math.ceil(full[1] / factor) + 2)
            shrunk = draw("kernel_glare_shrink", image=around, size=small, edge="black", result=_DATA, factor=factor)
            spread = draw.convolve_2d(shrunk, kernel)
            glare = draw("kernel_glare_grow", small=spread, size=full, result=_DATA, factor=factor)
        if self.edge != "black":
            glare = draw.pad(glare, (-across, -down))
        glow = draw.point("kernel_glare_glow", self.image, glare=glare)
        out = draw.point("kernel_glare", self.image, light=light, glare=glare, intensity=self.intensity, mode=self.mode)
        return {"out": out, "glow": glow}

    def _kernel(self, draw: Draw, height: float) -> Drawn:
        """The kernel at a height in pixels; it has a middle pixel."""
        linked = draw.is_linked(self.kernel)
        if linked:
            width, full = draw.size_of(self.kernel)
            size = (_odd(height * width / full), _odd(height))
            kernel = draw("kernel_glare_fit", self.kernel, size=size, result=_DATA)
        else:
            kernel = self._iris(draw, (_odd(height), _odd(height)))
        total = draw.reduce(kernel, "sum")
        return draw.point("kernel_glare_normalized", kernel=kernel, sum=total, white=not linked, result=_DATA)

    def _iris(self, draw: Draw, size: Size) -> Drawn:
        wide = _odd(size[1] * _BLUEST + 2.0)
        iris = draw(
            "kernel_glare_iris",
            size=(wide, wide),
            result=Field(),
            pitch=2.0 * _RINGS / size[1],
            blades=self.blades,
            angle=-self.rotation,
            falloff=self.falloff,
        )
        return draw("kernel_glare_dispersed", iris=iris, size=size, result=_DATA)


def _odd(length: float) -> int:
    """The nearest odd number of pixels."""
    return 2 * round((length - 1.0) / 2.0) + 1 if length > 1.0 else 1
