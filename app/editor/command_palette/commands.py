"""The commands of the command palette, and how they are ranked."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec import Struct

from ...authoring.commands import AddGroupFile, AddNode, AppendNode
from ...authoring.edits.element_id import ElementId
from ...custom_nodes.plugins import preset_paths
from ...graph import Group
from ...language.translation import translate
from ..shared.action import ListedAction
from ..shared.declared_words import name_category, name_choice, name_preset, name_type, raise_first, summarize_type
from ..shared.entries import code_entries, is_word_match, mode_entries, spell_out
from ..shared.fuzzy import Match, match

if TYPE_CHECKING:
    from .context import PaletteContext


_ALIAS = 8.0
"""How much less a name of another program counts than a label: as much as the start of a word, so that initials of a
label (`gb`, Gaussian Blur) come before the beginning of an alias (`gbuffer`)."""


class Command(Struct, frozen=True):
    """One line of the palette. `reason` says why it is disabled, "" if it is not."""

    id: str
    label: str
    kind: str
    run: Callable[[], object]
    shortcut: str = ""
    doc: str = ""
    reason: str = ""
    aliases: tuple[str, ...] = ()
    """What other programs call it."""
    weight: float = 0.0
    """Added to the score of a match: commands that are used less often rank lower."""


def list_commands(context: PaletteContext) -> tuple[Command, ...]:
    """Every action, node type, preset, and node of the graph; `run` does it within `editor.attempt`."""
    return tuple(_all(context))


def rank_commands(
    query: str, offered: tuple[Command, ...], recent: Collection[str]
) -> tuple[tuple[Command, Match], ...]:
    """The matching commands, best first; without a query the last used ones, then those that are enabled."""
    labels = tuple(command.label for command in offered)
    matches = [(offered[ranked.index], ranked) for ranked in match(query, labels)]
    if query.strip():
        matches = _add_aliases(query, offered, matches)

        def worth(pair: tuple[Command, Match]) -> tuple[bool, float, int]:
            return bool(pair[0].reason), -pair[1].score - pair[0].weight, pair[1].index

        return tuple(sorted(matches, key=worth))
    order = {id: place for place, id in enumerate(reversed(tuple(recent)))}
    last = len(order)
    return tuple(sorted(matches, key=lambda pair: (order.get(pair[0].id, last), bool(pair[0].reason), pair[1].index)))


def _add_aliases(
    query: str, offered: tuple[Command, ...], matches: list[tuple[Command, Match]]
) -> list[tuple[Command, Match]]:
    """The matches, and the commands that other programs call so; what fits both ways counts as the better one.

    The words of the query must begin words of the alias: letters in order, which do for labels, would be too many.
    """
    by_index = {ranked.index: ranked for _, ranked in matches}
    for index, command in enumerate(offered):
        fitting = [alias for alias in command.aliases if is_word_match(query, alias)]
        if not fitting:
            continue
        score = max((ranked.score for ranked in match(query, fitting)), default=0.0) - _ALIAS
        if index not in by_index or by_index[index].score < score:
            by_index[index] = Match(index, score, ())
    return [(offered[index], ranked) for index, ranked in by_index.items()]


def explain_disabled(context: PaletteContext, action: ListedAction) -> str:
    """Why an action is disabled, "" if it is not."""
    if context.actions.is_enabled(action):
        return ""
    if action.id == "edit.undo":
        return translate("nothing to undo")
    if action.id == "edit.redo":
        return translate("nothing to redo")
    return (
        translate("select something first")
        if action.scope == "graph" and not context.session.selection
        else translate("not available now")
    )


def _all(context: PaletteContext) -> Iterator[Command]:
    """Every command. A weight below 0 puts what is rarely meant behind commands that match a text as well."""
    yield from _list_actions(context)
    yield from _list_additions(context)
    for path in preset_paths():
        name = _head(spell_out(path.stem), name_preset)
        opens, adds = partial(context.documents.open_preset, path), partial(_add_preset, context, path)
        yield Command(
            f"preset {path.stem}", translate("Open Preset {name}", name=name), translate("Preset"), opens, weight=-4.0
        )
        yield Command(
            f"group {path.stem}", translate("Add Preset {name}", name=name), translate("Preset"), adds, weight=-5.0
        )
    for id, item in context.session.graph.nodes.items():
        kind = translate("Group", "element") if isinstance(item, Group) else translate("Node")
        yield Command(
            f"go {id}", translate("Go to {id}", id=id), kind, partial(_go, context, ElementId(id)), weight=-6.0
        )


def _list_actions(context: PaletteContext) -> Iterator[Command]:
    for action in context.actions.all:
        label = translate(action.label).removesuffix("...")
        menu = [translate(name, "menu") for name in action.menu.split("/")]
        full = f"{menu[1]} {label}" if len(menu) > 1 and menu[1].lower() not in label.lower() else label
        yield Command(
            action.id,
            full,
            menu[0] or translate("Action"),
            partial(context.actions.run, action.id),
            context.actions.shortcut(action.id),
            translate(action.doc),
            explain_disabled(context, action),
        )


def _list_additions(context: PaletteContext) -> Iterator[Command]:
    """The commands that add a node."""
    for id, type in context.session.types.items():
        yield Command(
            f"add {id}",
            translate("Add {title}", title=_head(type.title, name_type)),
            raise_first(name_category(type.category)),
            partial(_add, context, id),
            doc=summarize_type(type),
            aliases=(*type.aliases, type.title),
        )
    for entry in mode_entries(context.session.types):
        yield Command(
            f"merge {entry.title}",
            translate("Add Merge {title}", title=_head(entry.title, name_choice)),
            raise_first(name_category(entry.category)),
            partial(_append, context, AddNode(entry.id, context.canvas.pointer, values=entry.values)),
            doc=entry.doc,
            aliases=entry.aliases,
            weight=-1.0,
        )
    for entry in code_entries():
        yield Command(
            f"add {entry.id}", translate("Add Code"), translate("Code"), partial(_add, context, entry.id), doc=entry.doc
        )


def _head(title: str, name: Callable[[str], str]) -> str:
    """A title as `name` translates it, in English with a capital letter at the beginning of each word."""
    words = name(title)
    return title.title() if words == title else words


def _add(context: PaletteContext, type_id: str) -> None:
    _append(context, AddNode(type_id, context.canvas.pointer))


def _add_preset(context: PaletteContext, path: Path) -> None:
    _append(context, AddGroupFile(path, context.canvas.pointer))


def _append(context: PaletteContext, addition: AddNode | AddGroupFile) -> None:
    id = context.session.apply(AppendNode(addition, context.canvas.sizes))
    context.canvas.reveal((ElementId(id),))


def _go(context: PaletteContext, element: ElementId) -> None:
    context.session.select(element)
    context.canvas.fit((element,))
