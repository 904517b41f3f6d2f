"""A file whose text is small enough may still hold more parts than can be read quickly."""

from __future__ import annotations

import json
from random import Random
from typing import Any

import pytest
from halation.document import limits, loads
from halation.document.tally import count_parts
from halation.errors import DocumentError
from halation.graph.expressions.tokens import MAX_LENGTH
from large_graphs import animated, chain, change, controlled, document, keyed

MOST = 6
MOSTS = (
    *("MAX_ENDS", "MAX_ALL_ENDS", "MAX_LINKS", "MAX_KEYS", "MAX_WORDS", "MAX_ALLOWED", "MAX_ODD", "MAX_KEPT"),
    *("MAX_LAYOUT", "MAX_TEXTS", "MAX_LETTERS", "MAX_FILES", "MAX_ITEMS", "MAX_NUMBERS", "MAX_UNITS"),
)


@pytest.fixture(autouse=True)
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in MOSTS:
        monkeypatch.setattr(limits, name, MOST)
    for name in ("LEAST_WORDS", "LEAST_KEYS"):
        monkeypatch.setattr(limits, name, 0)


def ends(section: str, count: int) -> dict[str, Any]:
    """A graph with so many entries in a section of ends, and no others."""
    entry = {"target": "n.scale"} if section == "controls" else {"type": "Image"}
    graph = change(document({"n": {"type": "noise"}}, {}), outputs={})
    return graph | {section: {f"e{number}": entry for number in range(count)}}


def formulas(*texts: str) -> dict[str, Any]:
    """A graph with one expression for each node."""
    entries = {f"n{number}.stops": {"expression": text} for number, text in enumerate(texts)}
    return change(chain(3), animation=entries)


def group(path: str) -> dict[str, Any]:
    return {"type": "group", "path": path}


def blur(sigma: float) -> dict[str, Any]:
    return {"type": "gaussian_blur", "values": {"sigma": sigma}, "units": {"sigma": "height"}}


def key(count: int) -> dict[str, Any]:
    """A key of so many parts besides those that each has."""
    return {"frame": 1, "value": [0.0] * (count + 1)}


def nodes(type: str, count: int, **values: Any) -> dict[str, Any]:
    """So many nodes of a type, which differ in their values."""
    return document(
        {f"n{i}": {"type": type, "values": {name: make(i) for name, make in values.items()}} for i in range(count)}, {}
    )


def mislinked(count: int) -> dict[str, Any]:
    """Links from nothing, beside as few others as there may be."""
    return change(chain(1), links={f"x{number}.image": "n.out" for number in range(count)})


