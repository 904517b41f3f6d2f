"""Paint: strokes of a brush over a picture. `_brush_paths.py` says how their paths become tables."""

import math
from collections.abc import Mapping, Sequence
from typing import Annotated, NamedTuple, get_args

from .._declare import (
    Doc,
    Draw,
    Drawn,
    Field,
    Filter,
    Image,
    ItemSet,
    OutputSocket,
    PaintStroke,
    PaintStrokeSet,
    PaintTool,
    Pixels,
    paint_strokes_of,
)
from .._declare.paint_strokes import BrushBlend
from ._brush_paths import (
    Box,
    BrushPath,
    Patch,
    PathTables,
    boxes_meet,
    draw_smear,
    draw_tables,
    find_patch,
    grow_box,
    make_rows,
    trace_brush,
)

_FEW_STROKES, _MOST_STROKES = 32, 256
"""The most strokes of a pass. Where few are left to be drawn, a pass draws a power of two of them: each new stroke then
begins another pass, or seldom joins two, so that mostly no more than the few last strokes are drawn again. A pass over
a picture of 1080p takes 0.25 s of a processor, and 0.007 s more for each stroke (measured with llvmpipe), so few large
passes are better where nothing changes."""

_MOST_CHANNELS = 256
"""The most channels of segments of a pass: with 256, no table is higher than the picture."""

_TOOLS, _BLENDS = tuple(PaintTool), get_args(BrushBlend)

_Copied = tuple[str, int | None]
"""An input, and the frame of it; None for the one that is rendered."""


class _Trace(NamedTuple):
    """A stroke with its path in pixels, and what it reads of other pixels."""

    stroke: PaintStroke
    path: BrushPath
    copied: _Copied | None
    """The picture that it copies, other than that with the strokes before it."""
    sigma: float
    """How much it blurs; 0 for other tools."""
    read: Box | None
    """Where it reads the picture with the strokes before it, other than at its own pixel."""


class _Run:
    """Strokes that one pass draws: none of them reads what another one has painted at another pixel.

    `left` is how many strokes there are from its first one on.
    """

    def __init__(self, first: _Trace, left: int) -> None:
        self.traces = [first]
        self.copied, self.sigma = first.copied, first.sigma
        self._channels = first.path.channel_count
        self._most = _MOST_STROKES if left >= _MOST_STROKES else max(1 << max(left.bit_length() - 1, 0), _FEW_STROKES)

    @property
    def is_smear(self) -> bool:
        return self.traces[0].stroke.tool is PaintTool.SMEAR

    def takes(self, trace: _Trace) -> bool:
        """True if a stroke can be drawn in the same pass, after the others."""
        if self.is_smear or trace.stroke.tool is PaintTool.SMEAR or len(self.traces) == self._most:
            return False
        if self._channels + trace.path.channel_count > _MOST_CHANNELS:
            return False
        if self.copied and trace.copied and self.copied != trace.copied:
            return False
        if self.sigma and trace.sigma and self.sigma != trace.sigma:
            return False
        return trace.read is None or not any(boxes_meet(trace.read, other.path.box) for other in self.traces)

    def add(self, trace: _Trace) -> None:
        """Draw a stroke after the others."""
        self.traces.append(trace)
        self.copied, self.sigma = self.copied or trace.copied, self.sigma or trace.sigma
        self._channels += trace.path.channel_count


