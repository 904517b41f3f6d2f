"""Records where elements are drawn, for tests and hints."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct, field

from .brush import DETAILS_FROM, DrawContext
from .geometry import CanvasTransform, Rect, overlaps
from .link_index import LinkIndex, Wire
from .scene import CanvasScene, ElementBox

if TYPE_CHECKING:
    from .context import CanvasContext

_PIN = 5.0

NamedRects = dict[str, Rect]


class PlaceRecorder(Struct):
    """Records the rectangles of elements and links, cached until they move."""

    context: CanvasContext
    _inputs: tuple[object, ...] = ()
    _boxes: dict[str, tuple[ElementBox, NamedRects]] = field(default_factory=dict[str, tuple[ElementBox, NamedRects]])
    _links: tuple[LinkIndex, NamedRects] = field(default_factory=lambda: (LinkIndex(), {}))

    def record(self, scene: CanvasScene, brush: DrawContext) -> None:
        """Record the rectangles of everything visible."""
        inputs = brush.to, brush.visible
        if self._inputs != inputs:
            self._inputs, self._boxes, self._links = inputs, {}, (LinkIndex(), {})
        old_boxes, boxes = self._boxes, dict[str, tuple[ElementBox, NamedRects]]()
        places = self.context.places
        for key, box in scene.boxes.items():
            cached = old_boxes.get(key)
            boxes[key] = cached = cached if cached and cached[0] is box else (box, _find_box_rects(box, brush))
            places.update(cached[1])
        self._boxes = boxes
        if self._links[0] is not scene.links:
            self._links = scene.links, dict(_find_wire_rect(wire, brush.to) for wire in scene.wires)
        places.update(self._links[1])


def _find_wire_rect(wire: Wire, to: CanvasTransform) -> tuple[str, Rect]:
    x, y = to.to_screen(*wire.middle)
    return f"link {wire.target}", (x - 2.0, y - 2.0, x + 2.0, y + 2.0)


def _find_box_rects(box: ElementBox, brush: DrawContext) -> NamedRects:
    """Where the parts of a box are on the screen, by names: tests and hints find them there."""
    if not overlaps(box.rect, brush.visible):
        return {}
    to, s, key = brush.to, brush.to.scale, box.key
    left, top = to.to_screen(box.x, box.y)
    places: NamedRects = {
        f"node {key}": (left, top, left + box.w * s, top + box.h * s),
        f"title {key}": (left, top, left + box.w * s, top + min(brush.header, box.h) * s),
    }
    if box.layout is None:
        return places

    def add(name: str, rect: Rect) -> None:
        places[name] = left + rect[0] * s, top + rect[1] * s, left + rect[2] * s, top + rect[3] * s

    for word, output, pins in (("in", False, box.layout.ins), ("out", True, box.layout.outs)):
        for pin in pins.values():
            add(f"pin {word} {box.make_port(pin, output)}", (pin.x - _PIN, pin.y - _PIN, pin.x + _PIN, pin.y + _PIN))
    if box.layout.picture:
        add(f"picture {key}", box.layout.picture)
    if brush.zoom >= DETAILS_FROM:
        for row in box.layout.rows:
            if row.value and row.field:
                add(f"widget {key}.{row.value.name}", row.field)
        if box.layout.more:
            add(f"more {key}", box.layout.more)
    return places
