"""Which layer of a file an input reads."""

from __future__ import annotations

from halation.nodes import Kind

from ..errors import InputError
from ..graph import Input
from ..media.layers import ImageInfo, find_layer


def choose_layer(info: ImageInfo, socket: Input) -> str:
    """The layer that an input asks for, if this file has it; a plain picture stands for any layer of color."""
    if not socket.layer or socket.kind is not Kind.IMAGE:
        return socket.layer
    try:
        find_layer(info, socket.layer)
    except InputError:
        return find_layer(info, "").name
    return socket.layer
