"""What can be added to a graph, and how it is found by a few letters."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from halation.nodes import Kind, Node

from ...authoring.background.shader_files import ShaderFile
from ...authoring.edits.coding import CODE, make_starter_node
from .fuzzy import match

GROUP, GRAPH, SHADER = "group", "graph", "code"


@dataclass(frozen=True)
class CatalogEntry:
    """Something to add. `id` is a node type, a path (of presets) or a word such as `frame`, by category."""

    id: str
    title: str
    category: str
    doc: str = ""
    kind: str = ""
    """The category whose color it has, if not its own."""

    @property
    def searched(self) -> str:
        """The text in which letters are looked for: the title counts most since it comes first."""
        return f"{self.title}  {self.category}  {self.doc}"


def spell_out(name: str) -> str:
    """A name with spaces, as people read it."""
    return name.replace("_", " ")


def node_entries(types: Mapping[str, type[Node]]) -> tuple[CatalogEntry, ...]:
    """Every node type, in the order of the menu."""
    return tuple(
        CatalogEntry(id, kind.title, kind.category, (kind.__doc__ or "").strip().partition("\n")[0])
        for id, kind in types.items()
    )


def code_entries() -> tuple[CatalogEntry, ...]:
    """What is made by writing it."""
    doc = "GLSL of your own: the function's signature declares sockets and values."
    return (CatalogEntry(CODE, "code", make_starter_node().category, doc),)


def shader_entries(files: Iterable[ShaderFile]) -> tuple[CatalogEntry, ...]:
    """Shaders of this machine, under what they say they are."""
    return tuple(
        CatalogEntry(str(file.path), spell_out(file.path.stem), f"ISF {file.category.lower()}", file.doc, SHADER)
        for file in files
    )


def preset_entries(files: Iterable[Path]) -> tuple[CatalogEntry, ...]:
    """The graphs that come with the program."""
    return tuple(
        CatalogEntry(str(path), spell_out(path.stem), GROUP, "A preset: a ready graph, added as a group.")
        for path in files
    )


def graph_entries() -> tuple[CatalogEntry, ...]:
    """What is no node."""
    ends = [
        CatalogEntry(f"{side}:{kind}", f"{kind} {side}".lower(), GRAPH, doc)
        for side, doc in (("input", "Where it enters the graph."), ("output", "Where it leaves the graph."))
        for kind in Kind
    ]
    return (
        *ends,
        CatalogEntry("frame", "frame", GRAPH, "A titled area; what lies on it moves with it."),
        CatalogEntry("comment", "comment", GRAPH, "A note on the canvas."),
    )


@dataclass(frozen=True)
class Section:
    """Entries under a heading."""

    title: str
    entries: tuple[CatalogEntry, ...]


def arrange_entries(entries: Sequence[CatalogEntry], query: str, recent: Sequence[str] = ()) -> tuple[Section, ...]:
    """What the list shows: the best matches of `query`, or without one the recent ones and then all by category."""
    if query.strip():
        title_matches = match(query, [entry.title for entry in entries])
        named = [entries[hit.index] for hit in title_matches]
        described = [entries[hit.index] for hit in match(query, [entry.searched for entry in entries])]
        rest = [entry for entry in described if entry not in named and _says(entry, query)]
        return (Section("", (*named, *rest)),)
    by_id = {entry.id: entry for entry in entries}
    last = tuple(by_id[id] for id in recent if id in by_id)
    groups: dict[str, list[CatalogEntry]] = {}
    for entry in entries:
        groups.setdefault(entry.category, []).append(entry)
    listed = [Section(title, tuple(group)) for title, group in groups.items()]
    return (*([Section("recent", last)] if last else []), *listed)


def keep_fitting(entries: Collection[CatalogEntry], fitting: Collection[str]) -> tuple[CatalogEntry, ...]:
    """Those that a link fits."""
    fitting_ids = set(fitting)
    return tuple(entry for entry in entries if entry.id in fitting_ids)


def _says(entry: CatalogEntry, query: str) -> bool:
    """True if every word of the query stands in the category or description as it was typed."""
    text = entry.searched.lower()
    return all(word in text for word in query.lower().split())
