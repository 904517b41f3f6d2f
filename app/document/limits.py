"""How large a graph file may be. Beyond that it is damaged or hostile, and refused before it costs anything."""

from __future__ import annotations

MAX_BYTES = 32 * 2**20
"""Bytes of a file. Chosen by judgement: 100,000 nodes with their values and links take less."""

MAX_NESTING = 64
"""Objects and lists inside each other. A choice: a field of a light lies seven deep, and each group in place
adds three."""

MAX_PARTS = 1_500_000
"""Objects, lists and their entries in a file: fifteen for each of 100,000 nodes, which take about nine."""

MAX_KEY = 1000
"""Characters of a key: the names of nodes and sockets, and paths of links. Messages repeat them."""

MAX_CODE = 1_000_000
"""Letters of all code of a graph together, as many as one text may have: to read them takes a second or two."""

LEAST_CODE = 200
"""Letters that the shortest code counts as: to make a node type of it takes as long as to read so many (measured)."""

MAX_NODES = 100_000
"""Nodes after every group is expanded: a few files that hold each other twice would otherwise make billions."""


def size_fault(count: int) -> str | None:
    """Why a file of `count` bytes is refused, or None."""
    if count > MAX_BYTES:
        return f"the file has more than {MAX_BYTES // 2**20} MB; that is no graph"
    return None if count else "the file is empty"
