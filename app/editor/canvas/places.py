"""Where things were drawn, for tests and hints."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..editor import Editor
from .brush import WIDGETS_FROM, Brush
from .geometry import Rect, overlap
from .layout import HEADER
from .scene import Scene

_PIN = 5.0


@dataclass
class Places:
    """Keeps what was found for as long as nothing moves."""

    _of: tuple[object, ...] = ()
    _found: dict[str, Rect] = field(default_factory=dict[str, Rect])

    def record(self, editor: Editor, scene: Scene, brush: Brush) -> None:
        """Note where everything visible is."""
        of = scene, brush.to, brush.seen
        if not self._of or self._of[0] is not scene or self._of[1:] != of[1:]:
            self._of, self._found = of, _found(scene, brush)
        editor.places.update(self._found)


def _found(scene: Scene, brush: Brush) -> dict[str, Rect]:
    places, to, s = dict[str, Rect](), brush.to, brush.to.scale
    for key, box in scene.boxes.items():
        if not overlap(box.rect, brush.seen):
            continue
        left, top = to.to_screen(box.x, box.y)
        places[f"node {key}"] = left, top, left + box.w * s, top + box.h * s
        places[f"title {key}"] = left, top, left + box.w * s, top + min(HEADER, box.h) * s
        if box.layout is None:
            continue
        for word, output, pins in (("in", False, box.layout.ins), ("out", True, box.layout.outs)):
            for pin in pins.values():
                x, y, r = left + pin.x * s, top + pin.y * s, _PIN * s
                places[f"pin {word} {box.port(pin, output)}"] = x - r, y - r, x + r, y + r
        if brush.zoom < WIDGETS_FROM:
            continue
        for row in box.layout.rows:
            if row.value and (field := row.field):
                places[f"widget {key}.{row.value.name}"] = (
                    left + field[0] * s, top + field[1] * s, left + field[2] * s, top + field[3] * s
                )
        if more := box.layout.more:
            places[f"more {key}"] = left + more[0] * s, top + more[1] * s, left + more[2] * s, top + more[3] * s
    for wire in scene.wires:
        x, y = to.to_screen(*wire.middle)
        places[f"link {wire.target}"] = x - 2.0, y - 2.0, x + 2.0, y + 2.0
    return places
