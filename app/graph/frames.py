"""Frames as text: lists of frames (`1-24x2,40`), and file names with a frame number (`shot.####.exr`).

The last part of a path can have the number in three notations:

    shot.####.exr   as many digits as there are # (as in Nuke and Blender); shot.#.exr has no padding
    shot.%04d.exr   as printf; shot.%d.exr has no padding
    shot.$F4.exr    as Houdini; shot.$F.exr has no padding

A video (`shot.mov`) holds all its frames in one file.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Sequence
from functools import cached_property
from itertools import chain

from msgspec import Struct

from ..errors import UsageError

MOST_FRAMES = 1_000_000
"""Frames of one list: eleven hours at 24 frames per second. More are taken for a typing error."""
_DIGITS = 9
"""Digits of a frame number: all of them then fit into 32 bits."""
_MAX_PADDING = 16
"""Digits in the name of a file. Chosen by judgement: renderers write 4 to 8."""
_SHOWN_CHARACTERS = 40
"""How much of a wrong text a message repeats."""
_EXAMPLE = "such as 1-24, 1-24x2 or 1-12,40"

VIDEO_ENDINGS = frozenset(
    {
        ".mp4",
        ".m4v",
        ".mov",
        ".mkv",
        ".webm",
        ".avi",
        ".mxf",
        ".mpg",
        ".mpeg",
        ".m2v",
        ".ts",
        ".mts",
        ".m2ts",
        ".wmv",
        ".flv",
        ".ogv",
        ".3gp",
        ".y4m",
        ".dv",
    }
)
"""File name extensions of videos."""

_RANGE = r"(-?[0-9]+)\s*(?:-\s*(-?[0-9]+)\s*(?:[xX]\s*([0-9]+))?)?"
_PLACE = r"(?P<hashes>#+)|%(?:0(?P<printf>[1-9][0-9]*))?d|\$F(?![A-Za-z_])(?P<houdini>[0-9]*)"
_BLANK_PADDED = r"%([1-9][0-9]*)d"
"""Compiled when first used: most graphs have no frame numbers, and `halation check` counts milliseconds."""

_NUMBER = re.compile(rf"-?[0-9]{{1,{_MAX_PADDING + _DIGITS}}}")


def parse_frames(text: str) -> tuple[int, ...]:
    """The frames that a text such as `1-24`, `1-24x2,40`, `10-1` or `-5--1` lists, in its order, without repetitions.

    Raises:
        UsageError: the text is not a list of frames, or lists more than a million.
    """
    if not text.strip():
        raise UsageError(f"no frames are given: write them {_EXAMPLE}")
    spans: list[range] = []
    count = 0
    for entry in text.split(","):
        spans.append(_parse_entry(entry.strip(), text))
        count += len(spans[-1])
        if count > MOST_FRAMES:
            raise UsageError(f"frames '{_shorten(text)}': more than {MOST_FRAMES:,} frames: write fewer, {_EXAMPLE}")
    return tuple(dict.fromkeys(chain.from_iterable(spans)))


def list_range(first: int, last: int) -> tuple[int, ...]:
    """All frames of a range. Raises UsageError for more than a million."""
    if last - first >= MOST_FRAMES:
        raise UsageError(f"the frames {first} to {last} of the graph are more than {MOST_FRAMES:,}: name some of them")
    return tuple(range(first, last + 1))


def check_frame(frame: int) -> int:
    """The frame. Raises UsageError for a number with more digits than lists of frames may have."""
    if abs(frame) >= 10**_DIGITS:
        raise UsageError(f"frame {_shorten(str(frame))}: it has more than {_DIGITS} digits")
    return frame


def format_frames(frames: Iterable[int]) -> str:
    """The shortest text that lists these frames in this order: `1-23x2,40`; "" for no frames.

    `parse_frames` reads it back. A dynamic program over the frames finds the shortest split into runs of equal steps.
    """
    unique_frames = tuple(dict.fromkeys(frames))
    ends = _run_ends(unique_frames)
    best = {0: (0, 0, 0)}  # number of frames written -> length of the text, parts, frames before the last part
    for start, end in enumerate(ends):
        if start not in best:
            continue
        # A run may leave its last frame to the next one. Single frames are never shorter than a run of five.
        stops = {end, end + 1} if end - start > 3 else {start + 1, end, end + 1}
        for stop in stops - {start}:
            length = best[start][0] + 1 + len(_format_run(unique_frames, start, stop))
            route = (length, best[start][1] + 1, start)
            best[stop] = min(best.get(stop, route), route)
    parts: list[str] = []
    stop = len(unique_frames)
    while stop:
        start = best[stop][2]
        parts.append(_format_run(unique_frames, start, stop))
        stop = start
    return ",".join(reversed(parts))


class Pattern(Struct, frozen=True, dict=True):
    """A file name with one or more places for the frame number: `Pattern.parse("shot.####.exr")`.

    `folder` ends with its separator, `pieces` are the texts around the numbers, and `widths` the minimum widths of
    the numbers.
    """

    text: str
    folder: str
    pieces: tuple[str, ...]
    widths: tuple[int, ...]

    @staticmethod
    def parse(text: str) -> Pattern | None:
        """The pattern of a path, or None for a path without a number. Raises UsageError if the number is too wide."""
        name = _file_name(text)
        places = list(re.finditer(_PLACE, name))
        if not places:
            return None
        edges = [0, *chain.from_iterable(place.span() for place in places), len(name)]
        pieces = tuple(name[start:stop] for start, stop in zip(edges[::2], edges[1::2], strict=True))
        widths = tuple(_count_padding_digits(place, text) for place in places)
        return Pattern(text, text[: len(text) - len(name)], pieces, widths)

    def name(self, frame: int) -> str:
        """The path of a frame. The sign of a negative frame counts as a digit, as in printf and Nuke: -005."""
        return self.folder + self._insert_numbers(f"{frame:0{width}d}" for width in self.widths)

    def frame(self, name: str) -> int | None:
        """The frame number in a file name that matches the pattern, in any folder; else None.

        A number may be wider than the padding only without leading zeros. Blender's -0005 is read as well as -005.
        """
        file_name = os.path.normcase(_file_name(name))
        if not file_name.startswith(self._normalized_pieces[0]) or not file_name.endswith(self._normalized_pieces[-1]):
            return None
        digits = _NUMBER.match(file_name, len(self._normalized_pieces[0]))
        while digits is not None:
            frame = int(digits[0])
            if abs(frame) < 10**_DIGITS and file_name in self._spellings(frame):
                return frame
            digits = _NUMBER.fullmatch(file_name, digits.start(), digits.end() - 1)
        return None

    @cached_property
    def _normalized_pieces(self) -> tuple[str, ...]:
        """The pieces as this system compares file names: Windows ignores letter case."""
        return tuple(map(os.path.normcase, self.pieces))

    def _spellings(self, frame: int) -> tuple[str, ...]:
        usual = os.path.normcase(self._insert_numbers(f"{frame:0{width}d}" for width in self.widths))
        if frame >= 0:
            return (usual,)
        return usual, os.path.normcase(self._insert_numbers(f"-{-frame:0{width}d}" for width in self.widths))

    def _insert_numbers(self, numbers: Iterable[str]) -> str:
        rest = (number + piece for number, piece in zip(numbers, self.pieces[1:], strict=True))
        return self.pieces[0] + "".join(rest)


def is_video(path: str) -> bool:
    """True if a path is that of a video, which holds all frames."""
    return os.path.splitext(path)[1].casefold() in VIDEO_ENDINGS  # noqa: PTH122 - the text may not be a valid path


def add_frame_number(path: str) -> str:
    """A path with a place for the frame number: `out.exr` gives `out.####.exr`."""
    name = _file_name(path)
    folder = path[: len(path) - len(name)]
    if re.search(_BLANK_PADDED, name):
        return folder + re.sub(_BLANK_PADDED, r"%0\1d", name)
    stem, dot, ending = name.rpartition(".")
    return f"{folder}{stem}.####.{ending}" if stem else f"{folder}{dot}{ending}.####"


def remove_frame_number(path: str) -> str:
    """A path without its place for the frame number: `out.####.exr` gives `out.exr`."""
    try:
        pattern = Pattern.parse(path)
    except UsageError:
        return path
    if pattern is None:
        return path
    before, after = pattern.pieces[0].rstrip("._-"), "".join(pattern.pieces[1:])
    return f"{pattern.folder}{before}{after}"


def check_numbered(path: str, frames: Sequence[int]) -> None:
    """Raise UsageError if several frames would be written to one file that is not a video."""
    if is_video(path):
        if Pattern.parse(path) is not None:
            raise UsageError(f"{path}: a video holds all frames: remove the frame number from its name")
    elif len(frames) > 1 and Pattern.parse(path) is None:
        raise UsageError(f"{path}: {len(frames)} frames cannot go into one file: write -o {add_frame_number(path)}")


def _file_name(path: str) -> str:
    """The part after the last separator; may be empty."""
    return os.path.basename(path)  # noqa: PTH119 - Path ignores a separator at the end


def _parse_entry(entry: str, text: str) -> range:
    """One entry of a list of frames."""
    subject = f"frames '{_shorten(text)}'"
    if not entry:
        raise UsageError(f"{subject}: a frame is missing before or after a comma: write them {_EXAMPLE}")
    parts = re.fullmatch(_RANGE, entry)
    if parts is None:
        raise UsageError(f"{subject}: '{_shorten(entry)}' is not a frame or a range: write them {_EXAMPLE}")
    for number in filter(None, parts.groups()):
        if len(number.lstrip("-").lstrip("0")) > _DIGITS:
            raise UsageError(f"{subject}: '{_shorten(number)}' has more than {_DIGITS} digits: write them {_EXAMPLE}")
    first = int(parts[1])
    last = int(parts[2]) if parts[2] else first
    step = int(parts[3]) if parts[3] else 1
    if not step:
        raise UsageError(f"{subject}: the step cannot be 0: write 1-24x2 for every second frame")
    return range(first, last + 1, step) if first <= last else range(first, last - 1, -step)


def _shorten(text: str) -> str:
    return text if len(text) <= _SHOWN_CHARACTERS else f"{text[: _SHOWN_CHARACTERS - 3]}..."


def _run_ends(frames: Sequence[int]) -> list[int]:
    """For each frame, the index where the run of equal steps that starts there ends."""
    ends = list(range(len(frames)))
    for index in range(len(frames) - 2, -1, -1):
        after = index + 1
        follows = ends[after] > after and frames[after + 1] - frames[after] == frames[after] - frames[index]
        ends[index] = ends[after] if follows else after
    return ends


def _format_run(frames: Sequence[int], start: int, stop: int) -> str:
    """The text for a run of equal steps."""
    first, last = frames[start], frames[stop - 1]
    if stop - start == 1:
        return str(first)
    step = abs(frames[start + 1] - first)
    return f"{first}-{last}" if step == 1 else f"{first}-{last}x{step}"


def _count_padding_digits(place: re.Match[str], text: str) -> int:
    if place["hashes"]:
        width = len(place["hashes"])
    else:
        digits = (place["printf"] or place["houdini"] or "1").lstrip("0")
        width = int(digits or "1") if len(digits) < 4 else 10**4
    if width > _MAX_PADDING:
        raise UsageError(
            f"{_shorten(text)}: more than {_MAX_PADDING} digits for a frame: write fewer, such as shot.####.exr"
        )
    return width
