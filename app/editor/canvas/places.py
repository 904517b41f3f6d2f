"""Where things were drawn, for tests and hints."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from .brush import DETAILS_FROM, DrawContext
from .geometry import CanvasTransform, Rect, overlap
from .link_index import Net, Wire
from .scene import CanvasScene, ElementBox

if TYPE_CHECKING:
    from .context import CanvasContext

_PIN = 5.0

Found = dict[str, Rect]


@dataclass
class Places:
    """Keeps what was found of every element and of all links for as long as it does not move."""

    context: CanvasContext
    _of: tuple[object, ...] = ()
    _boxes: dict[str, tuple[ElementBox, Found]] = field(default_factory=dict[str, tuple[ElementBox, Found]])
    _net: tuple[Net, Found] = field(default_factory=lambda: (Net(), {}))

    def record(self, scene: CanvasScene, brush: DrawContext) -> None:
        """Note where everything visible is."""
        of = brush.to, brush.seen
        if self._of != of:
            self._of, self._boxes, self._net = of, {}, (Net(), {})
        known, boxes = self._boxes, dict[str, tuple[ElementBox, Found]]()
        places = self.context.places
        for key, box in scene.boxes.items():
            one = known.get(key)
            boxes[key] = one = one if one and one[0] is box else (box, _of_box(box, brush))
            places.update(one[1])
        self._boxes = boxes
        if self._net[0] is not scene.net:
            self._net = scene.net, dict(_of_wire(wire, brush.to) for wire in scene.wires)
        places.update(self._net[1])


def _of_wire(wire: Wire, to: CanvasTransform) -> tuple[str, Rect]:
    x, y = to.to_screen(*wire.middle)
    return f"link {wire.target}", (x - 2.0, y - 2.0, x + 2.0, y + 2.0)


def _of_box(box: ElementBox, brush: DrawContext) -> Found:
    if not overlap(box.rect, brush.seen):
        return {}
    to, s, key = brush.to, brush.to.scale, box.key
    left, top = to.to_screen(box.x, box.y)
    places: Found = {
        f"node {key}": (left, top, left + box.w * s, top + box.h * s),
        f"title {key}": (left, top, left + box.w * s, top + min(brush.header, box.h) * s),
    }
    if box.layout is None:
        return places

    def add(name: str, rect: Rect) -> None:
        places[name] = left + rect[0] * s, top + rect[1] * s, left + rect[2] * s, top + rect[3] * s

    for word, output, pins in (("in", False, box.layout.ins), ("out", True, box.layout.outs)):
        for pin in pins.values():
            add(f"pin {word} {box.port(pin, output)}", (pin.x - _PIN, pin.y - _PIN, pin.x + _PIN, pin.y + _PIN))
    if box.layout.picture:
        add(f"picture {key}", box.layout.picture)
    if brush.zoom >= DETAILS_FROM:
        for row in box.layout.rows:
            if row.value and row.field:
                add(f"widget {key}.{row.value.name}", row.field)
        if box.layout.more:
            add(f"more {key}", box.layout.more)
    return places
