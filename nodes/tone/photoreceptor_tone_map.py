from typing import Annotated

from .._declare import Doc, Draw, Drawn, Field, Filter, Fraction, Image, ProxyNote, Slider, Trait, Vector


class PhotoreceptorToneMap(Filter):
    """Compress scene light as the eye's cells do: adapted to their own light or to the whole scene.

    `V = C / (C + (f Ia)^m)`, where Ia is the light to which a cell has adapted (Reinhard and Devlin 2005). The averages
    and the contrast of the scene are measured, weighted by alpha. The result is display-linear light, 0..1: encode it
    as plain sRGB (view `none`), not by another view transform. Works on the color without its alpha.
    """

    aliases = ("reinhard", "tone map", "tonemap", "rd photoreceptor", "hdr", "photoreceptor")
    traits = (Trait.NEEDS_COLOR, Trait.NEEDS_SCENE_LIGHT, Trait.MAKES_DISPLAY_LIGHT)
    proxy_notes = (ProxyNote(("out",), "it measures the darkest and the brightest pixel, which a proxy averages"),)

    image = Image()
    brightness: Annotated[
        float,
        Slider(-4.0, 4.0, unit="ratio", minimum=-8.0, maximum=8.0, doc="f = exp(-brightness): higher is brighter."),
    ] = 0.0
    contrast: Annotated[
        float,
        Slider(
            0.0,
            1.0,
            unit="ratio",
            minimum=0.0,
            maximum=1.0,
            doc="The exponent m. 0 chooses it automatically: from 0.3 for a mostly bright scene to 1 "
            "for one with a few bright spots.",
        ),
    ] = 0.0
    light_adaptation: Annotated[
        Fraction, Doc("What the eye adapts to: 0 is the average of the scene, 1 the pixel itself.")
    ] = 0.5
    color_adaptation: Annotated[
        Fraction, Doc("How red, green and blue adapt: 0 together, 1 each on its own, which removes a color cast.")
    ] = 0.0
    stretch: Annotated[bool, Doc("Stretch the result so that its darkest channel is 0 and its brightest 1.")] = True

    def passes(self, draw: Draw) -> Drawn:
        scene = draw.point(
            "photoreceptor_tone_map_scene",
            result=Vector(width=4),
            contrast=self.contrast,
            means=draw.reduce(draw.point("photoreceptor_tone_map_light", self.image), "sum"),
            logs=draw.reduce(draw.point("photoreceptor_tone_map_log", self.image, result=Field()), "sum"),
            ends=draw.reduce(draw.point("photoreceptor_tone_map_ends", self.image, result=Vector(width=2)), "max"),
        )
        toned = draw.point(
            "photoreceptor_tone_map",
            self.image,
            scene=scene,
            brightness=self.brightness,
            light_adaptation=self.light_adaptation,
            color_adaptation=self.color_adaptation,
        )
        if not self.stretch:
            return toned
        span = draw.reduce(draw.point("photoreceptor_tone_map_span", image=toned, result=Vector(width=2)), "max")
        return draw.point("photoreceptor_tone_map_stretch", image=toned, span=span)
