import math
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
from ._area_lights import AREA_KINDS, COSINE_CELLS, pack_area_light, read_cosines
from ._blackbody import blackbody_rec709
from ._coverage import COVERAGE_REACH
from ._light_masks import BATCH, draw_masks, is_limited

TILE = 16
"""Pixels across a tile."""

FEW = 8
"""Up to so many lights, each pixel loops over all of them: sorting them into tiles costs more than it saves."""

_HERE = dict.fromkeys(("albedo", "material", "occlusion", "normal", "place", "near"), COVERAGE_REACH) | {"coverage": 0}
"""What a pixel is lit by: its own, or its neighbors'; lights and what they reach may be read anywhere."""

_BITS = 24
"""Lights to a channel of a texel: as many as a float holds exactly."""

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
    2013). Rectangles, discs and tubes light by linearly transformed cosines (Heitz et al. 2016), always those of GGX.
    Light falls off with the square of the distance, times (1 - (d / reach)^4)^2 if a reach is given: with many lights,
    those with a reach are fast. A light can have a color temperature instead of a color. A swarm adds many small lights
    at once.

    A light with `shadow` casts shadows of what the picture shows, by rays through the depth (McGuire and Mara 2014),
    soft for a light with a size. A light with a `matte` lights only what is in one of the four mattes. `out` is diffuse
    and specular light and emission.
    """

    aliases = (
        "relight", "lights", "lighting", "light", "shader", "deferred shading", "point light", "spot light",
        "relighting", "normal light", "normality",
    )  # fmt: skip
    traits = (Trait.NEEDS_SCENE_LIGHT,)
    version = 2

    albedo = Image((0.6, 0.6, 0.6, 1.0), doc="Color of the surfaces. Without a link, clay.")
    normal = Vector(0.0, width=3, doc="In the world. Without a link, from depth and camera.")
    depth = Field(0.0, doc="Planar distance along the way the camera looks, if there is no position.")
    position = Vector(0.0, width=3, doc="In the world. Without a link, from depth and camera.")
    camera = CameraSocket(0.0, doc="Without one, highlights look as if every surface faced the camera.")
    material = Vector((0.0, 0.0), width=2, doc="Metal and roughness, 0..1, in place of the two values.")
    emission = Image((0.0, 0.0, 0.0, 0.0), doc="Added as it is.")
    occlusion = Field(1.0, doc="Ambient occlusion, 0..1: only the ambient light is multiplied with it.")
    matte_1 = Field(1.0, folded=True, doc="A matte that lights can be limited to, of a cryptomatte, an id or any mask.")
    matte_2 = Field(1.0, folded=True, doc="Another matte.")
    matte_3 = Field(1.0, folded=True, doc="Another matte.")
    matte_4 = Field(1.0, folded=True, doc="Another matte.")
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
    swarm_seed: Annotated[int, Slider(0, 100, unit="count", doc="Another number strews them otherwise.")] = 0

    out = OutputSocket()
    diffuse = OutputSocket(Image(doc="The diffuse light."))
    specular_light = OutputSocket(Image(doc="The specular light."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        camera, placed = draw.camera(self.camera), draw.is_linked(self.position)
        rows, rays = (camera.rows, camera.inverse) if camera else ((0.0,) * 12, (0.0,) * 12)
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
            normal=normal,
            near=near,
            overlap=COVERAGE_REACH,
            result=Vector(width=3),
        )
        shining = self._list_lights()
        unlimited = [light for light in shining if not is_limited(light)]
        lights = [light for light in unlimited if light.kind not in AREA_KINDS]
        areas = [light for light in unlimited if light.kind in AREA_KINDS]
        texels = max(1, -(-len(lights) // (4 * _BITS)))
        tiled = len(lights) > FEW and any(_ball(light)[3] < math.inf for light in lights)
        words = self._tiles(draw, place, lights, texels) if tiled else draw.table(_all(len(lights), texels), texels)
        table = self._tabulate(draw, lights)
        ambient_gain = 0.0 if any(light.solo for light in shining) else self.ambient_intensity
        ambient = tuple(ambient_gain * self.ambient[3] * part for part in self.ambient[:3])
        limited = self._limit_lights(draw, shining, normal, place, camera)

        surface: dict[str, Any] = {"normal": normal, "place": place, "near": near, "coverage": coverage}
        material: dict[str, Any] = {
            "mapped": draw.is_linked(self.material),
            "metal": self.metal,
            "roughness": self.roughness,
            "specular": self.specular,
        }
        view: dict[str, Any] = {"rays": rays, "seen": camera is not None, "eye": camera.eye if camera else (0.0,) * 3}

        def lit(scattered: float, mirrored: float) -> Drawn:
            light = draw(
                "deferred_lighting_lit",
                self.albedo,
                self.material,
                self.occlusion,
                **surface,
                lights=table,
                words=words,
                overlap=_HERE,
                model=self.model,
                texels=texels,
                tiled=tiled,
                share=(scattered, mirrored),
                **material,
                ambient=ambient,
                **view,
            )
            if areas:
                light = draw(
                    "deferred_lighting_areas",
                    self.albedo,
                    self.material,
                    **surface,
                    lit=light,
                    areas=self._tabulate(draw, areas),
                    cosines=draw.table(read_cosines(), COSINE_CELLS),
                    overlap=_HERE | {"lit": 0},
                    count=len(areas),
                    share=(scattered, mirrored),
                    **material,
                    **view,
                )
            for batch, mask in limited:
                light = self._add_limited(
                    draw, light, batch, mask, surface, {"share": (scattered, mirrored), **material, **view}
                )
            return light

        return {
            "out": draw.point("deferred_lighting", lit=lit(1.0, 1.0), emission=self.emission),
            "diffuse": lit(1.0, 0.0),
            "specular_light": lit(0.0, 1.0),
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
            **surface,
            lit=light,
            mask=mask,
            lights=self._tabulate(draw, lamps),
            areas=self._tabulate(draw, areas),
            cosines=draw.table(read_cosines(), COSINE_CELLS),
            overlap=_HERE | {"lit": 0, "mask": COVERAGE_REACH},
            model=self.model,
            lamps=len(lamps),
            count=len(areas),
            **numbers,
        )

    def _tabulate(self, draw: Draw, lights: list[Light]) -> Drawn:
        """Rows of numbers for GLSL, one for each light; the second texel of a row is a color. All are areas, or none.

        Temperatures become colors in GLSL, as only that knows the working space.
        """
        pack = pack_area_light if lights and lights[0].kind in AREA_KINDS else _pack_light
        rows = [pack(light, self.intensity) for light in lights]
        width = len(rows[0]) // 4 if rows else 3
        table = draw.table(tuple(part for row in rows for part in row), width)
        if not any(light.temperature for light in lights):
            return table
        colors = [blackbody_rec709(light.temperature) if light.temperature else (1.0,) * 3 for light in lights]
        return draw(
            "deferred_lighting_tint",
            table=table,
            tints=draw.table(tuple(part for color in colors for part in (*color, 1.0)), 1),
            heated=draw.table(tuple(part for light in lights for part in (float(light.temperature > 0.0),) * 4), 1),
            size=(width, len(lights)),
            result=Vector(width=4),
        )

    def _list_lights(self) -> list[Light]:
        """The lights that shine. Where some are solo, those alone: without the swarm and without ambient light."""
        lights = [light for light in lights_of(self.lights) if light.on]
        if solos := [light for light in lights if light.solo]:
            return solos
        return [*lights, *self._swarm(MAX_LIGHTS - len(lights))]

    def _tiles(self, draw: Draw, place: Drawn, lights: list[Light], texels: int) -> Drawn:
        """Which lights can reach which tile: see the GLSL."""
        width, height = (-(-length // TILE) for length in draw.size)
        low, high = (
            draw(
                "deferred_lighting_corner",
                place=place,
                size=(width, height),
                overlap=2 * TILE,
                result=Vector(width=4),
                side=side,
            )
            for side in (1.0, -1.0)
        )
        balls = draw.table(tuple(part for light in lights for part in _ball(light, 1e18)), 1)
        return draw(
            "deferred_lighting_tile",
            low=low,
            high=high,
            balls=balls,
            size=(width * texels, height),
            result=Vector(width=4),
            count=len(lights),
            texels=texels,
        )

    def _swarm(self, most: int) -> Iterable[Light]:
        """Evenly in the box: Roberts's R3 sequence (2018), whose steps are powers of the root of x^4 = x + 1."""
        count, root = min(self.swarm, most), 1.2207440846057596
        for number in range(count):
            at = number + 1 + 7919 * self.swarm_seed
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


