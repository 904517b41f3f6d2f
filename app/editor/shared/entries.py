"""The catalog of what can be added to a graph, and the search in it."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from functools import cached_property
from types import MappingProxyType

from halation.nodes import Kind, Node, Plain
from msgspec import Struct

from ...authoring.background.shader_files import ShaderFile
from ...authoring.edits.coding import CODE, make_starter_node
from ...authoring.library import PresetFacts
from ...language.translation import mark, translate
from .declared_words import name_choice, name_preset, name_type, spell_out, summarize_type
from .fuzzy import match

GROUP, GRAPH, SHADER = "group", "graph", "code"
MERGE = "merge"

_MODE_ALIASES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "over": ("alpha over", "normal", "a over b", "source over", "blend over"),
        "under": ("behind", "destination over", "b over a"),
        "in": ("mask by alpha", "inside", "held in", "stencil alpha", "source in"),
        "out": ("held out", "holdout", "outside", "silhouette alpha", "source out", "cutout"),
        "atop": ("source atop", "on top of"),
        "xor": ("exclusive or", "non-overlapping"),
        "clear": ("none", "erase"),
        "plus": ("add", "linear dodge", "additive", "additive dissolve", "linear dodge add", "sum", "lighten add"),
        "multiply": ("mult", "times", "product"),
        "screen": ("negative multiply",),
        "soft light": ("softlight",),
        "hard light": ("hardlight", "vivid light", "linear light"),
        "color dodge": ("dodge", "colour dodge"),
        "color burn": ("burn", "colour burn", "linear burn"),
        "darken": ("min", "minimum", "darker color", "darken only"),
        "lighten": ("max", "maximum", "lighter color", "lighten only"),
        "difference": ("absminus", "abs minus", "absolute difference"),
        "exclusion": ("exclude",),
        "subtract": ("minus", "from", "linear subtract"),
        "divide": ("by",),
        "hypot": ("diagonal",),
        "average": ("mean", "half and half"),
        "luminosity": ("luminance blend", "value"),
    }
)
"""What other programs call a mode of the merge node."""

_END_ALIASES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "input": ("graph input", "placeholder", "media in", "group input"),
        "output": (
            "write",
            "write node",
            "write file",
            "file output",
            "file out",
            "saver",
            "save",
            "save image",
            "export",
            "render output",
            "composite",
            "viewer",
            "media out",
            "movie file out",
            "group output",
            "graph output",
        ),
    }
)
"""What other programs call the inputs and outputs of a graph: an output is what their write nodes are."""


class CatalogEntry(Struct, frozen=True, dict=True):
    """One entry of the catalog. `id` is a node type, a path (of presets) or a word such as `frame`, by category."""

    id: str
    title: str
    category: str
    doc: str = ""
    kind: str = ""
    """The category that gives the color, if not its own."""
    aliases: tuple[str, ...] = ()
    """The names that other programs have for it."""
    values: tuple[tuple[str, Plain], ...] = ()
    """Values of the new node that are not its defaults."""
    translated: str = ""
    """The title in the chosen language, where the title is a word of the catalogue."""

    @property
    def shown(self) -> str:
        """The title, as the user reads it."""
        return self.translated or self.title

    @cached_property
    def names(self) -> tuple[tuple[tuple[str, ...], bool], ...]:
        """The words of each name, and whether it is an alias. The title of a plug-in's node is one with the name of
        its package and one without: `soft glow (acme glow)`."""
        titles = dict.fromkeys((self.title, self.title.partition(" (")[0], self.shown))
        return (
            *((split_words(title), False) for title in titles),
            *((split_words(alias), True) for alias in self.aliases),
        )

    @property
    def description(self) -> str:
        """The category and doc that are searched; none for groups, inputs and outputs, whose docs are all alike."""
        return f"{self.category} {self.doc}" if self.category not in (GROUP, GRAPH) else ""


def node_entries(types: Mapping[str, type[Node]]) -> tuple[CatalogEntry, ...]:
    """Every node type, in the order of the menu."""
    return tuple(
        CatalogEntry(
            id,
            kind.title,
            kind.category,
            summarize_type(kind),
            aliases=kind.aliases,
            translated=name_type(kind.title),
        )
        for id, kind in types.items()
    )


def mode_entries(types: Mapping[str, type[Node]]) -> tuple[CatalogEntry, ...]:
    """Every way to merge: a merge node with that mode. Only a search lists them."""
    kind = types.get(MERGE)
    modes = kind.values["mode"].choices if kind is not None else ()
    return tuple(
        CatalogEntry(
            MERGE,
            mode,
            kind.category,
            translate("Merge two pictures with the mode {mode}.", mode=name_choice(mode)),
            aliases=(f"merge {mode}", f"{mode} blend", *_MODE_ALIASES.get(mode, ())),
            values=(("mode", mode),),
            translated=name_choice(mode),
        )
        for mode in modes
        if kind is not None
    )


def code_entries() -> tuple[CatalogEntry, ...]:
    """Nodes of new code."""
    doc = translate("GLSL of your own: the function's signature declares sockets and values.")
    return (CatalogEntry(CODE, "code", make_starter_node().category, doc, translated=name_type("code")),)


def shader_entries(files: Iterable[ShaderFile]) -> tuple[CatalogEntry, ...]:
    """ISF shaders of this machine, by the categories that they state."""
    return tuple(
        CatalogEntry(str(file.path), spell_out(file.path.stem), f"ISF {file.category.lower()}", file.doc, SHADER)
        for file in files
    )


def preset_entries(presets: Iterable[PresetFacts]) -> tuple[CatalogEntry, ...]:
    """The presets, which are found by their tags too."""
    return tuple(
        CatalogEntry(
            str(preset.path),
            spell_out(preset.path.stem),
            GROUP,
            preset.fault or translate(preset.about.doc) or translate("A preset: a ready graph, added as a group."),
            aliases=preset.about.tags,
            translated=name_preset(preset.path.stem),
        )
        for preset in presets
    )


def graph_entries() -> tuple[CatalogEntry, ...]:
    """Inputs, outputs, frames and comments."""
    ends = [
        CatalogEntry(
            f"{side}:{kind}",
            f"{kind} {side}".lower(),
            GRAPH,
            doc,
            aliases=_END_ALIASES[side],
            translated=translate(words, kind=translate(kind.lower(), "kind")),
        )
        for side, words, doc in (
            ("input", mark("{kind} input"), translate("The inputs of the graph: what comes from outside.")),
            ("output", mark("{kind} output"), translate("The outputs of the graph: what it gives to the outside.")),
        )
        for kind in Kind
    ]
    return (
        *ends,
        CatalogEntry(
            "frame",
            "frame",
            GRAPH,
            translate("A titled area; the nodes on it move with it."),
            translated=translate("frame", "decor"),
        ),
        CatalogEntry(
            "comment", "comment", GRAPH, translate("A note on the canvas."), translated=translate("comment", "decor")
        ),
    )


class Section(Struct, frozen=True):
    """Entries under a heading."""

    title: str
    entries: tuple[CatalogEntry, ...]


def arrange_entries(entries: Sequence[CatalogEntry], query: str, recent: Sequence[str] = ()) -> tuple[Section, ...]:
    """The sections of the list: the best matches of `query`; without one, the recent entries, then all by category."""
    if query.strip():
        return (Section("", rank_entries(entries, query)),)
    entries = [entry for entry in entries if not entry.values]
    by_id = {entry.id: entry for entry in entries}
    last = tuple(by_id[id] for id in recent if id in by_id)
    groups: dict[str, list[CatalogEntry]] = {}
    for entry in entries:
        groups.setdefault(entry.category, []).append(entry)
    listed = [Section(title, tuple(group)) for title, group in groups.items()]
    return (*([Section("recent", last)] if last else []), *listed)


def keep_fitting(entries: Collection[CatalogEntry], fitting: Collection[str]) -> tuple[CatalogEntry, ...]:
    """The entries that fit a link."""
    fitting_ids = set(fitting)
    return tuple(entry for entry in entries if entry.id in fitting_ids)


def rank_entries(entries: Sequence[CatalogEntry], query: str) -> tuple[CatalogEntry, ...]:
    """The entries that a query finds, best first.

    The better a name fits, the earlier its entry stands: the whole name, its beginning, beginnings of its words; then
    the same of what other programs call it; then names with these letters in order, then descriptions with these
    words. Presets come behind all nodes whose name fits, unless the query is their whole name.
    """
    words = split_words(query)
    letters = {hit.index: hit.score for hit in match(query, [entry.title for entry in entries])}
    ranked: list[tuple[tuple[float, ...], CatalogEntry]] = []
    for index, entry in enumerate(entries):
        fit = min(_measure_fit(words, name, is_alias) for name, is_alias in entry.names)
        if fit == _NONE:
            fit = _LETTERS if index in letters else _DESCRIBED if _says(entry, words) else _NONE
        if fit != _NONE:
            order = 2 if entry.category in (GROUP, GRAPH) else 1 if entry.values else 0
            stands_back = order == 2 and fit != _WHOLE and fit < _LETTERS
            key = (_BEHIND_NODES if stands_back else fit, fit, order, -letters.get(index, 0.0), index)
            ranked.append((key, entry))
    return tuple(entry for _, entry in sorted(ranked, key=lambda pair: pair[0]))


def is_word_match(query: str, name: str) -> bool:
    """True if every word of a query begins a word of a name, or all of them are its beginning."""
    return _measure_fit(split_words(query), split_words(name), is_alias=True) != _NONE


def split_words(text: str) -> tuple[str, ...]:
    """The words of a name in lower case, without signs; capitals begin a word: `TimeWarp` is two."""
    spaced = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", " ", text)
    return tuple(re.findall(r"[a-z0-9]+", spaced.lower()))


_WHOLE, _WHOLE_ALIAS, _START, _WORDS, _START_ALIAS, _WORDS_ALIAS = 0.0, 1.0, 2.0, 3.0, 4.0, 5.0
_BEHIND_NODES, _LETTERS, _DESCRIBED, _NONE = 6.0, 7.0, 8.0, 9.0
"""How a query fits a name, best first."""


def _measure_fit(words: tuple[str, ...], name: tuple[str, ...], is_alias: bool) -> float:
    """How well a query fits one name; small is good."""
    typed, text = "".join(words), "".join(name)
    if not typed:
        return _NONE
    if typed == text:
        return _WHOLE_ALIAS if is_alias else _WHOLE
    if text.startswith(typed) and name[0].startswith(words[0]):
        return _START_ALIAS if is_alias else _START
    if all(any(part.startswith(word) for part in name) for word in words):
        return _WORDS_ALIAS if is_alias else _WORDS
    return _NONE


def _says(entry: CatalogEntry, words: tuple[str, ...]) -> bool:
    """True if every word of the query begins a word of the category or description."""
    text = split_words(entry.description)
    return bool(words) and all(any(part.startswith(word) for part in text) for word in words)
