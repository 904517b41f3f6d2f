"""Stores numbers of 32 bits in PNG files, which ReShade reads with 8 bits: each number is the four bytes of a pixel."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from msgspec import Struct, field

from ...media.pictures.stored import encode_png

Array = np.ndarray

PACKED_WIDTH = 1024
"""Numbers in each row of a file. A choice: a picture of 1920x1080 takes 8100 rows, and devices have 16384."""

_LONGEST = 16384
"""Rows that a texture may have in Direct3D 11 and later, and in Vulkan on desktops."""


class PackedPictures(Struct):
    """The files of an effect, named by its stem and a number, and the code that reads a number of each."""

    stem: str
    files: dict[str, bytes] = field(default_factory=dict[str, bytes])
    code: list[str] = field(default_factory=list[str])
    _names: dict[bytes, str] = field(default_factory=dict[bytes, str])

    def add(self, pixels: Array) -> str:
        """Store pixels [height, width, channels]; the name of a function that gives the four channels at a place.

        Raises ValueError if they are too many for a texture.
        """
        values = np.ascontiguousarray(pixels, np.float32)
        height, width, channels = values.shape
        key = repr(values.shape).encode() + values.tobytes()
        if key not in self._names:
            rows = -(-values.size // PACKED_WIDTH)
            if rows > _LONGEST:
                raise ValueError(f"holds {width} x {height} pixels, and a file of an effect holds 4096 x 1024")
            number = len(self._names)
            codes = np.zeros((rows, PACKED_WIDTH, 4), np.uint8)
            codes.reshape(-1)[: values.nbytes] = np.frombuffer(values.astype("<f4").tobytes(), np.uint8)
            file = f"{self.stem}_fx_{number}.png"
            self.files[file] = encode_png(codes)
            self._names[key] = f"stored_{number}"
            self.code += _write_reader(number, file, rows, (width, channels))
        return self._names[key]


def _write_reader(number: int, file: str, rows: int, size: Sequence[int]) -> list[str]:
    width, channels = size
    parts = [f"stored_{number}_at(first + {at})" if at < channels else "0.0" for at in range(3)]
    parts.append(f"stored_{number}_at(first + 3)" if channels > 3 else "1.0")
    return [
        f'texture2D Stored{number} < source = "{file}"; > '
        f"{{ Width = {PACKED_WIDTH}; Height = {rows}; Format = RGBA8; }};",
        f"sampler2D Stored{number}Sampler {{ Texture = Stored{number}; MinFilter = POINT; MagFilter = POINT; "
        "MipFilter = POINT; };",
        f"float stored_{number}_at(int at) {{ return join_bytes(FETCH(Stored{number}Sampler, "
        f"at % {PACKED_WIDTH}, at / {PACKED_WIDTH})); }}",
        f"float4 stored_{number}(int2 place) {{",
        f"    int first = (place.y * {width} + place.x) * {channels};",
        f"    return float4({', '.join(parts)});",
        "}",
    ]
