"""Numbered pictures on disk: one that stands for all, all of them, and what a dropped one belongs to."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from ..errors import HalationError
from ..media.sequences import find_frame_file, find_sequence, suggest_pattern
from ..resources.sandbox import Sandbox

MOST = 400
"""Files of one sequence that are watched. A choice: to ask for the state of so many takes a few milliseconds."""

AFTER = 24
"""Frames after the last one that are waited for: a second of what a renderer writes. A choice."""


def representative_file(path: Path, frame: int = 1, *, sandbox: Sandbox) -> Path:
    """The picture itself; of a sequence the one at that frame, or the nearest one. A path that is wrong stays."""
    try:
        return Path(find_frame_file(str(path), frame, "nearest", sandbox=sandbox).path)
    except HalationError:
        return path


def list_sequence_files(paths: Iterable[Path], sandbox: Sandbox) -> tuple[Path, ...]:
    """Every file that is read for these paths, those included that a sequence lacks or may get soon."""
    files: list[Path] = []
    for path in paths:
        try:
            sequence = find_sequence(str(path), sandbox=sandbox)
        except HalationError:
            sequence = None
        if sequence is None or not sequence.frames:
            files.append(path)
            continue
        frames = range(sequence.frames[0], sequence.frames[-1] + AFTER + 1)[-MOST:]
        names = sequence.names
        files += [Path(sequence.path(frame) if frame in names else sequence.pattern.name(frame)) for frame in frames]
    return tuple(dict.fromkeys(files))


def suggest_patterns(paths: Sequence[Path], sandbox: Sandbox) -> tuple[tuple[Path, ...], dict[Path, Path]]:
    """Dropped files with several of one sequence made one, and the sequence that each of the others is a frame of."""
    suggested = {path: pattern for path in paths if (pattern := suggest_pattern(str(path), sandbox=sandbox))}
    counts = {
        sequence_pattern: [*suggested.values()].count(sequence_pattern) for sequence_pattern in suggested.values()
    }
    chosen = tuple(
        dict.fromkeys(
            Path(suggested[path]) if path in suggested and counts[suggested[path]] > 1 else path for path in paths
        )
    )
    return chosen, {path: Path(suggested[path]) for path in chosen if path in suggested}
