"""Reads the parts of a file as they are stored, without repair and change of color, to compare and to show them.

`read_stored_parts` reads them as floats over the display window, as regression tests compare them. `read_stored_codes`
reads the very numbers of the file in their own type, to tell whether two files hold the same bits.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
from halation.nodes import Kind
from msgspec import Struct

from ...color.display import to_display
from ...color.transforms import Array, to_three_channels
from ...errors import InputError, OutputError
from ...resources.atomic_write import write_atomically
from ...resources.library_messages import quiet_libraries
from ...resources.library_names import name_for_library
from ...resources.sandbox import Sandbox
from ..metadata import read_metadata
from .open import describe_fault, describe_picture, open_picture
from .writer import write_picture

_MAKER = ("halation:renderer", "halation:driver", "halation:version")
_FLOATS = ("half", "float", "double")


class StoredPart(Struct, frozen=True):
    """One part of a file: [h, w, c] of float32 over its display window. Integers fill 0..1, alpha is as stored.

    If it `is_encoded`, it was stored as integers, which a display shows as they are.
    """

    array: Array
    channels: tuple[str, ...]
    is_encoded: bool

    @property
    def is_data(self) -> bool:
        """True for data, such as depth and normals."""
        return not self.is_encoded and not any(name.rpartition(".")[2] in ("R", "G", "B") for name in self.channels)

    @property
    def is_linear(self) -> bool:
        """True for scene-linear light."""
        return not self.is_encoded and not self.is_data

    @property
    def count_unusable(self) -> int:
        """Pixels with NaN, or with infinite color. Data may be infinite: depth is on the background."""
        wrong = np.isnan(self.array) if self.is_data else ~np.isfinite(self.array)
        return int(np.count_nonzero(np.any(wrong, axis=2)))


def read_stored_parts(path: str | Path, sandbox: Sandbox) -> dict[str, StoredPart]:
    """The parts of a file by name. Nothing is repaired or converted. Raises InputError."""
    with open_picture(path, sandbox=sandbox) as handle:
        count = sum(1 for _ in _iterate_parts(handle))
    settings = oiio.ImageSpec()
    settings.attribute("oiio:UnassociatedAlpha", 1)
    parts: dict[str, StoredPart] = {}
    with name_for_library(path) as file, quiet_libraries():
        for index in range(count):
            buffer = oiio.ImageBuf(file, index, 0, settings)
            is_read = buffer.read(index, 0, True, oiio.FLOAT)
            pixels = buffer.get_pixels(oiio.FLOAT, roi=buffer.roi_full) if is_read else None
            if pixels is None:
                raise InputError(f"{path}: {describe_fault(buffer.geterror() or 'corrupt')}")
            spec = buffer.spec()
            name = str(spec.get_string_attribute("oiio:subimagename")) or str(index or "")
            integers = str(buffer.nativespec().format) not in _FLOATS
            parts[name] = StoredPart(np.asarray(pixels), tuple(spec.channelnames), integers)
    return parts


def read_stored_codes(path: str | Path, sandbox: Sandbox) -> dict[str, Array]:
    """The parts of a file by name, [h, w, c] in the type of the file; integers are codes. Raises InputError."""
    parts: dict[str, Array] = {}
    with open_picture(path, sandbox=sandbox) as handle:
        describe_picture(handle, str(path), sandbox=sandbox)
        for index, spec in enumerate(_iterate_parts(handle)):
            block = handle.read_image(index, 0, 0, spec.nchannels, str(spec.format))
            if block is None:
                raise InputError(f"{path}: {describe_fault(handle.geterror() or 'corrupt')}")
            name = spec.get_string_attribute("oiio:subimagename") or spec.get_string_attribute("name")
            parts[name if name and name not in parts else f"part {index + 1}" if parts else ""] = np.asarray(block)
    return parts


def _iterate_parts(handle: oiio.ImageInput) -> Iterator[oiio.ImageSpec]:
    """The description of every part of a file, while the file is positioned at it."""
    index = 0
    while handle.seek_subimage(index, 0):
        yield handle.spec()
        index += 1


def describe_maker(path: str | Path, sandbox: Sandbox) -> str:
    """The renderer, driver and version that made a picture, from its header; "" if it does not say."""
    attributes = read_metadata(path, sandbox=sandbox)
    parts = [str(attributes[key]) for key in _MAKER if attributes.get(key)]
    if len(parts) > 1 and _MAKER[2] in attributes:
        parts[-1] = f"Halation {parts[-1]}"
    return ", ".join(parts)


def copy_picture(path: Path, source: Path, sandbox: Sandbox) -> None:
    """Copy a file to a path, completely or not at all; its folder is created. Raises OutputError."""

    def copy(name: str) -> None:
        shutil.copyfile(source, name)

    if reason := sandbox.find_write_fault(path):
        raise OutputError(f"{path}: {reason}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as refusal:
        raise OutputError(f"{path}: its folder cannot be made ({refusal.strerror}); choose another") from None
    write_atomically(path, copy, source.stat().st_size, sandbox=sandbox)


def encode_for_viewing(part: StoredPart, view: str = "", span: tuple[float, float] = (0.0, 1.0)) -> Array:
    """A part as [h, w, 3] of uint8: light through a view over black, data from black to white over `span`."""
    if part.is_encoded:
        return _to_codes(to_three_channels(part.array))
    if part.is_data:
        low, high = span
        finite = np.nan_to_num(part.array, nan=low, posinf=high, neginf=low)
        return _to_codes(to_three_channels((finite - low) / ((high - low) or 1.0)))
    return to_display(np.ascontiguousarray(part.array[..., :3]), view)


def encode_png(codes: Array) -> bytes:
    """[h, w, 3 or 4] of uint8, or of numbers within 0..1, as the bytes of a PNG file; a fourth channel is unchanged."""
    buffer = oiio.ImageBuf(np.ascontiguousarray(codes if codes.dtype == np.uint8 else _to_codes(codes)))
    buffer.specmod().attribute("oiio:UnassociatedAlpha", 1)
    with tempfile.TemporaryDirectory(prefix="halation-") as folder:
        path = Path(folder) / "picture.png"
        if not buffer.write(str(path), oiio.UINT8):
            raise OutputError(f"{path}: cannot be written: {buffer.geterror()}")
        return path.read_bytes()


def write_difference(path: Path, differences: Mapping[str, Array], sandbox: Sandbox) -> None:
    """Absolute differences of layers as an EXR of 32 bits. Raises OutputError."""
    write_picture(path, differences, kinds=dict.fromkeys(differences, Kind.IMAGE), precision="float", sandbox=sandbox)


def _to_codes(numbers: Array) -> Array:
    return (np.clip(np.nan_to_num(numbers, nan=0.0), 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)
