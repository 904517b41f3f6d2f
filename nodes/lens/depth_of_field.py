import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from .._declare import (
    Argument,
    Dial,
    Doc,
    Draw,
    Drawn,
    Field,
    Filter,
    Fraction,
    Image,
    Number,
    OutputSocket,
    Overlap,
    Position,
    Reach,
    Size,
    Slider,
    Trait,
    Vector,
)

_FINEST = {"draft": 4.0, "normal": 6.0, "high": 12.0, "exact": math.inf}
"""Radius in pixels of the largest disc that is made of the picture's own pixels."""

_ENDLESS = 1e9
"""A radius or distance beyond all pictures, and finite, so that GLSL can calculate with it."""

_SOFTNESS = 4.0 * 0.354
"""What averaging and interpolating add to a disc's radius squared, in pixels of the smaller size: four times the
variance that they add, as the variance of a disc is a quarter of its radius squared."""

_LEAST_SQUARE = 0.25
"""The square of the least radius, half a pixel, that a stretched disc keeps: it is then no smaller than a pixel."""

_SIMPSON_STEPS = 32
"""Of Simpson's rule over half a blade: the area is exact to 2e-6 for three blades, to 4e-8 for five."""

_MIDDLE = 0.72
"""A typical radius of a level, as a part of its largest one: the mean from a half to the whole, evenly by octaves,
which is 1 / (2 ln 2)."""


