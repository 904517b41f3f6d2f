"""A difference in words: one line for everything that changed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from difflib import unified_diff
from typing import Any, Final, Literal

from ...graph import Graph
from .difference import Difference, difference
from .parts import ABSENT, CONFLICTS, At, Tree, is_list, is_tree, local, names_of, path_of, same
from .wording import animation_text, end_text, item_text, key_text, pair, text, value_at

Sign = Literal["+", "-", "~"]
_ORDER: Final = ("nodes", "links", "animation", "inputs", "outputs", "controls", "settings")
_WORD: Final = {"inputs": "input", "outputs": "output", "controls": "control"}


@dataclass(frozen=True)
class Line:
    """Something that was added, removed or changed; `below` are the lines of code that did."""

    sign: Sign
    words: str
    below: tuple[str, ...] = ()


def told(wanted: Difference, before: Graph, after: Graph) -> tuple[Line, ...]:
    """What a difference of two graphs says, renamed nodes first, then by section, node and value."""
    found = [Line("~", f"node {'/'.join((*one.group, one.old))} is now called {one.new}") for one in wanted.renamed]
    gone = {change.at for change in wanted.changes if change.after is ABSENT}
    for change in sorted(
        wanted.changes, key=lambda change: _ORDER.index(change.at[0]) if change.at[0] in _ORDER else len(_ORDER)
    ):
        if change.at not in gone or not _goes_with(change.at, gone):
            found += _Telling(change.at, (after, before)).lines(change.before, change.after)
    return tuple(found)


def facts(graph: Graph) -> tuple[str, ...]:
    """A graph without its layout, as lines of one fact each, so that those who compare lines compare facts."""
    found: list[str] = []
    for change in difference(Graph(), graph).changes:
        for line in _Telling(change.at, (graph, graph), exact=True).whole(change.after):
            found += [line.words, *(f"    {one}" for one in line.below)]
    return tuple(found)


@dataclass(frozen=True)
class _Telling:
    """The words for a part; `graphs` know its unit."""

    at: At
    graphs: tuple[Graph, ...]
    exact: bool = False

    @property
    def name(self) -> str:
        """What people call the part: ids of groups with slashes between, then `node.value` or the like."""
        groups = [str(self.at[place]) for place in range(1, len(self.at) - len(local(self.at)), 3)]
        here = local(self.at)
        if here[:1] in (("nodes",), ("links",), ("animation",)):
            here = here[1:]
            here = (here[0], *here[2:]) if here[1:2] == ("values",) else here
        return "/".join([*groups, path_of(here)])

    @property
    def value(self) -> Any:
        """What is declared of it."""
        return next((value for graph in self.graphs if (value := value_at(graph, self.at))), None)

    def lines(self, before: Any, after: Any) -> Iterator[Line]:
        """What changed."""
        here = local(self.at)
        if len(here) == 2 and here[0] == "nodes" and is_tree(before) and is_tree(after):
            yield from self._replaced(before, after)
        elif len(here) == 3 and here[0] == "nodes" and here[2] == "muted":
            yield Line("~", f"node {self._up().name} {'is muted' if after is True else 'works again'}")
        elif is_list(before) and is_list(after) and here[0] == "nodes" and here[2:] == ("code",):
            yield Line("~", f"{self.name}:", _code(before, after))
        elif here[0] == "links" and isinstance(before, str) and isinstance(after, str):
            yield Line("~", f"link {self.name}: {before} -> {after}")
        elif here[0] == "animation" and is_tree(before) and is_tree(after) and len(here) == 2:
            one, other = (animation_text(item, self.value) for item in (before, after))
            yield Line("~", f"animation of {self.name}: {one} -> {other}")
        elif here[0] == "animation" and len(here) == 5:
            what = "" if here[4] == "value" else f" {here[4]}"
            yield Line("~", f"{self._up().name} at {here[3]:g}{what}: {pair(before, after, self.value)}")
        elif ABSENT in (before, after) and (said := self._entry(after if before is ABSENT else before)):
            yield Line("-" if after is ABSENT else "+", said)
        else:
            yield Line("~", f"{self._kind()}{self.name}: {pair(before, after, self.value)}")

    def whole(self, part: Any) -> Iterator[Line]:
        """Everything that there is to say of a part that is there."""
        here = local(self.at)
        if len(here) != 2 or here[0] != "nodes":
            yield Line("+", self._entry(part) or f"{self._kind()}{self.name}: {text(part, self.value, self.exact)}")
            return
        yield Line("+", f"node {self.name}: {item_text(part)}")
        yield from self._parts(part, lambda inner, item: inner.whole(item))

    def _parts(self, node: Tree, each: Callable[[_Telling, Any], Iterator[Line]]) -> Iterator[Line]:
        """The same for all that a node holds."""
        for key, part in sorted(node.items()):
            if key == "values":
                for name, plain in sorted(part.items()):
                    yield from each(self._down("values", name), plain)
            elif key == "graph" and is_tree(part):
                for section in (name for name in part if name != "ui"):
                    for name, entry in sorted(part[section].items()) if is_tree(part[section]) else ():
                        yield from each(self._down("graph", section, name), entry)
            elif key == "code" and is_list(part):
                yield Line("+", f"{self._down(key).name}:", tuple(map(str, part)))
            elif key not in ("type", "version", "muted", "path"):
                yield from each(self._down(key), part)

    def _replaced(self, before: Tree, after: Tree) -> Iterator[Line]:
        """A node of another type, or with another sort of body."""
        one, other = item_text(before), item_text(after)
        if one != other:
            yield Line("~", f"node {self.name}: {one} -> {other}")
        for key in names_of(iter((before, after))):
            old, new = before.get(key, ABSENT), after.get(key, ABSENT)
            if key in ("type", "muted", "path", "graph") or same(old, new):
                continue
            if key == "values":
                values = [part if is_tree(part) else {} for part in (old, new)]
                for name in names_of(iter(values)):
                    pairs = [part.get(name, ABSENT) for part in values]
                    if not same(*pairs):
                        yield from self._down("values", name)._set(*pairs)
            else:
                yield from self._down(key).lines(old, new)

    def _set(self, before: Any, after: Any) -> Iterator[Line]:
        """A value of a node whose type changed: each end has its own unit and default."""
        new, old = (value_at(graph, self.at) for graph in self.graphs)
        yield Line("~", f"{self.name}: {text(before, old)} -> {text(after, new)}")

    def _entry(self, part: Any) -> str:
        """What was added or removed, if it stands for itself; a value that is set does not."""
        here = local(self.at)
        if here[0] == "links" and len(here) == 2:
            return f"link {self.name} <- {part}"
        if here[0] == "animation":
            if len(here) == 2 and is_tree(part):
                return f"animation of {self.name}: {animation_text(part, self.value, self.exact)}"
            if len(here) == 4 and is_tree(part):
                return f"key of {self._up().name} at {here[3]:g}: {key_text(part, self.value, self.exact)}"
            return ""
        if not is_tree(part) or len(here) != 2:
            return ""
        if here[0] == CONFLICTS:
            return f"conflict: {path_of(tuple(part['at']))}"
        if here[0] == "nodes":
            set_values = part.get("values")
            values = (
                [
                    f"{name} {text(plain, self._down('values', name).value)}"
                    for name, plain in sorted(set_values.items())
                ]
                if is_tree(set_values)
                else []
            )
            return f"node {self.name}: {', '.join([item_text(part), *values])}"
        return f"{_WORD[str(here[0])]} {self._named()}: {end_text(part, self.exact)}" if here[0] in _WORD else ""

    def _named(self) -> str:
        section, name = (str(part) for part in local(self.at)[:2])
        return self.name.replace(f"{section}.{name}", name)

    def _kind(self) -> str:
        here = local(self.at)
        if here[0] == "animation":
            return ""
        return "layout " if here[0] == "ui" else ""

    def _down(self, *keys: str) -> _Telling:
        return _Telling((*self.at, *keys), self.graphs, self.exact)

    def _up(self) -> _Telling:
        """The part that holds this one; what holds a key is the animation."""
        here = local(self.at)
        beyond = len(here) - 2 if here[0] == "animation" else 1
        return _Telling(self.at[:-beyond], self.graphs)


def _goes_with(at: At, gone: set[At]) -> bool:
    """True for a link to, or keys of, a node that is gone too."""
    here = local(at)
    if len(here) != 2 or here[0] not in ("links", "animation"):
        return False
    return (*at[:-2], "nodes", str(here[1]).partition(".")[0]) in gone


def _code(before: list[Any], after: list[Any]) -> tuple[str, ...]:
    """The lines that changed, with one around them."""
    lines = unified_diff([*map(str, before)], [*map(str, after)], n=1, lineterm="")
    return tuple(lines)[2:]
