"""Sequences of numbered pictures: their frames, and the file of each frame.

A path is a pattern (`shot.####.exr`), a folder with numbered pictures, a video, or one picture. An existing file whose
name looks like a pattern is one picture or video. Frames of a video count from 1. In a folder, the name with the most
frames is the sequence; of several with as many, the one whose number comes last in the name, then the first in
alphabetical order. Only this one folder is listed.
"""

from __future__ import annotations

import os
import re
import time
from bisect import bisect_left
from collections import defaultdict
from collections.abc import Iterator, Mapping
from functools import cached_property, lru_cache
from itertools import pairwise
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from halation.nodes import Missing
from msgspec import Struct

from ..errors import InputError, UsageError
from ..graph.frames import Pattern, format_frames, is_video
from ..resources.input_files import find_similar_name
from ..resources.provider import FrameFile
from ..resources.sandbox import Sandbox

if TYPE_CHECKING:
    from fractions import Fraction

_CLOCK_STEP_NS = 2_000_000_000
"""Nanoseconds: the resolution of the coarsest file system clocks. A folder that changed just now may change again with
the same time."""

_LONGEST_TEXT = 60
"""Letters of a list of frames in a message. Chosen by judgement: the sentence stays on two lines of a terminal."""

_MOST_NUMBERS = 8
"""Numbers of a name that may be the frame, the last ones first. Chosen by judgement: more than names have."""

_WIDEST = 16
"""Digits of a frame number in a name. Chosen by judgement: Nuke and Blender write four, and a frame has up to nine."""

_NUMBER = re.compile(r"(?:(?<![^._-])-)?[0-9]+")


class FrameSequence(Struct, frozen=True, dict=True):
    """The frames of a pattern that have a file. `names` are the names of the files by frame, in order.

    For a video all names are the same file, and `rate` is its frames per second.
    """

    pattern: Pattern
    names: Mapping[int, str]
    rate: Fraction | None = None

    @cached_property
    def frames(self) -> tuple[int, ...]:
        """The frames that are there, rising."""
        return tuple(self.names)

    @cached_property
    def gaps(self) -> tuple[tuple[int, int], ...]:
        """The gaps between the first and the last frame, each as its first and last missing frame."""
        return tuple((here + 1, there - 1) for here, there in pairwise(self.frames) if there - here > 1)

    @property
    def missing(self) -> int:
        """The number of missing frames."""
        return sum(last - first + 1 for first, last in self.gaps)

    @cached_property
    def frames_text(self) -> str:
        """The existing frames as text, such as `1-12,14-24`, shortened if it is too long to read."""
        return _shorten(format_frames(self.frames))

    @property
    def gaps_text(self) -> str:
        """The gaps as text, shortened likewise."""
        return _shorten(",".join(str(first) if first == last else f"{first}-{last}" for first, last in self.gaps))

    def path(self, frame: int) -> str:
        """The file of an existing frame."""
        return self.pattern.folder + self.names[frame]


def find_sequence(path: str, sandbox: Sandbox) -> FrameSequence | None:
    """The sequence or video that a path means, maybe without any frame; None for a path of one picture.

    Raises:
        InputError: a video that cannot be read, a folder without numbered pictures, or one that may not be read.
        UsageError: as `Pattern.parse`.
    """
    if _is_file(path):
        return _find_video(path, sandbox=sandbox) if is_video(path) else None
    if pattern := Pattern.parse(path):
        return _match_names(pattern, _list_folder(pattern.folder, sandbox=sandbox))
    if not _is_folder(path):
        return None
    names = _list_folder(path, sandbox=sandbox)
    groups = _rank_patterns(names)
    if not groups:
        raise InputError(f"{path}: is a folder without numbered pictures: name a picture inside it")
    best = min(groups, key=lambda text: (groups[text], text))
    pattern = Pattern.parse(str(Path(path, best)))
    return _match_names(pattern, names) if pattern else None


