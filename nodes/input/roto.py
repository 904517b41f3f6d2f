"""Rotoscope: named splines as one mask. `_paths.py` says how they become pixels."""

import math
from collections.abc import Mapping
from itertools import groupby, pairwise
from typing import Annotated, Literal, NamedTuple

from .._declare import (
    RGBA,
    CubicCurve,
    Doc,
    Draw,
    Drawn,
    Field,
    Filter,
    Image,
    OutputSocket,
    RotoMode,
    RotoShape,
    RotoShapeSet,
    Size,
    Slider,
    Vector,
    curve_point,
    list_curves,
    name_roto_shapes,
    roto_shapes_of,
    split_points,
)
from ._paths import BITS, BLOCK, SEGMENTS, PathFill, count_blocks, draw_coverage, draw_distance

_FINE = 0.002
"""How far in pixels a long segment may be from its curve: keeps coverage within 2e-3 of exact areas, as the polygon is
on both sides of the curve, by two thirds of this at most."""

_COARSE = 0.004
"""How far a segment may be that is no longer than `_SHORT`: what is too much at its middle is missing at its ends."""

_SHORT = 1.5
"""Pixels: the length up to which a segment counts as short. Coverage is a mean over a pixel, where errors even out."""

_LONG = 12.0
"""The longest segment in pixels: a span then lies in few tiles."""

_FARTHEST = 1e6
"""Pixels from the corner of the picture: floats of 32 bits have 1/16 of a pixel there."""

_MOST_SPANS = 64
"""The most spans of one curve: 512 segments, as many as a quarter of a circle needs that is 3000 pixels high."""

_LOOSE = 1.0 / 500.0
"""How far a chord may be from its curve where it stands for the distance, as a part of the feather: 0.3 percent of
coverage in the middle of the edge, where it changes most."""

_LEAST_SLACK = 0.05
"""The least such distance in pixels: a twentieth of a pixel is not seen in an edge of a few pixels."""

_MODES = tuple(RotoMode)


class _Path(NamedTuple):
    """An outline in pixels: its curves with the feather of the points they start at, and the spans of each curve."""

    outline: RotoShape
    curves: tuple[CubicCurve, ...]
    feathers: tuple[float, ...]
    span_counts: tuple[int, ...]

    @property
    def feather(self) -> float:
        """The width of its edge where that is widest."""
        return self.outline.feather + max(self.feathers)

    @property
    def fill(self) -> PathFill:
        """How it changes the mask below."""
        outline = self.outline
        return PathFill(sum(self.span_counts), _MODES.index(outline.mode), outline.opacity, outline.invert)


