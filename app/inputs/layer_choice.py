"""Chooses the layer of a file that an input reads.

An input names the layer of the file with which its graph was made. Another renderer, or another version, may use
another name, so a missing name is looked up by its role: `Diffuse Color` of Blender 5 is `DiffCol` in Blender 4.5 and
`albedo` in Arnold.
"""

from __future__ import annotations

from halation.nodes import Kind

from ..errors import InputError
from ..graph import Input
from ..media.layers import ImageInfo, Layer, find_layer, has_layer
from ..resources.sandbox import Sandbox


def choose_layer(info: ImageInfo, socket: Input, sandbox: Sandbox, *, is_bound: bool = True) -> str:
    """The layer of this file for an input, by name or by role.

    A picture that is not a render can replace a color layer, if the user bound it; `is_bound` is False for an input
    that follows another input to its file. Raises InputError.
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
