"""Writes a graph as a script of numpy and scipy that makes the same picture slowly, for papers and teaching.

- `functions` has what nodes do, as short functions for readers: one for each node that can be exported.
- `library` reads their text, and finds all that a function needs.
- `outline` follows the graph, and says which function is called with what.
- `parts` finds what is read at several frames, which becomes functions of the frame, and what runs frame by frame.
- `numbers` writes values as text: lengths as parts of the height, angles in degrees, animated values as tables.
- `script` puts the text together.

A node without a function is refused. So is a choice that its function does not know, and a link to a value that is a
plain number there: the annotations of the functions say both.
"""

from __future__ import annotations

from .script import export_script

__all__ = ["export_script"]
