from collections.abc import Mapping

from .._declare import Draw, Drawn, Field, Filter, Image, Number, OutputSocket, Socket, Vector


class RebuildBeauty(Filter):
    """Rebuild the picture from its light passes, each of which can be graded before.

    The sum is the one of Cycles: color * (direct + indirect) for diffuse, glossy and transmission, plus volume,
    emission, environment and other light. A color that is not linked counts as white, for renderers whose light passes
    contain the color. Link the render itself to beauty to measure the error of the sum.
    """

    aliases = (
        "beauty rebuild", "combine passes", "back to beauty", "light groups", "aov rebuild", "sum passes",
        "relight passes", "light mixer",
    )  # fmt: skip

    beauty = Image(0.0, doc="The render, to compare with and for its alpha.")
    diffuse_color = Image(1.0)
    diffuse_direct = Image(0.0)
    diffuse_indirect = Image(0.0)
    glossy_color = Image(1.0, doc="Glossy is also called specular.")
    glossy_direct = Image(0.0)
    glossy_indirect = Image(0.0)
    transmission_color = Image(1.0)
    transmission_direct = Image(0.0)
    transmission_indirect = Image(0.0)
    volume_direct = Image(0.0)
    volume_indirect = Image(0.0)
    emission = Image(0.0)
    environment = Image(0.0)
    other = Image(0.0, doc="Light without an input of its own: subsurface, coat, sheen.")

    out = OutputSocket()
    difference = OutputSocket(
        Field(doc="The difference between the sum and beauty: the largest of the three channels; 0 without beauty.")
    )
    error = OutputSocket(Number(doc="The largest difference anywhere."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        total = draw.point("rebuild_beauty_none", result=Vector(width=4))
        for color, direct, indirect in self._lobes():
            if draw.is_linked(direct) or draw.is_linked(indirect):
                total = draw.point(
                    "rebuild_beauty_lobe",
                    result=Vector(width=4),
                    total=total,
                    color=color,
                    direct=direct,
                    indirect=indirect,
                )
        for light in (self.volume_direct, self.volume_indirect, self.emission, self.environment, self.other):
            if draw.is_linked(light):
                total = draw.point("rebuild_beauty_light", result=Vector(width=4), total=total, light=light)
        has_beauty = draw.is_linked(self.beauty)
        difference = draw.point(
            "rebuild_beauty_difference", result=Field(), total=total, beauty=self.beauty, known=has_beauty
        )
        return {
            "out": draw.point("rebuild_beauty", total=total, beauty=self.beauty, known=has_beauty),
            "difference": difference,
            "error": draw.point("rebuild_beauty_error", result=Number(), most=draw.reduce(difference, "max")),
        }

    def _lobes(self) -> tuple[tuple[Socket, Socket, Socket], ...]:
        """Color, direct and indirect light of each."""
        return (
            (self.diffuse_color, self.diffuse_direct, self.diffuse_indirect),
            (self.glossy_color, self.glossy_direct, self.glossy_indirect),
            (self.transmission_color, self.transmission_direct, self.transmission_indirect),
        )
