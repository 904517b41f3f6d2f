from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Field, Filter, Fraction, Image, OutputSocket, ProxyNote, Slider, Vector

_REACH = 2
"""How many pixels beside the edge of a metal its color is looked for."""


class MaterialFromColors(Filter):
    """Find the color and the metalness of surfaces from the layers of a render, to light it again.

    Renderers such as Cycles write black as the diffuse color of metals, and their color as the glossy color: lit again
    without it, gold is black. Both together tell how much of a surface is metal, for surfaces that reflect 4 percent
    where they are not metal. Dark surfaces that could be both count as no metal.

    Without a layer of glossy color, the render itself tells less: what is black and still gives light mirrors it, and
    has its hue. Black matte surfaces count as metal then. Link the emission too, or lamps do as well. At the edge of a
    metal, the color of the surface beside it tells how much of a pixel is metal.

    Both are estimates: where the renderer writes a metalness, use that. Link `albedo` and `material` to Deferred
    Lighting.
    """

    aliases = ("metalness", "metallic", "base color", "pbr material", "gold", "metals", "specular to metallic")
    proxy_notes = (ProxyNote(("albedo", "material"), "how much of a surface is metal does not follow from averages"),)

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

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        found = draw.point(
            "material_from_colors_found",
            self.diffuse_color,
            self.glossy_color,
            self.beauty,
            self.emission,
            result=Vector(width=4),
            metals=self.metals,
            reflectance=self.reflectance,
        )
        if self.metals == "beauty":
            found = draw(
                "material_from_colors_edges",
                self.diffuse_color,
                self.beauty,
                found=found,
                overlap={"diffuse_color": 0, "beauty": 0, "found": _REACH},
                result=Vector(width=4),
                metals=self.metals,
            )
        albedo = draw.point(
            "material_from_colors_albedo",
            self.diffuse_color,
            self.beauty,
            result=Image(),
            found=found,
            metals=self.metals,
        )
        material = draw.point(
            "material_from_colors_material",
            self.roughness,
            result=Vector(width=2),
            found=found,
            roughen=self.roughen,
            polish=self.polish,
        )
        return {"albedo": albedo, "material": material}
