"""Limits for the size of pictures: a damaged or hostile header must not end the process."""

from __future__ import annotations

import os

from halation.nodes import Size

from ..errors import InputError
from ..resources.machine import machine_memory
from ..resources.picture import MAX_SIDE

LIMIT = "HALATION_MAX_PIXELS"
"""The environment variable that sets the largest number of pixels of a picture."""

_MOST_PIXELS = 1 << 28
"""16384 x 16384: 4 GiB as RGBA in 32-bit floats. It applies if nobody sets the limit."""

_CHANNEL_BYTES = 4
"""Pixels are converted in 32-bit floats."""

_WORKING_COPIES = 3
_WORKING_CHANNELS = 4
"""Channels in memory while a picture is converted, besides those of the file: as stored, as light and as RGBA, four
channels each."""


def check_size(path: str, size: Size) -> None:
    """Refuse a picture that is larger than allowed. Raises InputError."""
    setting = os.environ.get(LIMIT, "")
    most = int(setting) if setting.isascii() and setting.isdecimal() else _MOST_PIXELS
    if not all(0 < side <= MAX_SIDE for side in size) or size[0] * size[1] > most:
        raise InputError(
            f"{path}: claims to be {size[0]}x{size[1]} pixels, more than can be read ({most:,} in all): if that is "
            f"right, set {LIMIT} to more"
        )


def check_memory(path: str, size: Size, channels: int) -> None:
    """Refuse a picture that does not fit into memory, before the system ends the process. Raises InputError."""
    available = machine_memory()
    needed = size[0] * size[1] * _CHANNEL_BYTES * (channels + _WORKING_COPIES * _WORKING_CHANNELS)
    if available < needed:
        raise InputError(
            f"{path}: {size[0]}x{size[1]} pixels of {channels} channels take {needed / 2**30:.0f} GiB, and this "
            f"machine has {available / 2**30:.0f}: make it smaller first"
        )
