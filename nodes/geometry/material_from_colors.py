from typing import Annotated, Literal

from .._declare import Doc, Field, Fraction, Image, OutputSocket, Pointwise, Slider, Vector


class MaterialFromColors(Pointwise):
    """Find the color and the metalness of surfaces from the layers of a render, to light it again.

    Renderers such as Cycles write black as the diffuse color of metals, and their color as the glossy color: lit again
    without it, gold is black. Both together tell how much of a surface is metal, for surfaces that reflect 4 percent
    where they are not metal. Dark surfaces that could be both count as no metal.

    Without a layer of glossy color, the render itself tells less: what is black and still gives light mirrors it, and
    has its hue. Black matte surfaces count as metal then. Link the emission too, or lamps do as well.

    Both are estimates: where the renderer writes a metalness, use that. Link `albedo` and `material` to Deferred
    Lighting.
    """

    aliases = ("metalness", "metallic", "base color", "pbr material", "gold", "metals", "specular to metallic")

    diffuse_color = Image(doc="The color of diffuse reflection, without light.")
    glossy_color = Image(
        (0.0, 0.0, 0.0, 1.0), doc="The color of glossy reflection, without light; also called specular."
    )
    beauty = Image(
        (0.0, 0.0, 0.0, 0.0), doc="The render itself, if metals are told by it. Its alpha is that of albedo."
    )
    emission = Image((0.0, 0.0, 0.0, 0.0), doc="The light that surfaces emit, if metals are told by the beauty.")
    roughness = Field(0.4, doc="The layer of roughness, if the renderer writes one: 0 is a mirror, 1 is dull.")
    metals: Annotated[Literal["glossy color", "beauty"], Doc("The layer that tells metals and their color.")] = (
        "glossy color"
    )
    reflectance: Annotated[
        Fraction, Doc("The luminance of the color of metals that are told by the beauty, which only shows its hue.")
    ] = 0.7
    roughen: Annotated[float, Slider(-1.0, 1.0, unit="ratio", doc="Added to the roughness of all surfaces.")] = 0.0
    polish: Annotated[Fraction, Doc("How much less rough metals are than the rest.")] = 0.0

    albedo = OutputSocket(Image(doc="The color of the surfaces, of metals too."))
    material = OutputSocket(Vector(width=2, doc="Metal and roughness, 0 to 1."))
