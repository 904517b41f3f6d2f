from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Field, Filter, Fraction, Image, Pixels, ProxyNote, Slider, Trait
from ._diffusion import fill
from ._morphology import grow


class EdgeExtend(Filter):
    """Let the color of solid pixels grow over the soft edge of a matte, which has color of the old background.

    Color where alpha is high stays; where it is lower, color diffuses in from there. The alpha stays, or the picture
    becomes opaque: then the color goes on over the whole frame, for a matte that is made later.
    """

    aliases = (
        "edge extend", "extend edges", "edge color correction", "matte bleed", "color bleed", "solidify", "edge fill",
        "refine hard matte", "decontaminate", "edge blend", "dilate color", "unmult edges", "alpha bleed",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.USES_ALPHA)

    proxy_notes = (ProxyNote(("out",), "the pixels that count as solid are whole ones"),)

    image = Image(doc="A premultiplied picture.")
    solid: Annotated[
        Fraction,
        Slider(0.05, 1.0, unit="ratio", minimum=1e-3, maximum=1.0, doc="Color stays where alpha is at least this."),
    ] = 0.95
    inset: Annotated[
        float,
        Slider(0.0, 20.0, unit="px", minimum=0.0, maximum=200.0, doc="How far inside of that edge color stays."),
    ] = 1.0
    alpha: Annotated[Literal["keep", "opaque"], Doc("The alpha of the result.")] = "keep"

    def passes(self, draw: Draw) -> Drawn:
        inside: Pixels = self.image
        if self.inset > 0.0:
            inside = grow(draw, self.image, -self.inset, "circle", "clamp")
        known = draw.point("edge_extend_known", inside=inside, solid=self.solid, result=Field())
        color = draw.point("edge_extend_color", self.image)
        filled = fill(draw, color, known)
        return draw.point("edge_extend", self.image, filled=filled, alpha=self.alpha)