def find_frame_file(path: str, frame: int, missing: Missing = "error", *, sandbox: Sandbox) -> FrameFile:
    """The file that shows a frame; for a video also the number of the frame. For one picture it is always the picture.

    `hold` takes the last frame before it, or the first of all; `nearest` the closest one, of two the earlier; `black`
    returns the nearest one too, for its size.

    Raises:
        InputError: the frame is missing and nothing was to stand for it, or there is no frame at all.
        UsageError: as `Pattern.parse`.
    """
    if _is_file(path):
        return _video_frame(path, frame, missing, sandbox=sandbox) if is_video(path) else FrameFile(path)
    pattern = Pattern.parse(path)
    if pattern and _is_file(usual_name := pattern.name(frame)):
        return FrameFile(usual_name)
    sequence = find_sequence(path, sandbox=sandbox)
    if sequence is None:
        return FrameFile(path)
    check_has_files(sequence, sandbox=sandbox)
    if frame in sequence.names:
        return FrameFile(sequence.path(frame))
    if missing == "error":
        raise InputError(
            f"{sequence.pattern.name(frame)}: there is no such file, only frames {sequence.frames_text}: "
            "render it, or choose hold, nearest or black for missing frames"
        )
    after = bisect_left(sequence.frames, frame)
    near = sequence.frames[max(0, after - 1) : after + 1]
    chosen = near[0] if missing == "hold" else min(near, key=lambda there: (abs(there - frame), there))
    return FrameFile(sequence.path(chosen), missing == "black")


def _find_video(path: str, sandbox: Sandbox) -> FrameSequence:
    """A video as a sequence of frames that are all in one file."""
    from .video import read_video_info

    video = read_video_info(path, sandbox=sandbox)
    return _make_video_sequence(path, video.count, video.rate)


@lru_cache(maxsize=16)  # chosen by judgement: the videos of a graph
def _make_video_sequence(path: str, count: int, rate: Fraction) -> FrameSequence:
    name = Path(path).name
    pattern = Pattern(path, path[: len(path) - len(name)], (name,), ())
    return FrameSequence(pattern, MappingProxyType(dict.fromkeys(range(1, count + 1), name)), rate)


def _video_frame(path: str, frame: int, missing: Missing, sandbox: Sandbox) -> FrameFile:
    from .video import read_video_info

    count = read_video_info(path, sandbox=sandbox).count
    if 1 <= frame <= count:
        return FrameFile(path, number=frame)
    if missing == "error":
        raise InputError(
            f"{path}: has no frame {frame}, only 1-{count}: render fewer, or choose hold, nearest or black for missing "
            "frames"
        )
    return FrameFile(path, missing == "black", 1 if frame < 1 else count)


def check_has_files(sequence: FrameSequence, sandbox: Sandbox) -> None:
    """Raise InputError for a sequence without any file, with a similar name as a suggestion."""
    if sequence.frames:
        return
    text, folder = sequence.pattern.text, sequence.pattern.folder
    if not _is_folder(folder or "."):
        raise InputError(f"{text}: no file has such a name; its folder is missing too")
    names, sought = _list_folder(folder, sandbox=sandbox), text[len(folder) :]
    guess = find_similar_name(sought, _rank_patterns(names)) or find_similar_name(sought, names)
    hint = f"; did you mean '{guess}'?" if guess else ": check it"
    raise InputError(f"{text}: no file has such a name{hint}")


def suggest_pattern(path: str, sandbox: Sandbox) -> str | None:
    """The pattern of a picture that is part of a sequence: `shot.0012.exr` beside shot.0011.exr is `shot.####.exr`."""
    if not _is_file(path):
        return None
    name = Path(path).name
    folder = path[: len(path) - len(name)]
    try:
        groups = _rank_patterns(_list_folder(folder, sandbox=sandbox))
    except InputError:
        return None
    fitting = [
        text
        for before, number, after in _find_numbers(name)
        for width in range(1, _WIDEST + 1)
        if (text := _pattern_text(before, width, after)) in groups and groups[text][0] < -1 and _fits(number, width)
    ]
    return folder + min(fitting, key=lambda text: (groups[text], text)) if fitting else None


