"""Parses what the user typed after an option. Each function raises UsageError that names the option and the text."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeVar, get_args

from ..errors import GraphError, UsageError

if TYPE_CHECKING:
    from ..compiler import Form, Precision
    from ..graph import Graph, Port
    from ..resources.render_choices import Dither

_Word = TypeVar("_Word", bound=str)

_TEXTS = "-k", "--select", "--view", "--display", "--look", "--colorspace"
"""Options whose text may be empty: then they choose everything, or nothing."""


def check_words(words: Sequence[str]) -> None:
    """Raise UsageError for a word that is empty, as a variable of the shell without a value leaves it.

    A file without a name would be the current folder: `halation fmt "$FILE"` would rewrite all graphs in it.
    """
    for number, (before, word) in enumerate(zip(("", *words), words, strict=False), 1):
        option, equals, text = word.partition("=")
        if not word and before not in _TEXTS:
            place = f"what follows {before}" if before.startswith("-") else f"word {number} of the command"
        elif word.startswith("--") and equals and not text and option not in _TEXTS:
            place = f"{word}: what follows ="
        else:
            continue
        raise UsageError(f"{place} is empty: has a variable of the shell no value?")


def parse_assignments(items: Sequence[str], flag: str) -> dict[str, str]:
    """Texts by name from `name=text`, in order. Raises UsageError for other texts and for a repeated name."""
    texts: dict[str, str] = {}
    for item in items:
        name, equals, text = item.partition("=")
        if not equals or not name or not text:
            raise UsageError(f"{flag} {item}: write {flag} NAME=VALUE")
        if name in texts:
            raise UsageError(f"{flag} {item}: '{name}' is given twice")
        texts[name] = text
    return texts


def parse_inputs(items: Sequence[str] | None) -> dict[str, str]:
    """Files of `-i` by the name of the input; a file without a name has the name "". Raises UsageError."""
    files = parse_assignments([item for item in items or () if "=" in item], "-i")
    for item in items or ():
        if "=" not in item:
            if "" in files:
                raise UsageError(f"-i {item}: '{files['']}' is given already: write -i NAME=FILE for each input")
            files[""] = item
    return files


def parse_sets(items: Sequence[str] | None) -> dict[str, str]:
    """The texts of `--set` by what they set. Raises UsageError."""
    return parse_assignments(items or (), "--set")


def parse_destinations(items: Sequence[str]) -> tuple[tuple[str, Path], ...]:
    """`-o out.exr` or `-o name=out.exr` as names and files; the name of a bare path is empty."""
    files: list[tuple[str, Path]] = []
    for item in items:
        name, equals, text = item.partition("=")
        if not equals or "/" in name or "." in name:
            name, text = "", item
        elif not name or not text:
            raise UsageError(f"-o {item}: write -o FILE or -o NAME=FILE")
        files.append((name, Path(text)))
    return tuple(files)


def parse_value(text: str) -> Any:
    """A value: a number, true or false, a list of numbers with commas, or a word."""
    import json  # most commands set no values, and it takes 2 ms

    for candidate in (text, f"[{text}]"):
        try:
            return json.loads(candidate, parse_constant=_refuse_constant)
        except (ValueError, RecursionError):
            continue
    return text


def parse_memory(text: str | None) -> int:
    """The bytes of `512M` or `2G`; 0 without a text, which means no limit. Raises UsageError."""
    if text is None:
        return 0
    number, unit = (text[:-1], text[-1].upper()) if text[-1:].isalpha() else (text, "")
    try:
        nbytes = float(number) * 1024 ** " KMGT".index(unit or " ")
    except ValueError:
        nbytes = 0.0
    if not 1.0 <= nbytes < 2.0**63:
        raise UsageError(f"--memory {text}: give a size as 512M or 2G")
    return int(nbytes)


def parse_jobs(text: str) -> int:
    """The number of processes in `4`; 0 for `auto`. Raises UsageError."""
    if text == "auto":
        return 0
    if not text.isascii() or not text.isdigit() or int(text) < 1:
        raise UsageError(f"-j {text}: write a number of processes, such as -j 4, or -j auto")
    return int(text)


def parse_setting(text: str) -> Any:
    """The value of `--set`: a value, animation keys (`1@1,4@24`, `0,0@1:linear,1,.5@24`), or `=` and an expression."""
    from ..graph import Expression, Interpolation, Key, Keys

    if text.startswith("="):
        return Expression(text[1:].strip())
    if "@" not in text:
        return parse_value(text)
    keys: list[Key] = []
    numbers: list[str] = []
    for part in text.split(","):
        number, at, frame_text = part.partition("@")
        numbers.append(number)
        if at:
            frame, _, interpolation_text = frame_text.partition(":")
            key_value = parse_value(",".join(numbers))
            try:
                if not isinstance(key_value, bool | int | float | list):
                    raise ValueError
                channels = tuple(map(float, key_value)) if isinstance(key_value, list) else key_value
                key = Key(float(frame), channels)
            except (TypeError, ValueError):
                return text  # a text may hold an @
            word = _parse_choice(interpolation_text or "smooth", get_args(Interpolation), f"--set {part}:")
            keys.append(Key(key.frame, key.value, word))
            numbers = []
    return text if numbers else Keys(tuple(keys))


def parse_frame_options(frame: int | None, text: str | None) -> tuple[int, ...] | None:
    """The frames that --frame or --frames name; None without either."""
    from ..graph.frames import check_frame, parse_frames

    if text is None:
        return None if frame is None else (check_frame(frame),)
    if frame is not None:
        raise UsageError("--frame and --frames: give one of them")

    return parse_frames(text)


def have_frame_number(files: Sequence[tuple[str, Path]]) -> bool:
    """True if a file name has a place for the frame number (####), or is that of a video, which holds all frames."""
    from ..graph.frames import Pattern, is_video

    return any(Pattern.parse(str(path)) or is_video(str(path)) for _, path in files)


def _refuse_constant(word: str) -> Any:
    raise UsageError(f"--set: {word} is not a valid value; write a finite number")


def parse_size(text: str | None) -> tuple[int, int] | None:
    """Width and height from `960x540`; None without a text."""
    if text is None:
        return None
    width, cross, height = text.lower().partition("x")
    sides = [int(side) if side.isascii() and side.isdecimal() and len(side) < 7 else 0 for side in (width, height)]
    if not cross or not all(sides):
        raise UsageError(f"--size {text}: write WIDTHxHEIGHT in pixels, such as 1920x1080")
    return sides[0], sides[1]


def parse_scale(number: float) -> float:
    """The number, if it is a valid scale of a proxy: above 0 and at most 1."""
    if not 0.0 < number <= 1.0:
        raise UsageError(f"--scale {number:g}: write a number above 0 and up to 1; 0.5 renders at half size")
    return number


def parse_form(text: str | None) -> Form | None:
    """The form of passes that --form names; None if it is not given."""
    if text is None:
        return None
    form: Form = _parse_choice(text, ("fragment", "compute"), "--form")
    return form


def parse_form_or_device(text: str) -> Form | Literal["device"]:
    """The form of passes that --form names, or "device" for what suits this device."""
    return _parse_choice(text, ("fragment", "compute", "device"), "--form")


def parse_precision(text: str | None) -> Precision | None:
    """The precision that --precision names; None if it is not given."""
    if text is None:
        return None
    precision: Precision = _parse_choice(text, ("half", "float"), "--precision")
    return precision


def parse_dither(text: str) -> Dither:
    """How --dither says that colors are rounded."""
    return _parse_choice(text, ("blue", "none"), "--dither")


def parse_progress(text: str) -> Literal["bar", "json"]:
    """How to report progress, from --progress."""
    return _parse_choice(text, ("bar", "json"), "--progress")


def find_targets(graph: Graph, node: str) -> dict[str, Port]:
    """The port that --node names, by that name; empty without --node."""
    from ..graph import find_node_output

    try:
        return {node: find_node_output(graph, node)} if node else {}
    except GraphError as fault:
        raise UsageError(f"--node {node}: {fault}") from None


def _parse_choice(text: str, choices: tuple[_Word, ...], flag: str) -> _Word:
    for word in choices:
        if word == text:
            return word
    raise UsageError(f"{flag} {text}: choose {' or '.join(choices)}")
