"""Arrays of floats as JSON: what a render server and its clients send each other."""

from __future__ import annotations

import base64
import binascii
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ..errors import UsageError

if TYPE_CHECKING:
    import numpy as np


def pack_array(array: np.ndarray) -> dict[str, Any]:
    """An array of floats as JSON: its shape, its type, and its bytes as base64."""
    import numpy as np

    contiguous = np.ascontiguousarray(array)
    pixels = base64.b64encode(contiguous.data).decode("ascii")
    return {"shape": list(contiguous.shape), "type": contiguous.dtype.name, "pixels": pixels}


def unpack_array(name: str, packed: Mapping[str, Any]) -> np.ndarray:
    """The array in what `pack_array` made. Raises UsageError."""
    import numpy as np

    try:
        if packed["type"] not in ("float16", "float32"):
            raise ValueError(f"type {packed['type']}")
        pixels = base64.b64decode(packed["pixels"], validate=True)
        return np.frombuffer(pixels, packed["type"]).reshape([int(side) for side in packed["shape"]])
    except (KeyError, TypeError, ValueError, binascii.Error) as fault:
        raise UsageError(
            f"input '{name}': this is not an array ({fault}): write shape, type (float16 or float32) and pixels as "
            "base64, or the path of a file"
        ) from None
