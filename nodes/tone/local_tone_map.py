from typing import Annotated, Any

from .._declare import Doc, Draw, Drawn, Field, Filter, Image, Number, Pixels, ProxyNote, Slider, Trait, Vector

_SCALES = 8
"""Of the paper (Reinhard et al. 2002)."""
_RATIO = 1.6
"""From one scale to the next; the surround of one is the center of the next."""

_SIGMA = 0.25
"""Of a center of scale 1: the paper's Gaussian of width alpha s with alpha = 1 / (2 sqrt 2) has a sigma of s / 4."""


class LocalToneMap(Filter):
    """Compress scene light locally, as dodging and burning do for a print, so that lights and shadows keep detail.

    Every pixel is compared with the largest area around it that is uniform in brightness (Reinhard et al. 2002, with
    the paper's eight scales, or alone if it differs from all of them), `Ld = L (1 + L / white^2) / (1 + V)`. The result
    is display-linear light, 0..1: encode it as plain sRGB (view `none`), not by another view transform. Works on the
    color without its alpha.
    """

    aliases = (
        "shadow highlight", "shadows highlights", "shadow and highlight", "hdr toning", "local contrast", "clarity",
        "dodge and burn", "hdr compander", "local adaptation", "dynamic range compression", "detail", "fake hdr",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.NEEDS_SCENE_LIGHT, Trait.MAKES_DISPLAY_LIGHT)
    proxy_notes = (
        ProxyNote(("out",), "it is not linear: its result for an average differs from the average of its results"),
    )

    image = Image()
    average = Number(0.0, doc="Log-average luminance of the scene; without a link it is measured.")
    maximum = Number(0.0, doc="The luminance that becomes white; without a link it is measured.")
    key: Annotated[
        float,
        Slider(
            0.045,
            0.72,
            unit="scene",
            minimum=1e-3,
            doc="The luminance that the average becomes: low for night, high for snow.",
        ),
    ] = 0.18
    auto_key: Annotated[
        bool,
        Doc("Let the average decide the key: 1.03 - 2 / (2 + log10(1 + average in cd/m2)) (Krawczyk et al. 2005)."),
    ] = False
    nits: Annotated[
        float,
        Slider(0.01, 1000.0, unit="ratio", minimum=0.0, doc="For auto key: cd/m2 of a luminance of 1 in the scene."),
    ] = 100.0
    size: Annotated[
        float,
        Slider(
            0.5,
            8.0,
            unit="px",
            minimum=0.1,
            maximum=50.0,
            doc="The smallest area; the largest is 43 times as wide. Raise it for large pictures.",
        ),
    ] = 1.0
    sharpness: Annotated[
        float,
        Slider(
            1.0,
            15.0,
            unit="ratio",
            minimum=0.0,
            maximum=30.0,
            doc="Phi: higher values stop at weaker edges. That brings out more detail, and in the end"
            " makes dark seams.",
        ),
    ] = 8.0
    threshold: Annotated[
        float,
        Slider(
            0.01,
            0.2,
            unit="ratio",
            minimum=1e-4,
            maximum=10.0,
            doc="How uneven an area may be. Low values stop at weak edges.",
        ),
    ] = 0.05
    saturation: Annotated[
        float,
        Slider(
            0.0,
            1.5,
            unit="ratio",
            minimum=0.0,
            maximum=4.0,
            doc="Power of the channel ratios; 0 is gray, 1 keeps them.",
        ),
    ] = 1.0
    clip: Annotated[bool, Doc("Limit the result to 0..1. Off keeps the light of strong colors beyond that.")] = True

    def passes(self, draw: Draw) -> Drawn:
        """Let the area around each pixel grow while its center and its surround are alike: each scale is blurred once,
        and the surround of one is the center of the next.
        """
        scene = draw.point(
            "local_tone_map_scene",
            result=Vector(width=3),
            average=self._average(draw),
            maximum=self._maximum(draw),
            key=self.key,
            auto_key=self.auto_key,
            nits=self.nits,
        )
        light = draw.point("local_tone_map_light", self.image, result=Vector(width=2), scene=scene)
        center = draw.blur(light, _SIGMA * self.size, precise=True)
        even: dict[str, Any] = {"scene": scene, "sharpness": self.sharpness, "threshold": self.threshold}
        area = draw.point(
            "local_tone_map_start", result=Vector(width=2), light=light, center=center, scale=1 / _RATIO, **even
        )
        for index in range(_SCALES):
            scale = _RATIO**index
            surround = draw.blur(light, _SIGMA * self.size * scale * _RATIO, precise=True)
            area = draw.point(
                "local_tone_map_grow",
                result=Vector(width=2),
                area=area,
                center=center,
                surround=surround,
                scale=scale,
                **even,
            )
            center = surround
        return draw.point(
            "local_tone_map", self.image, area=area, scene=scene, saturation=self.saturation, clip=self.clip
        )

    def _average(self, draw: Draw) -> Pixels:
        if draw.is_linked(self.average):
            return self.average
        logs = draw.reduce(draw.point("local_tone_map_log", self.image, result=Vector(width=2)), "sum")
        return draw.point("local_tone_map_average", result=Number(), logs=logs)

    def _maximum(self, draw: Draw) -> Pixels:
        if draw.is_linked(self.maximum):
            return self.maximum
        return draw.reduce(draw.point("local_tone_map_luminance", self.image, result=Field()), "max")
