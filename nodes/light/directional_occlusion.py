from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import (
    CameraSocket,
    Doc,
    Draw,
    Drawn,
    Field,
    Filter,
    Fraction,
    Image,
    OutputSocket,
    ProxyNote,
    Slider,
    Vector,
)
from ._coverage import COVERAGE_AROUND, COVERAGE_REACH
from ._denoise import LIGHT, SPREAD, denoise, prefilter
from ._environment import SKY, irradiance, shrunk
from ._occlusion import DATA, FACTORS, SAMPLES, denoise_and_enlarge, measure_size

_STRIDES = (3, 6)
"""Pixels between what the passes of the filter read."""

_COARSE = (24, 12)
"""What is hidden of the surroundings is seen this coarsely."""

_HERE = dict.fromkeys(("depth", "albedo", "normal", "gathered", "lamps"), COVERAGE_REACH) | {"coverage": 0}
"""What a pixel at an edge is lit by: its neighbors' light; the sky may be read anywhere."""


class DirectionalOcclusion(Filter):
    """Light matte surfaces by their surroundings, with colored shadows and color bleeding between neighbors.

    Directional occlusion (Ritschel et al. 2009): each surface gets the light of the environment, except where near
    surfaces hide it; from these it gets one bounce of light instead. Both are computed below the horizons of slices
    through the view, weighted by the cosine to the normal, as in gtao (Jimenez et al. 2016). A uniform environment
    gives the albedo times its light times the occlusion. `light` is the added light, `out` the picture with it. Alpha
    is kept.
    """

    aliases = ("ssdo", "bent normal", "color bleeding", "directional ambient occlusion", "indirect light")

    proxy_notes = (ProxyNote(("light",), "occlusion is computed from depth, which is not interpolated in a proxy"),)

    image = Image(doc="The lit scene, whose light bounces on to neighbors.")
    depth = Field(doc="Planar depth: the distance along the camera's axis.")
    normal = Vector(0.0, width=3, doc="In the world. Without a link, from depth.")
    camera = CameraSocket(doc="The camera that the depth was rendered with.")
    albedo = Image((1.0, 1.0, 1.0, 1.0), doc="Color of the surfaces. Without a link white: the light alone.")
    environment = Image(
        0.0,
        own_size=True,
        doc="The surroundings, by longitude and latitude. Without a link black: only surfaces give light.",
    )
    radius: Annotated[
        float,
        Slider(
            0.01,
            5.0,
            unit="scene",
            minimum=1e-6,
            maximum=1e6,
            doc="How far surfaces block and reflect light, in world units.",
        ),
    ] = 1.0
    falloff: Annotated[Fraction, Doc("The outer part of the radius over which this fades out: 0 is a hard end.")] = 0.5
    intensity: Annotated[float, Slider(0.0, 4.0, unit="ratio", minimum=0.0, doc="How bright the environment is.")] = 1.0
    bounce: Annotated[
        float, Slider(0.0, 4.0, unit="ratio", minimum=0.0, doc="The strength of bounced light: 1 is physical.")
    ] = 1.0
    rotation: Annotated[
        float, Slider(-180.0, 180.0, unit="deg", doc="Rotates the environment counterclockwise, seen from above.")
    ] = 0.0
    up: Annotated[Literal["z", "y"], Doc("The axis of the world that points up: z in Blender, y in Maya.")] = "z"
    quality: Annotated[
        Literal["preview", "quality", "reference"],
        Doc("3 x 3, 4 x 8 or 16 x 16 slices and steps: 18, 64 or 512 points of depth per pixel."),
    ] = "quality"
    resolution: Annotated[
        Literal["full", "half"],
        Doc("Half measures every other pixel of every other row: four times as fast, fine detail is lost."),
    ] = "full"
    denoise: Annotated[
        bool, Doc("Average 4 x 4 pixels of the same surface, which compensates for their few samples: edges stay.")
    ] = True

    out = OutputSocket()
    light = OutputSocket(Image(doc="The light that is added, opaque."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        """Look along slices for what hides the sky and what shines, remove the noise, enlarge, then add the sky."""
        camera = draw.camera(self.camera)
        rows, rays = (camera.rows, camera.inverse) if camera else ((0.0,) * 12, (0.0,) * 12)
        normal = draw(
            "directional_occlusion_normal", self.depth, self.normal, edge="black", result=Vector(width=3), rows=rows
        )
        sky = shrunk(draw, "directional_occlusion", self.environment, SKY)
        gathered, lamps = self._gather(draw, normal, sky, rows, rays)
        light = draw(
            "directional_occlusion_light",
            self.depth,
            self.albedo,
            normal=normal,
            gathered=gathered,
            lamps=lamps,
            sky=irradiance(draw, "directional_occlusion", sky),
            coverage=self._share_pixels(draw),
            overlap=_HERE,
            rays=rays,
            intensity=self.intensity,
            bounce=self.bounce,
            rotation=self.rotation,
            up=self.up,
        )
        return {"out": draw.point("directional_occlusion", self.image, light=light), "light": light}

    def _share_pixels(self, draw: Draw) -> Drawn:
        """The surfaces of pixels at edges, by the normals that a renderer has filtered over them."""
        near = draw.point("directional_occlusion_near", self.depth, result=Field())
        return draw(
            "directional_occlusion_coverage",
            self.normal,
            near=near,
            overlap=COVERAGE_AROUND,
            result=Vector(width=3),
        )

    def _gather(
        self, draw: Draw, normal: Drawn, sky: Drawn, rows: tuple[float, ...], rays: tuple[float, ...]
    ) -> tuple[Drawn, Drawn]:
        """How much of the sky each pixel sees and from where, and the light of what shines around it.

        The light has the noise of few samples, and bright spots in it: so it has a filter of its own that follows its
        variance, where what is seen of the sky needs only a mean.
        """
        factor = FACTORS[self.resolution]
        slices, steps = SAMPLES[self.quality]
        visible, lamps, spread = draw.several(
            "directional_occlusion_seen",
            (DATA, LIGHT, SPREAD),
            self.depth,
            normal=normal,
            levels=prefilter(draw, "directional_occlusion", self.image),
            sky=shrunk(draw, "directional_occlusion", sky, _COARSE),
            size=measure_size(draw.size, factor),
            rows=rows,
            rays=rays,
            factor=factor,
            slices=slices,
            steps=steps,
            radius=self.radius,
            falloff=self.falloff,
            intensity=self.intensity,
            bounce=self.bounce,
            rotation=self.rotation,
            up=self.up,
            matched=self.denoise,
        )
        if self.denoise:
            guide = draw(
                "directional_occlusion_guide",
                self.depth,
                normal=normal,
                size=visible.size,
                result=LIGHT,
                factor=factor,
            )
            lamps = denoise(draw, "directional_occlusion", guide, lamps, spread, rays, slices, _STRIDES)
        gathered, lamps = (
            denoise_and_enlarge(
                draw, "directional_occlusion", self.depth, normal, part, rays, factor, self.denoise and part is visible
            )
            for part in (visible, lamps)
        )
        return gathered, lamps
