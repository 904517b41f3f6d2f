"""`halation bench`: every pass is measured, and a baseline decides about the exit code."""

from __future__ import annotations

import json

import pytest

NODES = {
    "blur": {"type": "gaussian_blur", "values": {"sigma": 3.0}},
    "more": {"type": "saturation"},
    "last": {"type": "grade", "values": {"gain": [2.0, 1.0, 1.0, 1.0]}},
}
LINKS = {"blur.image": "light.out", "more.image": "blur.out", "last.image": "more.out", "outputs.image": "last.out"}
FAST = ("-n", "3", "--warm-up", "1")


@pytest.fixture
def graph(graphs):
    return graphs(nodes={**NODES, "more": {"type": "saturation", "values": {"saturation": 0.5}}}, links=LINKS)


def measured(cli, graph, *words, code=0):
    result = cli("bench", graph, *FAST, *words, "--json")
    assert result.code == code, result.err
    return result.json


def test_every_pass_of_the_plan_is_there_with_its_bytes(cli, graph):
    found = measured(cli, graph)
    plan = cli("explain", graph, "--json").json
    assert [(one["nodes"], one["functions"]) for one in found["passes"]] == [
        (one["nodes"], one["functions"]) for one in plan["passes"]
    ]
    for one, planned in zip(found["passes"], plan["passes"], strict=True):
        assert one["read_bytes"] == sum(plan["surfaces"][number]["bytes"] for number in planned["reads"])
        assert one["written_bytes"] == sum(plan["surfaces"][number]["bytes"] for number in planned["writes"])
        assert 0.0 < one["fastest"] <= one["median"]
    assert found["size"] == [48, 32] and found["repeats"] == 3 and found["frames"] == [1]
    assert found["programs"] >= 1 and found["peak_bytes"] > 0 and found["compiling"] > 0.0


def test_nodes_share_passes_and_all_shares_are_the_whole(cli, graph):
    found = measured(cli, graph)
    assert ["more", "last"] in [one["nodes"] for one in found["nodes"]], "fused nodes have one time"
    assert sum(one["passes"] for one in found["nodes"]) == len(found["passes"])
    for name in ("read_bytes", "written_bytes"):
        assert sum(one[name] for one in found["nodes"]) == sum(one[name] for one in found["passes"])
    assert [one["median"] for one in found["nodes"]] == sorted((one["median"] for one in found["nodes"]), reverse=True)
    assert found["fastest"] >= max(one["fastest"] for one in found["passes"])


def test_the_table(cli, graph):
    table = cli("bench", graph, *FAST)
    lines = table.out.splitlines()
    assert table.code == 0 and any(line.startswith("more, last ") for line in lines)
    assert lines[-2].startswith("total ") and "at 48x32; median of 3 by " in lines[-2] and lines[-1].startswith("once ")
    by_pass = cli("bench", graph, *FAST, "--passes").out.splitlines()
    assert len(by_pass) == len(measured(cli, graph)["passes"]) + 2


def test_frames_with_a_history(cli, graphs):
    path = graphs(
        nodes={"trail": {"type": "frame_blend"}},
        settings={"frames": [1, 9]},
        links={"trail.image": "light.out", "outputs.image": "trail.out"},
    )
    found = measured(cli, path, "--frames", "2,5")
    assert found["lead"] == 1 + 4 and found["repeats"] == 6
    assert any("trail" in one["nodes"] for one in found["passes"])


def test_size_scale_and_node(cli, graph):
    assert measured(cli, graph, "--size", "64x16")["size"] == [64, 16]
    assert measured(cli, graph, "--scale", "0.5")["size"] == [24, 16]
    assert {name for one in measured(cli, graph, "--node", "light")["nodes"] for name in one["nodes"]} >= {"light"}


