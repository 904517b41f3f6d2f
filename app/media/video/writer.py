"""Writes a video frame by frame; the file appears when it is complete."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import ExitStack
from fractions import Fraction
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from halation.nodes import Kind, Size

from ...color.dithering import make_dither
from ...color.encoding import Encoding
from ...errors import OutputError
from ...resources.atomic_write import check_writable, replace_file
from ...resources.sandbox import Sandbox
from ..pictures.writer import choose_shown_layer
from .codecs import find_codec
from .library import load_pyav
from .signals import Array, code_ranges, rgb_to_chroma

_RGB, _UNKNOWN = 0, 2
_LIMITED, _FULL = 1, 2
_TAGS = MappingProxyType(
    {
        "srgb_rec709_scene": (1, 13),
        "srgb_p3d65_scene": (12, 13),
        "g24_rec709_scene": (1, 1),
        "g22_rec709_scene": (1, 4),
        "lin_rec709_scene": (1, 8),
        "pq_rec2020_scene": (9, 16),
        "hlg_rec2020_scene": (9, 18),
        "g24_rec2020_scene": (9, 14),
    }
)
"""Display color spaces -> primaries and transfer characteristics by the numbers of ITU-T H.273."""

_NTSC = 1001
"""NTSC rates are whole ones times 1000 / 1001, by definition."""
_RATE_ROUNDING = 0.005
"""How far a rate may be from an NTSC one: they are written with two or three decimals, 29.97 or 23.976."""
_MAX_DENOMINATOR = 100_000
"""Rates keep five decimals: the error is below a frame in an hour."""
_DITHERED_BITS = 10
"""The most bits that are dithered: with more, no eye sees steps."""


def check_video(
    path: str | Path,
    kinds: Mapping[str, Kind],
    sizes: Mapping[str, Size],
    *,
    codec: str,
    encoding: Encoding,
    sandbox: Sandbox,
) -> None:
    """Raise the errors of a `VideoWriter` before anything is rendered: UsageError, OutputError."""
    encoding.check_names()
    find_codec(path, codec, sizes[choose_shown_layer(path, kinds)])
    check_writable(path, sandbox=sandbox)


class VideoWriter:
    """Takes pictures one after the other. Until `close`, and after `abort`, an older file stays unchanged.

    Pictures are encoded as PNG files are, and tagged so: for the usual display BT.709 primaries with the curve of sRGB,
    and where there is chroma the BT.709 matrix and the limited range. Without alpha pictures are shown over black.
    `rate` is frames per second; `deep` asks for more than 8 bits where the codec can.
    """

    def __init__(
        self,
        path: str | Path,
        size: Size,
        rate: float | Fraction,
        *,
        codec: str = "",
        deep: bool = False,
        encoding: Encoding | None = None,
        metadata: Mapping[str, Any] | None = None,
        sandbox: Sandbox,
    ) -> None:
        """Open it. Raises UsageError for an impossible video, OutputError if it cannot be written."""
        self.path, self.size, self._rate = Path(path), size, to_exact_rate(rate)
        self._codec, self._encoding = find_codec(path, codec, size), encoding or Encoding()
        self._format, self._count = self._codec.pixels[deep], 0
        self._av, self._resources = load_pyav(), ExitStack()
        self._replacement = self._resources.enter_context(replace_file(path, sandbox, self.path.suffix))
        try:
            self._container, self._stream = self._open_container(_choose_tags(metadata or {}))
        except BaseException:
            self.abort()
            raise

    def add(self, layers: Mapping[str, Array], kinds: Mapping[str, Kind], frame: int = 1) -> None:
        """Write one more picture: the first one among the layers, [h, w, c]; `frame` chooses the pattern of dithering.

        Raises OutputError.
        """
        name = choose_shown_layer(self.path, kinds)
        picture = layers[name]
        height, width = picture.shape[:2]
        if (width, height) != self.size:
            here, there = f"{width}x{height}", f"{self.size[0]}x{self.size[1]}"
            raise OutputError(f"{self.path}: frame {self._count + 1} is {here}, those before it {there}: give --size")
        encoded = self._make_frame(picture, not kinds[name].is_color, frame)
        encoded.pts, encoded.time_base = self._count, 1 / self._rate
        self._count += 1
        self._encode_frame(encoded)

    def close(self) -> None:
        """Finish the file and give it its name. Raises OutputError; then there is no file."""
        try:
            self._encode_frame(None)
            self._try(self._container.close)
            self._replacement.commit()
        except OSError as error:
            raise self._replacement.explain(error) from error
        finally:
            self.abort()

    def abort(self) -> None:
        """Remove the unfinished file, unless it was closed."""
        self._resources.close()

    # --- parts -------------------------------------------------------------------------------------------------------

    def _open_container(self, tags: Mapping[str, str]) -> tuple[Any, Any]:
        options = {"fflags": "+bitexact"}
        suffix = self.path.suffix.casefold()
        if suffix in (".mp4", ".m4v", ".mov"):
            options["movflags"] = "+faststart+use_metadata_tags+write_colr"
        container = self._try(lambda: self._av.open(str(self._replacement.temporary), "w", options=options))
        self._resources.callback(lambda: self._close_quietly(container))
        stream = self._try(lambda: container.add_stream(self._codec.encoder, rate=self._rate))
        context = stream.codec_context
        stream.width, stream.height, stream.pix_fmt = *self.size, self._format
        stream.options = dict(self._codec.options)
        context.thread_count = 1
        context.flags |= self._av.codec.context.Flags.bitexact
        context.time_base = 1 / self._rate
        primaries, transfer = _TAGS.get(self._encoding.display_space, (_UNKNOWN, _UNKNOWN))
        chroma = self._format.startswith("yuv")
        context.colorspace, context.color_range = (self._matrix, _LIMITED) if chroma else (_RGB, _FULL)
        context.color_primaries, context.color_trc = primaries, transfer
        self._color = context.colorspace, context.color_range, primaries, transfer
        if self._codec.tag and suffix != ".mkv":
            context.codec_tag = self._codec.tag
        container.metadata.update(tags)
        return container, stream

    @property
    def _matrix(self) -> int:
        return 9 if _TAGS.get(self._encoding.display_space, (1, 0))[0] == 9 else 1

    def _encode_frame(self, frame: Any) -> None:
        for packet in self._try(lambda: self._stream.encode(frame)):
            self._try(lambda packet=packet: self._container.mux(packet))

    def _try(self, act: Any) -> Any:
        try:
            return act()
        except (self._av.FFmpegError, OSError, MemoryError) as error:
            raise self._replacement.explain(error) from error

    def _close_quietly(self, container: Any) -> None:
        try:
            container.close()
        except self._av.FFmpegError:
            return

    def _make_frame(self, picture: Array, is_data: bool, number: int) -> Any:
        """The planes of a picture; `number` is that of the frame."""
        if picture.shape[2] < 3:
            picture = picture[..., :1].repeat(3, axis=2)
        if not self._codec.alpha:
            picture = picture[..., :3]
        format = self._av.VideoFormat(self._format)
        bits = max(part.bits for part in format.components)
        noise_frame = number if bits <= _DITHERED_BITS and self._encoding.dithers(is_data) else None
        if self._format.startswith("yuv"):
            encoded = np.clip(self._encoding.to_encoded(picture, is_data=is_data), 0.0, 1.0)
            planes = _chroma_planes(encoded, self._matrix, self._format, bits, noise_frame)
        else:
            depth = 16 if bits == 16 else 8
            codes = self._encoding.to_codes(picture, depth, is_data=is_data, frame=number)
            planes = _rgb_planes(codes, self._format)
        frame = self._av.VideoFrame(*self.size, self._format)
        frame.colorspace, frame.color_range, frame.color_primaries, frame.color_trc = self._color
        for plane, numbers in zip(frame.planes, planes, strict=True):
            rows = np.zeros((plane.height, plane.line_size // numbers.dtype.itemsize), numbers.dtype)
            rows[:, : numbers.shape[1]] = numbers
            plane.update(rows)
        return frame


def _choose_tags(metadata: Mapping[str, Any]) -> dict[str, str]:
    """The metadata of the video: how it was made. Metadata of single frames are left out."""
    own_tags = {name: text for name, text in metadata.items() if name.startswith("halation:") and isinstance(text, str)}
    return {name: text for name, text in own_tags.items() if name != "halation:key"}


def to_exact_rate(rate: float | Fraction) -> Fraction:
    """Frames per second as a fraction: 23.976, 29.97 and 59.94 are the NTSC rates 24000/1001 and so on."""
    if isinstance(rate, Fraction):
        return rate
    whole = round(rate * _NTSC / 1000)
    if rate != round(rate) and abs(rate * _NTSC / 1000 - whole) < _RATE_ROUNDING:
        return Fraction(whole * 1000, _NTSC)
    return Fraction(rate).limit_denominator(_MAX_DENOMINATOR)


def _rgb_planes(codes: Array, format: str) -> list[Array]:
    """Red, green, blue and alpha in the order of a pixel format."""
    height, width, channels = codes.shape
    if channels == 3:
        opaque = np.full((height, width, 1), np.iinfo(codes.dtype).max, codes.dtype)
        codes = np.concatenate([codes, opaque], axis=2)
    if format.startswith("gbr"):
        return [codes[..., index] for index in (1, 2, 0, 3)]
    order = ["rgba".index(letter) for letter in format]
    return [codes[..., order].reshape(height, width * 4)]


def _chroma_planes(codes: Array, matrix: int, format: str, bits: int, noise_frame: int | None) -> list[Array]:
    """Luma, both color differences and alpha, rounded to the limited range; color is dithered for a frame."""
    black, white, none, all = code_ranges(bits, True)
    luma, blue, red = rgb_to_chroma(codes[..., :3], matrix)
    across, down = ("420" in format or "422" in format), "420" in format
    planes: list[Array] = [
        luma * white + black,
        *(_halve_chroma(difference, across, down) * all + none for difference in (blue, red)),
    ]
    if noise_frame is not None:
        for index, plane in enumerate(planes):
            height, width = plane.shape
            planes[index] = plane + make_dither(width, height, noise_frame, index)
    if format.startswith("yuva"):
        alpha = codes[..., 3] if codes.shape[2] == 4 else np.ones_like(codes[..., 0])
        planes.append(alpha * np.float32((1 << bits) - 1))
    top = (1 << bits) - 1
    return [np.clip(plane + 0.5, 0.0, top).astype(np.uint16 if bits > 8 else np.uint8) for plane in planes]


def _halve_chroma(plane: Array, across: bool, down: bool) -> Array:
    """Chroma at half the size: horizontally at the left luma samples, vertically between rows (as H.264 has it
    without other signs).

    The weights are those of a triangle over three samples, and of a box over two rows.
    """
    if across:
        wide = np.pad(plane, ((0, 0), (1, 2)), mode="edge")
        count = (plane.shape[1] + 1) // 2 * 2
        plane = 0.25 * wide[:, 0:count:2] + 0.5 * wide[:, 1 : count + 1 : 2] + 0.25 * wide[:, 2 : count + 2 : 2]
    if down:
        tall = np.pad(plane, ((0, plane.shape[0] % 2), (0, 0)), mode="edge")
        plane = 0.5 * (tall[0::2] + tall[1::2])
    return plane
