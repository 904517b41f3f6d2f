"""`halation schema`: the file format as a JSON Schema, for text editors and other tools."""

from __future__ import annotations

from .options import AsJson
from .outcome import print_json


def schema(as_json: AsJson = False) -> int:
    """Print a JSON Schema (2020-12) of graph files.

    It describes every node with its values, limits and choices. Text editors use it to complete and check graph files.
    """
    from halation.nodes import catalogue

    from ..document.canonical import pretty
    from ..document.schema import schema as build_schema

    if as_json:
        print_json(build_schema(catalogue()))
    else:
        print(pretty(build_schema(catalogue())), end="")
    return 0