@pytest.fixture
def baseline(cli, graph, tmp_path):
    """A measurement as it would be if everything took a known time; `baseline(factor)` writes it."""
    found = measured(cli, graph)

    def written(factor, **changes):
        scaled = json.loads(json.dumps(found))
        for one in (scaled, *scaled["passes"]):
            one["median"], one["fastest"] = one["median"] * factor, one["fastest"] * factor
        path = tmp_path / "baseline.json"
        path.write_text(json.dumps({**scaled, **changes}))
        return path

    return written


def test_what_became_much_slower_fails(cli, graph, baseline):
    """A baseline of a thousandth of the time, and one of a thousand times the time, leave no room for noise."""
    words = (*FAST, "--compare", baseline(1e-3), "--fail-over", "1.2x")
    failed = cli("bench", graph, *words)
    assert failed.code == 1 and "total: " in failed.out and "are slower than 1.2x" in failed.out
    slower = measured(cli, graph, *words[len(FAST) :], code=1)["compared"]["slower"]
    assert [] in [one["nodes"] for one in slower] and ["more", "last"] in [one["nodes"] for one in slower]
    assert all(one["ratio"] == min(one["median"], one["fastest"]) > 1.2 for one in slower)
    passed = cli("bench", graph, *FAST, "--compare", baseline(1e3), "--fail-over", "1.2")
    assert passed.code == 0 and "nothing is slower than 1.2x" in passed.out
    assert cli("bench", graph, *FAST, "--compare", baseline(1e-3)).code == 0, "without --fail-over it is only said"


def test_passes_that_come_and_go(cli, graph, graphs, baseline):
    path = graphs("other.json", nodes=NODES, links={"blur.image": "light.out", "outputs.image": "blur.out"})
    found = measured(cli, path, "--compare", baseline(1e3), "--fail-over", "2")
    assert found["compared"]["gone"] == 1 and not found["compared"]["slower"]


def test_one_slow_moment_fails_nothing():
    """The median of noise may be high, and so may one lucky baseline be low: both have to be."""
    from halation.renderer.baseline import BaselineComparison, Ratio

    def ratio(median, fastest):
        return Ratio(("blur",), ("gaussian",), median, fastest, 1.0, median)

    found = BaselineComparison((ratio(3.0, 1.01), ratio(1.0, 5.0), ratio(1.4, 1.3), ratio(2.0, 2.0)), 0, 0, "")
    assert [one.smaller for one in found.find_slower(1.2)] == [2.0, 1.3]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--fail-over", "1.2"), "--fail-over: name the file to compare with"),
        (("--compare", "BASE", "--fail-over", "fast"), "--fail-over fast: write a ratio above 0"),
        (("--compare", "BASE", "--fail-over", "-1"), "--fail-over -1: write a ratio above 0"),
        (("--compare", "missing.json"), "--compare missing.json: there is no such file"),
        (("--compare", "GRAPH"), "it is no measurement: make one with halation bench GRAPH --json"),
        (("--compare", "BASE", "--scale", "0.5"), "it was measured at 48x32 pixels, this is 24x16"),
    ],
)
def test_what_makes_no_sense(cli, graph, baseline, words, sentence):
    files = {"BASE": baseline(1.0), "GRAPH": graph}
    result = cli("bench", graph, *FAST, *(files.get(word, word) for word in words))
    assert result.code == 2 and sentence in result.err and result.out == ""


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        '{"median": 1}',
        '{"median": "x", "fastest": 1, "passes": [], "size": [1, 2], "device": ""}',
        '{"median": 0, "fastest": 0, "passes": [], "size": [48, 32], "device": ""}',
        "[" * 100_000,
    ],
)
def test_baselines_that_are_none(cli, graph, tmp_path, text):
    path = tmp_path / "base.json"
    path.write_text(text)
    result = cli("bench", graph, *FAST, "--compare", path)
    assert result.code == 2 and "it is no measurement" in result.err and result.err.count("halation: ") == 1


def test_nothing_to_measure(cli, graphs):
    path = graphs(links={"outputs.image": "inputs.beauty"})
    result = cli("bench", path, *FAST)
    assert result.code in (0, 2) and "bug" not in result.err
