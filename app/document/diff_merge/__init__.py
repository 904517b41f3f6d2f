"""Comparing two versions of a graph, and merging three.

A merge of text would put lines together that make no graph, and call a node that moved down a file a conflict. So both
work on documents by name, in four steps:

1. **Align** (`aligning`). A node that was renamed is found again by all that a graph says of it: type, values, code and
   links. What is certain identifies its neighbors, round by round, as colors are refined in tests of graph isomorphism
   (Weisfeiler and Leman 1968). After that, equal ids mean equal nodes.
2. **Split** (`parts`). Each version becomes the document that it would be saved as, addressed by keys: a value of a
   node, a link by its target, a key of an animation by its frame. Values at their default are absent, so it does not
   matter how a file was written.
3. **Compare or merge** (`difference`, `merging`). A part that only one side changed is taken from that side. Code that
   both changed is merged line by line (`lines`). All else that both changed is a conflict: our part stays in place, and
   the three versions are noted in the document (`conflicts`), which can still be loaded, checked and edited. What one
   side deleted while the other built on it (`references`) is a conflict as a whole, so no link is left without a node.
4. **Check** (`faults`). Two correct sides can make an incorrect graph, such as a loop of links. Their links are then
   taken back to our version and noted, until the merge has no fault that our side does not have.

`telling` and `wording` say differences in words; the command line, the git driver and the editor show these.
"""

from __future__ import annotations

from .aligning import NodeRename
from .conflicts import SIDES, Conflict, Side, read_conflicts, resolve_conflicts
from .difference import GraphDifference, PartChange, apply_difference, compare_graphs
from .merging import MergedGraph, merge_graphs
from .parts import ABSENT, PartPath, path_text, to_document
from .telling import DifferenceLine, describe_difference, describe_graph

__all__ = [
    "ABSENT",
    "SIDES",
    "Conflict",
    "DifferenceLine",
    "GraphDifference",
    "MergedGraph",
    "NodeRename",
    "PartChange",
    "PartPath",
    "Side",
    "apply_difference",
    "compare_graphs",
    "describe_difference",
    "describe_graph",
    "merge_graphs",
    "path_text",
    "read_conflicts",
    "resolve_conflicts",
    "to_document",
]
