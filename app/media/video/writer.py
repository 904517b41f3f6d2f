"""A video that is written frame by frame, and is there when it is whole or not at all."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import ExitStack
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from ....nodes import Size
from ...errors import OutputError
from ..color import to_display
from ..store import unfinished
from .codecs import Codec
from .library import library
from .signals import Array, from_rgb, scales

_BT709, _SRGB, _RGB, _UNKNOWN_MATRIX = 1, 13, 0, 2
_LIMITED, _FULL = 1, 2
_NTSC = 1001


class VideoFile:
    """Takes pictures one after the other. Until `close`, and after `abort`, an older file is as it was.

    Pictures are encoded for the eye as PNG files are, and tagged so: BT.709 primaries, the curve of sRGB, and where
    there is chroma the BT.709 matrix and the limited range. What has no transparency shows pictures over black.
    """

    def __init__(
        self, path: str | Path, size: Size, rate: float | Fraction, codec: Codec, *, view: str = "", deep: bool = False,
        tags: Mapping[str, str] | None = None,
    ) -> None:
        """Open it. Raises OutputError where it cannot be written."""
        self.path, self._size, self._codec, self._view = Path(path), size, codec, view
        self._format, self._rate, self._count = codec.pixels[deep], exact_rate(rate), 0
        self._open = ExitStack()
        self._av = library()
        part, self._target = self._open.enter_context(unfinished(path))
        self._part = part
        try:
            self._container, self._stream = self._opened(part, dict(tags or {}))
        except BaseException:
            self.abort()
            raise

    def add(self, picture: Array) -> None:
        """Write one more frame, [h, w, 3 or 4] of the working space. Raises OutputError."""
        frame = self._frame(picture)
        frame.pts, frame.time_base = self._count, 1 / self._rate
        self._count += 1
        self._put(frame)

    def close(self) -> None:
        """Finish it and give it its name. Raises OutputError; the file is not there then."""
        try:
            self._put(None)
            self._try(self._container.close)
            self._part.replace(self._target)
        except OSError as error:
            raise OutputError(f"{self.path}: cannot be written: {error.strerror or error}") from error
        finally:
            self.abort()

    def abort(self) -> None:
        """Leave nothing behind, unless it was closed."""
        self._open.close()

    # --- parts -------------------------------------------------------------------------------------------------------

    def _opened(self, part: Path, tags: dict[str, str]) -> tuple[Any, Any]:
        options = {"fflags": "+bitexact"}
        if part.suffix.casefold() in (".mp4", ".m4v", ".mov"):
            options["movflags"] = "+faststart+use_metadata_tags+write_colr"
        container = self._try(lambda: self._av.open(str(part), "w", options=options))
        self._open.callback(lambda: self._quietly(container))
        stream = self._try(lambda: container.add_stream(self._codec.encoder, rate=self._rate))
        context = stream.codec_context
        stream.width, stream.height, stream.pix_fmt = *self._size, self._format
        stream.options = dict(self._codec.options)
        context.thread_count = 1
        context.flags |= self._av.codec.context.Flags.bitexact
        context.time_base = 1 / self._rate
        chroma = self._format.startswith("yuv")
        context.colorspace, context.color_range = (_BT709, _LIMITED) if chroma else (_RGB, _FULL)
        context.color_primaries, context.color_trc = _BT709, _SRGB
        if self._codec.tag and part.suffix.casefold() != ".mkv":
            context.codec_tag = self._codec.tag
        container.metadata.update(tags)
        return container, stream

    def _put(self, frame: Any) -> None:
        for packet in self._try(lambda: self._stream.encode(frame)):
            self._try(lambda packet=packet: self._container.mux(packet))

    def _try(self, act: Any) -> Any:
        try:
            return act()
        except (self._av.FFmpegError, MemoryError) as error:
            reason = getattr(error, "strerror", "") or str(error)
            raise OutputError(f"{self.path}: cannot be written: {reason}") from error

    def _quietly(self, container: Any) -> None:
        try:
            container.close()
        except self._av.FFmpegError:
            return

    def _frame(self, picture: Array) -> Any:
        """The planes of a picture."""
        if picture.shape[2] < 3:
            picture = picture[..., :1].repeat(3, axis=2)
        if not self._codec.alpha:
            picture = picture[..., :3]
        form = self._av.VideoFormat(self._format)
        bits = max(part.bits for part in form.components)
        if self._format.startswith("yuv"):
            planes = _chroma_planes(to_display(picture, self._view, bits=32), self._format, bits)
        else:
            planes = _rgb_planes(to_display(picture, self._view, bits=16 if bits == 16 else 8), self._format)
        frame = self._av.VideoFrame(*self._size, self._format)
        for plane, numbers in zip(frame.planes, planes, strict=True):
            rows = np.zeros((plane.height, plane.line_size // numbers.dtype.itemsize), numbers.dtype)
            rows[:, : numbers.shape[1]] = numbers
            plane.update(rows)
        return frame


def exact_rate(rate: float | Fraction) -> Fraction:
    """Frames per second as a fraction: 23.976, 29.97 and 59.94 are those of NTSC, 24000/1001 and so on."""
    if isinstance(rate, Fraction):
        return rate
    whole = round(rate * _NTSC / 1000)
    if rate != round(rate) and abs(rate * _NTSC / 1000 - whole) < 0.005:
        return Fraction(whole * 1000, _NTSC)
    return Fraction(rate).limit_denominator(100_000)


def _rgb_planes(shown: Array, format: str) -> list[Array]:
    """Red, green, blue and alpha in the order of a format."""
    height, width, channels = shown.shape
    if channels == 3:
        opaque = np.full((height, width, 1), np.iinfo(shown.dtype).max, shown.dtype)
        shown = np.concatenate([shown, opaque], axis=2)
    if format.startswith("gbr"):
        return [shown[..., index] for index in (1, 2, 0, 3)]
    order = ["rgba".index(letter) for letter in format]
    return [shown[..., order].reshape(height, width * 4)]


def _chroma_planes(shown: Array, format: str, bits: int) -> list[Array]:
    """Luma, both color differences and alpha, rounded to the limited range."""
    black, white, none, all = scales(bits, True)
    luma, blue, red = from_rgb(np.clip(shown[..., :3], 0.0, 1.0), _BT709)
    across, down = ("420" in format or "422" in format), "420" in format
    planes = [luma * white + black, *(_halved(one, across, down) * all + none for one in (blue, red))]
    if format.startswith("yuva"):
        alpha = np.clip(shown[..., 3], 0.0, 1.0) if shown.shape[2] == 4 else np.ones(shown.shape[:2], np.float32)
        planes.append(alpha * ((1 << bits) - 1))
    top = (1 << bits) - 1
    return [np.clip(plane + 0.5, 0.0, top).astype(np.uint16 if bits > 8 else np.uint8) for plane in planes]


def _halved(plane: Array, across: bool, down: bool) -> Array:
    """Chroma at half the size: over the left samples of luma, and in the middle between its rows."""
    if across:
        wide = np.pad(plane, ((0, 0), (1, 2)), mode="edge")
        count = (plane.shape[1] + 1) // 2 * 2
        plane = 0.25 * wide[:, 0:count:2] + 0.5 * wide[:, 1 : count + 1 : 2] + 0.25 * wide[:, 2 : count + 2 : 2]
    if down:
        tall = np.pad(plane, ((0, plane.shape[0] % 2), (0, 0)), mode="edge")
        plane = 0.5 * (tall[0::2] + tall[1::2])
    return plane
