from collections.abc import Iterable, Mapping
from typing import Annotated, Any, Literal

from .._declare import (
    MAX_LIGHTS,
    RGBA,
    CameraModel,
    CameraSocket,
    Doc,
    Draw,
    Drawn,
    Field,
    Filter,
    Fraction,
    Image,
    Light,
    LightKind,
    LightSet,
    OutputSocket,
    Pixels,
    Slider,
    Stops,
    Trait,
    Vector,
    lights_of,
    name_lights,
    ramp_at,
)
from ._area_lights import AREA_KINDS
from ._coverage import COVERAGE_AROUND, COVERAGE_REACH
from ._light_cookies import tabulate_throws
from ._light_masks import BATCH, draw_masks, is_limited
from ._light_tables import sort_lamps, tabulate_lights

_R3_ROOT = 1.2207440846057596
"""The root of x^4 = x + 1."""

_SEED_STEP = 7919
"""How far apart in the sequence swarms of two seeds begin: a prime above `MAX_LIGHTS`, so that they share no place."""

_HERE = (
    dict.fromkeys(("albedo", "material", "occlusion", "place"), COVERAGE_REACH)
    | dict.fromkeys(("normal", "near"), COVERAGE_AROUND)
    | {"coverage": 0}
)
"""What a pixel is lit by: its own, or its neighbors'; lights and what they reach may be read anywhere."""

_RIG = name_lights(
    key=Light(LightKind.SPHERE, (-3.5, -5.0, 4.5), color=(1.0, 0.78, 0.55), intensity=80.0, size=0.6),
    kicker=Light(LightKind.SPOT, (5.0, -3.5, 3.0), (-0.78, 0.55, -0.3), (0.35, 0.6, 1.0), 45.0, inner=12.0, outer=40.0),
    rim=Light(LightKind.SPHERE, (1.8, 3.2, 3.6), color=(1.0, 0.35, 0.6), intensity=20.0, size=0.3),
    sun=Light(LightKind.SUN, direction=(0.25, 0.35, -0.9), color=(0.55, 0.7, 1.0), intensity=0.25),
)
"""A warm key from the left, a cool spot from the right, a rim from behind and moonlight."""

_NEON = (
    0.0, 1.0, 0.1, 0.35, 1.0,
    0.25, 1.0, 0.4, 0.08, 1.0,
    0.5, 0.1, 0.9, 0.8, 1.0,
    0.75, 0.12, 0.35, 1.0, 1.0,
    1.0, 0.65, 0.12, 1.0, 1.0,
)  # fmt: skip
"""Pink, orange, teal, blue, violet."""

_Place = tuple[float, float, float]


