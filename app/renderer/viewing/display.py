"""Draws results for the screen: placed on a panel, through a view, with what helps to judge them."""

from __future__ import annotations

import math
from typing import Protocol, get_args

from msgspec import Struct

from ..device import Device, DeviceTexture, PixelRect, TextureDepth
from .look import Channels, Look, Meaning, Size, find_origin, find_panel_point
from .view_programs import ColorView, ViewProgram, ViewPrograms

_LEAST_RANGE = 1e-6
"""A range of one number is shown this wide, so that nothing is divided by 0."""

_EVERYWHERE = -1e9, -1e9, 2e9, 2e9
"""A region beyond all pictures: nothing is dimmed."""

MAX_TEXEL_DENSITY = 0.8
"""Texels per pixel, along a side, up to which a view is computed per texel: at 0.8 there are 0.64 texels for each
pixel. Chosen by judgement: the second pass must cost less than the pixels that the view is not computed for."""


class Drawable(Protocol):
    """A result that can be drawn. `key` changes whenever its pixels do; `full_size` is its size at scale 1.

    Its frame has `size` pixels as it is. The texture holds them all, a part from pixel `start` on, or also pixels
    around the frame: then it starts below 0.
    """

    @property
    def texture(self) -> DeviceTexture: ...
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


class _Slot(Struct, eq=False):
    """The texture of a slot, and everything that decides its pixels."""

    texture: DeviceTexture
    contents: object = None


class Display:
    """One texture for every slot, drawn only when something changed.

    `depth` is the format of what is drawn: `f1` for a screen, `f4` for measurements.
    """

    def __init__(self, device: Device, depth: TextureDepth = "f1") -> None:
        self._device = device
        self._depth: TextureDepth = depth
        self._slots: dict[str, _Slot] = {}
        self._programs = ViewPrograms(device)
        self._texels: DeviceTexture | None = None
        """A picture through a view, while it is drawn."""
        self.draw_count = 0
        """How often something had to be drawn."""

    def draw(
        self, slot: str, size: Size, a: Drawable | None, b: Drawable | None = None, look: Look | None = None
    ) -> DeviceTexture:
        """What a panel of `size` pixels shows, row 0 on top, opaque: the same texture while a slot keeps its size.

        Without anything to compare with, `a` is shown alone. Raises UsageError for an unknown view.
        """
        look = look or Look()
        if look.compare == "b" and b is not None:
            a = b
        if look.compare not in ("wipe", "difference"):
            b = None
        size = (max(1, size[0]), max(1, size[1]))
        contents = (size, _identify(a), _identify(b), look)
        panel = self._slots.get(slot)
        if panel is None or panel.contents != contents:
            with self._device.save_draw_target():
                panel = self._resize(slot, size)
                self._redraw(panel.texture, a, b, look)
            panel.contents = contents
            self.draw_count += 1
        return panel.texture

    def release_slot(self, slot: str) -> None:
        """Give back a slot that is not shown any more."""
        if slot in self._slots:
            with self._device.make_current():
                self._slots.pop(slot).texture.release()

    def close(self) -> None:
        """Give everything back."""
        with self._device.make_current():
            for panel in self._slots.values():
                panel.texture.release()
            if self._texels is not None:
                self._texels.release()
            self._programs.release()
        self._slots.clear()
        self._texels = None

    # --- parts -------------------------------------------------------------------------------------------------------

    def _resize(self, slot: str, size: Size) -> _Slot:
        panel = self._slots.get(slot)
        if panel is None or panel.texture.size != size:
            if panel is not None:
                panel.texture.release()
            panel = self._slots[slot] = _Slot(self._device.create_texture(size, 4, self._depth, linear=True))
        return panel

    def _redraw(self, target: DeviceTexture, a: Drawable | None, b: Drawable | None, look: Look) -> None:
        """Draw one slot, in one step or in two.

        A view, a chain of color transforms, is the expensive part. Where a picture is enlarged, several pixels of the
        panel show one texel: then the view is computed per texel into `_texels`, and a second program places those.
        """
        size = target.size
        self._device.clear(target, (*look.surround, 1.0))
        covered = _find_covered(size, [picture for picture in (a, b) if picture is not None], look)
        if a is None or covered is None:
            return
        plain = look.meaning != "image" or look.channels in ("alpha", "false color")
        view = None if plain else ColorView(look.view, look.display, look.look)
        texels = _find_enlarged(size, a, covered, look) if view is not None and b is None else None
        textures = [a.texture]
        if view is not None and texels is not None:
            textures.append(self._view_texels(view, a, texels, look))
            program = self._programs.get(None, look.manager, viewed=True)
            program.set("viewed_first", texels[:2])
            program.set("viewed", 1)
        else:
            program = self._programs.get(view, look.manager, "off" if b is None else look.compare)
        _set_placement(program, "a", 0, a, size, look)
        if b is not None:
            textures.append(b.texture)
            _set_placement(program, "b", 1, b, size, look)
        _set_look(program, size, a.full_size, look)
        program.draw(target, textures, covered)

    def _view_texels(self, view: ColorView, a: Drawable, texels: PixelRect, look: Look) -> DeviceTexture:
        """Bring texels of a picture through a view."""
        x, y, width, height = texels
        if self._texels is None or self._texels.size[0] < width or self._texels.size[1] < height:
            if self._texels is not None:
                self._texels.release()
            self._texels = self._device.create_texture((width, height), 4, "f4", linear=True)
        program = self._programs.get(view, look.manager, texels=True)
        program.set("a", 0)
        program.set("a_channels", a.channels)
        program.set("a_part", (*a.start, *a.size))
        program.set("viewed_first", (x, y))
        _set_look(program, (1, 1), a.full_size, look)
        program.draw(self._texels, [a.texture], (0, 0, width, height))
        return self._texels


