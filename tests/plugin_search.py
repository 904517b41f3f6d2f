"""Prints what the search of the editor finds of the sample plug-in, and the ids of new nodes. Run by a test."""

from __future__ import annotations

from halation.authoring.commands import AddGroupFile, AddNode
from halation.authoring.library import PresetLibrary
from halation.authoring.session import Session
from halation.custom_nodes.plugins import preset_paths
from halation.editor.shared import entries
from halation.nodes import catalogue
from halation.resources.sandbox import UNRESTRICTED

every = entries.node_entries(catalogue()) + entries.preset_entries(PresetLibrary().list_presets())
for query in ("soft glow", "acme glow", "acme dream"):
    print(entries.arrange_entries(every, query)[0].entries[0].title)
session = Session(sandbox=UNRESTRICTED)
print(session.apply(AddNode("acme_glow.soft_glow")))
print(session.apply(AddGroupFile(next(path for path in preset_paths() if path.stem == "acme_dream"))))
