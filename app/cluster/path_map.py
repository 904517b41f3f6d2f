"""Paths of one machine on another: what `--map FROM=TO` says."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path, PurePath

from ..errors import UsageError


class PathMap:
    """Replaces the beginnings of absolute paths; the longest one that matches counts.

    A pair counts only where the folder that it leads to exists, so that one map suits machines of several kinds.
    """

    def __init__(self, pairs: Sequence[tuple[str, str]]) -> None:
        pairs = [(before, after) for before, after in pairs if os.path.lexists(after)]
        self._pairs = sorted(pairs, key=lambda pair: -len(pair[0]))

    def locate(self, path: str) -> str:
        """Where a file is on this machine."""
        for before, after in self._pairs:
            if PurePath(path).is_relative_to(before):
                return str(Path(after, PurePath(path).relative_to(before)))
        return path


def parse_path_map(texts: Sequence[str]) -> tuple[tuple[str, str], ...]:
    """The pairs of `FROM=TO`. Raises UsageError for what is not a pair of absolute paths."""
    pairs: list[tuple[str, str]] = []
    for text in texts:
        before, _, after = text.partition("=")
        is_absolute = after.startswith(("/", "\\")) or after[1:2] == ":"  # perhaps of another system
        if not PurePath(before).is_absolute() or not is_absolute:
            raise UsageError(f"--map {text}: write --map FROM=TO with two absolute folders, such as /farm/show=/show")
        pairs.append((os.path.normpath(before), after))
    return tuple(pairs)
