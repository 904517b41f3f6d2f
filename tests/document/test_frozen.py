"""Files as released versions wrote them. A frozen file is never edited: what it says must stay readable forever."""

from __future__ import annotations

from pathlib import Path

import pytest
from halation import document
from halation.graph import Group, Port, Settings, Unknown
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED

FROZEN = sorted((Path(__file__).parent / "frozen").glob("*.json"))


@pytest.mark.parametrize("path", FROZEN, ids=lambda path: path.stem)
def test_a_file_of_this_format_is_saved_as_it_was(path):
    graph = document.load(path, sandbox=UNRESTRICTED)
    if path.stem == f"format{document.FORMAT}":
        assert document.dumps(graph) == path.read_text(encoding="utf-8")
    assert document.loads(document.dumps(graph), sandbox=UNRESTRICTED) == graph


def test_every_format_has_a_frozen_file():
    assert [path.stem for path in FROZEN] == [f"format{number}" for number in range(1, document.FORMAT + 1)]


@pytest.mark.parametrize("path", FROZEN, ids=lambda path: path.stem)
def test_it_means_what_it_meant(path):
    graph = document.load(path, sandbox=UNRESTRICTED)
    assert graph.settings == Settings((960, 540))
    assert graph.inputs["beauty"].file == "shot.exr" and graph.inputs["beauty"].layer == "Combined"
    assert (graph.inputs["motion"].kind, graph.inputs["motion"].socket().channels) == (Kind.VECTOR, 2)
    assert graph.inputs["gain"].default == 0.5
    assert graph.value(Port("bloom", "intensity")) == 0.1 and graph.value(Port("bloom", "mode")) == "add"
    assert graph.muted == {"grade"}
    assert graph.links[Port("grade", "stops")] == Port("inputs", "gain")
    assert graph.controls["glow"].target == Port("bloom", "intensity")
    assert graph.outputs["depth"].layer == "Z"
    look = graph.nodes["look"]
    assert isinstance(look, Group) and look.values["amount"] == -2.0
    assert isinstance(graph.nodes["future"], Unknown)
