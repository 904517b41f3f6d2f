"""`halation schema`: the format, for editors of text and other tools."""

from __future__ import annotations


def schema() -> int:
    """Print a JSON Schema (draft 2020-12) of graph files: every node with its values, limits, choices and words."""
    from ...nodes import catalogue
    from ..document.canonical import pretty
    from ..document.schema import schema as made

    print(pretty(made(catalogue())), end="")
    return 0
