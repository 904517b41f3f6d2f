"""What a merge leaves in the layout of things that are no more."""

from __future__ import annotations

from typing import Any

from .parts import Tree, is_tree
from .references import things_of


def without_strays(made: Any, base: Any) -> Any:
    """A graph without the places of nodes, and the routes of links, that were in the base and are gone."""
    if not is_tree(made) or not is_tree(base) or not is_tree(ui := made.get("ui")):
        return made
    links = base.get("links", {}).keys() - made.get("links", {}).keys()
    gone = {"nodes": {*things_of(base)} - {*things_of(made)}, "routes": links}
    kept: Tree = dict(ui)
    for section, names in gone.items():
        if is_tree(entries := ui.get(section)) and names & entries.keys():
            kept[section] = {name: entry for name, entry in entries.items() if name not in names}
    return {**made, "ui": {name: entries for name, entries in kept.items() if entries or name not in gone}}
