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

MAX_CODE = 500_000
"""Letters of all code of a graph together: to read them takes a second."""

LEAST_CODE = 500
"""Letters that the shortest code counts as: to make a node type of it takes as long as to read so many (estimate)."""

MAX_NODES = 100_000
"""Nodes after every group is expanded: a few files that hold each other twice would otherwise make billions."""

GROUP_COST = 60
"""Nodes that a group counts as, besides those in it: to read and check its body takes as long (estimate). So there are
1,666 groups at most; graphs in use have dozens."""

MAX_ODD = 10_000
"""Nodes of unknown types, keys that nobody knows, and links from or to nodes that are not there: of each so many. A
graph with more links is not read if it has loops. Ten times what `halation check` reports."""

MAX_KEPT = 300_000
"""Parts of nodes and keys that nobody knows, which are kept: three for each of 100,000 nodes."""

MAX_LAYOUT = 500_000
"""Parts of the layout, `ui`: three for the place of each of 100,000 nodes, and as many again for routes and notes."""

MAX_TEXTS = 4000
"""Texts of nodes, names of fonts and layers among them, of which equal nodes count once. Twice the titles of a film: to
set 1,000 takes 0.2 s (estimate)."""

MAX_LETTERS = 200_000
"""Letters of all texts of nodes together: those of a small book."""

MAX_FILES = 4000
"""Names of files in nodes and inputs, of which equal nodes count once. To look for 1,000 takes 0.2 s (estimate)."""

MAX_ITEMS = 20_000
"""Named items (lights, outlines, strokes) of all nodes together: 78 nodes with as many outlines as one may have."""

MAX_ENDS = 10_000
"""Inputs, outputs and controls of one graph or group. Chosen by judgement: far more than a node can show."""

MAX_ALL_ENDS = 2 * MAX_ENDS
"""Those of a graph and all groups in its file together. Each takes longer than a node (estimate)."""

MAX_LINKS = 3 * MAX_NODES
"""Links of a graph and all groups in its file. Three for each node: most nodes have one or two inputs."""

MAX_KEYS = 200_000
"""Keys of all values together, of which each value has `LEAST_KEYS` at least: more than one for each of the 172,800
frames of a film of two hours."""

LEAST_KEYS = 20
"""Keys that a value with keys counts as at least: to find, check and calculate it takes as long (estimate)."""

MAX_NUMBERS = 1_200_000
"""Numbers and lists of numbers in values and keys together: 170,000 points with tangents, or 400,000 without."""

MAX_UNITS = 10_000
"""Nodes with units of their own, of which equal nodes count once: each takes as long to read as ten others."""

MAX_WORDS = 50_000
"""Words and signs of all expressions together, of which each counts as `LEAST_WORDS` at least: 10,000 expressions. To
read, check and calculate so many takes a second. Of one that was there before only the dots count, one for each value
that it reads: it is not read again."""

LEAST_WORDS = 5
"""Words that the shortest expression counts as: to look at it takes as long as to read so many (estimate)."""

MAX_FORMULA = 1000
"""Letters of an expression that is read at all: `expressions.tokens.MAX_LENGTH`, which is loaded with the first one."""

MAX_ALLOWED = 10_000
"""Warnings that a file allows. Chosen by judgement: ten times what `halation check` reports."""


def size_fault(count: int) -> str | None:
    """Why a file of `count` bytes is refused, or None."""
    if count > MAX_BYTES:
        return f"the file has more than {MAX_BYTES // 2**20} MB; that is no graph"
    return None if count else "the file is empty"


def refuse_nodes() -> str:
    """Why a file of more nodes is refused."""
    return f"with all groups, of which each counts as {GROUP_COST}, there are more than {MAX_NODES} nodes"
