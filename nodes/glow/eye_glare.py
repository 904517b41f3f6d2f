import math
from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Filter, Fraction, Image, OutputSocket, ProxyNote, Slider, Trait, Vector

_SMOOTH = 0.2
"""Degrees over which nothing of the glare changes much, but near its middle."""

_NEAR = (6.0, 14.0)
"""Where a smaller size takes over, in pixels of it. A choice."""

_HALO_TEXELS = 2048
"""For 6 degrees: 54 texels to the sigma of a ring of the halo, which is 0.16 degrees (1 / sqrt(2 * 19.75))."""

_DATA = Vector(width=4)


class EyeGlare(Filter):
    """Add the glare that lights have in the human eye, with rays and a colored halo.

    Spencer, Shirley, Zimmerman and Greenberg (1995): at an angle of t degrees, the eye scatters `20.91 / (t + 0.02)^3`
    and `72.37 / (t + 0.02)^2` per steradian. In the dark it also has a halo for each wavelength, `436.9 (568/nm)
    exp(-19.75 (t - 3 nm/568)^2)`. Light that is not scattered stays sharp. Every pixel loses the light that it
    scatters: no light is made or lost, and an even picture does not change. `glow` is the scattered light alone. Alpha
    is kept.
    """

    aliases = ("glare", "starburst", "veiling glare", "temporal glare", "lens glare", "eyelashes")
    traits = (Trait.NEEDS_COLOR, Trait.NEEDS_SCENE_LIGHT, Trait.NEEDS_HIGHLIGHTS)
    proxy_notes = (
        ProxyNote(
            ("glow",),
            "light that is scattered within a pixel counts as sharp, and pixels of a proxy are larger",
            "look",
        ),
    )

    image = Image()
    vision: Annotated[
        Literal["photopic", "mesopic", "scotopic"],
        Doc("What the eye is adapted to: daylight, dusk or night. A wider pupil gives more halo."),
    ] = "scotopic"
    field_of_view: Annotated[
        float,
        Slider(
            5.0,
            120.0,
            unit="deg",
            minimum=0.1,
            maximum=180.0,
            doc="The visual angle of the picture's height. Smaller angles make the glare larger.",
        ),
    ] = 40.0
    rays: Annotated[Fraction, Doc("How strongly the glare is divided into rays (the ciliary corona).")] = 0.5
    strength: Annotated[
        float, Slider(0.0, 1.0, unit="ratio", minimum=0.0, doc="The strength of the glare: 1 is that of the eye.")
    ] = 1.0

    out = OutputSocket()
    glow = OutputSocket()

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        width, height = draw.size
        degrees = math.degrees(self.field_of_view) / height
        factor = 2 ** max(0, min(4, math.floor(math.log2(_SMOOTH / degrees))))
        reach = math.ceil(_NEAR[1] * factor)
        light = draw.point("eye_glare_light", self.image)
        if factor == 1 or 2 * reach > max(width, height):
            glare = draw.convolve_2d(light, self._kernel(draw, degrees, 1, (width, height), whole=True))
        else:
            small = (math.ceil(width / factor) + 2, math.ceil(height / factor) + 2)
            shrunk = draw("eye_glare_shrink", image=light, size=small, edge="black", result=_DATA, factor=factor)
            kernel = self._kernel(draw, degrees, factor, small)
            kernel = draw("eye_glare_sharpen", kernel=kernel, size=kernel.size, result=_DATA)
            far = draw.convolve_2d(shrunk, kernel)
            near = draw.convolve_2d(light, self._kernel(draw, degrees, 1, (reach, reach), factor))
            glare = draw("eye_glare_grow", near=near, far=far, result=_DATA, factor=factor)
        out = draw.point("eye_glare", self.image, glare=glare, strength=self.strength)
        return {"out": out, "glow": draw.point("eye_glare_glow", self.image, glare=glare, strength=self.strength)}

    def _kernel(
        self, draw: Draw, degrees: float, cell: int, reach: tuple[int, int], factor: int = 0, whole: bool = False
    ) -> Drawn:
        halo = draw("eye_glare_halo", size=(_HALO_TEXELS, 1), result=_DATA)
        first, last = (0.0, 0.0) if whole else ((factor or cell) * part for part in _NEAR)
        # "from" and "to" are words of Python's or of GLSL's: they travel as one.
        return draw(
            "eye_glare_kernel",
            halo=halo,
            size=(2 * reach[0] - 1, 2 * reach[1] - 1),
            result=_DATA,
            vision=self.vision,
            pitch=degrees,
            cell=cell,
            fade=(first, last),
            rays=self.rays,
        )
