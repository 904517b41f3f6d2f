"""What is wrong with a live graph: values that an editor shows on the node, not exceptions."""

from __future__ import annotations

import builtins
import math
from collections.abc import Collection, Iterator, Mapping
from typing import Any, ClassVar

from halation.nodes import ItemSet, Node, catalogue
from msgspec.structs import replace

from ..errors import GraphError
from ..resources.picture import MAX_SIDE
from ..resources.record import Record
from ..resources.suggestions import limit_suggestions
from . import rules
from .enough import Enough
from .evaluate_at_frame import animation_fault, find_expression_loops
from .graph import Graph, Group, Item, find_setting, signature
from .model import MAX_GROUP_DEPTH, Input, Port, Unknown
from .named_items import find_item_faults
from .names import INPUTS, OUTPUTS, can_compare_all, did_you_mean, find_name_fault, name_fault, pick
from .rules import Rule, Severity
from .unknown_nodes import explain_unknown
from .unmerged import CONFLICTS, find_unmerged
from .values import coerce_numbers, sequence_fault, value_fault
from .walk import describe_loop, find_loops, has_loops

CONTROLS = "controls"
"""The `node` of a problem with a control."""


_FILE_KEYS = ("inputs", "outputs", "controls", "nodes", "links", "settings", "animation", "ui")
_NODE_KEYS = ("type", "version", "values", "muted", "code", "file", "path", "graph", "package")
"""Keys of a graph file, and of a node in it, that a similar unknown key may stand for."""

_LONG = 4000
"""Letters of a sentence that names no more of the groups around it: ids may be long, and groups deep."""


class Problem(Record, frozen=True):
    """A mistake in a graph. `sentence` names node and socket and says what to do.

    `node` is a path such as `group/inner`; it ends in `inputs`, `outputs` or `controls` for the ends of a graph, and is
    empty for the graph as a whole. `at` is the JSON path of what is wrong, where node and socket do not say it.
    """

    node: str
    socket: str
    sentence: str
    rule: Rule
    at: str = ""

    compare_exclude: ClassVar[frozenset[str]] = frozenset({"at"})

    @property
    def severity(self) -> Severity:
        """An error keeps that part of the graph from rendering, a warning does not."""
        return self.rule.severity


def problems(graph: Graph, node_types: Mapping[str, type[Node]] | None = None) -> tuple[Problem, ...]:
    """Everything that is wrong, groups included, in a stable order; of very much the first: see `Enough`.

    `node_types` are the installed ones, for suggestions. An input without file or default is none: it may be bound.
    """
    enough = Enough()
    with limit_suggestions():
        problems_ = list(enough.take(find_problems(graph, node_types, enough)))
    return tuple(sorted(problems_, key=lambda item: (item.severity, item.node, item.socket, item.sentence)))


def find_problems(
    graph: Graph, node_types: Mapping[str, type[Node]] | None = None, enough: Enough | None = None
) -> Iterator[Problem]:
    """What `problems` returns, one after the other in the order of the graph: there may be more than fit into memory.

    Warnings that are not wanted any more are not made. Call it inside of `limit_suggestions`.
    """
    return _inside(graph, catalogue() if node_types is None else node_types, enough or Enough(), 0)


def recheck(
    graph: Graph,
    before: Graph,
    earlier_problems: tuple[Problem, ...],
    node_types: Mapping[str, type[Node]] | None = None,
) -> tuple[Problem, ...]:
    """The same as `problems(graph, node_types)`; `earlier_problems` are those of the graph `before`.

    It costs nothing where only values of nodes differ that had no problem and have none now, as while one is dragged.
    """
    if not differ_in_nodes(graph, before):
        return problems(graph, node_types)
    changed = {id: item for id, item in graph.nodes.items() if item is not before.nodes[id]}
    faulty = {problem.node for problem in earlier_problems}
    for id, item in changed.items():
        like = isinstance(item, Node) and type(item) is type(before.nodes[id])
        if not like or id in faulty or any(_values(id, item)):
            return problems(graph, node_types)
    return earlier_problems


def differ_in_nodes(graph: Graph, before: Graph) -> bool:
    """True if all that can have changed are nodes of the same ids, and the layout."""
    parts = ("links", "inputs", "outputs", "controls", "animation", "settings", "extra")
    return all(getattr(graph, part) is getattr(before, part) for part in parts) and [*graph.nodes] == [*before.nodes]