def _pack_light(light: Light, gain: float) -> tuple[float, ...]:
    """What the GLSL reads of a light, as three texels.

    The place, or the way to a sun; 1 / reach^2. The color times the intensity; the radius, -1 for a sun. What takes the
    way to the light to a cosine between the cones of a spot.
    """
    kind = light.kind
    red, green, blue = (gain * light.gain * part for part in light.color)
    x, y, z = light.aim
    window = 1.0 / light.reach**2 if light.reach > 0.0 and kind is not LightKind.SUN else 0.0
    size = max(light.size, 1e-4) if kind is LightKind.SPHERE else -1.0 if kind is LightKind.SUN else 0.0
    cone = (0.0, 0.0, 0.0, 1.0)
    if kind is LightKind.SPOT:
        outer = math.cos(light.outer)
        scale = 1.0 / max(math.cos(min(light.inner, light.outer)) - outer, 1e-4)
        cone = (-x * scale, -y * scale, -z * scale, -outer * scale)
    place = (-x, -y, -z) if kind is LightKind.SUN else light.place
    return (*place, window, red, green, blue, size, *cone)


def _ball(light: Light, endless: float = math.inf) -> tuple[float, float, float, float]:
    """A ball, middle and radius, in which all lies that a light can reach. A little larger, as floats are rounded."""
    if light.reach <= 0.0 or light.kind is LightKind.SUN:
        return (0.0, 0.0, 0.0, endless)
    along, radius = 0.0, light.reach
    if light.kind is LightKind.SPOT and light.outer < math.pi / 2:
        angle = light.outer
        along = radius / (2.0 * math.cos(angle)) if angle < math.pi / 4 else radius * math.cos(angle)
        radius = along if angle < math.pi / 4 else radius * math.sin(angle)
    x, y, z = (place + along * part for place, part in zip(light.place, light.aim, strict=True))
    return (x, y, z, 1.0001 * radius + 1e-6 * max(map(abs, (*light.place, x, y, z))))


def _all(count: int, texels: int) -> tuple[float, ...]:
    """The words of a tile that every light can reach."""
    lengths = (min(max(count - first, 0), _BITS) for first in range(0, 4 * _BITS * texels, _BITS))
    return tuple(float(2**length - 1) for length in lengths)
