from typing import Annotated

from halation.nodes import Doc, Draw, Drawn, Filter, Fraction, Image, Slider, Trait


class SoftGlow(Filter):
    """Lay a soft haze of light over the picture, as a diffusion filter in front of a lens does.

    The haze is the picture blurred by a Gaussian. No light is added or lost.
    """

    traits = (Trait.NEEDS_COLOR, Trait.NEEDS_SCENE_LIGHT)

    image = Image()
    radius: Annotated[
        float, Slider(0.0, 0.1, unit="height", minimum=0.0, maximum=1.0, doc="Standard deviation of the haze.")
    ] = 0.02
    amount: Annotated[Fraction, Doc("The share of the haze.")] = 0.3

    def identity(self) -> str | None:
        return "image" if self.amount == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        haze = draw.blur(self.image, sigma=self.radius)
        return draw.point("acme_glow_soft_glow", self.image, haze=haze, amount=self.amount)
