from collections.abc import Mapping
from typing import Annotated

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Slider, Trait


class LightWrap(Filter):
    """Let the light of a background shine around the edge of a subject, as a lens and skin do.

    The background beside the subject is blurred, and what of it falls on the subject is added. `out` is the subject
    with this light, to merge over the background; `light` is the light alone. Light covers nothing, so alpha stays.
    """

    aliases = (
        "light wrap", "edge wrap", "wrap light", "background wrap", "rim wrap", "edge light", "bleed light",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.USES_ALPHA)

    image = Image(doc="The subject, premultiplied.")
    background = Image(doc="The picture behind it.")
    width: Annotated[
        float,
        Slider(0.0, 200.0, unit="px", minimum=0.0, maximum=2000.0, doc="How far the light reaches: two sigma."),
    ] = 24.0
    intensity: Annotated[
        float,
        Slider(0.0, 4.0, unit="ratio", minimum=0.0, doc="Factor on the light; 1 is half of it on a straight edge."),
    ] = 0.5
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    out = OutputSocket(Image(doc="The subject with the light of the background."))
    light = OutputSocket(Image(doc="The light alone, without alpha."))

    def identity(self) -> str | None:
        return "image" if self.intensity == 0.0 else None

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        beside = draw.point("light_wrap_beside", self.image, self.background)
        spread = draw.blur(beside, 0.5 * self.width, self.edge)
        light = draw.point("light_wrap_light", self.image, spread=spread, intensity=self.intensity)
        return {"out": draw.point("light_wrap", self.image, light=light), "light": light}
