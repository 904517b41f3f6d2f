"""Finds the graph that a user names: a file, or a preset by its name."""

from __future__ import annotations

import os
from pathlib import Path

from halation.nodes import plugins

from ..custom_nodes.plugins import find_graph_or_preset, find_preset, name_presets
from ..errors import DocumentError
from ..graph import did_you_mean


def locate_graph(name: str | Path) -> Path:
    """The file of `find_graph_or_preset`, which is there, or is a path whose reader says that nothing is there.

    Raises DocumentError with a suggestion where the name of a preset or a preset's file may be meant.
    """
    path = find_graph_or_preset(name)
    if not os.path.lexists(path) and (hint := _suggest_preset(path)):
        raise DocumentError(str(name), "", f"there is no such file{hint}", rule="unreadable-graph")
    return path


def _suggest_preset(path: Path) -> str:
    """How to name the preset that the user may mean by a path where nothing is, or ""."""
    if path.suffix.lower() == ".json":
        return f"; for the preset write {path.stem}" if find_preset(path.stem) else ""
    if path.name != str(path) or not path.name.replace(".", "_").isidentifier():
        return ""
    return f", and no preset has this name{did_you_mean(path.name, name_presets()) or _explain_missing(path.name)}"


def _explain_missing(name: str) -> str:
    """Where a preset comes from that has no name like it."""
    namespace, dot, _ = name.partition(".")
    if dot and all(plugin.namespace != namespace for plugin in plugins()):
        return f": no plug-in '{namespace}' is installed, and its presets come with it"
    return "; halation demo --list prints them"
