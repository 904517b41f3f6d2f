import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from .._declare import (
    REFERENCE_HEIGHT,
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
    Trait,
    Vector,
)
from ._coverage import COVERAGE_AROUND
from ._denoise import LIGHT, SPREAD, denoise, prefilter
from ._march import surfaces

_RAYS = {"preview": 2, "quality": 8, "reference": 64}
"""Rays per pixel where surfaces are rough. The 4 x 4 pixels around share their rays, and the filter joins more."""

_STRIDES = (3, 6, 12)
"""Pixels between what the passes of the filter read."""

_FOUND = Vector(width=4)


class ScreenReflections(Filter):
    """Let surfaces reflect the rest of the picture: wet streets, polished floors, glass tables.

    A ray from every pixel is followed through the picture until it meets a surface, according to depth (McGuire and
    Mara 2014, through a pyramid of nearest depths as in Uludag 2014). On rough surfaces rays scatter by GGX (Heitz
    2018), so reflections are sharp at contacts and blur with the distance. A filter that is guided by their variance
    removes the noise (Schied et al. 2017). The strength is Schlick's (1994) Fresnel.
    Objects outside of the picture cannot be reflected: there the surface stays unchanged.
    """

    aliases = (
        "ssr", "screen space reflections", "reflection", "reflections", "wet floor", "mirror floor",
        "ray traced reflections",
    )  # fmt: skip
    traits = (Trait.NEEDS_SCENE_LIGHT,)
    proxy_notes = (
        ProxyNote(
            ("confidence", "reflection"),
            "occlusion is computed from depth, which is not interpolated in a proxy",
        ),
    )

    image = Image()
    depth = Field(doc="Planar depth: the distance along the camera's axis.")
    normal = Vector(0.0, width=3, doc="In the world. Without a link, from depth.")
    camera = CameraSocket(doc="The camera that the depth was rendered with.")
    material = Vector(0.0, width=2, doc="Metal and roughness, 0..1. Without a link, no metal, and the roughness below.")
    albedo = Image((1.0, 1.0, 1.0, 1.0), doc="Color of the surfaces: metals tint what they mirror.")
    mask = Field(1.0, doc="Where, and how strongly, surfaces reflect: the floor, puddles.")
    strength: Annotated[float, Slider(0.0, 2.0, unit="ratio", minimum=0.0, doc="1 is physical.")] = 1.0
    reflectance: Annotated[
        Fraction, Doc("The reflectance straight on, F0: 0.02 water, 0.04 plastic and glass, 1 a perfect mirror.")
    ] = 0.04
    roughness: Annotated[Fraction, Doc("0 is a sharp mirror. As in Blender, GGX's alpha is its square.")] = 0.2
    distance: Annotated[
        float,
        Slider(
            0.1,
            100.0,
            unit="scene",
            minimum=1e-4,
            maximum=1e8,
            doc="The distance up to which objects are reflected, in world units.",
        ),
    ] = 20.0
    fade: Annotated[Fraction, Doc("The last part of that distance, over which reflections fade out.")] = 0.5
    border: Annotated[
        float,
        Slider(
            0.0,
            0.5,
            unit="height",
            minimum=0.0,
            maximum=1.0,
            doc="The width at the border of the picture over which reflections fade out.",
        ),
    ] = 0.08
    thickness: Annotated[
        float,
        Slider(
            0.01,
            5.0,
            unit="scene",
            minimum=0.0,
            maximum=1e8,
            doc="The largest assumed thickness of objects: rays that are farther behind them pass. Thin ones count as "
            "thick as they are wide.",
        ),
    ] = 0.3
    sky: Annotated[bool, Doc("Reflect the background, as if it were infinitely far.")] = True
    quality: Annotated[
        Literal["preview", "quality", "reference"], Doc("2, 8 or 64 rays per pixel where surfaces are rough.")
    ] = "quality"
    steps: Annotated[
        int,
        Slider(
            32,
            1024,
            unit="count",
            minimum=1,
            maximum=8192,
            doc="The most steps of a ray, in a picture of up to 1080 lines; in larger ones more. With too few, distant "
            "reflections are lost where the picture is complex.",
        ),
    ] = 256

    out = OutputSocket(Image(doc="The picture with its reflections."))
    reflection = OutputSocket(Image(doc="The light that was added; its alpha is how much of the picture was replaced."))
    confidence = OutputSocket(Field(doc="The confidence of the reflection, 0..1."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        """Trace rays per surface, then share the light between the surfaces of a pixel at an edge.

        A pixel at an edge has the mean of two normals, which reflects what neither surface does: so its light is that
        of its neighbors on both sides, by their shares.
        """
        camera = draw.camera(self.camera)
        rows, rays = (camera.rows, camera.inverse) if camera else ((0.0,) * 12, (0.0,) * 12)
        all_surfaces = surfaces(draw, self.depth, "screen_reflections", solid=rays, thickness=self.thickness)
        normal = draw(
            "screen_reflections_normal",
            self.normal,
            surfaces=all_surfaces,
            result=Vector(width=3),
            rows=rows,
            rays=rays,
        )
        rough = draw.point(
            "screen_reflections_roughness",
            self.material,
            result=Field(),
            linked=draw.is_linked(self.material),
            roughness=self.roughness,
        )
        light = self._trace(draw, all_surfaces, normal, rough, rows, rays)
        if draw.is_linked(self.normal):
            light, normal = draw.several(
                "screen_reflections_shared",
                (LIGHT, Vector(width=3)),
                self.normal,
                near=draw("screen_reflections_near", surfaces=all_surfaces, result=Field()),
                facing=normal,
                light=light,
                overlap=COVERAGE_AROUND,
            )
        shading: dict[str, Any] = {
            "light": light,
            "normal": normal,
            "rough": rough,
            "material": self.material,
            "albedo": self.albedo,
            "mask": self.mask,
            "rays": rays,
            "reflectance": self.reflectance,
            "strength": self.strength,
        }
        reflection = draw.point("screen_reflections_light", **shading)
        out = draw.point("screen_reflections", self.image, **shading)
        confidence = draw.point("screen_reflections_confidence", light=light, result=Field())
        return {"out": out, "reflection": reflection, "confidence": confidence}

    def _trace(
        self,
        draw: Draw,
        all_surfaces: Drawn,
        normal: Drawn,
        rough: Drawn,
        rows: tuple[float, ...],
        rays: tuple[float, ...],
    ) -> Drawn:
        """The light that every surface mirrors, and its confidence: along one ray, or of a rough surface along many."""
        search: dict[str, Any] = {
            "rows": rows,
            "rays": rays,
            "longest": self.distance,
            "fade": self.fade,
            "border": self.border,
            "sky": self.sky,
            "steps": math.ceil(self.steps * max(draw.size[1] / REFERENCE_HEIGHT, 1.0)),
        }
        if not draw.is_linked(self.material) and self.roughness <= 0.0:
            return draw(
                "screen_reflections_sharp",
                self.image,
                surfaces=all_surfaces,
                normal=normal,
                result=_FOUND,
                **search,
            )
        light, spread = draw.several(
            "screen_reflections_scattered",
            (LIGHT, SPREAD),
            surfaces=all_surfaces,
            normal=normal,
            rough=rough,
            levels=prefilter(draw, "screen_reflections", self.image),
            **search,
            count=_RAYS[self.quality],
        )
        guide = draw("screen_reflections_guide", surfaces=all_surfaces, normal=normal, result=LIGHT)
        return denoise(draw, "screen_reflections", guide, light, spread, rays, _RAYS[self.quality], _STRIDES)
