"""Draws results for the screen: placed on a panel, through a view, with what helps to judge them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, get_args

import moderngl

from ...color.management import color_mark
from ..opengl.device import Device
from .look import Channels, Look, Meaning, Point, Size, origin
from .view_programs import Seen, ViewProgram, ViewPrograms

Rect = tuple[int, int, int, int]

ENLARGED = 0.8
"""Texels per pixel, along a side, below which a view is computed per texel."""

Handle = moderngl.Texture
"""A texture; `glo` is what window libraries call it."""


class Drawable(Protocol):
    """A result that can be drawn. `key` changes whenever its pixels do; `full_size` is its size at scale 1.

    It has `size` pixels as it is; the texture holds them all, or a part from pixel `start` on.
    """

    @property
    def texture(self) -> Handle: ...
    @property
    def size(self) -> Size: ...
    @property
    def start(self) -> tuple[int, int]: ...
    @property
    def full_size(self) -> Size: ...
    @property
    def channels(self) -> int: ...
    @property
    def key(self) -> str: ...


@dataclass(eq=False)
class _Panel:
    """What a slot shows now."""

    texture: moderngl.Texture
    framebuffer: moderngl.Framebuffer
    shown: object = None

    def release(self) -> None:
        self.framebuffer.release()
        self.texture.release()


class Display:
    """One texture for every slot, drawn only when something changed.

    `depth` is the format of what is drawn: `f1` for a screen, `f4` for measurements.
    """

    def __init__(self, device: Device, depth: str = "f1") -> None:
        self._device, self._depth = device, depth
        self._panels: dict[str, _Panel] = {}
        self._programs = ViewPrograms(device.context)
        self._texels: _Panel | None = None
        """A picture through a view, while it is drawn."""
        self.drawn = 0
        """How often something had to be drawn."""

    def draw(
        self, slot: str, size: Size, a: Drawable | None, b: Drawable | None = None, look: Look | None = None
    ) -> Handle:
        """What a panel of `size` pixels shows, row 0 on top, opaque: the same texture while a slot keeps its size.

        Without anything to compare with, `a` is shown alone. Raises UsageError for an unknown view.
        """
        look = look or Look()
        if look.compare == "b" and b is not None:
            a = b
        if look.compare not in ("wipe", "difference"):
            b = None
        shown = ((max(1, size[0]), max(1, size[1])), _mark(a), _mark(b), look, color_mark(look.color))
        panel = self._panels.get(slot)
        if panel is None or panel.shown != shown:
            with self._device.drawing():
                panel = self._panel(slot, shown[0])
                self._redraw(panel, a, b, look)
            panel.shown = shown
            self.drawn += 1
        return panel.texture

    def drop(self, slot: str) -> None:
        """Give back a slot that is not shown any more."""
        if slot in self._panels:
            with self._device.current():
                self._panels.pop(slot).release()

    def close(self) -> None:
        """Give everything back."""
        with self._device.current():
            self._release()

    # --- parts -------------------------------------------------------------------------------------------------------

    def _release(self) -> None:
        for panel in self._panels.values():
            panel.release()
        if self._texels is not None:
            self._texels.release()
        self._panels.clear()
        self._programs.release()
        self._texels = None

    def _panel(self, slot: str, size: Size) -> _Panel:
        panel = self._panels.get(slot)
        if panel is None or panel.texture.size != size:
            if panel is not None:
                panel.release()
            panel = self._panels[slot] = self._made(size, self._depth)
        return panel

    def _made(self, size: Size, depth: str) -> _Panel:
        texture = self._device.context.texture(size, 4, dtype=depth)
        texture.repeat_x = texture.repeat_y = False
        return _Panel(texture, self._device.context.framebuffer([texture]))

    def _redraw(self, panel: _Panel, a: Drawable | None, b: Drawable | None, look: Look) -> None:
        size, framebuffer = panel.texture.size, panel.framebuffer
        framebuffer.viewport = (0, 0, *size)
        framebuffer.use()
        framebuffer.clear(*look.surround, 1.0)
        covered = _covered(size, [item for item in (a, b) if item is not None], look)
        if a is None or covered is None:
            return
        plain = look.meaning != "image" or look.channels in ("alpha", "false color")
        view = None if plain else Seen(look.view, look.display, look.look)
        texels = _enlarged(size, a, covered, look) if view is not None and b is None else None
        if view is not None and texels is not None:
            self._look_through(view, a, texels, look)
            program = self._programs.get(None, look.color, viewed=True)
            program.set("viewed_first", texels[:2])
            program.set("viewed", 1)
        else:
            program = self._programs.get(view, look.color, "off" if b is None else look.compare)
        framebuffer.viewport = covered
        framebuffer.use()
        self._place(program, "a", 0, a, size, look)
        if b is not None:
            self._place(program, "b", 1, b, size, look)
        elif self._texels is not None:
            self._texels.texture.use(1)
        _settings(program, size, a.full_size, look)
        program.draw()

    def _look_through(self, view: Seen, a: Drawable, texels: Rect, look: Look) -> None:
        """Bring texels of a picture through a view."""
        x, y, width, height = texels
        if self._texels is None or self._texels.texture.width < width or self._texels.texture.height < height:
            if self._texels is not None:
                self._texels.release()
            self._texels = self._made((width, height), "f4")
        self._texels.framebuffer.viewport = (0, 0, width, height)
        self._texels.framebuffer.use()
        a.texture.use(0)
        program = self._programs.get(view, look.color, texels=True)
        program.set("a", 0)
        program.set("a_channels", a.channels)
        program.set("a_part", (*a.start, *a.size))
        program.set("viewed_first", (x, y))
        _settings(program, (1, 1), a.full_size, look)
        program.draw()

    def _place(self, program: ViewProgram, name: str, unit: int, item: Drawable, panel: Size, look: Look) -> None:
        item.texture.use(unit)
        size = item.size
        program.set(name, unit)
        program.set(f"{name}_part", (*item.start, *size))
        program.set(f"{name}_origin", origin(look, panel, item.full_size))
        program.set(f"{name}_step", tuple(size[axis] / (item.full_size[axis] * look.zoom) for axis in (0, 1)))
        program.set(f"{name}_channels", item.channels)


def _enlarged(panel: Size, item: Drawable, covered: Rect, look: Look) -> Rect | None:
    """The texels that cover these pixels of a panel, if they are clearly fewer."""
    found: list[tuple[int, int]] = []
    for axis, corner in enumerate(origin(look, panel, item.full_size)):
        step = item.size[axis] / (item.full_size[axis] * look.zoom)
        first, last = ((covered[axis] - corner) * step, (covered[axis] + covered[axis + 2] - corner) * step)
        low, high = max(0, math.floor(first) - 1), min(item.size[axis], math.ceil(last) + 1)
        if step > ENLARGED:
            return None
        found.append((low, max(1, high - low)))
    (x, width), (y, height) = found
    return x, y, width, height


def _covered(panel: Size, items: list[Drawable], look: Look) -> Rect | None:
    """The pixels of the panel where there is any picture, as x, y, width, height."""
    corners = [(origin(look, panel, item.full_size), item.full_size) for item in items]
    low = [max(0, min((math.floor(corner[axis]) for corner, _ in corners), default=0)) for axis in (0, 1)]
    high = [
        min(panel[axis], max((math.ceil(corner[axis] + size[axis] * look.zoom) for corner, size in corners), default=0))
        for axis in (0, 1)
    ]
    width, height = high[0] - low[0], high[1] - low[1]
    return (low[0], low[1], width, height) if min(width, height) > 0 else None


def _mark(item: Drawable | None) -> object:
    return item and (item.key, item.texture.glo, item.start, item.size, item.full_size, item.channels)


def _settings(program: ViewProgram, panel: Size, picture: Size, look: Look) -> None:
    left, top = origin(look, panel, picture)
    angle = math.radians(look.angle)
    found: dict[str, object] = {
        "meaning": get_args(Meaning).index(look.meaning),
        "channels": get_args(Channels).index(look.channels),
        "exposure": 2.0**look.exposure,
        "gamma": look.gamma,
        "range": (look.low, look.high if look.high != look.low else look.low + 1e-6),
        "wipe_point": _on_panel(look, (left, top), (look.wipe[0] * picture[0], look.wipe[1] * picture[1])),
        "wipe_normal": (math.cos(angle), math.sin(angle)),
        "checker": look.checker,
        "clipping": look.clipping,
        "nonfinite": look.nonfinite,
        "background": look.background,
        "surround": look.surround,
    }
    x, y, width, height = look.region or (-1e9, -1e9, 2e9, 2e9)
    found["region"] = (*_on_panel(look, (left, top), (x, y)), *_on_panel(look, (left, top), (x + width, y + height)))
    for name, value in found.items():
        program.set(name, value)


def _on_panel(look: Look, corner: Point, point: Point) -> Point:
    return corner[0] + point[0] * look.zoom, corner[1] + point[1] * look.zoom
