"""The files that one graph is rendered for, by `render --each` and in the editor, and what each of them has of its own.

Files come as names, folders and patterns, from lists (`@files.txt`, one name per line), or as JSON lines on standard
input, which may also say `input`, `set` and `output` for one file. In `-i`, `--set` and `-o`, `{}` stands for the file,
`{stem}` for its name without the ending and the frame number, `{name}` for its name, `{parent}` for its folder, and
`{index}` for its number from 1 on; `{index:04}` has at least four digits.
"""

from __future__ import annotations

import glob
import json
import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path, PurePath
from typing import Any

from msgspec import Struct, field

from ...errors import HalationError, InputError, UsageError
from ...graph.frames import remove_frame_number
from ...media import PICTURE_ENDINGS
from ...resources.folders import find_matches
from ...resources.input_files import open_file
from ...resources.sandbox import Sandbox
from ...resources.typed_data import convert_data
from .render_entry import RenderEntry

STANDARD_INPUT = "-"
_PLACE = re.compile(r"\{(?P<word>\w*)(?::(?P<width>\d+))?\}")
_WORDS = ("", "stem", "name", "parent", "index")
_MAX_LIST_BYTES = 2**28
"""A list of a million names of 256 bytes, as many as a list of frames may have."""
_MAX_DIGITS = 16
"""As many as the number of a frame may have."""

Texts = str | dict[str, Any]


class _Line(Struct, frozen=True, forbid_unknown_fields=True):
    """One JSON line: a file and what it has instead of the options of the command line."""

    file: str = ""
    input: Texts = field(default_factory=dict[str, Any])
    set: dict[str, Any] = field(default_factory=dict[str, Any])
    output: Texts = field(default_factory=dict[str, Any])


def expand_entries(
    each: Sequence[str],
    inputs: Mapping[str, str],
    sets: Mapping[str, str],
    destinations: Sequence[tuple[str, Path]],
    read_lines: Callable[[], str],
    sandbox: Sandbox,
) -> tuple[RenderEntry, ...]:
    """What to render for every file of `--each`, in order. `read_lines` reads standard input.

    Values of `--set` that are the same for all files are not part of it: they belong to the job.

    Raises UsageError for what is no list of files, and for two files that would be written to one.
    """
    own_sets = {name: text for name, text in sets.items() if names_file(text)}
    is_placed = bool(own_sets) or any(map(names_file, inputs.values()))
    entries: list[RenderEntry] = []
    for line in _list_lines(each, read_lines, sandbox):
        index = len(entries) + 1
        line_inputs = _read_texts(line.input)
        line_sets = {**own_sets, **{name: _write_setting(setting) for name, setting in line.set.items()}}
        files = {**inputs, **line_inputs}
        if line.file and not (is_placed or line_inputs or any(map(names_file, line_sets.values()))):
            files = {"": "{}", **files} if "" not in files else files
        outputs = list(_read_texts(line.output).items()) or [(name, str(path)) for name, path in destinations]
        if not outputs:
            raise UsageError(f"--each {line.file}: it has no output: write -o FILE, such as -o 'graded/{{stem}}.png'")
        entries.append(
            RenderEntry(
                line.file or f"line {index}",
                {name: _fill_places(text, line.file, index, f"-i {text}") for name, text in files.items()},
                {name: _fill_places(text, line.file, index, "") for name, text in line_sets.items()},
                tuple((name, _fill_places(text, line.file, index, f"-o {text}")) for name, text in outputs),
            )
        )
    if not entries:
        raise UsageError(f"--each {' '.join(each)}: there is no such file")
    _check_outputs(entries)
    return tuple(entries)


def _list_lines(each: Sequence[str], read_lines: Callable[[], str], sandbox: Sandbox) -> Iterator[_Line]:
    """The files of all `--each` options, in order."""
    for text in each:
        if text == STANDARD_INPUT:
            yield from _parse_lines(read_lines())
        elif text.startswith("@"):
            yield from (_Line(line.strip()) for line in _read_list(text[1:], sandbox).splitlines() if line.strip())
        else:
            yield from (_Line(path) for path in _find_files(text, sandbox))


def _list_pictures(folder: str, sandbox: Sandbox) -> list[str]:
    """The pictures of a folder, by name."""
    if fault := sandbox.find_read_fault(folder):
        raise UsageError(f"--each {folder}: {fault}")
    pictures = sorted(path for path in Path(folder).iterdir() if path.suffix.casefold() in PICTURE_ENDINGS)
    if not pictures:
        raise UsageError(f"--each {folder}: no picture is in this folder")
    return [str(path) for path in pictures]


