from collections.abc import Mapping
from typing import Annotated, Any, Literal

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
    Trait,
    Vector,
)
from ._march import surfaces

_RAYS = {"preview": 4, "quality": 16, "reference": 64}
"""Rays to a pixel where surfaces are rough; their neighbors lend them as many times 16."""

_FOUND = Vector(width=4)


class ScreenReflections(Filter):
    """Let surfaces mirror what else is in the picture: wet streets, polished floors, glass tables.

    A ray from every pixel is followed through the picture until it meets what depth says is there (McGuire and Mara
    2014, through a pyramid of nearest depths as in Uludag 2014). Where surfaces are rough, rays scatter as GGX does
    (Heitz 2018), so reflections are sharp where things touch and streak with the distance. How much is mirrored is
    Schlick's (1994) Fresnel. What is not in the picture cannot be mirrored: there, the surface stays as it is.
    """

    aliases = (
        "ssr", "screen space reflections", "reflection", "reflections", "wet floor", "mirror floor",
        "ray traced reflections",
    )  # fmt: skip
    traits = (Trait.NEEDS_SCENE_LIGHT,)
    proxy_notes = (
        ProxyNote(
            ("confidence", "reflection"),
            "what hides what is read from depth, which has fewer steps in a proxy and is never mixed",
        ),
    )

    image = Image()
    depth = Field(doc="Planar distance along the way the camera looks.")
    normal = Vector(0.0, width=3, doc="In the world. Without a link, from depth.")
    camera = CameraSocket(doc="The camera that the depth was rendered with.")
    material = Vector(0.0, width=2, doc="Metal and roughness, 0..1. Without a link, no metal, and the roughness below.")
    albedo = Image((1.0, 1.0, 1.0, 1.0), doc="Color of the surfaces: metals tint what they mirror.")
    mask = Field(1.0, doc="What mirrors, and how much: the floor, puddles.")
    strength: Annotated[float, Slider(0.0, 2.0, unit="ratio", minimum=0.0, doc="1 is physical.")] = 1.0
    reflectance: Annotated[
        Fraction, Doc("How much is mirrored straight on, F0: 0.02 water, 0.04 plastic and glass, 1 a perfect mirror.")
    ] = 0.04
    roughness: Annotated[Fraction, Doc("0 mirrors sharply. As in Blender: GGX's alpha is its square.")] = 0.2
    distance: Annotated[
        float,
        Slider(
            0.1, 100.0, unit="scene", minimum=1e-4, maximum=1e8, doc="How far away things are mirrored, in world units."
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
            doc="How wide reflections of what is near the border of the picture fade out.",
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
            doc="How far objects go on behind what is seen of them: rays that come deeper pass behind them.",
        ),
    ] = 0.3
    sky: Annotated[bool, Doc("Mirror what shows through where nothing is, as if it were infinitely far.")] = True
    quality: Annotated[
        Literal["preview", "quality", "reference"], Doc("4, 16 or 64 rays to a pixel where surfaces are rough.")
    ] = "quality"
    steps: Annotated[
        int,
        Slider(
            32,
            1024,
            unit="count",
            minimum=1,
            maximum=8192,
            doc="The most steps that a ray takes. Too few, and far reflections are lost where the picture is busy.",
        ),
    ] = 256

    out = OutputSocket(Image(doc="The picture with its reflections, instead of the part that is mirrored."))
    reflection = OutputSocket(Image(doc="What was added to it; its alpha is how much was taken away."))
    confidence = OutputSocket(Field(doc="How surely what is mirrored was found, 0..1."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        camera = draw.camera(self.camera)
        rows, rays = (camera.rows, camera.inverse) if camera else ((0.0,) * 12, (0.0,) * 12)
        all_surfaces = surfaces(draw, self.depth, "screen_reflections")
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
            "thickness": self.thickness,
            "longest": self.distance,
            "fade": self.fade,
            "border": self.border,
            "sky": self.sky,
            "steps": self.steps,
        }
        mirror = draw("screen_reflections_mirror", surfaces=all_surfaces, normal=normal, result=_FOUND, **search)
        if not draw.is_linked(self.material) and self.roughness <= 0.0:
            return draw("screen_reflections_sharp", self.image, mirror=mirror, result=_FOUND)
        scattered = draw(
            "screen_reflections_scattered",
            self.image,
            surfaces=all_surfaces,
            normal=normal,
            rough=rough,
            mirror=mirror,
            result=_FOUND,
            **search,
            count=_RAYS[self.quality],
        )
        return draw(
            "screen_reflections_denoise",
            surfaces=all_surfaces,
            normal=normal,
            rough=rough,
            mirror=mirror,
            scattered=scattered,
            result=_FOUND,
            rays=rays,
        )
