from .._declare import Field, Image, OutputSocket, Pointwise, Vector


class MaterialFromColors(Pointwise):
    """Find the color and the metalness of surfaces from the diffuse and glossy color of a render, to light it again.

    Renderers such as Cycles write black as the diffuse color of metals, and their color as the glossy color: lit again
    without it, gold is black. Both together tell how much of a surface is metal, for surfaces that reflect 4 percent
    where they are not metal. Dark surfaces that could be both count as no metal. It is an estimate: where the renderer
    writes a metalness, use that. Link `albedo` and `material` to Deferred Lighting.
    """

    aliases = ("metalness", "metallic", "base color", "pbr material", "gold", "metals", "specular to metallic")

    diffuse_color = Image(doc="The color of diffuse reflection, without light.")
    glossy_color = Image(doc="The color of glossy reflection, without light; also called specular.")
    roughness = Field(0.4, doc="The layer of roughness, if the renderer writes one: 0 is a mirror, 1 is dull.")

    albedo = OutputSocket(Image(doc="The color of the surfaces, of metals too."))
    material = OutputSocket(Vector(width=2, doc="Metal and roughness, 0 to 1."))
