"""The place of the picture in the panel, and what is under the mouse."""

from __future__ import annotations

import math
from typing import Literal

from msgspec import Struct
from msgspec.structs import replace

from ...renderer.viewing import look
from ...renderer.viewing.look import Look

Point = tuple[float, float]
Pixels = tuple[int, int]
Box = tuple[float, float, float, float]

MIN_ZOOM, MAX_ZOOM = 1 / 64, 128.0
GRID_FROM = 8.0
"""The zoom from which on lines separate pixels."""

Grip = Literal["", "line", "angle", "move", "n", "s", "w", "e", "nw", "ne", "sw", "se"]


class Sight(Struct, frozen=True):
    """A picture seen through a panel.

    `origin` is the panel's left top on the screen, `density` how many panel pixels a screen unit has (2 on some
    displays of laptops). `panel`, `zoom` and `pan` are panel pixels; `picture` is the size at scale 1, whose pixels are
    shown `stretch` times as wide as high.
    """

    origin: Point
    panel: Pixels
    picture: Pixels
    zoom: float = 1.0
    pan: Point = (0.0, 0.0)
    density: float = 1.0
    stretch: float = 1.0

    @classmethod
    def of(
        cls,
        origin: Point,
        panel: Pixels,
        picture: Pixels,
        zoom: float,
        pan: Point,
        density: float = 1.0,
        stretch: float = 1.0,
    ) -> Sight:
        """The sight of a picture; with a zoom of 0 it fits the panel."""
        if zoom <= 0.0:
            zoom, pan = look.fit_zoom(panel, picture, stretch), (0.0, 0.0)
        return cls(origin, panel, picture, zoom, pan, density, stretch)

    @property
    def look(self) -> Look:
        """The placement of the picture, as the display takes it."""
        return Look(zoom=self.zoom, stretch=self.stretch, pan=self.pan)

    @property
    def pixel_size(self) -> Point:
        """Screen units of a pixel of the picture, across and down."""
        across, down = self.look.pixel_size
        return across / self.density, down / self.density

    def pixel(self, at: Point) -> Point:
        """The picture position (pixels at full size, fractions kept) under a screen point."""
        x, y = ((at[i] - self.origin[i]) * self.density for i in (0, 1))
        return look.find_picture_point(self.look, self.panel, self.picture, (x, y))

    def screen(self, pixel: Point) -> Point:
        """The screen point of a picture position."""
        point = look.find_panel_point(self.look, self.panel, self.picture, pixel)
        x, y = (self.origin[i] + point[i] / self.density for i in (0, 1))
        return x, y

    def fraction(self, at: Point) -> Point:
        """The picture position under a screen point, as a fraction of the picture."""
        x, y = self.pixel(at)
        return x / max(self.picture[0], 1), y / max(self.picture[1], 1)

    def place(self, fraction: Point) -> Point:
        """The screen point of a fraction of the picture."""
        return self.screen((fraction[0] * self.picture[0], fraction[1] * self.picture[1]))

    def rectangle(self, box: Box) -> Box:
        """A box of fractions on the screen."""
        return (*self.place(box[:2]), *self.place(box[2:]))

    def under(self, at: Point) -> Pixels | None:
        """The pixel under a screen point, None outside of the picture."""
        x, y = (math.floor(part) for part in self.pixel(at))
        return (x, y) if 0 <= x < self.picture[0] and 0 <= y < self.picture[1] else None

    def zoom_by(self, factor: float, at: Point) -> Sight:
        """Zoom in by `factor` about the screen point `at`."""
        zoom = min(max(self.zoom * factor, MIN_ZOOM), MAX_ZOOM)
        grown = zoom / self.zoom
        x, y = (
            offset - (offset - self.pan[i]) * grown
            for i, offset in enumerate((at[i] - self.origin[i]) * self.density - self.panel[i] / 2 for i in (0, 1))
        )
        return replace(self, zoom=zoom, pan=(x, y))

    def pan_by(self, dx: float, dy: float) -> Sight:
        """Pan by screen units; a part of the picture always stays visible."""
        moved = (self.pan[0] + dx * self.density, self.pan[1] + dy * self.density)
        x, y = (
            min(max(moved[i], -limit), limit)
            for i, limit in enumerate(
                max((self.panel[i] + self.picture[i] * self.look.pixel_size[i]) / 2 - 32.0, 0.0) for i in (0, 1)
            )
        )
        return replace(self, pan=(x, y))


