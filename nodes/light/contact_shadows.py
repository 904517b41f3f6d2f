import math
from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import (
    RGBA,
    CameraSocket,
    Doc,
    Draw,
    Drawn,
    Field,
    Filter,
    Image,
    OutputSocket,
    ProxyNote,
    Slider,
    Vector,
)
from ._coverage import COVERAGE_AROUND, COVERAGE_REACH
from ._march import surfaces

_RAYS = {"preview": 1, "quality": 4, "reference": 32}
"""Rays per pixel where the light is a disc. The filter averages 4 x 4 pixels, so a pixel has 16 times as many."""


class ContactShadows(Filter):
    """Add the short shadows where objects touch, from a sun or a lamp.

    A ray from every pixel toward the light is followed through the picture for a short distance, until it meets a
    surface, according to depth (McGuire and Mara 2014). Objects count as deep as they are wide. A light with a size
    gives soft edges, softer the farther away the shadow caster is. Surfaces that face away from the light stay
    unchanged: they are dark already. Objects outside of the picture cast no shadow.
    """

    aliases = ("screen space shadows", "drop shadow", "shadow", "shadows", "contact shadow", "ray shadows")

    proxy_notes = (ProxyNote(("shadow",), "occlusion is computed from depth, which is not interpolated in a proxy"),)

    image = Image((1.0, 1.0, 1.0, 1.0), doc="The picture that is shaded. Without a link, white.")
    depth = Field(doc="Planar depth: the distance along the camera's axis.")
    normal = Vector(0.0, width=3, doc="In the world. Without a link, from depth.")
    camera = CameraSocket(doc="The camera that the depth was rendered with.")
    light: Annotated[Literal["sun", "lamp"], Doc("A sun has a direction, a lamp a position.")] = "sun"
    direction: Annotated[
        tuple[float, float, float], Slider(-1.0, 1.0, unit="ratio"), Doc("Towards the sun, in the world's axes.")
    ] = (-0.5, -0.4, 0.75)
    position: Annotated[
        tuple[float, float, float], Slider(-10.0, 10.0, unit="scene"), Doc("Where the lamp is in the world.")
    ] = (-2.0, -2.0, 3.0)
    length: Annotated[
        float,
        Slider(0.01, 5.0, unit="scene", minimum=1e-5, maximum=1e8, doc="How far away a shadow caster may be."),
    ] = 0.5
    softness: Annotated[
        float,
        Slider(
            0.0,
            20.0,
            unit="deg",
            minimum=0.0,
            maximum=60.0,
            doc="The angular size of the light seen from the surface: the sun has 0.5.",
        ),
    ] = 4.0
    thickness: Annotated[
        float,
        Slider(
            0.01,
            5.0,
            unit="scene",
            minimum=0.0,
            maximum=1e8,
            doc="The least thickness of objects, which count as deep as they are wide: rays farther behind them pass.",
        ),
    ] = 0.3
    color: Annotated[RGBA, Doc("The color of the shadow; its alpha is the strength of the shadow.")] = (
        0.0,
        0.0,
        0.0,
        0.8,
    )
    quality: Annotated[Literal["preview", "quality", "reference"], Doc("1, 4 or 32 rays per pixel.")] = "quality"

    out = OutputSocket(Image(doc="The picture with the shadows."))
    shadow = OutputSocket(Field(doc="1 where light arrives, 0 where none does."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        camera = draw.camera(self.camera)
        rows, rays = (camera.rows, camera.inverse) if camera else ((0.0,) * 12, (0.0,) * 12)
        all_surfaces = surfaces(draw, self.depth, "contact_shadows", rays)
        length = math.hypot(*self.direction)
        sun = tuple(part / length for part in self.direction) if length else (0.0, 0.0, 1.0)
        shadow = draw(
            "contact_shadows_open",
            self.normal,
            surfaces=all_surfaces,
            result=Field(),
            rows=rows,
            rays=rays,
            light=self.light,
            to=sun if self.light == "sun" else self.position,
            reach=self.length,
            spread=math.tan(0.5 * self.softness),
            thickness=self.thickness,
            count=_RAYS[self.quality] if self.softness else 1,
        )
        if self.softness:
            shadow = draw(
                "contact_shadows_denoise",
                self.normal,
                surfaces=all_surfaces,
                open=shadow,
                result=Field(),
                rows=rows,
                rays=rays,
            )
        if draw.is_linked(self.normal):
            shadow = self._share(draw, shadow, rays, sun if self.light == "sun" else self.position)
        out = draw.point("contact_shadows", self.image, shadow=shadow, color=self.color)
        return {"out": out, "shadow": shadow}

    def _share(self, draw: Draw, open: Drawn, rays: tuple[float, ...], to: tuple[float, ...]) -> Drawn:
        """The shadow where several surfaces share a pixel: rays start at one of them there, with its normal unknown."""
        near = draw.point("contact_shadows_near", self.depth, result=Field())
        coverage = draw(
            "contact_shadows_coverage", self.normal, near=near, overlap=COVERAGE_AROUND, result=Vector(width=3)
        )
        return draw(
            "contact_shadows_shared",
            self.normal,
            near=near,
            coverage=coverage,
            open=open,
            overlap={"normal": COVERAGE_AROUND, "near": COVERAGE_AROUND, "open": COVERAGE_REACH, "coverage": 0},
            result=Field(),
            rays=rays,
            light=self.light,
            to=to,
        )
