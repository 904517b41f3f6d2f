"""A difference in words: one line for each change."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from difflib import unified_diff
from typing import Any, Final, Literal

from msgspec import Struct

from ...graph import Graph
from .difference import GraphDifference, compare_graphs
from .parts import (
    ABSENT,
    CONFLICTS,
    PartPath,
    Tree,
    equals,
    is_list,
    is_named_item,
    is_tree,
    local_path,
    path_text,
    sort_keys,
)
from .wording import animation_text, change_text, end_text, item_text, key_text, value_at, value_text

Sign = Literal["+", "-", "~"]
_ORDER: Final = ("nodes", "links", "animation", "inputs", "outputs", "controls", "settings")
_WORD: Final = {"inputs": "input", "outputs": "output", "controls": "control"}


class DifferenceLine(Struct, frozen=True):
    """A line about an addition, removal or change; `below` are its changed lines of code."""

    sign: Sign
    words: str
    below: tuple[str, ...] = ()


def describe_difference(changes: GraphDifference, before: Graph, after: Graph) -> tuple[DifferenceLine, ...]:
    """The lines that describe a difference: renamed nodes first, then by section, node and value."""
    lines = [
        DifferenceLine("~", f"node {'/'.join((*renamed.group, renamed.old))} is now called {renamed.new}")
        for renamed in changes.renamed
    ]
    removed = {change.at for change in changes.changes if change.after is ABSENT}
    for change in sorted(
        changes.changes, key=lambda change: _ORDER.index(change.at[0]) if change.at[0] in _ORDER else len(_ORDER)
    ):
        if change.at not in removed or not _goes_with(change.at, removed):
            lines += _PartDescription(change.at, (after, before)).describe_change(change.before, change.after)
    return tuple(lines)


def describe_graph(graph: Graph) -> tuple[str, ...]:
    """The lines that describe a graph without its layout: one fact a line, for tools that compare lines."""
    lines: list[str] = []
    for change in compare_graphs(Graph(), graph).changes:
        for line in _PartDescription(change.at, (graph, graph), exact=True).describe_whole(change.after):
            lines += [line.words, *(f"    {detail}" for detail in line.below)]
    return tuple(lines)


class _PartDescription(Struct, frozen=True):
    """Describes one part; its unit and default are looked up in `graphs`."""

    at: PartPath
    graphs: tuple[Graph, ...]
    exact: bool = False

    @property
    def name(self) -> str:
        """The name of the part for users: ids of groups with slashes between, then `node.value` or the like."""
        groups = [str(self.at[place]) for place in range(1, len(self.at) - len(local_path(self.at)), 3)]
        here = local_path(self.at)
        if here[:1] in (("nodes",), ("links",), ("animation",)):
            here = here[1:]
            here = (here[0], *here[2:]) if here[1:2] == ("values",) else here
        return "/".join([*groups, path_text(here)])

    @property
    def value(self) -> Any:
        """The declaration of the value, if the part is one."""
        return next((value for graph in self.graphs if (value := value_at(graph, self.at))), None)

    def describe_change(self, before: Any, after: Any) -> Iterator[DifferenceLine]:
        """The lines for a change of the part."""
        here = local_path(self.at)
        if len(here) == 2 and here[0] == "nodes" and is_tree(before) and is_tree(after):
            yield from self._describe_replaced(before, after)
        elif len(here) == 3 and here[0] == "nodes" and here[2] == "muted":
            yield DifferenceLine("~", f"node {self._parent().name} {'is muted' if after is True else 'works again'}")
        elif is_list(before) and is_list(after) and here[0] == "nodes" and here[2:] == ("code",):
            yield DifferenceLine("~", f"{self.name}:", _code(before, after))
        elif here[0] == "links" and isinstance(before, str) and isinstance(after, str):
            yield DifferenceLine("~", f"link {self.name}: {before} -> {after}")
        elif here[0] == "animation" and is_tree(before) and is_tree(after) and len(here) == 2:
            text_before, text_after = (animation_text(item, self.value) for item in (before, after))
            yield DifferenceLine("~", f"animation of {self.name}: {text_before} -> {text_after}")
        elif here[0] == "animation" and len(here) == 5:
            aspect = "" if here[4] == "value" else f" {here[4]}"
            yield DifferenceLine(
                "~", f"{self._parent().name} at {here[3]:g}{aspect}: {change_text(before, after, self.value)}"
            )
        elif ABSENT in (before, after) and (sentence := self._entry(after if before is ABSENT else before)):
            yield DifferenceLine("-" if after is ABSENT else "+", sentence)
        else:
            yield DifferenceLine("~", f"{self._kind()}{self.name}: {change_text(before, after, self.value)}")

    def describe_whole(self, part: Any) -> Iterator[DifferenceLine]:
        """The lines for a part that exists."""
        here = local_path(self.at)
        if is_tree(part) and self.value and self.value.items:
            for name, fields in sorted(part.items()):
                for field, plain in sorted(fields.items()):
                    yield from self._child(name, field).describe_whole(plain)
        elif len(here) != 2 or here[0] != "nodes":
            yield DifferenceLine(
                "+", self._entry(part) or f"{self._kind()}{self.name}: {value_text(part, self.value, self.exact)}"
            )
        else:
            yield DifferenceLine("+", f"node {self.name}: {item_text(part)}")
            yield from self._describe_parts(part, lambda inner, item: inner.describe_whole(item))

    def _describe_parts(
        self, node: Tree, each: Callable[[_PartDescription, Any], Iterator[DifferenceLine]]
    ) -> Iterator[DifferenceLine]:
        """The lines for each part of a node."""
        for key, part in sorted(node.items()):
            if key == "values":
                for name, plain in sorted(part.items()):
                    yield from each(self._child("values", name), plain)
            elif key == "graph" and is_tree(part):
                for section in (name for name in part if name != "ui"):
                    for name, entry in sorted(part[section].items()) if is_tree(part[section]) else ():
                        yield from each(self._child("graph", section, name), entry)
            elif key == "code" and is_list(part):
                yield DifferenceLine("+", f"{self._child(key).name}:", tuple(map(str, part)))
            elif key not in ("type", "version", "muted", "path"):
                yield from each(self._child(key), part)

    def _describe_replaced(self, before: Tree, after: Tree) -> Iterator[DifferenceLine]:
        """The lines for a node whose type or kind of body changed."""
        text_before, text_after = item_text(before), item_text(after)
        if text_before != text_after:
            yield DifferenceLine("~", f"node {self.name}: {text_before} -> {text_after}")
        for key in sort_keys(iter((before, after))):
            old, new = before.get(key, ABSENT), after.get(key, ABSENT)
            if key in ("type", "muted", "path", "graph") or equals(old, new):
                continue
            if key == "values":
                values = [part if is_tree(part) else {} for part in (old, new)]
                for name in sort_keys(iter(values)):
                    pairs = [part.get(name, ABSENT) for part in values]
                    if not equals(*pairs):
                        yield from self._child("values", name)._describe_value(*pairs)
            else:
                yield from self._child(key).describe_change(old, new)

    def _describe_value(self, before: Any, after: Any) -> Iterator[DifferenceLine]:
        """A value of a node whose type changed: each end has its own unit and default."""
        new, old = (value_at(graph, self.at) for graph in self.graphs)
        yield DifferenceLine("~", f"{self.name}: {value_text(before, old)} -> {value_text(after, new)}")

    def _entry(self, part: Any) -> str:
        """The sentence for a part that was added or removed; "" if the sentence of another part covers it."""
        here = local_path(self.at)
        if here[0] == "links" and len(here) == 2:
            return f"link {self.name} <- {part}"
        if here[0] == "animation":
            if len(here) == 2 and is_tree(part):
                return f"animation of {self.name}: {animation_text(part, self.value, self.exact)}"
            if len(here) == 4 and is_tree(part):
                return f"key of {self._parent().name} at {here[3]:g}: {key_text(part, self.value, self.exact)}"
            return ""
        if is_tree(part) and is_named_item(here) and (holder := self._parent().value) and holder.items:
            fields = [
                f"{name} {value_text(plain, self._child(name).value)}"
                for name, plain in sorted(part.items())
                if name != "kind"
            ]
            return f"{holder.items.noun} {self.name}: {', '.join([str(part.get('kind')), *fields])}"
        if not is_tree(part) or len(here) != 2:
            return ""
        if here[0] == CONFLICTS:
            return f"conflict: {path_text(tuple(part['at']))}"
        if here[0] == "nodes":
            set_values = part.get("values")
            values = (
                [
                    f"{name} {value_text(plain, self._child('values', name).value)}"
                    for name, plain in sorted(set_values.items())
                ]
                if is_tree(set_values)
                else []
            )
            return f"node {self.name}: {', '.join([item_text(part), *values])}"
        return f"{_WORD[str(here[0])]} {self._end_name()}: {end_text(part, self.exact)}" if here[0] in _WORD else ""

    def _end_name(self) -> str:
        section, name = (str(part) for part in local_path(self.at)[:2])
        return self.name.replace(f"{section}.{name}", name)

    def _kind(self) -> str:
        here = local_path(self.at)
        if here[0] == "animation":
            return ""
        return "layout " if here[0] == "ui" else ""

    def _child(self, *keys: str) -> _PartDescription:
        return _PartDescription((*self.at, *keys), self.graphs, self.exact)

    def _parent(self) -> _PartDescription:
        """The part that holds this one; that of a key is the animation."""
        here = local_path(self.at)
        beyond = len(here) - 2 if here[0] == "animation" else 1
        return _PartDescription(self.at[:-beyond], self.graphs)


def _goes_with(at: PartPath, removed: set[PartPath]) -> bool:
    """True for a link to a deleted node, or keys of one: the line of the node covers them."""
    here = local_path(at)
    if len(here) != 2 or here[0] not in ("links", "animation"):
        return False
    return (*at[:-2], "nodes", str(here[1]).partition(".")[0]) in removed


def _code(before: list[Any], after: list[Any]) -> tuple[str, ...]:
    """The lines that changed, with one around them."""
    lines = unified_diff([*map(str, before)], [*map(str, after)], n=1, lineterm="")
    return tuple(lines)[2:]
