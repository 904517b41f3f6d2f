from collections.abc import Mapping
from types import MappingProxyType
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
    Overlap,
    Slider,
    Trait,
    Vector,
)
from ._coverage import COVERAGE_AROUND, COVERAGE_REACH, TURN_REACH
from ._environment import DATA, SKY, irradiance, shrunk

_MIRROR = (1024, 512)
"""What a mirror sees: a third of a degree a pixel. Chosen by judgement; a render shows a part of it as a rule."""

_LEVELS = ((512, 256), (256, 128), SKY, (64, 32), (32, 16))
"""The surroundings, halved again and again; a mirror sees them twice as large as the first."""

_LOBES = ((0.25, (256, 128)), (0.5, (128, 64)), (0.75, (64, 32)), (1.0, (32, 16)))
"""Roughness, and the size at which the surroundings are blurred by it."""

_SHARES = (64, 32)
"""Angles and roughnesses of the table of shares: reflections change by 0.25 % (RMS) with twice as many of both."""

_HERE: Mapping[str, Overlap] = MappingProxyType(
    dict.fromkeys(("albedo", "roughness", "metallic", "occlusion"), COVERAGE_REACH)
    | dict.fromkeys(("normal", "near"), COVERAGE_AROUND)
    | {"coverage": 0}
)
"""What is read at the pixel itself or beside it; the surroundings are read anywhere."""


class ImageBasedLight(Filter):
    """Relight surfaces by a picture of their surroundings: matte light by normals, reflections by roughness.

    Matte light is the cosine-weighted mean over all directions. Reflections take the picture blurred by the GGX lobe
    of the roughness (Walter et al. 2007), times how much a surface reflects at that angle (Karis 2013, split sum).
    Nothing blocks the light: link an ambient occlusion. Where there is no normal, nothing is lit.
    """

    aliases = (
        "ibl", "hdri", "environment light", "sky light", "environment", "env light", "skylight", "hdr light",
        "dome light", "reflection map", "spherical harmonics",
    )  # fmt: skip
    traits = (Trait.NEEDS_SCENE_LIGHT,)

    normal = Vector(width=3, doc="In the world.")
    camera = CameraSocket(doc="The camera that the normals were rendered with.")
    environment = Image(
        (1.0, 1.0, 1.0, 1.0),
        own_size=True,
        doc=("The surroundings, by longitude and latitude. Without a link, a uniform white."),
    )
    albedo = Image((0.8, 0.8, 0.8, 1.0), doc="Color of the surfaces. Without a link, a light gray.")
    roughness = Field(0.5, doc="0 is a mirror, 1 is matte. As in Blender, the square root of GGX's alpha.")
    metallic = Field(0.0, doc="1 where surfaces are metal: they only reflect, in their own color.")
    occlusion = Field(1.0, doc="The part of the light that reaches the surface: 1 is all of it.")
    depth = Field(
        0.0, doc="Shows at edges which surface is in front. Without a link, all surfaces have the same depth."
    )
    intensity: Annotated[float, Slider(0.0, 4.0, unit="ratio", minimum=0.0, doc="How bright the environment is.")] = 1.0
    rotation: Annotated[
        float, Slider(-180.0, 180.0, unit="deg", doc="Rotates the environment counterclockwise, seen from above.")
    ] = 0.0
    up: Annotated[Literal["z", "y"], Doc("The axis of the world that points up: z in Blender, y in Maya.")] = "z"
    specular: Annotated[
        Fraction,
        Doc(
            "How much non-metals reflect: 0.5 is 4 percent where the view meets the surface at a "
            "right angle, as for most materials."
        ),
    ] = 0.5

    out = OutputSocket(Image(doc="All of the light, opaque on surfaces."))
    diffuse = OutputSocket(Image(doc="The matte part."))
    reflection = OutputSocket(Image(doc="The reflected part."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        """Blur the surroundings once for each of a few roughnesses, so that a pixel needs few reads; the share that a
        surface reflects at an angle comes from a small table (split sum, Karis 2013)."""
        camera = draw.camera(self.camera)
        rays = camera.inverse if camera else (0.0,) * 12
        mirror, sky, lobes = self._blur_surroundings(draw)
        near, coverage = self._find_surfaces(draw)
        diffuse = draw(
            "image_based_light_diffuse",
            self.normal,
            self.albedo,
            self.metallic,
            self.occlusion,
            near=near,
            coverage=coverage,
            overlap=_HERE,
            sky=irradiance(draw, "image_based_light", sky),
            intensity=self.intensity,
            rotation=self.rotation,
            up=self.up,
        )
        reflection = draw(
            "image_based_light_reflection",
            self.normal,
            self.albedo,
            self.roughness,
            self.metallic,
            self.occlusion,
            near=near,
            coverage=coverage,
            overlap={**_HERE, "normal": max(COVERAGE_AROUND, COVERAGE_REACH + TURN_REACH)},
            level0=mirror,
            level1=lobes[0],
            level2=lobes[1],
            level3=lobes[2],
            level4=lobes[3],
            shares=draw("image_based_light_shares", size=_SHARES, result=Vector(width=2)),
            rays=rays,
            intensity=self.intensity,
            rotation=self.rotation,
            up=self.up,
            specular=self.specular,
        )
        out = draw.point("image_based_light", diffuse=diffuse, reflection=reflection)
        return {"out": out, "diffuse": diffuse, "reflection": reflection}

    def _find_surfaces(self, draw: Draw) -> tuple[Drawn, Drawn]:
        """How near the surfaces are, and how much of each pixel the front one covers."""
        near = draw.point(
            "image_based_light_nearness", self.normal, self.depth, result=Field(), linked=draw.is_linked(self.depth)
        )
        coverage = draw(
            "image_based_light_coverage",
            self.normal,
            self.albedo,
            near=near,
            overlap=COVERAGE_AROUND,
            result=Vector(width=3),
        )
        return near, coverage

    def _blur_surroundings(self, draw: Draw) -> tuple[Drawn, Drawn, list[Drawn]]:
        """The surroundings that a mirror sees, a small picture of them for matte light, and one for each lobe."""
        skies = [shrunk(draw, "image_based_light", self.environment, _MIRROR)]
        for size in _LEVELS:
            skies.append(shrunk(draw, "image_based_light", skies[-1], size))
        smaller: dict[str, Any] = {f"level{number}": sky for number, sky in enumerate(skies[1:])}
        lobes = [
            draw("image_based_light_lobe", **smaller, size=size, result=DATA, roughness=roughness)
            for roughness, size in _LOBES
        ]
        return skies[0], skies[3], lobes
