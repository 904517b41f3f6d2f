"""The merge of three versions of a text, line by line, as diff3 does (Khanna, Kunal and Pierce 2007)."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import SequenceMatcher


def merge_lines(base: Sequence[str], ours: Sequence[str], theirs: Sequence[str]) -> list[str] | None:
    """The lines with the changes of both sides, or None if both changed the same lines differently."""
    lines: list[str] = []
    start = (0, 0, 0)
    for at, end in _find_shared_runs(base, ours, theirs):
        parts = [side[first:last] for side, first, last in zip((base, ours, theirs), start, at, strict=True)]
        before, ours_here, theirs_here = (list(part) for part in parts)
        if ours_here != before and theirs_here != before and ours_here != theirs_here:
            return None
        lines += theirs_here if ours_here == before else ours_here
        lines += base[at[0] : end[0]]
        start = end
    return lines


def _find_shared_runs(
    base: Sequence[str], ours: Sequence[str], theirs: Sequence[str]
) -> list[tuple[tuple[int, int, int], tuple[int, int, int]]]:
    """Runs of lines that all three share: where each starts and ends in the three texts; an empty run at the end."""
    our_lines, their_lines = _matches(base, ours), _matches(base, theirs)
    runs: list[tuple[tuple[int, int, int], tuple[int, int, int]]] = []
    for line in sorted(our_lines.keys() & their_lines.keys()):
        here = (line, our_lines[line], their_lines[line])
        after = (line + 1, our_lines[line] + 1, their_lines[line] + 1)
        if runs and runs[-1][1] == here:
            runs[-1] = (runs[-1][0], after)
        else:
            runs.append((here, after))
    end = (len(base), len(ours), len(theirs))
    return [*runs, (end, end)]


def _matches(base: Sequence[str], side: Sequence[str]) -> dict[int, int]:
    """Line numbers of a side by line numbers of the base."""
    blocks = SequenceMatcher(None, base, side, autojunk=False).get_matching_blocks()
    return {block.a + step: block.b + step for block in blocks for step in range(block.size)}