def _inside(graph: Graph, node_types: Mapping[str, type[Node]], enough: Enough, depth: int) -> Iterator[Problem]:
    yield from _ends(graph)
    yield from _links(graph)
    needed = graph.upstream(OUTPUTS)
    sound_nodes = set[int]()  # files that say the same of many nodes make one object of them
    has_odd_names = find_name_fault(graph.nodes, "node") is not None
    for id, item in graph.nodes.items():
        if has_odd_names and (fault := name_fault(id, "node")):
            yield Problem(id, "", fault, rules.BAD_NAME)
        if isinstance(item, Unknown):
            sentence, rule = explain_unknown(id, item, node_types)
            yield Problem(id, "", sentence, rule, f"nodes.{id}")
            continue
        if builtins.id(item) not in sound_nodes:
            value_problems = [*_values(id, item)]
            yield from value_problems
            if not value_problems:
                sound_nodes.add(builtins.id(item))
        yield from _check_inputs(graph, id, item, id in needed, enough)
        if isinstance(item, Group):
            yield from _group(id, item, node_types, enough, depth)
    feeding = {id: graph.feeding[id] for id in graph.nodes}
    for loop in find_loops(feeding, in_order=True) if has_loops(feeding) else ():
        yield Problem(loop[0], "", describe_loop(loop), rules.LOOP)
    yield from _animations(graph)
    yield from _settings(graph)
    yield from _leftovers(graph, enough)
    for node, socket, sentence, at in find_unmerged(graph.extra):
        yield Problem(node, socket, sentence, rules.UNMERGED, at)


def _animations(graph: Graph) -> Iterator[Problem]:
    for port, item in graph.animation.items():
        if isinstance(graph.nodes.get(port.node), Unknown):
            continue
        if fault := animation_fault(graph, port, item):
            yield Problem(port.node, port.socket, fault, rules.BAD_ANIMATION, f"animation.{port}")
        elif port in graph.links:
            sentence = f"'{port}' is linked, so that its keys do nothing"
            yield Problem(port.node, port.socket, sentence, rules.DEAD_ANIMATION, f"animation.{port}")
    for port, fault in find_expression_loops(graph):
        yield Problem(port.node, port.socket, fault, rules.BAD_ANIMATION, f"animation.{port}")


def _settings(graph: Graph) -> Iterator[Problem]:
    first, last = graph.settings.frames or (1, 1)
    if last < first:
        sentence = f"the frames {first} to {last} run backwards: exchange the two"
        yield Problem("", "", sentence, rules.BACKWARD_FRAMES, "settings.frames")
    width, height = graph.settings.size or (1, 1)
    if max(width, height) > MAX_SIDE:
        sentence = f"a canvas of {width}x{height} pixels is too large: each side may have at most {MAX_SIDE:,}"
        yield Problem("", "", sentence, rules.HUGE_CANVAS, "settings.size")


def _group(id: str, item: Group, node_types: Mapping[str, type[Node]], enough: Enough, depth: int) -> Iterator[Problem]:
    if depth == MAX_GROUP_DEPTH:
        sentence = f"group '{id}': groups nest deeper than {MAX_GROUP_DEPTH}; flatten some of them"
        yield Problem(id, "", sentence, rules.DEEP_GROUPS)
        return
    for problem in _inside(item.graph, node_types, enough, depth + 1):
        where = f"{id}/{problem.node}" if problem.node else id
        at = f"nodes.{id}.{f'graph.{problem.at}' if not item.path else 'path'}" if problem.at else ""
        prefix = f"in group '{id}': " if len(problem.sentence) < _LONG else ""
        yield replace(problem, node=where, sentence=f"{prefix}{problem.sentence}", at=at)


def _links(graph: Graph) -> Iterator[Problem]:
    for target, fault in graph.find_link_faults():
        source = graph.links[target]
        has_node = source.node in graph.nodes or source.node == OUTPUTS
        is_reversed = has_node and graph.link_fault(target, source) is None
        hint = f'; a link names its target first: write "{source}": "{target}"' if is_reversed else ""
        sentence = f"'{source}' cannot feed '{target}': {fault}{hint}"
        yield Problem(target.node, target.socket, sentence, rules.BAD_LINK, f"links.{target}")


def _check_inputs(graph: Graph, id: str, item: Item, needed: bool, enough: Enough) -> Iterator[Problem]:
    for name, socket in signature(item).inputs.items():
        if not socket.optional and Port(id, name) not in graph.links:
            # A node that nothing uses yet is unfinished, not wrong.
            rule = rules.UNLINKED_INPUT if needed else rules.UNFINISHED_NODE
            if not enough.wants(rule.severity):
                continue
            article = "an" if socket.kind[0] in "AEIOU" else "a"
            sentence = f"'{id}.{name}' is not linked: it needs {article} {socket.kind}"
            yield Problem(id, name, sentence, rule, f"nodes.{id}")


def _values(id: str, item: Item) -> Iterator[Problem]:
    node = item if isinstance(item, Node) else None
    values = node.values if node else signature(item).values
    settings: Mapping[str, Any] = node.settings if node else item.values if isinstance(item, Group) else {}
    for name, value in values.items():
        setting = settings.get(name, value.default)
        if node and (node.length_units or value.listed_in):
            value = node.declaration(name)
        if value.items:
            for path, fault in find_item_faults(value, setting) if setting is not value.default else ():
                place = ".".join((name, *path))
                yield Problem(id, name, f"{id}.{place}: {fault}", rules.BAD_VALUE, f"nodes.{id}.values.{place}")
        elif setting is not value.default and (fault := value_fault(value, setting)):
            yield Problem(id, name, f"{id}.{name}: {fault}", rules.BAD_VALUE, f"nodes.{id}.values.{name}")
    for name in item.values if isinstance(item, Group) else ():
        if name not in values:
            sentence = f"group '{id}' has no control '{name}'{did_you_mean(name, values)}"
            yield Problem(id, name, sentence, rules.UNKNOWN_CONTROL, f"nodes.{id}.values.{name}")


