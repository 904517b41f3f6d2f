"""Checking takes work in proportion to the file. Work is counted in calls; how long it takes is for tests/bench."""

from __future__ import annotations

import importlib
import io
import json
import sys
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from halation.cli import options
from halation.document import limits
from halation.document.positions import Positions
from halation.errors import DocumentError, InputError
from halation.graph import enough
from halation.graph.enough import MAX_FINDINGS
from halation.graph.names import can_compare_all
from halation.inputs.provider import MediaProvider
from halation.lint import compiled
from halation.lint.checking import CheckReport, GraphChecker
from halation.lint.compiled import NotingProvider
from halation.lint.rules import unused
from halation.nodes import Kind
from halation.resources.picture import Picture
from halation.resources.provider import PictureProbe
from halation.resources.sandbox import UNRESTRICTED
from halation.resources.suggestions import limit_suggestions, may_compare
from large_graphs import GRAPHS, TEXTS, chain, change, coded, fan, missing
from msgspec.structs import replace
from oiio_pictures import write_picture


def check(text: str) -> CheckReport:
    return GraphChecker(sandbox=UNRESTRICTED).check_text(text, "a.json", "")


def count_calls(function: Callable[[], object]) -> int:
    """How many functions are called meanwhile, those of C included."""
    count = 0

    def trace(frame: object, event: str, argument: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(trace)
    try:
        function()
    finally:
        sys.setprofile(None)
    return count


@pytest.mark.parametrize("name", sorted(GRAPHS))
def test_four_times_the_graph_is_four_times_the_work(name: str) -> None:
    check(json.dumps(chain(5)))  # what is made once
    small, large = (json.dumps(GRAPHS[name](count)) for count in (150, 600))
    ratio = count_calls(lambda: check(large)) / count_calls(lambda: check(small))
    assert ratio < 5.0, f"{ratio:.1f} times the calls"


def test_a_file_that_is_missing_is_looked_for_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """A node that reads a picture asks for three layers of it."""
    asked_paths: list[str] = []
    ask = MediaProvider.probe_picture

    def count(self: MediaProvider, picture: Picture) -> PictureProbe:
        asked_paths.append(picture.path)
        return ask(self, picture)

    monkeypatch.setattr(MediaProvider, "probe_picture", count)
    report = check(json.dumps(missing(3)))
    assert [finding.problem.node for finding in report.findings if finding.code] == ["r0", "r1", "r2"]
    assert sorted(asked_paths) == ["r0.exr", "r1.exr", "r2.exr"]


def test_of_many_missing_files_the_first_are_looked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """To look for each of 40,000 took 20 s."""
    monkeypatch.setattr(compiled, "MAX_FINDINGS", 5)
    report = check(json.dumps(missing(30)))
    sentences = [finding.problem.sentence for finding in report.findings if finding.code]
    assert report.code == InputError.exit_code and len(sentences) == 7
    assert "more than 5 files cannot be read: no others were looked for" in sentences


def test_a_picture_outside_of_its_folder_says_nothing_about_others_of_its_name(tmp_path: Path) -> None:
    """A shader may read only pictures of its folder; a node may read the same file."""
    write_picture(tmp_path / "a.exr", np.zeros((2, 2, 4), np.float32))
    provider = NotingProvider(UNRESTRICTED)
    picture = Picture(str(tmp_path / "a.exr"), "", Kind.IMAGE, 4)
    provider.probe_picture(replace(picture, within=str(tmp_path / "shaders")))
    assert provider.faults.popitem() and provider.probe_picture(picture).size == (2, 2)
    assert not provider.faults
    provider.probe_picture(replace(picture, within=str(tmp_path / "shaders")))
    assert len(provider.faults) == 1


@pytest.mark.parametrize(
    ("name", "most"),
    [
        ("chain", 170),
        ("fan", 150),
        ("distinct", 240),
        ("mistyped", 85),
        ("mislinked", 200),
        ("deep", 170),
        ("animated", 400),
    ],
)
def test_a_node_is_checked_with_few_calls(name: str, most: int) -> None:
    """A file may hold 100,000 nodes, and a million calls take a second at most."""
    check(json.dumps(GRAPHS[name](5)))
    small, large = (json.dumps(GRAPHS[name](count)) for count in (1000, 2000))
    assert (count_calls(lambda: check(large)) - count_calls(lambda: check(small))) / 1000 < most


def test_only_some_missing_files_are_compared_with_what_is_there(tmp_path: Path) -> None:
    """A folder was listed and compared for each: a minute for 40,000 files."""
    for number in range(300):
        (tmp_path / f"s{number}.exr").touch()
    checker = GraphChecker(sandbox=UNRESTRICTED)
    few, many = (json.dumps(missing(count)) for count in (500, 1000))
    few_calls, many_calls = (
        count_calls(lambda text=t: checker.check_text(text, "a", str(tmp_path))) for t in (few, many)
    )
    assert (many_calls - few_calls) / 500 < 3000  # 40,000 where each is compared


def test_a_missing_file_still_gets_a_suggestion(tmp_path: Path) -> None:
    (tmp_path / "r0x.exr").touch()
    report = GraphChecker(sandbox=UNRESTRICTED).check_text(json.dumps(missing(1)), "a", str(tmp_path))
    assert any("did you mean 'r0x.exr'?" in finding.problem.sentence for finding in report.findings)


def test_the_code_of_a_graph_is_bounded() -> None:
    """A second of processor time for each million letters, and a class for each code."""
    nodes = limits.MAX_CODE // limits.LEAST_CODE
    (finding,) = check(json.dumps(coded(nodes + 1))).findings
    assert finding.problem.at == f"nodes.n{nodes}" and "the code of the graph has more than" in finding.problem.sentence
    graph = coded(3)
    for number in range(3):
        graph["nodes"][f"n{number}"]["code"].append("//" + "x" * (limits.MAX_CODE // 3))
    assert check(json.dumps(graph)).findings[0].problem.at == "nodes.n2"


def test_the_same_code_counts_once() -> None:
    graph = coded(4)
    for number in range(4):
        graph["nodes"][f"n{number}"] = graph["nodes"]["n0"] | {"muted": False}
        graph["nodes"]["n0"]["code"][1:] = ["//" + "x" * (limits.MAX_CODE // 2)]
    assert check(json.dumps(graph)).code == 0


@pytest.mark.parametrize("name", sorted(TEXTS))
def test_memory_stays_in_proportion_to_the_text(name: str) -> None:
    """Paths of parts were spelled in full: gigabytes for 40,000 brackets."""
    text = TEXTS[name](40_000)
    tracemalloc.start()
    try:
        assert check(text).findings
        assert tracemalloc.get_traced_memory()[1] < 60 * len(text) + (20 << 20)
    finally:
        tracemalloc.stop()


def test_no_more_than_a_thousand_faults_are_looked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    graph = fan(MAX_FINDINGS + 500)
    for node in list(graph["nodes"].values())[1:]:
        node["type"] = "exposre"
    explained: list[str] = []
    problems = importlib.import_module("halation.graph.problems")
    explain = problems.explain_unknown

    def count(id: str, *rest: Any) -> Any:
        explained.append(id)
        return explain(id, *rest)

    monkeypatch.setattr(problems, "explain_unknown", count)
    report = check(json.dumps(graph))
    assert len(report.findings) == MAX_FINDINGS and report.more
    assert MAX_FINDINGS - 1 <= len(explained) <= MAX_FINDINGS
    assert report.code == 3 and "did you mean 'exposure'" in report.findings[1].problem.sentence


def test_no_more_warnings_are_made_than_are_wanted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nodes that lead nowhere; an error behind them is still found."""
    found: list[Any] = []
    make = unused.Problem

    def count(*facts: Any) -> Any:
        found.append(facts)
        return make(*facts)

    monkeypatch.setattr(unused, "Problem", count)
    report = check(json.dumps(fan(MAX_FINDINGS + 500)))
    assert len(report.findings) == MAX_FINDINGS and report.more and report.code == 0
    assert len(found) <= MAX_FINDINGS + 1


def test_allowed_warnings_are_looked_at_ten_thousand_times(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(enough, "MAX_SEEN", 30)
    graph = change(fan(100), settings={"allow": {"unused-branch": "shown elsewhere", "not-canonical": "by hand"}})
    report = check(json.dumps(graph))
    assert not report.findings and report.more


def test_a_graph_with_few_faults_says_that_these_are_all() -> None:
    graph = fan(5)
    graph["links"]["n3.image"] = "nothing.out"
    report = check(json.dumps(graph))
    assert report.code == 3 and not report.more


def test_names_of_all_nodes_are_not_listed_for_each_fault() -> None:
    """An expression that names no control was compared with all nodes, which were listed anew for each."""
    graph = fan(1000)
    graph["animation"] = {f"n{number}.stops": {"expression": f"odd{number} * 2"} for number in range(1000)}
    report = check(json.dumps(graph))
    assert len(report.findings) == MAX_FINDINGS and "there is no control 'odd0'" in report.findings[0].problem.sentence
    with limit_suggestions():
        while may_compare(20):
            pass
        assert not can_compare_all(["a"])


def test_lines_behind_the_last_finding_are_not_read() -> None:
    """The text of 99,000 nodes was read to its end for a fault in the first."""
    nodes = {f"n{number}": {"type": "noise", "values": {"a": {}}} for number in range(2000)}
    short, long = (json.dumps({"nodes": dict(list(nodes.items())[:count])}, indent=1) for count in (100, 2000))
    paths = ("nodes.n1", "nodes.n7.values.a")
    calls = [count_calls(lambda text=text: Positions(text, paths, first=True)) for text in (short, long)]
    assert calls[0] == calls[1]
    line = long.count("\n", 0, long.index('"n7"')) + 4  # the node, its type, its values, and the first of them
    assert [Positions(long, paths, first=first).line(paths[1]) for first in (True, False)] == [line, line]


def test_of_many_unknown_keys_the_first_are_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(enough, "MAX_FINDINGS", 5)
    report = check(json.dumps(change(chain(2), **{f"x{number}": 1 for number in range(40)}), indent=1))
    assert [finding.problem.at for finding in report.findings] == [f"x{number}" for number in range(5)]


def test_a_sentence_does_not_name_all_of_many_long_groups() -> None:
    body: dict[str, object] = {"nodes": {"n": {"type": "x"}}, "outputs": {"a": {}}}
    for _ in range(18):
        body = {"nodes": {"g" * 900: {"type": "group", "graph": body}}}
    sentences = [finding.problem.sentence for finding in check(json.dumps({"halation": 1, **body})).findings]
    assert 4000 < max(map(len, sentences)) < 6000
    assert any(sentence.endswith("or remove the node") for sentence in sentences)


def test_errors_are_not_left_out_for_warnings() -> None:
    graph = fan(MAX_FINDINGS + 500)
    graph["links"]["n7.image"] = "nothing.out"
    report = check(json.dumps(graph))
    assert any("nothing" in finding.problem.sentence for finding in report.findings) and report.code == 3


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("[" * 100 + "]" * 100, "nest deeper than 64"),
        (json.dumps({"halation": 1, "ui": {"k" * (limits.MAX_KEY + 1): 1}}), "has 1,001 characters"),
        ('{"halation": 1, "ui": [' + "0," * limits.MAX_PARTS + "0]}", "more than 1,500,000 parts"),
    ],
    ids=["depth", "key", "parts"],
)
def test_what_is_too_large_is_refused(text: str, sentence: str) -> None:
    (finding,) = check(text).findings
    assert sentence in finding.problem.sentence and finding.code == 3


def test_brackets_in_strings_are_not_parts() -> None:
    report = check(json.dumps({**chain(2), "ui": {"note": "[{," * limits.MAX_PARTS}}))
    assert report.code == 0


class EndlessInput:
    """Standard input that never ends. `count` bytes have been read."""

    def __init__(self) -> None:
        self.buffer, self.count = self, 0

    def read(self, count: int = -1) -> bytes:
        assert 0 <= count <= 2 * limits.MAX_BYTES, "all of it is read"
        self.count += count
        return b" " * count


def test_standard_input_is_bounded_as_files_are(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", EndlessInput())
    with pytest.raises(DocumentError, match="more than 32 MB"):
        options.read_standard_input()
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b'{"a": 1}')))
    assert options.read_standard_input() == '{"a": 1}'
