"""Videos made for tests with PyAV alone: every frame carries its number as dark and bright bars."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

BITS = 10
SIZE = (80, 32)
_DARK, _BRIGHT = 30, 220


def bars(number: int, size: tuple[int, int] = SIZE) -> np.ndarray:
    """A picture [h, w, 3] of uint8 whose columns are the bits of a number, the lowest first."""
    picture = np.full((size[1], size[0], 3), 90, np.uint8)
    width = size[0] // BITS
    for bit in range(BITS):
        picture[6:-6, bit * width : (bit + 1) * width] = _BRIGHT if number >> bit & 1 else _DARK
    return picture


def number_in(picture: np.ndarray) -> int:
    """The number in a picture [h, w, c] of any range."""
    gray = picture[..., :3].astype(np.float64).mean(axis=2)
    middle = gray[picture.shape[0] // 2 - 2 : picture.shape[0] // 2 + 2]
    width = picture.shape[1] // BITS
    level = gray[:4].mean()
    return sum(1 << bit for bit in range(BITS) if middle[:, bit * width + 2 : (bit + 1) * width - 2].mean() > level)


def write_frames(
    path: Path,
    frames: Sequence[Any],
    codec: str,
    *,
    options: Mapping[str, str] | None = None,
    container: Mapping[str, str] | None = None,
    times: Sequence[int] | None = None,
    rate: int = 24,
    rotation: int = 0,
    tags: Mapping[str, str] | None = None,
    color: Mapping[str, int] | None = None,
) -> Path:
    """Encode PyAV frames as they are; `times` are in milliseconds."""
    import av

    with av.open(str(path), "w", options=dict(container or {})) as file:
        stream = file.add_stream(codec, rate=rate)
        assert isinstance(stream, av.VideoStream)
        stream.width, stream.height, stream.pix_fmt = frames[0].width, frames[0].height, frames[0].format.name
        stream.options = dict(options or {})
        stream.metadata.update(tags or {})
        if rotation:
            stream.set_display_rotation(rotation)
        for name, number in (color or {}).items():
            setattr(stream.codec_context, name, number)
        if times is not None:
            stream.time_base = stream.codec_context.time_base = Fraction(1, 1000)
        for at, frame in enumerate(frames):
            frame.pts = at if times is None else times[at]
            frame.time_base = Fraction(1, rate if times is None else 1000)
            for name, number in (color or {}).items():
                setattr(frame, name, number)
            for packet in stream.encode(frame):
                file.mux(packet)
        for packet in stream.encode():
            file.mux(packet)
    return path


def write_numbers(path: Path, codec: str, pixels: str, count: int, **rest: Any) -> Path:
    """A video whose frame n shows the number n."""
    import av

    shown = (av.VideoFrame.from_ndarray(bars(number), "rgb24") for number in range(1, count + 1))
    return write_frames(path, [frame.reformat(format=pixels) for frame in shown], codec, **rest)


def decode_frames(path: Path) -> list[np.ndarray]:
    """All frames as PyAV decodes them from the first on, [h, w, 3] of uint8."""
    import av

    with av.open(str(path)) as file:
        return [frame.to_ndarray(format="rgb24") for frame in file.decode(video=0)]
