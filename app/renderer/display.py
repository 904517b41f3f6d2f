"""Draws results for the screen: placed on a panel, through a view, with what helps to judge them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, cast, get_args

import moderngl
import numpy as np

from ..compiler import installed
from ..errors import DeviceError
from ..media import GpuView, gpu_view
from .device import Device
from .look import Channels, Look, Meaning, Point, Size, origin
from .programs import VERTEX, undisturbed


class Drawable(Protocol):
    """A result that can be drawn. `key` changes whenever its pixels do; `full_size` is its size at scale 1."""

    @property
    def texture(self) -> moderngl.Texture: ...
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


@dataclass(eq=False)
class _Program:
    """A compiled program, and the tables that its view reads."""

    handle: moderngl.Program
    vertices: moderngl.VertexArray
    luts: tuple[moderngl.Texture | moderngl.Texture3D, ...]

    def set(self, name: str, value: object) -> None:
        if name in self.handle:
            self.handle[name] = value


class Display:
    """One texture for every slot, drawn only when something changed.

    `depth` is the format of what is drawn: `f1` for a screen, `f4` for measurements.
    """

    def __init__(self, device: Device, depth: str = "f1") -> None:
        self._device, self._depth = device, depth
        self._panels: dict[str, _Panel] = {}
        self._programs: dict[tuple[tuple[str, str] | None, str], _Program] = {}
        self.drawn = 0
        """How often something had to be drawn."""

    def draw(
        self, slot: str, size: Size, a: Drawable | None, b: Drawable | None = None, look: Look | None = None
    ) -> moderngl.Texture:
        """What a panel of `size` pixels shows, row 0 on top, opaque: the same texture while a slot keeps its size.

        Without anything to compare with, `a` is shown alone. Raises UsageError for an unknown view.
        """
        look = look or Look()
        if look.compare == "b" and b is not None:
            a = b
        if look.compare not in ("wipe", "difference"):
            b = None
        shown = ((max(1, size[0]), max(1, size[1])), _mark(a), _mark(b), look)
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
        for program in self._programs.values():
            for item in (*program.luts, program.vertices, program.handle):
                item.release()
        self._panels.clear()
        self._programs.clear()

    def _panel(self, slot: str, size: Size) -> _Panel:
        panel = self._panels.get(slot)
        if panel is None or panel.texture.size != size:
            if panel is not None:
                panel.release()
            texture = self._device.context.texture(size, 4, dtype=self._depth)
            texture.repeat_x = texture.repeat_y = False
            panel = self._panels[slot] = _Panel(texture, self._device.context.framebuffer([texture]))
        return panel

    def _redraw(self, panel: _Panel, a: Drawable | None, b: Drawable | None, look: Look) -> None:
        size, framebuffer = panel.texture.size, panel.framebuffer
        framebuffer.viewport = (0, 0, *size)
        framebuffer.use()
        framebuffer.clear(*look.surround, 1.0)
        covered = _covered(size, [item for item in (a, b) if item is not None], look)
        if a is None or covered is None:
            return
        framebuffer.viewport = covered
        program = self._program(look, "off" if b is None else look.compare)
        self._place(program, "a", 0, a, size, look)
        if b is not None:
            self._place(program, "b", 1, b, size, look)
        _settings(program, size, a.full_size, look)
        for unit, lut in enumerate(program.luts, 2):
            lut.use(unit)
        program.vertices.render(moderngl.TRIANGLES, vertices=3)

    def _place(self, program: _Program, name: str, unit: int, item: Drawable, panel: Size, look: Look) -> None:
        item.texture.use(unit)
        size = item.texture.size
        program.set(name, unit)
        program.set(f"{name}_origin", origin(look, panel, item.full_size))
        program.set(f"{name}_step", tuple(size[axis] / (item.full_size[axis] * look.zoom) for axis in (0, 1)))
        program.set(f"{name}_channels", item.channels)

    def _program(self, look: Look, compare: str) -> _Program:
        """Views are programs of their own: a branch around one would cost as much as the view."""
        plain = look.meaning != "image" or look.channels in ("alpha", "false color")
        key = (None if plain else (look.view, look.display), compare)
        if key not in self._programs:
            view = None if plain else gpu_view(look.view, look.display)
            with undisturbed():
                self._programs[key] = self._compile(view, compare)
        return self._programs[key]

    def _compile(self, view: GpuView | None, compare: str) -> _Program:
        context = self._device.context
        try:
            handle = context.program(vertex_shader=VERTEX, fragment_shader=_source(view, compare))
        except moderngl.Error as fault:
            raise DeviceError(f"the viewer's shader does not compile: {fault}") from None
        luts: list[moderngl.Texture | moderngl.Texture3D] = []
        for unit, lut in enumerate(view.luts if view else (), 2):
            values = np.ascontiguousarray(lut.values)
            shape = values.shape
            if values.ndim == 3:
                made = context.texture((shape[1], shape[0]), shape[2], values, dtype="f4")
            else:
                made = context.texture3d((shape[2], shape[1], shape[0]), shape[3], values, dtype="f4")
                made.repeat_z = False
            made.repeat_x = made.repeat_y = False
            way = moderngl.LINEAR if lut.linear else moderngl.NEAREST
            made.filter = (way, way)
            luts.append(made)
            if lut.sampler in handle:
                handle[lut.sampler] = unit
        return _Program(handle, context.vertex_array(handle, []), tuple(luts))


_MODES = ("off", "wipe", "difference")


def _covered(panel: Size, items: list[Drawable], look: Look) -> tuple[int, int, int, int] | None:
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
    return item and (item.key, item.texture.glo, item.texture.size, item.full_size, item.channels)


def _source(view: GpuView | None, compare: str) -> str:
    """The whole fragment shader; modes are numbers by name."""
    names = {f"COMPARE_{mode}": number for number, mode in enumerate(_MODES)}
    names |= {mode: number for number, mode in enumerate(cast("tuple[str, ...]", get_args(Channels)))}
    names |= {mode: number for number, mode in enumerate(cast("tuple[str, ...]", get_args(Meaning)))}
    defines = [f"#define {name.replace(' ', '_').upper()} {number}" for name, number in names.items()]
    texts = installed().closure(("viewer/display",), "viewer")
    defines += [f"#define COMPARE COMPARE_{compare.upper()}", f"#define DATA {int(view is None)}"]
    return "\n".join([
        "#version 410 core", *defines, view.text if view else "", *(text.body for text in texts),
    ])


def _settings(program: _Program, panel: Size, picture: Size, look: Look) -> None:
    left, top = origin(look, panel, picture)
    angle = math.radians(look.angle)
    found: dict[str, object] = {
        "meaning": get_args(Meaning).index(look.meaning), "channels": get_args(Channels).index(look.channels),
        "exposure": 2.0**look.exposure, "gamma": look.gamma,
        "range": (look.low, look.high if look.high != look.low else look.low + 1e-6),
        "wipe_point": _on_panel(look, (left, top), (look.wipe[0] * picture[0], look.wipe[1] * picture[1])),
        "wipe_normal": (math.cos(angle), math.sin(angle)),
        "checker": look.checker, "clipping": look.clipping, "nonfinite": look.nonfinite,
        "background": look.background, "surround": look.surround,
    }
    x, y, width, height = look.region or (-1e9, -1e9, 2e9, 2e9)
    found["region"] = (
        *_on_panel(look, (left, top), (x, y)), *_on_panel(look, (left, top), (x + width, y + height))
    )
    for name, value in found.items():
        program.set(name, value)


def _on_panel(look: Look, corner: Point, point: Point) -> Point:
    return corner[0] + point[0] * look.zoom, corner[1] + point[1] * look.zoom
