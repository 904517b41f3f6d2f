"""Finds the missing frames of sequences, from time to time."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from msgspec import Struct

from ...authoring.session import Session
from ...compiler import find_named_files
from ...errors import HalationError
from ...graph import Graph
from ...media.layers import split_layer
from ...media.sequences import find_sequence
from ...resources.sandbox import Sandbox

EVERY = 1.0
"""The least seconds between two checks while the graph changes: a choice, for listing folders takes time."""

STALE = 5.0
"""Seconds after which files are checked again in any case: a choice."""

Gaps = tuple[tuple[int, int], ...]
"""The first and last frame of each gap."""


class MissingFrames(Struct):
    """The gaps in the sequences of one document; cached."""

    gaps: Gaps = ()
    _of: tuple[object, ...] = ()
    _at: float = float("-inf")

    def update(self, session: Session, time_now: float) -> Gaps:
        """The gaps: frames between the first and the last file of a sequence that have no file."""
        of = session.root, dict(session.bindings)
        if time_now - self._at > STALE or (time_now - self._at > EVERY and (not self._of or of[0] is not self._of[0])):
            self._at, self._of = time_now, of
            self.gaps = find_gaps(session.root, session.bindings, session.sandbox)
        return self.gaps


def find_gaps(graph: Graph, bindings: Mapping[str, object], sandbox: Sandbox) -> Gaps:
    """The gaps of every sequence that a graph reads; unreadable ones have none."""
    paths = [split_layer(str(file))[0] for file in bindings.values() if isinstance(file, str | Path)]
    with suppress(HalationError):
        paths += [
            path for path, owner, _ in find_named_files(graph, {}) if owner.removeprefix("inputs.") not in bindings
        ]
    gaps: set[tuple[int, int]] = set()
    for path in dict.fromkeys(paths):
        try:
            sequence = find_sequence(path, sandbox=sandbox)
        except HalationError:
            continue
        if sequence is not None:
            gaps.update(sequence.gaps)
    return tuple(sorted(gaps))
