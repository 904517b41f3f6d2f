"""Which layer of a file an input reads.

An input names the layer of the file that its graph was made with. Another renderer, or another version of the same one,
calls it something else, so a name that a file does not have is looked up by its role: what Blender 5 calls `Diffuse
Color` is `DiffCol` in Blender 4.5 and `albedo` in Arnold.
"""

from __future__ import annotations

from halation.nodes import Kind

from ..errors import InputError
from ..graph import Input
from ..media.layers import ImageInfo, Layer, find_layer, has_layer
from ..resources.sandbox import Sandbox


def choose_layer(info: ImageInfo, socket: Input, sandbox: Sandbox, *, is_bound: bool = True) -> str:
    """The layer of this file that an input asks for, by name or by role.

    A picture without any layers of a render stands for a layer of color that the user bound it to; `is_bound` is False
    for an input that only follows another one to its file. Raises InputError.
    """
    if not socket.layer or has_layer(info, socket.layer):
        return socket.layer
    from ..render_layers.analysis import analyze_render
    from ..render_layers.naming import Role
    from ..render_layers.recognition import find_named_role

    analysis, role = analyze_render(info.path, sandbox=sandbox), find_named_role(socket.layer)
    if role and (layer := analysis.find_layer(role)):
        return layer.full_name
    if role and role in analysis.rivals:
        names = " or ".join(layer.full_name for layer in analysis.rivals[role])
        raise InputError(f"{info.path}: '{socket.layer}' may mean {names}: write one of them")
    is_plain = all(item.role in (None, Role.BEAUTY) for item in analysis.passes)
    if socket.kind is Kind.IMAGE and (role is Role.BEAUTY or (is_bound and is_plain)):
        return find_layer(info, "").name
    return socket.layer


def find_input_layer(info: ImageInfo, name: str, sandbox: Sandbox) -> Layer:
    """The layer that a user names, as `find_layer`; the error suggests the layer of that role."""

    def suggest(unknown: str) -> list[str]:
        from ..render_layers.analysis import analyze_render
        from ..render_layers.recognition import suggest_by_role

        return suggest_by_role(analyze_render(info.path, sandbox=sandbox).passes, unknown)

    return find_layer(info, name, suggest)