class Roto(Filter):
    """Draw a mask by hand: closed splines by name, each added to those before it, cut from them, or kept inside them.

    The mask is how much of each pixel the shapes cover, to 2e-3. Shapes are combined in the order of their names.
    Points and tangents are fractions of the picture, so that shapes are the same at every size. A feather is measured
    from the nearest point of the spline, and a wide one costs no more than a narrow one. Where a spline overlaps
    itself, the pixels count once if both parts run the same way around.
    """

    aliases = (
        "rotoscope", "rotopaint", "roto paint", "mask", "bezier", "spline", "b-spline", "garbage matte", "mask node",
        "polygon mask", "draw mask", "hold-out", "power window", "pen tool", "vignette mask", "curve mask",
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

    def _list_moments(self, draw: Draw) -> list[list[RotoShape]]:
        """The outlines that count at this frame, at each time that the mask is a mean of: one, if nothing moves.

        The frame is asked for only where something depends on it.
        """
        active = {name: outline for name, outline in roto_shapes_of(self.shapes).items() if outline.on}
        if any(outline.lifetime == "range" for outline in active.values()):
            active = {name: outline for name, outline in active.items() if outline.is_active(draw.frame)}
        moments = [list(active.values())]
        if self.shutter > 0.0 and any(outline.motion_blur for outline in active.values()):
            moved = (roto_shapes_of(draw.settings_at(time)["shapes"]) for time in self._list_times(draw.frame))
            moments = [
                [at[name] if outline.motion_blur else outline for name, outline in active.items()] for at in moved
            ]
        return moments if any(moment != moments[0] for moment in moments) else moments[:1]

    def _list_times(self, frame: int) -> list[float]:
        """The middles of equal parts of the time in which the shutter is open, in frames."""
        opening = self.shutter / (2.0 * math.pi)
        start = frame + {"centered": -0.5, "start": 0.0, "end": -1.0}[self.phase] * opening
        return [start + opening * (number + 0.5) / self.samples for number in range(self.samples)]


def _draw_mask(draw: Draw, matte: Drawn, outlines: list[RotoShape]) -> Drawn:
    """The mask that outlines make of another one. Neighbors without a feather are drawn together."""
    mask, paths = matte, [_trace_path(outline, draw.size) for outline in outlines]
    for is_soft, run in groupby(paths, lambda path: path.feather > 0.0):
        if is_soft:
            for path in run:
                mask = _draw_soft(draw, mask, path)
        else:
            mask = _draw_coverage(draw, mask, list(run))
    return mask


def _draw_soft(draw: Draw, mask: Drawn, path: _Path) -> Drawn:
    """One outline with a feather: its exact coverage says which side of the edge a pixel is on."""
    outline = path.outline
    nothing = draw("path_nothing", size=(1, 1), result=Field())
    cover = _draw_coverage(draw, nothing, [path._replace(outline=RotoShape())])
    nearest = draw_distance(draw, _list_chords(path), 0.5 * path.feather)
    return draw.point(
        "roto_soft", mask=mask, cover=cover, nearest=nearest, result=Field(),
        mode=_MODES.index(outline.mode), feather=outline.feather, opacity=outline.opacity, invert=outline.invert,
    )  # fmt: skip


def _draw_coverage(draw: Draw, mask: Drawn, paths: list[_Path]) -> Drawn:
    """The mask with the coverage of splines, whose points are found on the device."""
    fills = [path.fill for path in paths]
    spans = draw.table(_pack_spans(paths), BLOCK)
    curves = draw.table(_pack_curves(paths), 3 * BLOCK)
    size = (BLOCK * SEGMENTS, count_blocks(fills))
    points = draw("roto_points", spans=spans, curves=curves, size=size, result=Vector(width=4))
    return draw_coverage(draw, mask, fills, spans, points)


def _trace_path(outline: RotoShape, size: Size) -> _Path:
    """An outline, moved as it says, in pixels."""
    points = split_points(outline.points)
    a, b, c, d, e, f = outline.find_affine(size, outline.rotation)

    def move(place: tuple[float, float]) -> tuple[float, float]:
        x, y = place
        return _limit(a * x + b * y + c), _limit(d * x + e * y + f)

    moved = [(move(first), move(second), move(third)) for first, second, third, _ in list_curves(points)]
    curves = tuple((*curve, after[0]) for curve, after in zip(moved, (*moved[1:], *moved[:1]), strict=True))
    feathers = tuple(max(point[6], 0.0) * size[1] for point in points)
    return _Path(outline, curves, feathers, tuple(map(_count_spans, curves)))


def _limit(place: float) -> float:
    """A place that is exact enough in 32 bits, and the same within pictures: no picture is so large."""
    return min(max(place, -_FARTHEST), _FARTHEST)


def _count_spans(curve: CubicCurve) -> int:
    """How many spans a curve needs. Its bend bounds how far n segments are from it: 3 / 4 of the bend / n^2."""
    length, bend = sum(math.dist(a, b) for a, b in pairwise(curve)), _measure_bend(curve)
    segments = min(math.sqrt(0.75 * bend / _FINE), max(length / _SHORT, math.sqrt(0.75 * bend / _COARSE)))
    return min(max(1, math.ceil(max(segments, length / _LONG) / SEGMENTS)), _MOST_SPANS)


def _measure_bend(curve: CubicCurve) -> float:
    """The largest second difference of the control points."""
    (ax, ay), (bx, by), (cx, cy), (dx, dy) = curve
    return max(math.hypot(ax - 2 * bx + cx, ay - 2 * by + cy), math.hypot(bx - 2 * cx + dx, by - 2 * cy + dy))


def _pack_curves(paths: list[_Path]) -> tuple[float, ...]:
    """Three texels for each curve: its four points, and the feather at its start and its end."""
    numbers = list[float]()
    for path in paths:
        feathers = (*path.feathers, path.feathers[0])
        for curve, ends in zip(path.curves, pairwise(feathers), strict=True):
            for point in curve:
                numbers += point
            numbers += (*ends, 0.0, 0.0)
    return tuple(numbers)


def _pack_spans(paths: list[_Path]) -> tuple[float, ...]:
    """A texel for each span: its curve, which part of it the span is, of how many, and the span that follows.

    The spans of each outline start with a new channel.
    """
    numbers, curve = list[float](), 0
    for path in paths:
        base = span = len(numbers) // 4
        for count in path.span_counts:
            for part in range(count):
                span += 1
                numbers += (curve, part, count, span)
            curve += 1
        numbers[-1] = base
        numbers += [0.0] * (4 * (path.fill.channel_count * BITS - path.fill.span_count))
    return tuple(numbers)


def _list_chords(path: _Path) -> tuple[float, ...]:
    """Two texels for each chord: its ends, and the feather there."""
    numbers, slack = list[float](), max(_LOOSE * path.feather, _LEAST_SLACK)
    for curve, ends in zip(path.curves, pairwise((*path.feathers, path.feathers[0])), strict=True):
        count = max(1, math.ceil(math.sqrt(0.75 * _measure_bend(curve) / slack)))
        places = (curve[0], *(curve_point(curve, number / count) for number in range(1, count)), curve[3])
        for number, (start, end) in enumerate(pairwise(places)):
            feathers = (ends[0] + (ends[1] - ends[0]) * t / count for t in (number, number + 1))
            numbers += (*start, *end, *feathers, 0.0, 0.0)
    return tuple(numbers)
