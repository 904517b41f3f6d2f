"""`halation merge`: three files in, one out; conflicts and how they are decided."""

from __future__ import annotations

import json
from pathlib import Path

import pytest


def exposed(stops: float, **more: object) -> dict[str, object]:
    return {"light": {"type": "exposure", "values": {"stops": stops}}, **more}


@pytest.fixture
def fight(cli, graphs, tmp_path) -> Path:
    """A graph with one conflict: 1 became 2 here and 3 there."""
    files = [graphs(f"{name}.json", nodes=exposed(stops)) for name, stops in (("b", 1.0), ("o", 2.0), ("t", 3.0))]
    out = tmp_path / "out.json"
    found = cli("merge", *files, "-o", out)
    assert (found.code, found.out) == (1, "")
    assert found.err == (
        f"{out}: nodes.light.values.stops was changed by both sides of a merge (ours has 2.0, theirs has 3.0): "
        "choose with halation merge --resolve\n"
    )
    return out


def test_a_merge_without_conflicts(cli, graphs, tmp_path):
    base = graphs("b.json")
    ours = graphs("o.json", nodes=exposed(2.0))
    theirs = graphs("t.json", nodes=exposed(1.0, more={"type": "saturation"}))
    found = cli("merge", base, ours, theirs)
    assert (found.code, found.err) == (0, "")
    out = tmp_path / "out.json"
    assert cli("merge", base, theirs, ours, "-o", out).code == 0 and out.read_text() == found.out
    assert cli("fmt", "--check", out).code == 0
    nodes = json.loads(found.out)["nodes"]
    assert nodes["light"]["values"] == {"stops": 2.0} and nodes["more"]["type"] == "saturation"
    assert cli("merge", base, ours, theirs, "--json").json == {"conflicts": [], "merged": found.out}


def test_conflicts_keep_a_graph_from_rendering_until_they_are_decided(cli, fight, tmp_path):
    picture = tmp_path / "p.exr"
    for words in (("check", fight), ("render", fight, "-o", picture), ("explain", fight)):
        found = cli(*words)
        assert found.code == 3 and "nodes.light.values.stops" in found.out + found.err
    assert not picture.exists()
    assert json.loads(fight.read_text())["conflicts"] == [
        {"at": ["nodes", "light", "values", "stops"], "base": 1.0, "ours": 2.0, "theirs": 3.0}
    ]
    assert cli("fmt", "--check", fight).code == 0


@pytest.mark.parametrize(
    ("choice", "stops"),
    [
        ("ours", 2.0),
        ("theirs", 3.0),
        ("base", 1.0),
        ("nodes.light.values.stops=theirs", 3.0),
        ("nodes.light=theirs", 3.0),
    ],
)
def test_resolving(cli, fight, choice, stops):
    found = cli("merge", "--resolve", choice, fight)
    assert (found.code, found.err) == (0, f"{fight}: no conflict is left\n")
    tree = json.loads(fight.read_text())
    assert "conflicts" not in tree and tree["nodes"]["light"]["values"]["stops"] == stops
    assert cli("render", fight, "-o", fight.with_suffix(".exr")).code == 0
    assert cli("merge", "--resolve", choice, fight).code == 2


def test_resolving_one_of_several(cli, graphs, tmp_path):
    sides = [
        graphs(f"{name}.json", nodes=exposed(stops, wide={"type": "saturation", "values": {"saturation": stops}}))
        for name, stops in (("b", 0.5), ("o", 2.0), ("t", 3.0))
    ]
    out = tmp_path / "out.json"
    assert cli("merge", *sides, "-o", out, "--json").code == 1
    found = cli("merge", "--resolve", "nodes.wide=theirs", out, "--json")
    assert found.code == 1
    assert found.json == {"graphs": [{"graph": str(out), "conflicts": ["nodes.light.values.stops"]}]}
    found = cli("merge", "--resolve", "nodes.lihgt=theirs", out)
    assert found.code == 2 and "there is nodes.light.values.stops" in found.err


def test_an_edit_in_place_is_kept_by_ours(cli, fight):
    fight.write_text(fight.read_text().replace('"values": {"stops": 2.0}', '"values": {"stops": 2.5}'))
    assert cli("merge", "--resolve", "ours", fight).code == 0
    assert json.loads(fight.read_text())["nodes"]["light"]["values"]["stops"] == 2.5


@pytest.mark.parametrize(
    "words", [("a",), ("a", "b"), ("-", "-", "a"), ("--resolve", "mine", "a"), ("--resolve", "ours", "a", "-o", "x")]
)
def test_words_that_make_no_sense(cli, words):
    assert cli("merge", *words).code == 2


def test_trouble_is_not_taken_for_a_conflict(cli, graphs, tmp_path):
    good, broken = graphs("a.json"), tmp_path / "broken.json"
    broken.write_text('{"halation": 1, "nodes": 3}')
    found = cli("merge", good, good, broken)
    assert found.code == 3 and f"{broken} (theirs): nodes: " in found.err
    assert cli("merge", good, good, good, "-o", tmp_path / "no" / "x.json").code == 2


def test_a_base_without_text_is_an_empty_graph(cli, graphs, tmp_path):
    """As where both sides added the file."""
    empty, one = tmp_path / "empty.json", graphs("a.json")
    empty.write_text("")
    found = cli("merge", empty, one, one)
    assert found.code == 0 and json.loads(found.out)["nodes"].keys() == {"light"}
    assert cli("merge", one, empty, one).code == 3
