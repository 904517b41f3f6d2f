"""What a graph says about itself as a preset: a description and tags. They are part of its layout, `ui.about`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import cast

import msgspec
from msgspec import Struct

from ..errors import DocumentError
from ..graph import Graph
from ..resources.input_files import read_bytes
from ..resources.sandbox import Sandbox
from ..resources.typed_data import decode_data


class About(Struct, frozen=True):
    """The description and the tags of a preset. The first tag is its category."""

    doc: str = ""
    tags: tuple[str, ...] = ()


class _LayoutRecord(msgspec.Struct):
    about: object = None


class _PresetRecord(msgspec.Struct):
    halation: object = None
    ui: _LayoutRecord = msgspec.field(default_factory=_LayoutRecord)


def read_about(path: Path, sandbox: Sandbox) -> About:
    """What a graph file says about itself, without reading its nodes. Raises InputError, and DocumentError if it is
    no graph."""
    try:
        record = decode_data(read_bytes(path, sandbox=sandbox), _PresetRecord)
    except msgspec.MsgspecError as fault:
        raise DocumentError(str(path), "", f"this is no graph: {fault}") from None
    if record.halation is None:
        raise DocumentError(str(path), "", 'this is no graph: the key "halation", its format number, is missing')
    return _parse(record.ui.about)


def find_about(graph: Graph) -> About:
    """What a graph says about itself."""
    return _parse(graph.ui.get("about"))


def with_about(graph: Graph, about: About) -> Graph:
    """The graph with another description and other tags."""
    facts = {name: fact for name, fact in (("doc", about.doc), ("tags", list(about.tags))) if fact}
    others = {name: section for name, section in graph.ui.items() if name != "about"}
    return replace(graph, ui={**others, "about": facts} if facts else others)


def _parse(facts: object) -> About:
    """What is readable; a file that somebody else wrote may hold anything there."""
    if not isinstance(facts, Mapping):
        return About()
    keys = cast("Mapping[str, object]", facts)
    doc, tags = keys.get("doc", ""), keys.get("tags", ())
    texts = cast("Sequence[object]", tags) if isinstance(tags, list | tuple) else ()
    return About(doc if isinstance(doc, str) else "", tuple(text for text in texts if isinstance(text, str)))
