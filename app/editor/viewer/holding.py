"""What the mouse takes hold of on the picture, and what becomes of it while it is dragged."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from ...graph import Port
from .geometry import Box, Grip, Point, Sight, box_dragged, box_grip, ordered, wipe_angle, wipe_grip
from .handles import handles
from .lights import Lamp, lamps, put

if TYPE_CHECKING:
    from ..editor import Editor

What = Literal["pan", "handle", "light", "wipe", "region", "new region", "measure", "pick"]

ARM = 56.0
"""Length of the wipe's turning handle at UI scale 1."""

REACH = 6.0
"""From how far away something is hit, at UI scale 1."""


@dataclass(frozen=True)
class Aim:
    """What a press of the button would take hold of."""

    what: What
    grip: Grip = ""
    port: Port | None = None
    lamp: Lamp | None = None


def aim(editor: Editor, sight: Sight, at: Point, scale: float = 1.0, *, ctrl: bool = False) -> Aim:
    """What is under the mouse. `scale` is that of the interface."""
    viewer, reach = editor.viewer, REACH * scale
    if viewer.picking:
        return Aim("pick")
    if viewer.drawing_region:
        return Aim("new region")
    if ctrl:
        return Aim("measure")
    for handle in handles(editor.session):
        if math.dist(at, sight.place(handle.at)) <= reach * 1.6:
            return Aim("handle", port=handle.port)
    for lamp in reversed(lamps(editor)):
        if math.dist(at, sight.place(lamp.at)) <= reach * 1.6:
            return Aim("light", lamp=lamp)
    if viewer.compare == "wipe" and sight.under(at):
        grip = wipe_grip(at, sight.place(viewer.wipe), viewer.wipe_angle, ARM * scale, reach)
        if grip:
            return Aim("wipe", grip)
    if viewer.region is not None:
        grip = box_grip(at, sight.rectangle(viewer.region), reach)
        if grip:
            return Aim("region", grip)
    return Aim("pan")


@dataclass
class Hold:
    """Something that the mouse holds, from press to release."""

    aim: Aim
    start: Point
    """Where it was pressed on the screen."""
    offset: Point = (0.0, 0.0)
    """From the mouse to the held point, as a fraction of the picture."""
    box: Box = (0.0, 0.0, 1.0, 1.0)
    moved: bool = False

    @classmethod
    def begin(cls, editor: Editor, sight: Sight, at: Point, aim: Aim) -> Hold:
        """Take hold of what is aimed at."""
        hold, (x, y) = cls(aim, at), sight.fraction(at)
        held = next((one.at for one in handles(editor.session) if one.port == aim.port), None)
        if aim.lamp is not None:
            held, editor.lights[str(aim.lamp.port)] = aim.lamp.at, aim.lamp.index
        if aim.what == "wipe" and aim.grip == "line":
            held = editor.viewer.wipe
        if held is not None:
            hold.offset = held[0] - x, held[1] - y
        if aim.what == "region" and editor.viewer.region:
            hold.box = editor.viewer.region
        return hold

    def drag(self, editor: Editor, sight: Sight, at: Point, by: Point) -> None:
        """Follow the mouse to `at`, `by` screen units from where it was a frame ago."""
        self.moved = self.moved or math.dist(at, self.start) > 3.0
        viewer, (x, y), begun = editor.viewer, sight.fraction(at), sight.fraction(self.start)
        match self.aim.what:
            case "pan":
                if by != (0.0, 0.0) and self.moved:
                    moved = sight.panned(*by)
                    viewer.zoom, viewer.pan = moved.zoom, moved.pan
            case "handle" if self.moved:
                self._move_handle(editor, (x + self.offset[0], y + self.offset[1]))
            case "light" if self.moved and self.aim.lamp is not None:
                put(editor, self.aim.lamp, (x + self.offset[0], y + self.offset[1]))
            case "wipe" if self.aim.grip == "angle":
                viewer.wipe_angle = wipe_angle(at, sight.place(viewer.wipe))
            case "wipe":
                left, top = (min(max(part, 0.0), 1.0) for part in (x + self.offset[0], y + self.offset[1]))
                viewer.wipe = left, top
            case "region":
                viewer.region = box_dragged(self.box, self.aim.grip, (x - begun[0], y - begun[1]))
            case "new region" if self.moved:
                viewer.region = ordered((*begun, x, y))
            case "measure" if self.moved:
                viewer.measured = ordered((*begun, x, y))
            case _:
                pass

    def release(self, editor: Editor, sight: Sight, at: Point) -> None:
        """Let go."""
        viewer = editor.viewer
        if self.aim.what in ("handle", "light"):
            editor.session.seal()
        elif self.aim.what == "new region":
            viewer.drawing_region = False
            viewer.region = viewer.region if self.moved else None
        elif self.aim.what == "measure":
            viewer.table = True  # only now: it takes room, and the picture would move under the pointer
            if not self.moved and sight.under(at):
                viewer.markers = toggled(viewer.markers, sight, at)

    def _move_handle(self, editor: Editor, to: Point) -> None:
        port = self.aim.port
        assert port is not None
        editor.dragging = True
        position = tuple(round(min(max(part, -1.0), 2.0), 5) for part in to)
        editor.attempt(lambda: editor.session.set(port, position, merge=f"handle {port}"))


def toggled(markers: tuple[Point, ...], sight: Sight, at: Point) -> tuple[Point, ...]:
    """The markers with one more at the pixel under the mouse, or without the one that is there."""
    pixel = sight.under(at)
    assert pixel is not None
    width, height = sight.picture
    near = tuple(one for one in markers if math.dist(sight.place(one), at) <= REACH)
    if near:
        return tuple(one for one in markers if one not in near)
    return (*markers, ((pixel[0] + 0.5) / width, (pixel[1] + 0.5) / height))