def _find_files(text: str, sandbox: Sandbox) -> list[str]:
    """The files that match a pattern, or the pictures of a folder.

    What has no matches stands for itself, as the name of a sequence does.
    """
    if Path(text).is_dir():
        return _list_pictures(text, sandbox)
    if not glob.has_magic(text) or os.path.lexists(text):
        return [text]
    try:
        matches = [path for path in find_matches(text, sandbox) if not Path(path).is_dir()]
    except InputError as fault:
        raise UsageError(f"--each {text}: {fault}") from None
    if not matches:
        raise UsageError(f"--each {text}: no file matches this pattern")
    return matches


def _read_list(path: str, sandbox: Sandbox) -> str:
    """The text of a list of files."""
    try:
        with open_file(path, sandbox) as file:
            content = file.read(_MAX_LIST_BYTES + 1)
    except HalationError as fault:
        raise UsageError(f"--each @{path}: {fault}") from None
    except (OSError, ValueError) as fault:
        reason = getattr(fault, "strerror", None) or fault
        raise UsageError(f"--each @{path}: the list cannot be read ({reason})") from None
    if len(content) > _MAX_LIST_BYTES:
        raise UsageError(f"--each @{path}: the list has more than {_MAX_LIST_BYTES // 2**20} MB; name files in parts")
    return content.decode("utf-8-sig", "surrogateescape")


def _parse_lines(text: str) -> Iterator[_Line]:
    """The lines of standard input: JSON objects, or texts, which are names of files."""
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip():
            continue
        try:
            parsed = json.loads(line)
            yield _Line(parsed) if isinstance(parsed, str) else convert_data(parsed, _Line)
        except (ValueError, RecursionError) as fault:
            raise UsageError(
                f'--each -: line {number} of standard input is invalid ({fault}): write {{"file": "a.png"}}, and '
                'maybe "input", "set" and "output"'
            ) from None


def _read_texts(texts: Texts) -> dict[str, str]:
    """Names and texts of one option of a line; a single text has no name."""
    return {"": texts} if isinstance(texts, str) else {name: str(text) for name, text in texts.items()}


def _write_setting(setting: Any) -> str:
    """A number, list or text of JSON as the user would type it after `--set`."""
    if isinstance(setting, str):
        return setting
    return ",".join(map(json.dumps, setting)) if isinstance(setting, list) else json.dumps(setting)


def names_file(text: str) -> bool:
    """True if a text has a place for the file."""
    return any(place["word"] in _WORDS for place in _PLACE.finditer(text))


def _fill_places(text: str, file: str, index: int, option: str) -> str:
    """The text with the file in its places. Raises UsageError for an unknown place, where there is an `option`."""

    def fill(place: re.Match[str]) -> str:
        word, width = place["word"], int(place["width"] or 0)
        if word not in _WORDS or width > _MAX_DIGITS or (place["width"] and word != "index"):
            if option:
                raise UsageError(
                    f"{option}: '{place[0]}' is not a place: write {{}}, {{stem}}, {{name}}, {{parent}} or {{index}}"
                )
            return place[0]
        if not file and word != "index":
            raise UsageError(f"{option or text}: line {index} of --each names no file that '{place[0]}' stands for")
        path = PurePath(file)
        return {
            "": file,
            "stem": PurePath(remove_frame_number(path.name)).stem,
            "name": path.name,
            "parent": str(path.parent),
            "index": f"{index:0{width}d}",
        }[word]

    return _PLACE.sub(fill, text)


def _check_outputs(entries: Iterable[RenderEntry]) -> None:
    """Raise UsageError if two entries would be written to one file, or one over a file that another one reads."""
    readers = {os.path.realpath(file): entry for entry in entries for file in entry.inputs.values()}
    writers: dict[str, RenderEntry] = {}
    for entry in entries:
        for _, path in entry.destinations:
            real_path = os.path.realpath(path)
            if (reader := readers.get(real_path)) is not None:
                raise UsageError(f"-o {path}: this file is read for {reader.file}; write to another")
            if (writer := writers.setdefault(real_path, entry)) is not entry:
                raise UsageError(
                    f"-o {path}: {writer.file} and {entry.file} would be written to this one file: use more of "
                    "{parent}, {stem} and {index} in its name"
                )
