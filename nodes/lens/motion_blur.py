import math
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Field, Filter, Image, Pixels, Reach, Slider, Trait, Vector


class MotionBlur(Filter):
    """Blur moving surfaces along their paths while the shutter is open.

    A gather filter after McGuire et al. 2012, Jimenez 2014 and Guertin et al. 2014: the fastest motion around tells
    which surfaces may pass in front of a pixel, and for how long each of them covers it; the rest of the time shows the
    surfaces on the pixel's own path. Paths are parabolas through the positions before, now and after. Where the
    velocity is 0 and nothing passes, pixels stay unchanged.
    """

    aliases = (
        "vector blur", "vector motion blur", "pixel motion blur", "force motion blur", "rsmb", "shutter", "motionblur",
        "cc force motion blur", "motion blur 3d", "reelsmart",
    )  # fmt: skip
    traits = (Trait.NEEDS_SCENE_LIGHT,)

    image = Image()
    velocity = Vector(
        width=4,
        doc=(
            "Motion in pixels of the full-size picture, x right, y down: x and y since the "
            "previous frame, z and w until the next one. Where z and w are 0, the motion keeps "
            "its speed."
        ),
    )
    depth = Field(0.0, doc="Shows which surfaces are in front. Without a link, all surfaces have the same depth.")
    shutter: Annotated[
        float,
        Slider(
            0.0,
            360.0,
            unit="deg",
            minimum=0.0,
            maximum=720.0,
            doc="Shutter angle: at 360 the shutter is open from frame to frame, at 180 half the time.",
        ),
    ] = 180.0
    phase: Annotated[
        Literal["centered", "start", "end"],
        Doc("When the shutter is open: around the frame, from the frame on (start) or until the frame (end)."),
    ] = "centered"
    path: Annotated[
        Literal["curved", "straight"], Doc("Curved follows both motions. Straight ignores the motion after the frame.")
    ] = "curved"
    max_length: Annotated[
        float, Slider(0.0, 0.2, unit="height", minimum=0.0, maximum=1.0, doc="Longer paths are shortened to this.")
    ] = 0.06
    samples: Annotated[
        int,
        Slider(
            4,
            128,
            unit="count",
            minimum=2,
            maximum=1024,
            doc="Samples along a path; if it has more pixels, noise replaces those that are left out.",
        ),
    ] = 64

    def identity(self) -> str | None:
        return "image" if self.shutter == 0.0 or self.max_length == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        """Repair antialiased edges, find the path of every pixel and the fastest one near each tile, then gather along
        both.
        """
        frames = self.shutter / (2.0 * math.pi)
        opens = {"centered": -0.5, "start": 0.0, "end": -1.0}[self.phase] * frames
        times, vector = (opens, opens + frames), Vector(width=4)
        # Around the frame, things get half as far from their place; those on bent paths a little farther.
        reach = self.max_length * (0.75 if self.phase == "centered" else 1.0)
        tile = max(math.ceil(reach), 1) + 1
        # Stops may lie half a step before and after the shutter is open; a parabola gets so much farther by then.
        looks = math.ceil(reach * (1.0 + 4.0 / self.samples + 2.0 / self.samples**2)) + 4
        within = Reach.within(tile, tile)
        layer = draw("motion_blur_layer", self.velocity, self.depth, self.image, overlap=2, result=Vector(width=2))
        velocity: Pixels = self.velocity
        fronts: Pixels = self.image
        if draw.is_linked(self.depth):
            velocity = draw("motion_blur_clean", self.velocity, self.depth, layer=layer, overlap=2, result=vector)
            fronts = draw("motion_blur_front", self.image, layer=layer, overlap=2)
        paths = draw.point(
            "motion_blur_path",
            velocity=velocity,
            result=vector,
            path=self.path,
            times=times,
            longest=self.max_length,
            reach=reach,
        )
        around, variety = self._find_tiles(draw, paths, tile, times)
        return draw(
            "motion_blur",
            self.image,
            fronts=fronts,
            layer=layer,
            paths=paths,
            around=around,
            variety=variety,
            overlap={
                "image": looks,
                "fronts": looks,
                "layer": looks,
                "paths": looks,
                "around": within,
                "variety": within,
            },
            times=times,
            tile=tile,
            samples=self.samples,
        )

    def _find_tiles(self, draw: Draw, paths: Drawn, tile: int, times: tuple[float, float]) -> tuple[Drawn, Drawn]:
        """For every tile, the fastest path in it and around it, and how much the paths in it differ.

        No path leads farther than a tile, so a pixel is only reached by what moves in its own tile or in one beside it.
        """
        vector = Vector(width=4)
        width, height = draw.size
        across, down = math.ceil(width / tile), math.ceil(height / tile)
        rows = draw(
            "motion_blur_fastest",
            paths=paths,
            size=(across, height),
            overlap=Reach.block(tile, 1),
            result=vector,
            axis=0,
            count=tile,
            times=times,
        )
        tiles = draw(
            "motion_blur_fastest",
            paths=rows,
            size=(across, down),
            overlap=Reach.block(1, tile),
            result=vector,
            axis=1,
            count=tile,
            times=times,
        )
        around = draw("motion_blur_around", tiles=tiles, size=(across, down), overlap=1, result=vector, times=times)
        spread = draw(
            "motion_blur_spread",
            paths=paths,
            tiles=tiles,
            size=(across, down),
            overlap={"paths": Reach.block(tile, tile), "tiles": 0},
            result=Field(),
            tile=tile,
            times=times,
        )
        variety = draw(
            "motion_blur_variety",
            tiles=tiles,
            around=around,
            spread=spread,
            size=(across, down),
            overlap=1,
            result=Field(),
            times=times,
        )
        return around, variety
