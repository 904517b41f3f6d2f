"""Rotoscope: named splines as one mask."""

import math
from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import (
    RGBA,
    Affine,
    Doc,
    Draw,
    Drawn,
    Field,
    Filter,
    Image,
    OutlineFill,
    OutlinePlace,
    OutputSocket,
    PlacedRotoShape,
    RotoShape,
    RotoShapeSet,
    Slider,
    name_roto_shapes,
    place_roto_shapes,
    trace_spline,
)


class Roto(Filter):
    """Draw a mask by hand: closed splines by name, each added to those before it, cut from them, or kept inside them.

    The mask is how much of each pixel the shapes cover, to 2e-3. Shapes are combined in the order of their names.
    Points and tangents are fractions of the picture, so that shapes are the same at every size. A feather is measured
    from the point of the spline whose distance is the least part of its feather, so that an edge has no steps where
    feathers differ; a wide one costs no more than a narrow one. A spline that crosses itself is solid: what it runs
    around counts once, however often (nonzero winding), and has no edge inside.

    A shape can have a parent: a transform, a track of one or two points, or another shape, also one that is off. It is
    moved as it says itself, then as its parent is, and as the parent of that. Its motion blur is that of all of them.
    """

    aliases = (
        "rotoscope", "rotopaint", "roto paint", "mask", "bezier", "spline", "b-spline", "garbage matte", "mask node",
        "polygon mask", "draw mask", "hold-out", "power window", "pen tool", "vignette mask", "curve mask",
        "b-spline mask", "polyline mask", "roto brush",
    )  # fmt: skip

    matte = Field(0.0, doc="A mask that the shapes are added to.")
    shapes: Annotated[RotoShapeSet, Doc("Shapes by name, combined in the order of their names.")] = name_roto_shapes(
        shape_1=RotoShape()
    )
    color: Annotated[RGBA, Doc("The color of the picture, premultiplied.")] = (1.0, 1.0, 1.0, 1.0)
    shutter: Annotated[
        float,
        Slider(
            0.0, 360.0, unit="deg", minimum=0.0, maximum=720.0,
            doc="Motion blur by the keys of the shapes: at 360 the shutter is open from frame to frame, at 0 never.",
        ),
    ] = 0.0  # fmt: skip
    phase: Annotated[
        Literal["centered", "start", "end"],
        Doc("When the shutter is open: around the frame, from the frame on (start) or until the frame (end)."),
    ] = "centered"
    samples: Annotated[
        int, Slider(4, 64, unit="count", minimum=2, maximum=256, doc="At how many times a moving shape is drawn.")
    ] = 16

    out = OutputSocket(Image(doc="The color where the shapes are, transparent elsewhere."))
    mask = OutputSocket(Field(doc="How much of each pixel the shapes cover, 0..1."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        matte = draw.point("roto_matte", self.matte, result=Field())
        masks = [_draw_mask(draw, matte, outlines) for outlines in self._list_moments(draw)]
        mask = masks[0]
        if len(masks) > 1:
            mask = draw("path_nothing", size=(1, 1), result=Field())
            for moment in masks:
                mask = draw.point("roto_expose", total=mask, mask=moment, result=Field(), part=1.0 / len(masks))
        return {"out": draw.point("roto_fill", mask=mask, color=self.color), "mask": mask}

    def _list_moments(self, draw: Draw) -> list[list[PlacedRotoShape]]:
        """The outlines that count at this frame, at each time that the mask is a mean of: one, if nothing moves.

        The frame is asked for only where something depends on it.
        """
        active = {name: placed for name, placed in place_roto_shapes(self.shapes, draw.size).items() if placed.shape.on}
        if any(placed.shape.lifetime == "range" for placed in active.values()):
            active = {name: placed for name, placed in active.items() if placed.shape.is_active(draw.frame)}
        moments = [list(active.values())]
        if self.shutter > 0.0 and any(placed.shape.motion_blur for placed in active.values()):
            times = self._list_times(draw.frame)
            moved = (place_roto_shapes(draw.settings_at(time)["shapes"], draw.size) for time in times)
            moments = [
                [at[name] if placed.shape.motion_blur else placed for name, placed in active.items()] for at in moved
            ]
        return moments if any(moment != moments[0] for moment in moments) else moments[:1]

    def _list_times(self, frame: int) -> list[float]:
        """The middles of equal parts of the time in which the shutter is open, in frames."""
        opening = self.shutter / (2.0 * math.pi)
        start = frame + {"centered": -0.5, "start": 0.0, "end": -1.0}[self.phase] * opening
        return [start + opening * (number + 0.5) / self.samples for number in range(self.samples)]


def _draw_mask(draw: Draw, matte: Drawn, outlines: list[PlacedRotoShape]) -> Drawn:
    """The mask that outlines make of another one."""
    return draw.fill(matte, [_trace(*placed, draw.size[1]) for placed in outlines]) if outlines else matte


def _trace(shape: RotoShape, affine: Affine, height: int) -> OutlineFill:
    """A shape, moved as it and its parents say, in pixels."""
    contour, feathers = trace_spline(shape.points, height)
    return OutlineFill(
        ((contour,),), (OutlinePlace(0, affine),), shape.mode, shape.opacity, shape.invert, shape.feather, feathers
    )