CASES = [
    ("inputs", lambda count: ends("inputs", count), "inputs"),
    ("outputs", lambda count: ends("outputs", count), "outputs"),
    ("controls", lambda count: ends("controls", count), "controls"),
    ("links", lambda count: chain(count - 1), "links"),
    ("keys", keyed, "animation"),
    ("words", lambda count: formulas(" + ".join("1" * ((count + 1) // 2)) + " -" * (1 - count % 2)), "animation"),
    ("odd nodes", lambda count: nodes("odd", count), "nodes"),
    ("odd keys", lambda count: change(chain(1), **{f"x{i}": 0 for i in range(count)}), ""),
    ("odd values", lambda count: nodes("noise", 1, **{f"x{i}": lambda _: 0 for i in range(count)}), "nodes"),
    ("kept parts", lambda count: change(chain(1), x=[0] * (count - 1)), ""),
    ("layout", lambda count: change(chain(1), ui={"x": [0] * (count - 1)}), "ui"),
    ("texts", lambda count: nodes("text", count, text=str), "nodes"),
    ("letters", lambda count: nodes("text", 1, text=lambda _: "x" * count), "nodes"),
    ("files", lambda count: nodes("read_image", count, path=str), "nodes"),
    ("files of groups", lambda count: document({f"n{i}": group(str(i)) for i in range(count)}, {}), "nodes"),
    ("units", lambda count: document({f"n{i}": blur(0.1 * i) for i in range(count)}, {}), "nodes"),
    ("numbers of keys", lambda count: change(chain(1), animation={"n0.stops": {"keys": [key(count)]}}), "animation"),
    ("allowed", lambda count: change(chain(2), settings={"allow": {f"r{i}": "" for i in range(count)}}), "settings"),
]


@pytest.mark.parametrize(("build", "section"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_one_part_more_is_refused(build: Any, section: str) -> None:
    loads(json.dumps(build(MOST)), sandbox=None)
    with pytest.raises(DocumentError, match=f"more than {MOST} .*; that is no graph") as caught:
        loads(json.dumps(build(MOST + 1)), sandbox=None)
    assert caught.value.path.partition(".")[0] == section or not section


def make_tree(rng: Random, depth: int = 0) -> Any:
    """Entries whose names and texts JSON must escape, or that look like its parts."""
    text = "".join(rng.choices('"\\[]{},:x\n', k=rng.randrange(6)))
    if depth and rng.random() < 0.4:
        return rng.choice((text, None, 1.5))
    parts = [make_tree(rng, depth + 1) for _ in range(rng.randrange(4 - depth // 2))]
    return parts if rng.random() < 0.5 else {f"{text}{at}": part for at, part in enumerate(parts)}


@pytest.mark.parametrize("seed", range(40))
def test_parts_are_those_that_a_walk_finds(seed: int) -> None:
    """Each object and list, and a comma between two entries, whatever the texts hold."""
    tree = make_tree(Random(seed))

    def walk(part: Any) -> int:
        if not isinstance(part, list | dict):
            return 0
        entries = part.values() if isinstance(part, dict) else part
        return 1 + max(len(part) - 1, 0) + sum(map(walk, entries))

    assert count_parts(tree) == walk(tree)


def test_parts_of_groups_count_too() -> None:
    """The controls of a group, in a file with few ends of its own."""
    with pytest.raises(DocumentError, match="more than") as caught:
        loads(json.dumps(controlled(MOST + 1)), sandbox=None)
    assert caught.value.path.startswith("nodes.g.graph.")


def test_equal_formulas_are_read_once() -> None:
    loads(json.dumps(formulas("1 + 2 + 3", "1 + 2 + 3", "1 + 2 + 3")), sandbox=None)
    with pytest.raises(DocumentError, match="words and signs"):
        loads(json.dumps(formulas("1 + 2 + 3", "1 + 2 + 4")), sandbox=None)
    graph = loads(json.dumps(formulas("frame", "frame", "time")), sandbox=None)
    first, second, third = graph.animation.values()
    assert first is second and first is not third


def test_values_that_equal_formulas_read_count_each_time() -> None:
    texts = ["n0.stops * 2"] * (MOST - 3 + 1)
    loads(json.dumps(formulas(*texts)), sandbox=None)
    with pytest.raises(DocumentError, match="words and signs"):
        loads(json.dumps(formulas(*texts, texts[0])), sandbox=None)


def test_ten_thousand_formulas_are_a_graph(monkeypatch: pytest.MonkeyPatch) -> None:
    """Scaled to a hundredth: each node has a link, and an expression of three words."""
    for name, most in (("MAX_LINKS", 300), ("MAX_WORDS", 500), ("MAX_ODD", 300)):
        monkeypatch.setattr(limits, name, most)
    monkeypatch.setattr(limits, "LEAST_WORDS", 5)
    assert len(loads(json.dumps(animated(101)), sandbox=None).animation) == 100
    with pytest.raises(DocumentError, match="words and signs"):
        loads(json.dumps(animated(102)), sandbox=None)


def test_named_items_are_counted_before_they_are_made() -> None:
    """What an item holds counts too, as numbers."""
    lights = {f"l{number}": 0 for number in range(MOST + 1)}
    with pytest.raises(DocumentError, match="more than 6 named items"):
        loads(json.dumps(nodes("deferred_lighting", 1, lights=lambda _: lights)), sandbox=None)


def test_links_from_nothing_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "MAX_LINKS", 2 * MOST)
    loads(json.dumps(mislinked(MOST)), sandbox=None)
    with pytest.raises(DocumentError, match="more than 6 links from or to nodes that are not there") as caught:
        loads(json.dumps(mislinked(MOST + 1)), sandbox=None)
    assert caught.value.path == "links.x0.image"


def test_a_loop_is_named_in_a_graph_of_many_links(monkeypatch: pytest.MonkeyPatch) -> None:
    """One of few links is read, so that it can be repaired."""
    monkeypatch.setattr(limits, "MAX_LINKS", 2 * MOST)
    for count, refused in ((MOST - 1, False), (MOST, True)):
        graph = chain(count)
        graph["links"]["n0.image"] = "n1.out"
        if refused:
            with pytest.raises(DocumentError, match="the nodes n0 -> n1 -> n0 form a loop"):
                loads(json.dumps(graph), sandbox=None)
        else:
            assert loads(json.dumps(graph), sandbox=None).links


def test_what_is_no_expression_does_not_count() -> None:
    assert limits.MAX_FORMULA == MAX_LENGTH
    loads(json.dumps(formulas("1+" * MAX_LENGTH)), sandbox=None)
