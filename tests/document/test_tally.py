"""A file whose text is small enough may still hold more parts than can be read quickly."""

from __future__ import annotations

import json
from typing import Any

import pytest
from halation.document import limits, loads
from halation.errors import DocumentError
from halation.graph.expressions.tokens import MAX_LENGTH
from large_graphs import animated, chain, change, controlled, document, keyed

MOST = 6


@pytest.fixture(autouse=True)
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("MAX_ENDS", "MAX_ALL_ENDS", "MAX_LINKS", "MAX_KEYS", "MAX_WORDS", "MAX_ALLOWED"):
        monkeypatch.setattr(limits, name, MOST)


def ends(section: str, count: int) -> dict[str, Any]:
    """A graph with so many entries in a section of ends, and no others."""
    entry = {"target": "n.scale"} if section == "controls" else {"type": "Image"}
    graph = change(document({"n": {"type": "noise"}}, {}), outputs={})
    return graph | {section: {f"e{number}": entry for number in range(count)}}


def formulas(*texts: str) -> dict[str, Any]:
    """A graph with one expression for each node."""
    entries = {f"n{number}.stops": {"expression": text} for number, text in enumerate(texts)}
    return change(chain(3), animation=entries)


CASES = [
    ("inputs", lambda count: ends("inputs", count), "inputs"),
    ("outputs", lambda count: ends("outputs", count), "outputs"),
    ("controls", lambda count: ends("controls", count), "controls"),
    ("links", lambda count: chain(count - 1), "links"),
    ("keys", keyed, "animation"),
    ("words", lambda count: formulas(" + ".join("1" * ((count + 1) // 2)) + " -" * (1 - count % 2)), "animation"),
    ("allowed", lambda count: change(chain(2), settings={"allow": {f"r{i}": "" for i in range(count)}}), "settings"),
]


@pytest.mark.parametrize(("build", "section"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_one_part_more_is_refused(build: Any, section: str) -> None:
    loads(json.dumps(build(MOST)), sandbox=None)
    with pytest.raises(DocumentError, match=f"more than {MOST} .*; that is no graph") as caught:
        loads(json.dumps(build(MOST + 1)), sandbox=None)
    assert caught.value.path.partition(".")[0] == section


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


def test_a_hundred_thousand_nodes_with_formulas_are_a_graph(monkeypatch: pytest.MonkeyPatch) -> None:
    """Scaled to a hundredth: each node has a link, and an expression of three words."""
    for name in ("MAX_LINKS", "MAX_WORDS"):
        monkeypatch.setattr(limits, name, (3 if name == "MAX_LINKS" else 5) * 1000)
    assert len(loads(json.dumps(animated(990)), sandbox=None).animation) == 989


def test_what_is_no_expression_does_not_count() -> None:
    assert limits.MAX_FORMULA == MAX_LENGTH
    loads(json.dumps(formulas("1+" * MAX_LENGTH)), sandbox=None)
