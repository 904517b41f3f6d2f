"""The viewer's shaders: one program for every view and way to draw, compiled when it is first used."""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast, get_args

import moderngl
from halation.nodes import ColorSettings

from ...color.gpu_programs import gpu_view
from ...color.management import color_mark
from ...color.primaries import working_of
from ...compiler import Library, installed, library_for
from ...errors import DeviceError
from ...resources.color_program import ColorProgram
from ..opengl.programs import VERTEX, undisturbed
from ..opengl.tables import table_texture
from .look import Channels, Compare, Meaning

FIRST_LUT = 2
"""The texture unit of a view's first table; pictures are bound to those before."""


@dataclass(frozen=True)
class Seen:
    """A view of OpenColorIO: see `Look`."""

    view: str
    display: str
    look: str


@dataclass(eq=False)
class ViewProgram:
    """A compiled program, and the tables that its view reads."""

    handle: moderngl.Program
    vertices: moderngl.VertexArray
    luts: tuple[moderngl.Texture | moderngl.Texture3D, ...]

    def set(self, name: str, value: object) -> None:
        """Set a uniform, unless the driver found it unused."""
        if name in self.handle:
            self.handle[name] = value

    def draw(self) -> None:
        """Cover what the bound framebuffer shows."""
        for unit, lut in enumerate(self.luts, FIRST_LUT):
            lut.use(unit)
        self.vertices.render(moderngl.TRIANGLES, vertices=3)


class ViewPrograms:
    """Views and ways to draw are programs of their own: a branch around one would cost as much as the view."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._known: dict[object, ViewProgram] = {}

    def get(
        self,
        view: Seen | None,
        color: ColorSettings,
        compare: Compare = "off",
        *,
        texels: bool = False,
        viewed: bool = False,
    ) -> ViewProgram:
        """The program for a view, or for data, of pictures whose colors are managed that way.

        With `texels` it brings the texels of a picture through the view; with `viewed` it draws what that one made.
        Raises UsageError for an unknown view; GraphError, UsageError without a config.
        """
        key = (view, color, color_mark(color), compare, texels, viewed)
        if key not in self._known:
            text = gpu_view(view.view, view.display, view.look, color) if view else None
            library = library_for(installed(), working_of(color))
            with undisturbed():
                self._known[key] = self._compile(text, _source(text, library, compare, texels, viewed))
        return self._known[key]

    def release(self) -> None:
        """Give everything back to the driver."""
        for program in self._known.values():
            for item in (*program.luts, program.vertices, program.handle):
                item.release()
        self._known.clear()

    def _compile(self, view: ColorProgram | None, source: str) -> ViewProgram:
        context = self._context
        try:
            handle = context.program(vertex_shader=VERTEX, fragment_shader=source)
        except moderngl.Error as fault:
            raise DeviceError(f"the viewer's shader does not compile: {fault}") from None
        luts = [table_texture(context, table) for table in (view.tables if view else ())]
        program = ViewProgram(handle, context.vertex_array(handle, []), tuple(luts))
        for unit, table in enumerate(view.tables if view else (), FIRST_LUT):
            program.set(table.sampler, unit)
        return program


def _source(view: ColorProgram | None, library: Library, compare: Compare, texels: bool, viewed: bool) -> str:
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