class DeferredLighting(Filter):
    """Relight a render from its albedo, normals and positions, with up to 1024 lights of your own.

    Points, spots, suns, spheres, rectangles, discs and tubes; a light with negative intensity subtracts light. Diffuse
    reflection is Lambert's; specular reflection is that of GGX microfacets (Walter et al. 2007, Heitz 2014, Schlick
    1994) or Phong's lobe (Lafortune and Willems 1994), for spheres by the point nearest to the mirrored ray (Karis
    2013). Rectangles, discs and tubes reflect in GGX facets by the part that they cover of the cap of directions that
    facets mirror (Dupuy and Benyoub 2023), also where the model is Phong's. Light falls off with the square of the
    distance, times (1 - (d / reach)^4)^2 if a reach is given: with many lights, those with a reach are fast. A light
    can have a color temperature instead of a color. A swarm adds many small lights at once.

    A light with `shadow` casts shadows of what the picture shows, by rays through the depth (McGuire and Mara 2014),
    soft for a light with a size. A light with a `matte` lights only what is in one of the four mattes. A light with a
    `cookie` throws one of four pictures, as a slide projector does. `out` is diffuse and specular light and emission.
    """

    aliases = (
        "relight", "lights", "lighting", "light", "shader", "deferred shading", "point light", "spot light",
        "relighting", "normal light", "normality",
    )  # fmt: skip
    traits = (Trait.NEEDS_SCENE_LIGHT, Trait.NEEDS_SURFACES)
    version = 2

    albedo = Image((0.6, 0.6, 0.6, 1.0), doc="Color of the surfaces. Without a link, clay.")
    normal = Vector(0.0, width=3, doc="In the world. Without a link, from depth and camera.")
    depth = Field(0.0, doc="Planar depth: the distance along the camera's axis, if there is no position.")
    position = Vector(0.0, width=3, doc="In the world. Without a link, from depth and camera.")
    camera = CameraSocket(0.0, doc="Without one, highlights look as if every surface faced the camera.")
    material = Vector((0.0, 0.0), width=2, doc="Metal and roughness, 0..1, in place of the two values.")
    emission = Image((0.0, 0.0, 0.0, 0.0), doc="Added as it is.")
    occlusion = Field(1.0, doc="Ambient occlusion, 0..1: only the ambient light is multiplied with it.")
    matte_1 = Field(1.0, folded=True, doc="A matte that lights can be limited to, of a cryptomatte, an id or any mask.")
    matte_2 = Field(1.0, folded=True, doc="Another matte.")
    matte_3 = Field(1.0, folded=True, doc="Another matte.")
    matte_4 = Field(1.0, folded=True, doc="Another matte.")
    cookie_1 = Image(
        (1.0, 1.0, 1.0, 1.0),
        own_size=True,
        folded=True,
        doc="A picture that lights can throw: leaves, clouds; by longitude and latitude for points and spheres.",
    )
    cookie_2 = Image((1.0, 1.0, 1.0, 1.0), own_size=True, folded=True, doc="Another picture that lights can throw.")
    cookie_3 = Image((1.0, 1.0, 1.0, 1.0), own_size=True, folded=True, doc="Another picture that lights can throw.")
    cookie_4 = Image((1.0, 1.0, 1.0, 1.0), own_size=True, folded=True, doc="Another picture that lights can throw.")
    model: Annotated[Literal["ggx", "phong"], Doc("The shape of highlights.")] = "ggx"
    roughness: Annotated[Fraction, Doc("How wide highlights are: 0 polished, 1 dull.")] = 0.4
    metal: Annotated[Fraction, Doc("1 reflects in the color of the albedo, without diffuse light.")] = 0.0
    specular: Annotated[Fraction, Doc("The reflectance of non-metals: 8 percent at 1, straight on.")] = 0.5
    lights: Annotated[
        LightSet, Doc("Lights by name. Places are in the world, intensities in W/sr, of suns in W/m2.")
    ] = _RIG
    intensity: Annotated[float, Slider(0.0, 4.0, unit="ratio", doc="Scales all lights, those of the swarm too.")] = 1.0
    ambient: Annotated[RGBA, Doc("Light from everywhere; its alpha scales it.")] = (0.35, 0.5, 0.8, 1.0)
    ambient_intensity: Annotated[float, Slider(0.0, 2.0, unit="ratio", doc="How strong it is.")] = 0.06
    shadow_length: Annotated[
        float,
        Slider(0.01, 20.0, unit="scene", minimum=1e-5, maximum=1e8, doc="How far away a shadow caster may be."),
    ] = 5.0
    shadow_thickness: Annotated[
        float,
        Slider(
            0.01,
            5.0,
            unit="scene",
            minimum=0.0,
            maximum=1e8,
            doc="The least thickness of shadow casters, which count as deep as they are wide.",
        ),
    ] = 0.3
    swarm: Annotated[
        int, Slider(0, 128, unit="count", minimum=0, maximum=MAX_LIGHTS, doc="The number of point lights in the swarm.")
    ] = 0
    swarm_place: Annotated[
        _Place, Slider(-10.0, 10.0, unit="scene"), Doc("The center of the box that the swarm fills evenly.")
    ] = (0.0, 0.0, 0.8)
    swarm_spread: Annotated[
        _Place, Slider(0.0, 10.0, unit="scene"), Doc("The distance from its center to its sides.")
    ] = (
        5.0,
        4.0,
        0.7,
    )
    swarm_colors: Annotated[Stops, Doc("The ramp from which the swarm's colors are taken, evenly.")] = _NEON
    swarm_intensity: Annotated[
        float, Slider(-10.0, 10.0, unit="scene", doc="The intensity of each light, in W/sr.")
    ] = 2.0
    swarm_reach: Annotated[
        float,
        Slider(
            0.0, 10.0, unit="scene", minimum=0.0, doc="The distance at which their light has faded out; 0 for none."
        ),
    ] = 3.0
    swarm_seed: Annotated[int, Slider(0, 100, unit="count", doc="Another number gives the lights other places.")] = 0

    out = OutputSocket()
    diffuse = OutputSocket(Image(doc="The diffuse light."))
    specular_light = OutputSocket(Image(doc="The specular light."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        """Describe the surfaces, sort the lights, then add up their light three times: all of it, and its two parts.

        The sum is not put together from its parts, because an output that nothing reads is not drawn: so graphs that
        read only the first output draw one picture.
        """
        camera = draw.camera(self.camera)
        surface = self._describe_surfaces(draw, camera)
        shining = self.list_lights()
        unlimited = [light for light in shining if not is_limited(light)]
        areas = [light for light in unlimited if light.kind in AREA_KINDS]
        point_lights = [light for light in unlimited if light.kind not in AREA_KINDS]
        lamps = sort_lamps(draw, surface["place"], point_lights, self.intensity)
        ambient_gain = 0.0 if any(light.solo for light in shining) else self.ambient_intensity
        ambient = tuple(ambient_gain * self.ambient[3] * part for part in self.ambient[:3])
        limited = self._limit_lights(draw, shining, surface["normal"], surface["place"], camera)

        def add_up(scattered: float, mirrored: float) -> Drawn:
            numbers: dict[str, Any] = {"share": (scattered, mirrored), **self._list_numbers(draw, camera)}
            light = draw(
                "deferred_lighting_lit",
                self.albedo,
                self.material,
                self.occlusion,
                **surface,
                **lamps,
                overlap=_HERE,
                model=self.model,
                ambient=ambient,
                **numbers,
            )
            if areas:
                light = self._add_areas(draw, light, areas, surface, numbers)
            for batch, mask in limited:
                light = self._add_limited(draw, light, batch, mask, surface, numbers)
            return light

        return {
            "out": draw.point("deferred_lighting", lit=add_up(1.0, 1.0), emission=self.emission),
            "diffuse": add_up(1.0, 0.0),
            "specular_light": add_up(0.0, 1.0),
        }

    def _describe_surfaces(self, draw: Draw, camera: CameraModel | None) -> dict[str, Any]:
        """What light falls on: the place, the normal and the nearness of each pixel, and its shares at an edge."""
        rows, rays = (camera.rows, camera.inverse) if camera else ((0.0,) * 12, (0.0,) * 12)
        placed = draw.is_linked(self.position)
        place = draw.point(
            "deferred_lighting_place", self.depth, self.position, result=Vector(width=4), rays=rays, placed=placed
        )
        normal = (
            self.normal
            if draw.is_linked(self.normal)
            else draw(
                "deferred_lighting_normal", self.depth, edge="black", overlap=2, result=Vector(width=3), rows=rows
            )
        )
        near = draw.point("deferred_lighting_nearness", place=place, result=Field())
        coverage = draw(
            "deferred_lighting_coverage",
            self.albedo,
            normal=normal,
            near=near,
            overlap=COVERAGE_AROUND,
            result=Vector(width=3),
        )
        return {"normal": normal, "place": place, "near": near, "coverage": coverage}

    def _list_numbers(self, draw: Draw, camera: CameraModel | None) -> dict[str, Any]:
        """The material and the camera, as numbers for GLSL."""
        return {
            "mapped": draw.is_linked(self.material),
            "metal": self.metal,
            "roughness": self.roughness,
            "specular": self.specular,
            "rays": camera.inverse if camera else (0.0,) * 12,
            "seen": camera is not None,
            "eye": camera.eye if camera else (0.0,) * 3,
        }

    def _limit_lights(
        self, draw: Draw, shining: list[Light], normal: Pixels, place: Drawn, camera: CameraModel | None
    ) -> list[tuple[list[Light], Drawn]]:
        """Lights with shadows or mattes, a few at a time, those of an area last, and the masks of each few."""
        lights = sorted((light for light in shining if is_limited(light)), key=lambda light: light.kind in AREA_KINDS)
        if not lights:
            return []
        depth: Pixels = self.depth
        if camera is not None and draw.is_linked(self.position):
            depth = draw.point("deferred_lighting_depth", place=place, result=Field(), rows=camera.rows)
        mattes = (self.matte_1, self.matte_2, self.matte_3, self.matte_4)
        pictures = {"normal": normal, "depth": depth}
        batches = [lights[first : first + BATCH] for first in range(0, len(lights), BATCH)]
        return [
            (batch, draw_masks(draw, batch, pictures, camera, mattes, self.shadow_length, self.shadow_thickness))
            for batch in batches
        ]

    def _add_areas(
        self,
        draw: Draw,
        light: Drawn,
        areas: list[Light],
        surface: Mapping[str, Any],
        numbers: Mapping[str, Any],
    ) -> Drawn:
        """A picture of light with that of rectangles, discs and tubes."""
        return draw(
            "deferred_lighting_areas",
            self.albedo,
            self.material,
            **surface,
            lit=light,
            areas=tabulate_lights(draw, areas, self.intensity),
            overlap=_HERE | {"lit": 0},
            count=len(areas),
            **numbers,
        )

    def _add_limited(
        self,
        draw: Draw,
        light: Drawn,
        batch: list[Light],
        mask: Drawn,
        surface: Mapping[str, Any],
        numbers: Mapping[str, Any],
    ) -> Drawn:
        """A picture of light with that of a few lights more, as far as their masks let it through."""
        areas = [light for light in batch if light.kind in AREA_KINDS]
        lamps = batch[: len(batch) - len(areas)]
        return draw(
            "deferred_lighting_limited",
            self.albedo,
            self.material,
            self.cookie_1,
            self.cookie_2,
            self.cookie_3,
            self.cookie_4,
            **surface,
            lit=light,
            mask=mask,
            throws=tabulate_throws(draw, lamps),
            lights=tabulate_lights(draw, lamps, self.intensity),
            areas=tabulate_lights(draw, areas, self.intensity),
            overlap=_HERE | {"lit": 0, "mask": COVERAGE_REACH},
            model=self.model,
            lamps=len(lamps),
            count=len(areas),
            **numbers,
        )

    def list_lights(self) -> list[Light]:
        """The lights that shine. Where some are solo, those alone: without the swarm and without ambient light."""
        lights = [light for light in lights_of(self.lights) if light.on]
        if solos := [light for light in lights if light.solo]:
            return solos
        return [*lights, *self._swarm(MAX_LIGHTS - len(lights))]

    def _swarm(self, most: int) -> Iterable[Light]:
        """Evenly in the box: Roberts's R3 sequence (2018), whose steps are powers of the root of x^4 = x + 1."""
        count, root = min(self.swarm, most), _R3_ROOT
        for number in range(count):
            at = number + 1 + _SEED_STEP * self.swarm_seed
            x, y, z = (
                middle + side * (2.0 * ((0.5 + at * root**-power) % 1.0) - 1.0)
                for middle, side, power in zip(self.swarm_place, self.swarm_spread, (1, 2, 3), strict=True)
            )
            red, green, blue, alpha = ramp_at(self.swarm_colors, (number + 0.5) / count)
            yield Light(
                place=(x, y, z),
                color=(red, green, blue),
                intensity=alpha * self.swarm_intensity,
                reach=self.swarm_reach,
            )
