"""Tables of color programs as textures."""

from __future__ import annotations

import moderngl
import numpy as np

from ...resources.color_program import LookupTable

MAX_TABLES = 64


def table_texture(context: moderngl.Context, table: LookupTable) -> moderngl.Texture | moderngl.Texture3D:
    """A table on the device, clamped at its edges."""
    values = np.ascontiguousarray(table.values, np.float32)
    *depth, height, width, channels = values.shape
    if depth:
        made = context.texture3d((width, height, depth[0]), channels, values, dtype="f4")
        made.repeat_z = False
    else:
        made = context.texture((width, height), channels, values, dtype="f4")
    made.repeat_x = made.repeat_y = False
    way = moderngl.LINEAR if table.linear else moderngl.NEAREST
    made.filter = (way, way)
    return made


class Tables:
    """The tables of passes, each uploaded once."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._known: dict[LookupTable, moderngl.Texture | moderngl.Texture3D] = {}

    def use(self, table: LookupTable, unit: int) -> None:
        """Bind a table to a texture unit."""
        known = self._known.pop(table, None)
        if known is None:
            if len(self._known) >= MAX_TABLES:
                self._known.pop(next(iter(self._known))).release()
            known = table_texture(self._context, table)
        self._known[table] = known
        known.use(unit)

    def clear(self) -> None:
        """Give everything back to the driver."""
        for texture in self._known.values():
            texture.release()
        self._known.clear()
