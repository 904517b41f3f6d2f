"""Removing layout of deleted elements from a merge."""

from __future__ import annotations

from typing import Any

from .parts import Tree, is_tree
from .references import element_names


def remove_stray_layout(merge: Any, base: Any) -> Any:
    """A graph without the places of deleted nodes and the routes of deleted links."""
    if not is_tree(merge) or not is_tree(base) or not is_tree(ui := merge.get("ui")):
        return merge
    links = base.get("links", {}).keys() - merge.get("links", {}).keys()
    removed = {"nodes": {*element_names(base)} - {*element_names(merge)}, "routes": links}
    layout: Tree = dict(ui)
    for section, names in removed.items():
        if is_tree(entries := ui.get(section)) and names & entries.keys():
            layout[section] = {name: entry for name, entry in entries.items() if name not in names}
    return {**merge, "ui": {name: entries for name, entries in layout.items() if entries or name not in removed}}