def _set_placement(program: ViewProgram, name: str, unit: int, picture: Drawable, panel: Size, look: Look) -> None:
    """Set where a picture, bound to a texture unit, lies on the panel."""
    size, full_size = picture.size, picture.full_size
    program.set(name, unit)
    program.set(f"{name}_part", (*picture.start, *size))
    program.set(f"{name}_origin", find_origin(look, panel, full_size))
    program.set(f"{name}_step", tuple(size[axis] / (full_size[axis] * look.pixel_size[axis]) for axis in (0, 1)))
    program.set(f"{name}_channels", picture.channels)


def _find_enlarged(panel: Size, picture: Drawable, covered: PixelRect, look: Look) -> PixelRect | None:
    """The texels that cover these pixels of a panel, if they are clearly fewer."""
    spans: list[tuple[int, int]] = []
    for axis, corner in enumerate(find_origin(look, panel, picture.full_size)):
        step = picture.size[axis] / (picture.full_size[axis] * look.pixel_size[axis])
        first, last = ((covered[axis] - corner) * step, (covered[axis] + covered[axis + 2] - corner) * step)
        start, end = _find_span(picture, axis)
        low, high = max(start, math.floor(first) - 1), min(end, math.ceil(last) + 1)
        if step > MAX_TEXEL_DENSITY:
            return None
        spans.append((low, max(1, high - low)))
    (x, width), (y, height) = spans
    return x, y, width, height


def _find_covered(panel: Size, pictures: list[Drawable], look: Look) -> PixelRect | None:
    """The pixels of the panel where there is any picture, as x, y, width, height."""
    low, high = [panel[0], panel[1]], [0, 0]
    for picture in pictures:
        for axis, corner in enumerate(find_origin(look, panel, picture.full_size)):
            pixel = picture.full_size[axis] * look.pixel_size[axis] / picture.size[axis]
            start, end = _find_span(picture, axis)
            low[axis] = max(0, min(low[axis], math.floor(corner + start * pixel)))
            high[axis] = min(panel[axis], max(high[axis], math.ceil(corner + end * pixel)))
    width, height = high[0] - low[0], high[1] - low[1]
    return (low[0], low[1], width, height) if min(width, height) > 0 else None


def _find_span(picture: Drawable, axis: int) -> tuple[int, int]:
    """The first pixel along an axis and the one after the last, of the frame and of what is held around it."""
    start = picture.start[axis]
    return min(start, 0), max(picture.size[axis], start + picture.texture.size[axis])


def _identify(picture: Drawable | None) -> object:
    """Everything about a picture that decides how it is drawn."""
    return picture and (
        picture.key,
        picture.texture.native_handle,
        picture.start,
        picture.texture.size,
        picture.size,
        picture.full_size,
        picture.channels,
    )


def _set_look(program: ViewProgram, panel: Size, picture: Size, look: Look) -> None:
    angle = math.radians(look.angle)
    uniforms: dict[str, object] = {
        "meaning": get_args(Meaning).index(look.meaning),
        "channels": get_args(Channels).index(look.channels),
        "exposure": 2.0**look.exposure,
        "gamma": look.gamma,
        "range": (look.low, look.high if look.high != look.low else look.low + _LEAST_RANGE),
        "wipe_point": find_panel_point(look, panel, picture, (look.wipe[0] * picture[0], look.wipe[1] * picture[1])),
        "wipe_normal": (math.cos(angle), math.sin(angle)),
        "checker": look.checker,
        "clipping": look.clipping,
        "nonfinite": look.nonfinite,
        "background": look.background,
        "surround": look.surround,
    }
    x, y, width, height = look.region or _EVERYWHERE
    corners = ((x, y), (x + width, y + height))
    uniforms["region"] = tuple(part for corner in corners for part in find_panel_point(look, panel, picture, corner))
    for name, setting in uniforms.items():
        program.set(name, setting)