@lru_cache(maxsize=64)  # chosen by judgement: the sequences of a graph
def _match_names(pattern: Pattern, names: tuple[str, ...]) -> FrameSequence:
    names_by_frame: dict[int, str] = {}
    for name in names:
        frame = pattern.frame(name)
        if frame is not None and (frame not in names_by_frame or name == Path(pattern.name(frame)).name):
            names_by_frame[frame] = name
    return FrameSequence(pattern, MappingProxyType(dict(sorted(names_by_frame.items()))))


@lru_cache(maxsize=16)  # chosen by judgement: the folders of a graph
def _rank_patterns(names: tuple[str, ...]) -> Mapping[str, tuple[int, int]]:
    """The patterns that fit pictures among these files, with their rank: by count, then by the place of the number.

    Names that would mean something else as a pattern are left out.
    """
    numbers: defaultdict[tuple[str, str, int], list[str]] = defaultdict(list)
    from .pictures.file_endings import list_readable_endings  # a library that graphs without sequences do not need

    endings = list_readable_endings()
    for name in names:
        if not name.startswith(".") and Path(name).suffix.casefold() in endings:
            for place, (before, number, after) in enumerate(_find_numbers(name)):
                numbers[before, after, place].append(number)
    groups: dict[str, tuple[int, int]] = {}
    for (before, after, place), candidates in numbers.items():
        for width in _possible_widths(candidates):
            text, count = _pattern_text(before, width, after), sum(_fits(number, width) for number in candidates)
            if count and _is_read_back(text, before, after):
                groups[text] = (-count, place)
    return MappingProxyType(groups)


def _find_numbers(name: str) -> Iterator[tuple[str, str, str]]:
    """The numbers in a name without its ending, the last one first: the text before, the number, the text after."""
    stem = name.rpartition(".")[0]
    for match in list(_NUMBER.finditer(stem))[: -_MOST_NUMBERS - 1 : -1]:
        if len(match[0]) <= _WIDEST:
            yield name[: match.start()], match[0], name[match.end() :]


def _possible_widths(numbers: list[str]) -> set[int]:
    """The possible paddings of the numbers: by their leading zeros, or the common length, or none."""
    padded = {len(number) for number in numbers if number[0] == "0" and len(number) > 1}
    lengths = {len(number) for number in numbers}
    return lengths if len(lengths) == 1 else {1, *padded}


def _fits(number: str, width: int) -> bool:
    return _bare_pattern(width).frame(number) is not None


@lru_cache(maxsize=_WIDEST)
def _bare_pattern(width: int) -> Pattern:
    """The pattern of a number and nothing else."""
    return Pattern("", "", ("", ""), (width,))


def _is_file(path: str) -> bool:
    return os.path.isfile(path)  # noqa: PTH113 - Path raises where names are too long or may not be seen


def _is_folder(path: str) -> bool:
    return os.path.isdir(path)  # noqa: PTH112 - as above


def _shorten(frames: str) -> str:
    return frames if len(frames) <= _LONGEST_TEXT else f"{frames[:_LONGEST_TEXT].rpartition(',')[0]},..."


def _pattern_text(before: str, width: int, after: str) -> str:
    return f"{before}{'#' * width}{after}"


def _is_read_back(text: str, before: str, after: str) -> bool:
    try:
        pattern = Pattern.parse(text)
    except UsageError:
        return False
    return pattern is not None and pattern.pieces == (before, after)


def _list_folder(folder: str, sandbox: Sandbox) -> tuple[str, ...]:
    """The names of the files in a folder, from the cache if it has not changed; none if there is no folder."""
    place = Path(folder or ".").absolute()
    sandbox.check(place)
    try:
        written = place.stat().st_mtime_ns
        settled = time.time_ns() - written > _CLOCK_STEP_NS
        return _scan_folder(place, written) if settled else _scan_folder.__wrapped__(place, written)
    except (FileNotFoundError, NotADirectoryError, ValueError):
        return ()
    except OSError as error:
        raise InputError(f"{folder or '.'}: the folder cannot be read: {error.strerror or error}") from error


@lru_cache(maxsize=16)  # chosen by judgement: the folders of a graph
def _scan_folder(folder: Path, written: int) -> tuple[str, ...]:
    with os.scandir(folder) as entries:
        return tuple(sorted(entry.name for entry in entries if entry.is_file()))
