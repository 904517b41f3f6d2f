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

MAX_ENDS = 10_000
"""Inputs, outputs and controls of one graph or group. Chosen by judgement: far more than a node can show."""

MAX_ALL_ENDS = MAX_NODES
"""Those of a graph and all groups in its file together. Each takes longer than a node (measured)."""

MAX_LINKS = 3 * MAX_NODES
"""Links of a graph and all groups in its file. Three for each node: most nodes have one or two inputs."""

MAX_KEYS = 250_000
"""Keys of all values together: one for each frame of a film of two hours, and half as many again."""

MAX_WORDS = 5 * MAX_NODES
"""Words and signs of all expressions together: five for each of 100,000 nodes. To read them takes two or three seconds.
Of one that was there before only the dots count, one for each value that it reads: it is not read again."""

MAX_FORMULA = 1000
"""Letters of an expression that is read at all: `expressions.tokens.MAX_LENGTH`, which is loaded with the first one."""

MAX_ALLOWED = 10_000
"""Warnings that a file allows. Chosen by judgement: ten times what `halation check` reports."""


def size_fault(count: int) -> str | None:
    """Why a file of `count` bytes is refused, or None."""
    if count > MAX_BYTES:
        return f"the file has more than {MAX_BYTES // 2**20} MB; that is no graph"
    return None if count else "the file is empty"
