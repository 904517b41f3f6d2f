"""Many files that one queued render writes, as `halation render --each` does: a folder, a pattern, or a list."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from msgspec import Struct

from ...errors import UsageError
from ...graph import Graph
from ...language.translation import translate
from ...renderer.jobs.entry_list import expand_entries
from ...renderer.jobs.render_entry import RenderEntry
from ...resources.sandbox import Sandbox

LIST_MARK = "@"
"""The first character of a text that names a list of files."""


class QueuedFiles(Struct, frozen=True):
    """Which files fill an input of a graph, one after the other: `files` is a folder, a pattern or a list.

    `input` is the name of the input, "" for the only one.
    """

    files: str
    input: str = ""


def list_entries(
    graph: Graph,
    files: QueuedFiles,
    destinations: Sequence[tuple[str, Path]],
    inputs: Mapping[str, str],
    sandbox: Sandbox,
) -> tuple[RenderEntry, ...]:
    """What is rendered for each file. `inputs` are the files of all other inputs. Raises UsageError.

    Names without a folder are those of the folder of the graph.
    """
    name = files.input or next(iter(graph.inputs), "")
    if name not in graph.inputs:
        raise UsageError(translate("no input of the graph is there to fill: add one"))
    text = files.files.strip()
    if not text.strip(LIST_MARK):
        raise UsageError(translate("no files are chosen: name a folder, or a pattern such as photos/*.jpg"))
    mark, path = (LIST_MARK, text[1:]) if text.startswith(LIST_MARK) else ("", text)
    # A name may have a layer or a pattern after the path.
    place = os.path.abspath(os.path.join(graph.folder, os.path.expanduser(path)))  # noqa: PTH100, PTH111, PTH118
    entries = expand_entries(
        [f"{mark}{place}"],
        {**inputs, name: "{}"},
        {},
        [(output, file.absolute()) for output, file in destinations],
        str,
        sandbox,
    )
    if len({entry.destinations for entry in entries}) < len(entries):
        raise UsageError(translate("several files would have one name: write {place} into the name", place="{stem}"))
    return entries
