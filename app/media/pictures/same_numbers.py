"""The numbers in a file as they are stored, without any change of color: to see whether two files hold the same."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ...color.transforms import Array
from ...errors import InputError
from ...resources.sandbox import Sandbox
from .open import describe_fault, describe_picture, open_picture


def read_numbers(path: str | Path, sandbox: Sandbox) -> Mapping[str, Array]:
    """Every part by its name, [h, w, c] in the type of the file; integers are codes. Channels are in their order.

    Raises:
        InputError: the file cannot be read.
    """
    parts: dict[str, Array] = {}
    with open_picture(path, sandbox=sandbox) as handle:
        describe_picture(handle, str(path), sandbox=sandbox)
        while handle.seek_subimage(len(parts), 0):
            spec = handle.spec()
            block = handle.read_image(len(parts), 0, 0, spec.nchannels, str(spec.format))
            if block is None:
                raise InputError(f"{path}: {describe_fault(handle.geterror() or 'corrupt')}")
            name = spec.get_string_attribute("oiio:subimagename") or spec.get_string_attribute("name")
            parts[name if name and name not in parts else f"part {len(parts) + 1}" if parts else ""] = np.asarray(block)
    return parts
