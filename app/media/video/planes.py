"""Converts a decoded frame to arrays."""

from __future__ import annotations

from typing import Any

import numpy as np
from msgspec import Struct

from ...errors import InputError
from .index import VideoInfo
from .signals import GAMUTS, Array, choose_matrix, chroma_to_rgb, code_ranges, decode_transfer, enlarge_plane

_CENTERED = ("mjpeg", "mpeg1video", "theora")
"""Codecs whose chroma samples lie in the middle between luma samples; for others they lie at the left ones, as in
MPEG-2."""

_UNPACKED = {
    "nv12": "yuv420p",
    "nv21": "yuv420p",
    "nv16": "yuv422p",
    "nv24": "yuv444p",
    "nv42": "yuv444p",
    "nv20le": "yuv422p10le",
    "p010le": "yuv420p10le",
    "p012le": "yuv420p12le",
    "p016le": "yuv420p16le",
    "p210le": "yuv422p10le",
    "p216le": "yuv422p16le",
    "p410le": "yuv444p10le",
    "p416le": "yuv444p16le",
    "yuyv422": "yuv422p",
    "uyvy422": "yuv422p",
    "yvyu422": "yuv422p",
    "y210le": "yuv422p10le",
    "pal8": "gbrap",
    "ya8": "gbrap",
    "ya16le": "gbrap16le",
    "ya16be": "gbrap16le",
}
"""Formats with several channels in one plane -> the format with the same numbers and a plane each."""


class DecodedFrame(Struct, frozen=True):
    """R'G'B' [h, w, 3] of a frame, as 8- or 16-bit integers if the file has these, else as floats; straight alpha."""

    rgb: Array
    alpha: Array | None
    transfer: int
    primaries: int

    @property
    def numbers(self) -> Array:
        """Color and alpha without any color conversion."""
        if self.alpha is None:
            return self.rgb
        same = self.rgb.dtype == self.alpha.dtype
        rgb, alpha = (self.rgb, self.alpha) if same else (_to_float(self.rgb), _to_float(self.alpha))
        return np.concatenate([rgb, alpha[..., None]], axis=2)

    @property
    def light(self) -> tuple[Array, str]:
        """Color and alpha as a picture, and the OpenColorIO name of the color space."""
        gamut = GAMUTS.get(self.primaries, "")
        if not gamut and self.transfer in (0, 2, 13):
            return self.numbers, "srgb_rec709_scene"
        light = decode_transfer(_to_float(self.rgb), self.transfer)
        if self.alpha is not None:
            light = np.concatenate([light, _to_float(self.alpha)[..., None]], axis=2)
        return light, gamut or "lin_rec709_scene"


def convert_frame(frame: Any, facts: VideoInfo) -> DecodedFrame:
    """The picture of a PyAV frame, upright. Raises InputError for an unknown matrix."""
    frame = _separate_planes(frame)
    format = frame.format
    planes = [_read_plane(frame, part) for part in format.components]
    alpha = next((plane for plane, part in zip(planes, format.components, strict=True) if part.is_alpha), None)
    colors = [plane for plane, part in zip(planes, format.components, strict=True) if not part.is_alpha]
    bits, full = format.components[0].bits, _is_full(frame, facts)
    if format.is_rgb:
        rgb = np.stack([_to_unit_range(plane, bits, False) for plane in colors], axis=2)
    elif len(colors) == 1:
        rgb = _to_unit_range(colors[0], bits, int(frame.color_range) == 1)[..., None].repeat(3, axis=2)
    else:
        rgb = _decode_chroma(frame, facts, colors, code_ranges(bits, not full))
    if alpha is not None:
        alpha = _to_unit_range(alpha, next(part.bits for part in format.components if part.is_alpha), False)
    turns = round(frame.rotation / 90) % 4
    rgb, alpha = np.rot90(rgb, turns), None if alpha is None else np.rot90(alpha, turns)
    return DecodedFrame(rgb, alpha, int(frame.color_trc), int(frame.color_primaries))


def _decode_chroma(
    frame: Any, facts: VideoInfo, colors: list[Array], scale: tuple[float, float, float, float]
) -> Array:
    black, white, none, all = (np.float32(number) for number in scale)
    height, width = colors[0].shape
    luma = (colors[0].astype(np.float32) - black) / white
    centered = facts.codec in _CENTERED
    differences: list[Array] = []
    for plane in colors[1:3]:
        across, down = max(1, round(width / plane.shape[1])), max(1, round(height / plane.shape[0]))
        chroma = (plane.astype(np.float32) - none) / all
        chroma = enlarge_plane(chroma, 0, height, down, (down - 1) / 2)
        differences.append(enlarge_plane(chroma, 1, width, across, (across - 1) / 2 if centered else 0.0))
    try:
        return chroma_to_rgb(luma, differences[0], differences[1], choose_matrix(int(frame.colorspace), facts.size))
    except InputError as error:
        raise InputError(f"{facts.path}: {error}") from None


def _is_full(frame: Any, facts: VideoInfo) -> bool:
    """True for the full range, in which 0 is black; YUV has the limited range unless it says otherwise."""
    return int(frame.color_range) == 2 or facts.pixels.startswith("yuvj")


def _to_unit_range(plane: Array, bits: int, limited: bool) -> Array:
    """Numbers of a channel as 0..1; 8 and 16 bits of the full range stay integers, and floats stay."""
    if plane.dtype.kind == "f" or (not limited and bits in (8, 16)):
        return plane
    black, white, _, _ = code_ranges(bits, limited)
    return (plane.astype(np.float32) - np.float32(black)) / np.float32(white)


def _separate_planes(frame: Any) -> Any:
    """The frame with a plane for every channel."""
    format = frame.format
    planes = [part.plane for part in format.components]
    if format.name in _UNPACKED:
        return _reformat(frame, _UNPACKED[format.name])
    if format.is_bit_stream or format.is_bayer or len(set(planes)) < len(planes):
        deep = max(part.bits for part in format.components) > 8
        alpha = any(part.is_alpha for part in format.components)
        if not format.is_rgb and not format.is_bit_stream and not format.is_bayer:
            return _reformat(frame, f"yuv{'a' if alpha else ''}444p{'16le' if deep else ''}")
        return _reformat(frame, f"gbr{'a' if alpha else ''}p{'16le' if deep else ''}")
    return frame


def _reformat(frame: Any, name: str) -> Any:
    """The same numbers in another format: neither matrix nor range changes."""
    return frame.reformat(format=name)


def _read_plane(frame: Any, part: Any) -> Array:
    """The numbers of a channel."""
    plane = frame.planes[part.plane]
    order = ">" if frame.format.is_big_endian else "<"
    dtype = np.dtype(f"{order}f4" if part.bits == 32 else f"{order}u2" if part.bits > 8 else "u1")
    rows = np.frombuffer(plane, dtype).reshape(plane.height, plane.line_size // dtype.itemsize)
    return rows[:, : plane.width].astype(dtype.newbyteorder("="), copy=False)


def _to_float(array: Array) -> Array:
    if array.dtype.kind == "f":
        return array
    return array.astype(np.float32) / np.float32(np.iinfo(array.dtype).max)
