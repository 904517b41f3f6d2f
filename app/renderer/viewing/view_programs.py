"""The viewer's shaders: one program for every view and way to draw, compiled when it is first used."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import cast, get_args

from msgspec import Struct

from ...color.gpu_programs import write_view_program
from ...color.management import ColorManager
from ...color.primaries import find_working_space
from ...compiler import Library, load_library
from ...errors import DeviceError
from ...resources.color_program import ColorProgram
from ..device import Bindings, Device, DeviceProgram, DeviceResource, DeviceTexture, PixelRect
from .look import Channels, Compare, Meaning

_FIRST_TABLE = 2
"""The texture unit of a view's first table; pictures are bound to those before."""


class ColorView(Struct, frozen=True):
    """A view of OpenColorIO: see `Look`."""

    view: str
    display: str
    look: str


class ViewProgram(Struct, eq=False):
    """A compiled program, and the tables that its view reads by texture unit."""

    device: Device
    handle: DeviceProgram
    tables: Mapping[int, DeviceResource]

    def set(self, name: str, value: object) -> None:
        """Set a uniform, unless the driver found it unused."""
        self.handle.set(name, value)

    def draw(self, target: DeviceTexture, textures: Sequence[DeviceTexture], viewport: PixelRect) -> None:
        """Draw over a part of `target`; `textures` are bound in order."""
        self.device.draw(self.handle, [target], Bindings(textures, self.tables), viewport=viewport)

    def release(self) -> None:
        """Give it back to the driver."""
        for resource in (*self.tables.values(), self.handle):
            resource.release()


class ViewPrograms:
    """Views and ways to draw are programs of their own: a branch around one would cost as much as the view."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._programs: dict[object, ViewProgram] = {}

    def get(
        self,
        view: ColorView | None,
        manager: ColorManager,
        compare: Compare = "off",
        *,
        texels: bool = False,
        viewed: bool = False,
    ) -> ViewProgram:
        """The program for a view, or for data, of pictures whose colors are managed that way.

        With `texels` it brings the texels of a picture through the view; with `viewed` it draws what that one made.
        Raises UsageError for an unknown view; GraphError, UsageError without a config.
        """
        key = (view, manager, compare, texels, viewed)
        if key not in self._programs:
            text = write_view_program(view.view, view.display, view.look, manager) if view else None
            library = load_library().with_working_space(find_working_space(manager))
            self._programs[key] = self._compile(text, _write_source(text, library, compare, texels, viewed))
        return self._programs[key]

    def release(self) -> None:
        """Give everything back to the driver."""
        for program in self._programs.values():
            program.release()
        self._programs.clear()

    def _compile(self, view: ColorProgram | None, source: str) -> ViewProgram:
        try:
            handle = self._device.create_program(source)
        except DeviceError as fault:
            raise DeviceError(f"the viewer's shader does not compile: {fault}") from None
        tables = dict(enumerate(view.tables if view else (), _FIRST_TABLE))
        for unit, table in tables.items():
            handle.set(table.sampler, unit)
        resources = {unit: self._device.create_table(table) for unit, table in tables.items()}
        return ViewProgram(self._device, handle, resources)


def _write_source(view: ColorProgram | None, library: Library, compare: Compare, texels: bool, viewed: bool) -> str:
    """The whole fragment shader; modes are numbers by name."""
    names = {f"COMPARE_{mode}": number for number, mode in enumerate(cast("tuple[str, ...]", get_args(Compare)))}
    names |= {mode: number for number, mode in enumerate(cast("tuple[str, ...]", get_args(Channels)))}
    names |= {mode: number for number, mode in enumerate(cast("tuple[str, ...]", get_args(Meaning)))}
    names |= {"DATA": view is None and not viewed, "VIEWED": viewed}
    defines = [f"#define {name.replace(' ', '_').upper()} {number:d}" for name, number in names.items()]
    return "\n".join(
        [
            "#version 410 core",
            *defines,
            f"#define COMPARE COMPARE_{compare.upper()}",
            view.text.body if view else "",
            *(text.body for text in library.closure((f"viewer/{'texels' if texels else 'display'}",), "viewer")),
        ]
    )