class Paint(Filter):
    """Paint over a picture: brush, erase, clone, reveal, blur and smear, in the order of the names of the strokes.

    A stroke covers what the brush covers anywhere on its way, once: overlapping itself adds nothing. Points are
    fractions of the picture, so that strokes are the same at every size. A clone copies the picture as it was before
    the stroke. A smear drags the picture along with the brush (the forward warp of Gustafsson 1993), which keeps it
    sharp.
    """

    aliases = (
        "rotopaint", "roto paint", "brush", "clone", "clone stamp", "stamp", "rubber stamp", "eraser", "smudge",
        "reveal", "paint strokes", "dust busting", "dustbust", "retouch", "touch up", "paint node", "vector paint",
        "liquify", "wire removal", "rig removal", "draw", "paint mask", "write-on", "scribble",
    )  # fmt: skip

    image = Image()
    source = Image((0.0, 0.0, 0.0, 0.0), doc="A picture that clone and reveal can copy, such as a clean plate.")
    strokes: Annotated[PaintStrokeSet, Doc("Strokes by name, drawn in the order of their names.")] = ItemSet()

    out = OutputSocket()
    painted = OutputSocket(Field(doc="How much of each pixel is covered by strokes, 0..1, without what is erased."))

    def times(self, frame: int) -> Mapping[str, tuple[int, ...]]:
        copies = {_find_copied(stroke, frame) for stroke in paint_strokes_of(self.strokes) if stroke.is_active(frame)}
        frames = {"image": {frame}, "source": {frame}}
        for copied in copies:
            if copied and copied[1] is not None:
                frames[copied[0]].add(copied[1])
        return {name: tuple(sorted(numbers)) for name, numbers in frames.items() if numbers != {frame}}

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        picture: Drawn | None = None
        cover = draw.point("paint_nothing", result=Field())
        for run in _gather_runs([_trace_stroke(draw, stroke) for stroke in self._list_active(draw)]):
            paths = [trace.path for trace in run.traces]
            patch = find_patch(paths, draw.size, draw.overscan)
            if patch is None:
                continue
            base = picture or self.image
            if run.is_smear:
                painted = draw_smear(draw, base, run.traces[0].stroke, paths[0], patch)
            else:
                tables = draw_tables(draw, paths, patch)
                strokes = make_rows(draw, (part for trace in run.traces for part in _pack_stroke(trace, draw.size)), 4)
                painted = self._draw_run(draw, base, run, tables, strokes, patch)
                covered = draw(
                    "paint_mask", cover=cover, strokes=strokes, segments=tables.segments, owners=tables.owners,
                    words=tables.words, digest=tables.digest, overlap={"cover": patch.read()}, result=Field(),
                    size=patch.size, origin=patch.origin, rows=tables.rows,
                )  # fmt: skip
                cover = draw(
                    "paint_place_mask", cover=cover, patch=covered, overlap={"cover": 0, "patch": patch.place()},
                    result=Field(), origin=patch.origin,
                )  # fmt: skip
            picture = draw(
                "paint_place", base=base, patch=painted, overlap={"base": 0, "patch": patch.place()},
                origin=patch.origin,
            )  # fmt: skip
        return {"out": picture or draw.point("paint_unchanged", self.image), "painted": cover}

    def _draw_run(self, draw: Draw, base: Pixels, run: _Run, tables: PathTables, strokes: Drawn, patch: Patch) -> Drawn:
        """The patch with the strokes of a run."""
        copied, sigma = run.copied, run.sigma
        clones = [trace.stroke.offset for trace in run.traces if trace.stroke.tool is PaintTool.CLONE]
        across = math.ceil(max((abs(offset[0]) for offset in clones), default=0.0) * draw.size[0]) + 1
        down = math.ceil(max((abs(offset[1]) for offset in clones), default=0.0) * draw.size[1]) + 1
        far, near = patch.read(across, down), patch.read()
        return draw(
            "paint_run", self.image, base=base, other=self._read(draw, copied) if copied else base,
            blurred=draw.blur(base, sigma) if sigma else base, strokes=strokes,
            segments=tables.segments, owners=tables.owners, words=tables.words, digest=tables.digest,
            overlap={"image": near, "base": far, "other": far, "blurred": near}, size=patch.size,
            origin=patch.origin, rows=tables.rows,
        )  # fmt: skip

    def _read(self, draw: Draw, copied: _Copied) -> Pixels:
        """The picture that strokes copy."""
        name, frame = copied
        socket = self.image if name == "image" else self.source
        return socket if frame is None else draw.at(socket, frame)

    def _list_active(self, draw: Draw) -> list[PaintStroke]:
        """The strokes that count at this frame. The frame is asked for only where a range depends on it."""
        strokes = [
            stroke for stroke in paint_strokes_of(self.strokes) if stroke.on and stroke.size > 0 and stroke.opacity > 0
        ]
        if any(stroke.lifetime == "range" for stroke in strokes):
            strokes = [stroke for stroke in strokes if stroke.is_active(draw.frame)]
        return strokes


def _gather_runs(traces: Sequence[_Trace]) -> list[_Run]:
    """As few passes as possible. The last stroke has one of its own: while it is drawn, those before it stay."""
    runs = list[_Run]()
    for number, trace in enumerate(traces):
        if runs and trace is not traces[-1] and runs[-1].takes(trace):
            runs[-1].add(trace)
        else:
            runs.append(_Run(trace, len(traces) - 1 - number))
    return runs


def _find_copied(stroke: PaintStroke, frame: int) -> _Copied | None:
    """What a stroke copies, other than the picture with the strokes before it."""
    if stroke.tool not in (PaintTool.CLONE, PaintTool.REVEAL) or stroke.source == "painted":
        return None
    return stroke.source, None if stroke.timing == "offset" and stroke.frame == 0 else stroke.source_frame(frame)


def _trace_stroke(draw: Draw, stroke: PaintStroke) -> _Trace:
    path, sigma, read = trace_brush(stroke, draw.size), 0.0, None
    moves = stroke.tool in (PaintTool.CLONE, PaintTool.REVEAL) and stroke.timing == "offset" and stroke.frame != 0
    copied = _find_copied(stroke, draw.frame if moves else 0)
    if stroke.tool is PaintTool.BLUR:
        sigma = stroke.sigma
        read = grow_box(path.box, 5.0 * sigma + 8.0, 5.0 * sigma + 8.0)
    elif stroke.tool is PaintTool.CLONE and copied is None:
        across, down = stroke.offset[0] * draw.size[0], stroke.offset[1] * draw.size[1]
        left, top, right, bottom = grow_box(path.box, 1.0, 1.0)
        read = left + across, top + down, right + across, bottom + down
    return _Trace(stroke, path, copied, sigma, read)


def _pack_stroke(trace: _Trace, size: tuple[int, int]) -> tuple[float, ...]:
    """Four texels for a stroke, the last one empty.

    The tool, the blend, the opacity and the hardness; the color and whether it copies another picture; the offset.
    """
    stroke = trace.stroke
    offset = stroke.offset if stroke.tool is PaintTool.CLONE else (0.0, 0.0)
    return (
        _TOOLS.index(stroke.tool), _BLENDS.index(stroke.blend), stroke.opacity, stroke.hardness,
        *stroke.color, float(trace.copied is not None),
        offset[0] * size[0], offset[1] * size[1], 0.0, 0.0,
        0.0, 0.0, 0.0, 0.0,
    )  # fmt: skip
