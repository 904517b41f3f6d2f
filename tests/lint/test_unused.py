"""What is said of branches that lead nowhere: each end once, with how many nodes are before it."""

from __future__ import annotations

import json

import pytest
from halation.lint.checking import GraphChecker
from halation.lint.rules import unused
from halation.resources.sandbox import UNRESTRICTED


def list_sentences(*chains: int) -> list[str]:
    """What is said of a graph with a chain of so many nodes each, beside one node that leads to its output."""
    nodes, links = {"used": {"type": "constant"}}, {"outputs.image": "used.out"}
    for name, count in zip("abc", chains, strict=False):
        ids = [f"{name}{place}" for place in range(count)]
        nodes |= {id: {"type": "exposure"} for id in ids}
        links |= {f"{id}.image": f"{before}.out" for before, id in zip(["used", *ids], ids, strict=False)}
    graph = {"halation": 1, "outputs": {"image": {"type": "Image"}}, "nodes": nodes, "links": links}
    findings = GraphChecker(UNRESTRICTED).check_text(json.dumps(graph), "-", "").findings
    return sorted(item.problem.sentence for item in findings if item.problem.rule is unused.UNUSED_BRANCH)


@pytest.mark.parametrize(
    ("count", "more"),
    [(1, ""), (2, ", nor does the one before it"), (3, ", nor do the 2 before it"), (6, ", nor do the 5 before it")],
)
def test_an_end_says_how_many_are_before_it(count: int, more: str) -> None:
    (sentence,) = list_sentences(count)
    assert sentence == f"'a{count - 1}' leads to no output{more}: link it to something, or remove it"


def test_what_is_used_is_not_spoken_of() -> None:
    assert list_sentences() == []


def test_of_very_many_only_the_first_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """To count those before each of thousands of ends would take long."""
    monkeypatch.setattr(unused, "_MOST_COUNTED", 2)
    first, second, third = list_sentences(3, 2, 3)
    assert "the 2 before it" in first and "before" not in second and "before" not in third
    monkeypatch.setattr(unused, "_MOST_COUNTED", 3)
    first, second, third = list_sentences(3, 2, 3)
    assert "the 2 before it" in first and "the one before it" in second and "before" not in third
