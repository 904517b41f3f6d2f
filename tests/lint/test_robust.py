"""Whatever a file holds, checking ends with sentences that have lines."""

from __future__ import annotations

import json
from copy import deepcopy
from pathlib import Path
from random import Random

from halation.document import dumps
from halation.lint.checking import RULES, GraphChecker
from halation.lint.sarif import sarif
from halation.nodes import catalogue
from halation.resources.sandbox import UNRESTRICTED
from hypothesis import given, settings
from hypothesis import strategies as st
from lint_graphs import DIM, chain

PRESETS = sorted((Path(__file__).parents[2] / "presets").glob("*.json"))
TEXTS = [path.read_text("utf-8") for path in PRESETS]
CHECKER = GraphChecker(sandbox=UNRESTRICTED)
ODD = [
    None,
    True,
    -1,
    0,
    1e308,
    2**70,
    "",
    "x",
    "a.b",
    "inputs.beauty",
    "bloom",
    "group",
    "/x\\y",
    "####",
    "\u0000",
    "none",
    "é" * 300,
    [],
    [1.0],
    [0.0] * 9,
    {},
    {"type": "bloom"},
    {"type": "group", "graph": {}},
    {"expression": "1/0"},
]


def parts(tree: object) -> list[tuple[dict | list, str | int]]:
    """Every place in a tree, as holder and key."""
    keys = tree if isinstance(tree, dict) else range(len(tree)) if isinstance(tree, list) else ()
    return [place for key in keys for place in ((tree, key), *parts(tree[key]))]


def looked_at(text: str) -> None:
    report = CHECKER.check_text(text, "a.json", str(PRESETS[0].parent))
    last = text.count("\n") + 1
    for finding in report.findings:
        assert RULES[finding.problem.rule.name] is finding.problem.rule
        assert 1 <= finding.line <= last and finding.problem.sentence
        assert (finding.code == 0) == (finding.problem.severity == "warning")
    json.dumps(sarif([report], RULES, Path.cwd(), "1"))


@settings(max_examples=150)
@given(st.integers(0, len(TEXTS) - 1), st.randoms(use_true_random=False))
def test_a_part_is_something_else(index, rng: Random) -> None:
    tree = json.loads(TEXTS[index])
    for _ in range(rng.randint(1, 3)):
        holder, key = rng.choice(parts(tree))
        act = rng.random()
        if act < 0.6:
            holder[key] = deepcopy(rng.choice(ODD))
        elif act < 0.8 or isinstance(holder, list):
            del holder[key]
        else:
            holder[rng.choice(["a.b", "x", "", key + "x", "glow.image"])] = holder.pop(key)
    looked_at(json.dumps(tree, indent=rng.choice((None, 2))))


@settings(max_examples=60)
@given(st.integers(0, len(TEXTS) - 1), st.randoms(use_true_random=False))
def test_text_is_cut_or_spoiled(index, rng: Random) -> None:
    text = TEXTS[index]
    at = rng.randrange(len(text))
    rest = text[at:]
    looked_at(text[:at] + rng.choice(["", rest[5:], "\n<<<<<<< a\n" + rest, '"' + rest, "}" + rest]))


def test_nodes_of_older_versions_are_named() -> None:
    newer = type("Grade", (catalogue()["grade"],), {"version": 3, "__module__": catalogue()["grade"].__module__})
    checker = GraphChecker(UNRESTRICTED, frozenset({"unbound-input"}))
    checker.types = {**catalogue(), "grade": newer}
    text = dumps(chain(DIM, DIM)).replace('"version": 1', '"version": 2', 1)
    found = [
        (one.problem.node, one.line)
        for one in checker.check_text(text, "", "").findings
        if one.problem.rule.name == "old-version"
    ]
    first = next(number for number, line in enumerate(text.splitlines(), 1) if '"a": {' in line)
    assert [node for node, _ in found] == ["a", "b"] and found[0][1] == first
