"""Three versions of a text made one, line by line, as diff3 does (Khanna, Kunal and Pierce 2007)."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import SequenceMatcher


def merged_lines(base: Sequence[str], ours: Sequence[str], theirs: Sequence[str]) -> list[str] | None:
    """The lines with what both sides changed, or None where they changed the same lines in different ways."""
    found: list[str] = []
    start = (0, 0, 0)
    for at, end in _stable(base, ours, theirs):
        parts = [side[first:last] for side, first, last in zip((base, ours, theirs), start, at, strict=True)]
        before, mine, other = (list(part) for part in parts)
        if mine != before and other != before and mine != other:
            return None
        found += other if mine == before else mine
        found += base[at[0] : end[0]]
        start = end
    return found


def _stable(
    base: Sequence[str], ours: Sequence[str], theirs: Sequence[str]
) -> list[tuple[tuple[int, int, int], tuple[int, int, int]]]:
    """Runs of lines that all three share, from where to where in each; an empty one at the end."""
    mine, others = _matches(base, ours), _matches(base, theirs)
    runs: list[tuple[tuple[int, int, int], tuple[int, int, int]]] = []
    for line in sorted(mine.keys() & others.keys()):
        here = (line, mine[line], others[line])
        after = (line + 1, mine[line] + 1, others[line] + 1)
        if runs and runs[-1][1] == here:
            runs[-1] = (runs[-1][0], after)
        else:
            runs.append((here, after))
    end = (len(base), len(ours), len(theirs))
    return [*runs, (end, end)]


def _matches(base: Sequence[str], side: Sequence[str]) -> dict[int, int]:
    """Line of the base to line of a side."""
    blocks = SequenceMatcher(None, base, side, autojunk=False).get_matching_blocks()
    return {block.a + step: block.b + step for block in blocks for step in range(block.size)}