def _ends(graph: Graph) -> Iterator[Problem]:
    for name, end in graph.inputs.items():
        if fault := name_fault(name, "input"):
            yield Problem(INPUTS, name, fault, rules.BAD_NAME)
        elif fault := _default_fault(name, end):
            yield Problem(INPUTS, name, fault, rules.BAD_DEFAULT, f"inputs.{name}.default")
        elif fault := sequence_fault(end.file):
            yield Problem(INPUTS, name, f"input '{name}': {fault}", rules.BAD_VALUE, f"inputs.{name}.file")
    for name in graph.outputs:
        if fault := name_fault(name, "output"):
            yield Problem(OUTPUTS, name, fault, rules.BAD_NAME)
        if Port(OUTPUTS, name) not in graph.links:
            sentence = f"nothing feeds the output '{name}': link a node to '{OUTPUTS}.{name}'"
            yield Problem(OUTPUTS, name, sentence, rules.UNFED_OUTPUT, f"outputs.{name}")
    for name, control in graph.controls.items():
        if fault := name_fault(name, "control"):
            yield Problem(CONTROLS, name, fault, rules.BAD_NAME)
        elif fault := _control_fault(graph, name, control.target):
            yield Problem(CONTROLS, name, fault, rules.BAD_CONTROL, f"controls.{name}.target")
    if not graph.outputs:
        yield Problem("", "", "the graph has no outputs: add one and link a node to it", rules.NO_OUTPUT)


def _control_fault(graph: Graph, name: str, target: Port) -> str | None:
    try:
        item = graph.node(target.node)
        interface = signature(item)
        if not interface.anything and find_setting(item, target.socket) is None:
            pick(interface.values, target.socket, f"node '{target.node}' has no value")
    except GraphError as error:
        return f"control '{name}' points at '{target}': {error}"
    return None


def _default_fault(name: str, end: Input) -> str | None:
    channels = end.width
    default = (end.default,) if isinstance(end.default, int | float) else end.default
    fits = coerce_numbers(default, 1) or coerce_numbers(default, channels)
    if default is None or (fits and all(map(math.isfinite, fits))):
        return None
    expected_form = "a number" if channels == 1 else f"a number or a list of {channels} numbers"
    return f"input '{name}': the default {end.default!r} does not fit: {end.kind} takes {expected_form}"


def _suggest_key(key: str, keys: Collection[str]) -> str:
    """The key of the format that the user may mean, as the end of a sentence; "" if none is similar.

    One of the same name does not help: it stands where it means nothing, such as the version of a node of code.
    """
    hint = did_you_mean(key, [name for name in keys if name != key]) if can_compare_all(keys) else ""
    return hint if "did you mean" in hint else ""


def _suggest_value(item: Item, path: list[str], key: str) -> str:
    """What an unknown value, or an unknown kind or field of a named item, may mean."""
    values = signature(item).values
    value = find_setting(item, path[0]) if path else None
    if value is None or value.items is None:
        return did_you_mean(key, values)
    if len(path) == 1:
        return f": its kind is none of {', '.join(value.items.by_name)}"
    named = value.default.get(path[1]) if isinstance(value.default, ItemSet) else None
    return did_you_mean(key, value.items.by_name[named.kind].fields) if named else ""


def _leftovers(graph: Graph, enough: Enough) -> Iterator[Problem]:
    """Unknown keys are kept, but whoever mistyped one should hear of it."""
    for path, keys in graph.extra.items():
        parts = path.split(".")
        item = graph.nodes.get(parts[1]) if len(parts) >= 3 and parts[0] == "nodes" else None
        for key in keys:
            if not enough.wants(rules.UNKNOWN_KEY.severity):
                return
            if not path and key in ("$schema", CONFLICTS):  # the first is for editors of text
                continue
            if item is None:
                hint = _suggest_key(key, _FILE_KEYS if not path else _NODE_KEYS if parts[0] == "nodes" else ())
            else:
                hint = _suggest_value(item, parts[3:], key)
            where = f"{path}.{key}" if path else key
            node = parts[1] if len(parts) > 1 else ""
            if key == "package" and len(parts) == 2 and getattr(graph.nodes.get(parts[1]), "required_package", ""):
                continue
            sentence = f"{where} means nothing to this version and is only kept{hint}"
            yield Problem(node, "", sentence, rules.UNKNOWN_KEY, where)