def texel(pixel: Pixels, full: Pixels, size: Pixels) -> Pixels:
    """The texel of a texture of another size that shows a pixel of the full size."""
    x, y = (min(max(int((pixel[i] + 0.5) * size[i] / max(full[i], 1)), 0), size[i] - 1) for i in (0, 1))
    return x, y


def texels(box: Box, size: Pixels) -> tuple[int, int, int, int]:
    """The pixels (x, y, width, height; at least one) of a texture that a box of fractions covers."""
    left, top, right, bottom = order_box(box)
    x, y = (min(max(math.floor(part * size[i] + 1e-6), 0), size[i] - 1) for i, part in enumerate((left, top)))
    ends = (min(max(math.ceil(part * size[i] - 1e-6), 1), size[i]) for i, part in enumerate((right, bottom)))
    x1, y1 = ends
    return x, y, max(x1 - x, 1), max(y1 - y, 1)


def order_box(box: Box) -> Box:
    """The same box with left before right and top before bottom, inside the picture."""
    (left, right), (top, bottom) = sorted((box[0], box[2])), sorted((box[1], box[3]))
    left, top, right, bottom = (min(max(part, 0.0), 1.0) for part in (left, top, right, bottom))
    return left, top, right, bottom


# --- wipe ----------------------------------------------------------------------------------------------------------


def wipe_direction(angle: float) -> Point:
    """The direction of the wipe line on the screen, a unit vector: down at 0 degrees, turning clockwise."""
    radians = math.radians(angle)
    return -math.sin(radians), math.cos(radians)


def wipe_grip(at: Point, center: Point, angle: float, arm: float, reach: float) -> Grip:
    """The part of the wipe under the mouse: its turning handle, `arm` units down the line, or the line."""
    along = wipe_direction(angle)
    if math.dist(at, (center[0] + along[0] * arm, center[1] + along[1] * arm)) <= reach * 1.5:
        return "angle"
    away = (at[0] - center[0]) * along[1] - (at[1] - center[1]) * along[0]
    return "line" if abs(away) <= reach else ""


def wipe_angle(at: Point, center: Point) -> float:
    """The angle, in degrees, at which the turning handle is under `at`; whole steps of 45 degrees attract it."""
    angle = math.degrees(math.atan2(-(at[0] - center[0]), at[1] - center[1]))
    nearest = round(angle / 45.0) * 45.0
    return nearest if abs(angle - nearest) < 3.0 else angle


# --- boxes ---------------------------------------------------------------------------------------------------------


def box_grip(at: Point, box: Box, reach: float) -> Grip:
    """Which edge or corner of a box on the screen the mouse is over; "move" is its center."""
    left, top, right, bottom = box
    if math.dist(at, ((left + right) / 2, (top + bottom) / 2)) <= reach * 1.5:
        return "move"
    if not (left - reach <= at[0] <= right + reach and top - reach <= at[1] <= bottom + reach):
        return ""
    sides: dict[tuple[str, str], Grip] = {
        ("n", "w"): "nw",
        ("n", "e"): "ne",
        ("s", "w"): "sw",
        ("s", "e"): "se",
        ("n", ""): "n",
        ("s", ""): "s",
        ("", "w"): "w",
        ("", "e"): "e",
    }
    vertical = "n" if abs(at[1] - top) <= reach else "s" if abs(at[1] - bottom) <= reach else ""
    horizontal = "w" if abs(at[0] - left) <= reach else "e" if abs(at[0] - right) <= reach else ""
    return sides.get((vertical, horizontal), "")


def drag_box(box: Box, grip: Grip, by: Point) -> Box:
    """A box of fractions after one of its grips was moved; it stays inside the picture."""
    left, top, right, bottom = box
    if grip == "move":
        dx = min(max(by[0], -left), 1.0 - right)
        dy = min(max(by[1], -top), 1.0 - bottom)
        return left + dx, top + dy, right + dx, bottom + dy
    return order_box(
        (
            left + (by[0] if "w" in grip else 0.0),
            top + (by[1] if "n" in grip else 0.0),
            right + (by[0] if "e" in grip else 0.0),
            bottom + (by[1] if "s" in grip else 0.0),
        )
    )


def share_height(room: float, below: float, table: float) -> tuple[float, float]:
    """The heights of the picture and of the table in a panel, over `below` pixels of text: a table takes no more than
    two fifths of it."""
    table = min(table, room * 0.4)
    return max(room - below - table, 32.0), table