class DepthOfField(Filter):
    """Focus like a lens: surfaces that are nearer or farther spread into discs of light (bokeh).

    The diameter of the circle of confusion is `f / N * f / sensor * width * (1 / focus - 1 / depth)`, as Cycles'
    cameras project (pinhole), times `focus / (focus - f)` for a thin lens. Every pixel gathers the discs that reach it.
    Surfaces in front cover the pixel; the rest is shared between its own surface and what is visible behind the soft
    edge of that surface. Large discs are made at a half, a quarter and smaller sizes, separately for near and far
    surfaces. The sum of the light stays. `coc` is the diameter of the disc in pixels of the full-size picture, below 0
    for surfaces nearer than the focus.
    """

    aliases = (
        "dof", "defocus", "z defocus", "zdefocus", "z blur", "zblur", "bokeh", "bokeh blur", "camera lens blur",
        "lens blur", "depth blur", "focus", "rack focus", "focal blur", "frischluft", "cinematic dof",
    )  # fmt: skip
    traits = (Trait.NEEDS_SCENE_LIGHT, Trait.NEEDS_HIGHLIGHTS)

    image = Image()
    depth = Field(doc="Planar depth: the distance along the camera's axis.")
    mask = Field(1.0, doc="How much of its blur each pixel gets, 0..1.")
    focus: Annotated[
        Literal["point", "distance"],
        Doc("Point: the surface at that place in the picture is sharp. Distance: surfaces at that distance are."),
    ] = "point"
    focus_point: Annotated[Position, Doc("The point that is sharp, for focus by point.")] = (0.5, 0.5)
    focus_distance: Annotated[
        float, Slider(0.1, 100.0, unit="scene", minimum=1e-3, doc="The distance that is sharp, for focus by distance.")
    ] = 8.0
    f_number: Annotated[
        float,
        Slider(
            0.7,
            22.0,
            unit="ratio",
            minimum=0.01,
            maximum=1000.0,
            doc="The f-number: focal length over aperture. Lower numbers blur more.",
        ),
    ] = 1.4
    focal: Annotated[
        float, Slider(8.0, 300.0, unit="mm", minimum=0.1, maximum=10000.0, doc="Focal length in millimeters.")
    ] = 85.0
    sensor: Annotated[
        float,
        Slider(
            4.0,
            70.0,
            unit="mm",
            minimum=0.1,
            maximum=1e3,
            doc="Width of the sensor in millimeters; full frame is 36.",
        ),
    ] = 36.0
    meters: Annotated[
        float,
        Slider(
            0.01, 10.0, unit="ratio", minimum=1e-6, maximum=1e6, doc="The length of a unit of the scene, in meters."
        ),
    ] = 1.0
    convention: Annotated[
        Literal["thin lens", "pinhole"],
        Doc("With a thin lens, blur grows when the focus is near. With a pinhole it does not, as in Cycles."),
    ] = "thin lens"
    max_blur: Annotated[
        float, Slider(0.0, 0.1, unit="height", minimum=0.0, maximum=0.5, doc="The largest diameter of discs.")
    ] = 0.03
    aperture: Annotated[Literal["round", "blades"], Doc("The shape of bokeh.")] = "round"
    blades: Annotated[
        int,
        Slider(
            3,
            12,
            unit="count",
            minimum=3,
            maximum=64,
            doc="The number of blades, each of which makes a corner of the bokeh.",
        ),
    ] = 6
    roundness: Annotated[Fraction, Doc("How round the blades are: 1 makes a circle.")] = 0.0
    rotation: Annotated[
        float, Slider(-180.0, 180.0, unit="deg", doc="The rotation of the blades."), Dial("counterclockwise")
    ] = 0.0
    ratio: Annotated[
        float,
        Slider(
            0.5,
            2.0,
            unit="ratio",
            minimum=0.1,
            maximum=10.0,
            doc="Height over width of bokeh: 2 for an anamorphic lens.",
        ),
    ] = 1.0
    cat_eye: Annotated[
        float,
        Slider(
            0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.5, doc="How far the barrel cuts off bokeh in the corners."
        ),
    ] = 0.0
    quality: Annotated[
        Literal["draft", "normal", "high", "exact"],
        Doc(
            "Discs up to this diameter are made at full size: 8, 12 or 24 pixels, or all. The "
            "cost of exact grows with the square of the blur."
        ),
    ] = "normal"

    out = OutputSocket()
    coc = OutputSocket(Field())

    def identity(self) -> str | None:
        return "image" if self.max_blur == 0.0 else None

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        """Compute the radius of every pixel's disc, repair antialiased edges, find the largest disc near each tile,
        then gather: only as far as that disc reaches, and large discs at smaller sizes.
        """
        largest = self.max_blur / 2.0
        radius = self._radius(draw, largest)
        sharp, clean = draw.several(
            "depth_of_field_apart",
            (Image(), Image()),
            self.image,
            radius=radius,
            edge="reflect",
            overlap={"image": 1, "radius": 2},
        )
        image = draw(
            "depth_of_field_whole",
            self.image,
            clean=clean,
            kept=sharp,
            radius=radius,
            edge="reflect",
            overlap={"image": 1, "clean": 1, "kept": 1, "radius": 2},
        )
        finest = min(_FINEST[self.quality], largest)
        levels = max(math.ceil(math.log2(largest / finest)), 0) if finest else 0
        tile = math.ceil(finest) + 1
        most = draw(
            "depth_of_field_most_sharp",
            radius=radius,
            size=_blocks(draw.size, tile),
            result=Field(),
            edge="reflect",
            overlap=Reach.block(tile, tile),
            tile=tile,
            sharpest=finest if levels else _ENDLESS,
        )
        reach = draw("depth_of_field_reach", most=most, size=most.size, overlap=1, result=Field())
        looks: dict[str, Overlap] = {"image": tile, "kept": 0, "radius": tile, "reach": Reach.within(tile, tile)}
        stretch = (max(self.ratio, 1.0), max(1.0 / self.ratio, 1.0))
        bokeh = self._bokeh(draw, finest, stretch)
        gathered: dict[str, Any] = {"image": image, "kept": sharp, "radius": radius, "reach": reach}
        if not levels:
            out = draw("depth_of_field_alone", **gathered, overlap=looks, **bokeh)
        else:
            out = self._gather_levels(draw, gathered, looks, bokeh, levels, finest, stretch)
        return {"out": out, "coc": draw.point("depth_of_field_coc", result=Field(), radius=radius)}

    def _gather_levels(
        self,
        draw: Draw,
        gathered: dict[str, Any],
        looks: dict[str, Overlap],
        bokeh: dict[str, Any],
        levels: int,
        finest: float,
        stretch: tuple[float, float],
    ) -> Drawn:
        """The picture with small discs of full size and large ones of `levels` lower sizes."""
        image, radius = gathered["image"], gathered["radius"]
        # Averaging and interpolating spreads light along both axes, and makes smaller discs rounder.
        widest = (_MIDDLE * finest) ** 2
        across, down = (
            math.sqrt((widest - _SOFTNESS) / max(widest / part**2 - _SOFTNESS, _LEAST_SQUARE)) for part in stretch
        )
        smaller = self._bokeh(draw, finest, (across, down))
        near, hidden = self._layers(draw, image, radius, smaller, levels, finest, -1.0)
        far, filled = self._layers(draw, image, radius, smaller, levels, finest, 1.0)
        rest = self._rest(draw, image, radius, levels, finest)
        coarse = dict.fromkeys(("near", "hidden", "far", "filled"), Reach.within(2, 2, 1))
        return draw(
            "depth_of_field",
            **gathered,
            near=near,
            hidden=hidden,
            far=far,
            filled=filled,
            rest=rest,
            overlap=looks | coarse | {"rest": Reach.within(2**levels, 2**levels, 1)},
            **bokeh,
            coarsest=2.0**levels,
        )

    def _radius(self, draw: Draw, largest: float) -> Drawn:
        """Of the disc of every pixel, below 0 nearer than the focus."""
        focal = self.focal / 1000.0 / self.meters  # in units of the scene
        scale = focal / self.f_number * self.focal / self.sensor * draw.size[0] / 2.0
        bend = focal if self.convention == "thin lens" else 0.0
        sharp: Argument = 1.0 / self.focus_distance
        if self.focus == "point":
            x, y = (
                min(max(at, 0.0), 1.0) * (side - 1) + 0.5
                for at, side in zip(self.focus_point, draw.size_of(self.depth), strict=True)
            )
            sharp = draw(
                "depth_of_field_sharp",
                self.depth,
                size=(1, 1),
                overlap=Reach((0.0, 0.0, x, 0.0, 0.0, y), (1, 1)),
                result=Number(),
                point=self.focus_point,
            )
        return draw.point(
            "depth_of_field_radius",
            self.depth,
            self.mask,
            result=Field(),
            sharp=sharp,
            scale=scale,
            bend=bend,
            largest=largest,
        )

    def _bokeh(self, draw: Draw, finest: float, stretch: tuple[float, float]) -> dict[str, Any]:
        """The arguments of the gathering functions that describe the aperture, squeezed along both axes."""
        inner, area, middle = 1.0, math.pi, 0
        if self.aperture == "blades":
            inner = 1.0 + (math.cos(math.pi / self.blades) - 1.0) * (1.0 - self.roundness)
            area, middle = self._area(inner), math.ceil(finest) + 1
        shape = draw(
            "depth_of_field_blades",
            size=(2 * middle + 1, 2 * middle + 1),
            result=Field(),
            middle=middle,
            blades=self.blades,
            roundness=self.roundness,
            rotation=self.rotation,
            stretch=stretch,
        )
        return {
            "shape": shape,
            "tile": math.ceil(finest) + 1,
            "finest": finest,
            "aperture": self.aperture,
            "lens": (inner, area / (stretch[0] * stretch[1]), self.cat_eye),
            "stretch": stretch,
        }

    def _area(self, inner: float) -> float:
        """Of an aperture of blades whose corners are 1 away from its middle, by Simpson's rule over half a blade."""
        step, sum = math.pi / self.blades / _SIMPSON_STEPS, 0.0
        for i in range(_SIMPSON_STEPS + 1):
            edge = inner / (self.roundness + (1.0 - self.roundness) * math.cos(i * step))
            sum += edge * edge * (1 if i in (0, _SIMPSON_STEPS) else 4 if i % 2 else 2)
        return self.blades * sum * step / 3.0

    def _layers(
        self, draw: Draw, image: Drawn, radius: Drawn, bokeh: dict[str, Any], levels: int, finest: float, side: float
    ) -> tuple[Drawn, Drawn]:
        """Discs that are made at lower sizes, the largest first: their light, and how much of each pixel they cover."""
        tile = math.ceil(finest) + 1
        light = draw("depth_of_field_nothing", size=(1, 1))
        cover = draw("depth_of_field_nothing", size=(1, 1), result=Field())
        within = Reach.within(2, 2, 1)
        for level in range(levels, 0, -1):
            block = 2**level
            size = _blocks(draw.size, block)
            own, extents = draw.several(
                "depth_of_field_level",
                (Image(), Vector(width=3)),
                image=image,
                radius=radius,
                size=size,
                edge="reflect",
                overlap=Reach.block(block, block),
                block=block,
                side=side,
                low=finest * block / 2.0,
                high=finest * block if level < levels else _ENDLESS,
            )
            light, cover = draw.several(
                "depth_of_field_near" if side < 0.0 else "depth_of_field_far",
                (Image(), Field()),
                own=own,
                extents=extents,
                reach=_measure_reach(draw, extents, tile),
                light=light,
                cover=cover,
                size=size,
                overlap={
                    "own": tile,
                    "extents": tile,
                    "reach": Reach.within(tile, tile),
                    "light": within,
                    "cover": within,
                },
                **bokeh,
            )
        return light, cover

    def _rest(self, draw: Draw, image: Drawn, radius: Drawn, levels: int, finest: float) -> Drawn:
        """What may lie behind near and blurred surfaces: all other light, spread into the places that they hide."""
        block = 2**levels
        size, reach = _blocks(draw.size, block), math.ceil(finest) + 1
        light, weight = draw.several(
            "depth_of_field_kept_light",
            (Image(), Field()),
            image=image,
            radius=radius,
            size=size,
            edge="reflect",
            overlap=Reach.block(block, block),
            block=block,
            finest=finest,
        )
        return draw(
            "depth_of_field_rest",
            image=image,
            light=light,
            weight=weight,
            size=size,
            overlap={"image": Reach.block(block, block, 1), "light": reach, "weight": reach},
            reach=reach,
            block=float(block),
        )


def _blocks(size: Size, length: int) -> Size:
    return math.ceil(size[0] / length), math.ceil(size[1] / length)


def _measure_reach(draw: Draw, extents: Drawn, tile: int) -> Drawn:
    """For every tile of a lower size, the largest disc that reaches into it from there or from a tile beside it."""
    most = draw(
        "depth_of_field_most",
        extents=extents,
        size=_blocks(draw.size_of(extents), tile),
        overlap=Reach.block(tile, tile),
        result=Field(),
        tile=tile,
    )
    return draw("depth_of_field_reach", most=most, size=most.size, overlap=1, result=Field())
