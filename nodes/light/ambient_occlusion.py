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
    Vector,
)
from ._occlusion import DATA, FACTORS, SAMPLES, denoise_and_enlarge, measure_size


class AmbientOcclusion(Filter):
    """Darken corners, creases and contacts: how much of a uniform sky every surface sees within a radius.

    It is computed from depth, and is better if normals are linked. 1 is open. Multiply ambient or indirect light with
    it, never lamps or glow. Modes: gtao, the cosine-weighted share of the sky between two horizons (Jimenez et al.
    2016); hbao, the share of solid angle between them (Bavoil et al. 2008); bitmask, gtao in 32 sectors, so that light
    passes behind thin objects (Therrien et al. 2023); hemisphere and crytek, how many points of the half or whole ball
    around a point are behind visible surfaces (Mittring 2007; Chapman's hemisphere); alchemy, an obscurance that fades
    with distance (McGuire et al. 2011). `out` is the same as a picture, and can be tinted by light that surfaces
    reflect onto each other.
    """

    aliases = (
        "ssao", "ao", "hbao", "gtao", "occlusion", "screen space ambient occlusion", "contact occlusion", "dirt", "sao",
        "mxao",
    )  # fmt: skip

    proxy_notes = (
        ProxyNote(
            ("bent_normal", "occlusion"),
            "occlusion is computed from depth, which is not interpolated in a proxy",
        ),
    )

    depth = Field(doc="Planar depth: the distance along the camera's axis.")
    normal = Vector(0.0, width=3, doc="In the world. Without a link, from depth.")
    camera = CameraSocket(doc="The camera that the depth was rendered with.")
    albedo = Image((0.5, 0.5, 0.5, 1.0), doc="Color of the surfaces, for the tint. Without a link, a mid gray.")
    mode: Annotated[
        Literal["gtao", "hbao", "bitmask", "hemisphere", "crytek", "alchemy"],
        Doc("How occlusion is measured. Bitmask is best for grass, hair and wires, gtao for all else."),
    ] = "gtao"
    radius: Annotated[
        float,
        Slider(0.01, 5.0, unit="scene", minimum=1e-6, maximum=1e6, doc="How far light is blocked, in world units."),
    ] = 1.0
    falloff: Annotated[
        Fraction,
        Doc("The outer part of the radius over which occlusion fades out: 0 is a hard end. For gtao and hbao."),
    ] = 0.5
    thickness: Annotated[
        float,
        Slider(
            0.01,
            5.0,
            unit="scene",
            minimum=0.0,
            maximum=1e9,
            doc="The assumed thickness of objects. For bitmask, hemisphere and crytek.",
        ),
    ] = 0.5
    power: Annotated[
        float,
        Slider(0.25, 4.0, unit="ratio", minimum=0.01, maximum=16.0, doc="Contrast: 1 is physical, more is darker."),
    ] = 1.0
    multi_bounce: Annotated[
        bool, Doc("Brighten and tint `out` by the light that surfaces reflect onto each other (Jimenez et al. 2016).")
    ] = False
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

    out = OutputSocket(Image(doc="The color that ambient light is multiplied with."))
    occlusion = OutputSocket(Field(doc="1 where everything is open, 0 where nothing is."))
    bent_normal = OutputSocket(
        Vector(width=3, doc="The direction from which most light comes: unit length, in the world.")
    )

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        """Measure at some pixels with a pattern of noise, average it away over pixels of the same surface, then
        enlarge.
        """
        camera = draw.camera(self.camera)
        rows, rays = (camera.rows, camera.inverse) if camera else ((0.0,) * 12, (0.0,) * 12)
        normal = draw(
            "ambient_occlusion_normal", self.depth, self.normal, edge="black", result=Vector(width=3), rows=rows
        )
        factor = FACTORS[self.resolution]
        slices, steps = SAMPLES[self.quality]
        settings: dict[str, Any] = {
            "depth": self.depth,
            "normal": normal,
            "size": measure_size(draw.size, factor),
            "result": DATA,
            "mode": self.mode,
            "rows": rows,
            "rays": rays,
            "factor": factor,
        }
        if self.mode in ("gtao", "hbao", "bitmask"):
            open_ = draw(
                "ambient_occlusion_horizons",
                **settings,
                slices=slices,
                steps=steps,
                radius=self.radius,
                falloff=self.falloff,
                thickness=self.thickness,
                matched=self.denoise,
            )
        else:
            open_ = draw(
                "ambient_occlusion_points",
                **settings,
                points=2 * slices * steps,
                radius=self.radius,
                thickness=self.thickness,
                matched=self.denoise,
            )
        open_ = denoise_and_enlarge(draw, "ambient_occlusion", self.depth, normal, open_, rays, factor, self.denoise)
        return {
            "out": draw.point(
                "ambient_occlusion", open=open_, albedo=self.albedo, power=self.power, multi_bounce=self.multi_bounce
            ),
            "occlusion": draw.point("ambient_occlusion_value", open=open_, power=self.power, result=Field()),
            "bent_normal": draw.point("ambient_occlusion_bent", open=open_, result=Vector(width=3)),
        }
