"""The brush: with what strokes are painted on the picture, and the one that is being drawn. Nothing here changes the
document."""

from __future__ import annotations

from typing import Literal

from halation.nodes import PAINT_STROKES, PaintTool, Row
from msgspec import Struct, field

from .geometry import Point

BrushRange = Literal["all", "here", "onward"]
"""The frames of new strokes: all, the current one, or from the current one on."""

LEAST_SIZE, MOST_SIZE = 0.001, 4.0
"""The range of the size of a brush, as fractions of the height."""


class PaintBrush(Struct):
    """What the next stroke is like. Lengths are fractions of the height of the picture, places of the picture."""

    is_on: bool = True
    """True while a drag on the picture of a node with strokes paints."""
    tool: PaintTool = PaintTool.BRUSH
    size: float = 0.06
    hardness: float = 0.6
    opacity: float = 1.0
    color: tuple[float, float, float] = (1.0, 1.0, 1.0)
    blend: str = "over"
    sources: dict[PaintTool, str] = field(default_factory=dict[PaintTool, str])
    """What a tool copies, where it is not its default."""
    range: BrushRange = "all"
    copied: Point | None = None
    """The place that the first stroke of a clone copies; None once `offset` follows from it."""
    offset: Point | None = None
    """From what is painted to what is copied there; None until it was chosen."""
    stroke: str = ""
    """The stroke that is being drawn, by its name; "" for none."""
    rows: list[Row] = field(default_factory=list[Row])
    """Its points."""

    @property
    def needs_place(self) -> bool:
        """True if the user must choose first what a clone copies."""
        return self.tool is PaintTool.CLONE and self.offset is None and self.copied is None

    @property
    def source(self) -> str:
        """What the tool copies; "" if it copies nothing."""
        declared = PAINT_STROKES.by_name[self.tool].fields.get("source")
        return self.sources.get(self.tool, str(declared.default)) if declared else ""

    def resize(self, size: float) -> None:
        """Set the size, within its range."""
        self.size = min(max(size, LEAST_SIZE), MOST_SIZE)

    def copy_from(self, place: Point) -> None:
        """Choose what the next stroke of a clone copies; those after it keep the distance."""
        self.copied, self.offset = place, None

    def describe_stroke(self, start: Point, frame: int, end: int) -> dict[str, object]:
        """The fields of a new stroke from a place; `end` is the last frame of one that goes on."""
        if self.tool is PaintTool.CLONE and self.copied is not None:
            self.offset = round(self.copied[0] - start[0], 6), round(self.copied[1] - start[1], 6)
            self.copied = None
        settings: dict[str, object] = {
            "size": round(self.size, 5),
            "hardness": round(self.hardness, 3),
            "opacity": round(self.opacity, 3),
            "color": tuple(round(part, 6) for part in self.color),
            "blend": self.blend,
            "offset": self.offset,
            "source": self.source,
        }
        if self.range != "all":
            settings |= {"lifetime": "range", "first": frame, "last": frame if self.range == "here" else end}
        defaults = PAINT_STROKES.by_name[self.tool].defaults
        return {
            name: part for name, part in settings.items() if name in defaults and part not in (defaults[name], None)
        }
