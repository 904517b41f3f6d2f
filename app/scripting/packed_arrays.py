"""Arrays of floats as JSON: what a render server and its clients send each other.

Their bytes are most of a line, so msgspec writes and reads them, as base64, in a tenth of the time of `json`.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import msgspec

from ..errors import UsageError
from ..resources.typed_data import convert_data, decode_data

if TYPE_CHECKING:
    import numpy as np

    from .array_file import ArrayFile


class _PackedArray(msgspec.Struct):
    """The `pixels` themselves, or where they begin in the file that the request has named."""

    shape: tuple[int, ...]
    type: str
    pixels: bytes = b""
    offset: int | None = None


class _PictureReply(msgspec.Struct):
    pictures: dict[str, _PackedArray]


def pack_array(array: np.ndarray) -> dict[str, Any]:
    """What `write_message` takes for an array of floats: its shape, its type, and its bytes."""
    import numpy as np

    contiguous = np.ascontiguousarray(array)
    return {"shape": list(contiguous.shape), "type": contiguous.dtype.name, "pixels": contiguous.tobytes()}


def write_message(message: Mapping[str, Any]) -> bytes:
    """A message as one line of JSON, with the bytes in it as base64."""
    if "pictures" in message or any(isinstance(item, dict) for item in message.get("input", {}).values()):
        try:
            return msgspec.json.encode(message) + b"\n"
        except UnicodeEncodeError:  # a name that is not UTF-8
            message = msgspec.to_builtins(message)
    return json.dumps(message, ensure_ascii=False).encode("utf-8", "surrogateescape") + b"\n"


def read_pictures(line: bytes, array_file: ArrayFile | None = None) -> dict[str, np.ndarray] | None:
    """The arrays in a line with the pictures of a render, by the name of the output; None for another line.

    `array_file` is where their pixels are, if they are not in the line.
    """
    try:
        reply = decode_data(line, _PictureReply)
    except (msgspec.DecodeError, UnicodeDecodeError):
        return None
    return {name: _make_array(packed, array_file) for name, packed in reply.pictures.items()}


def unpack_array(name: str, packed: Mapping[str, Any], array_file: ArrayFile | None = None) -> np.ndarray:
    """The array in a part of a message that was read from JSON. Raises UsageError."""
    try:
        return _make_array(convert_data(packed, _PackedArray), array_file)
    except ValueError as fault:
        raise UsageError(
            f"input '{name}': this is not an array ({fault}): write shape, type (float16 or float32) and pixels as "
            "base64, or the path of a file"
        ) from None


def _make_array(packed: _PackedArray, array_file: ArrayFile | None) -> np.ndarray:
    """The array with these bytes. Raises ValueError."""
    import numpy as np

    if packed.type not in ("float16", "float32"):
        raise ValueError(f"type {packed.type}")
    if packed.offset is None:
        return np.frombuffer(packed.pixels, packed.type).reshape(packed.shape)
    if array_file is None:
        raise ValueError("the request names no file with pixels")
    return array_file.read_array(packed.type, packed.shape, packed.offset)
