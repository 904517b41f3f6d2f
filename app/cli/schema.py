"""`halation schema`: the format, for editors of text and other tools."""

from __future__ import annotations

from .options import AsJson
from .outcome import print_json


def schema(as_json: AsJson = False) -> int:
    """Print a JSON Schema (draft 2020-12) of graph files: every node with its values, limits, choices and words."""
    from halation.nodes import catalogue

    from ..document.canonical import pretty
    from ..document.schema import schema as made

    if as_json:
        print_json(made(catalogue()))
    else:
        print(pretty(made(catalogue())), end="")
    return 0
