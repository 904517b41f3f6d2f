"""What pages and `halation library --json` say about nodes, against what their classes declare."""

from __future__ import annotations

import json
import math

import pytest
from halation.nodes import Kind, OutputSocket, Socket, catalogue
from halation.reference.facts import node_facts, output_type


@pytest.mark.parametrize("id", catalogue())
def test_facts_are_what_the_class_declares(id: str) -> None:
    node = catalogue()[id]
    facts = json.loads(json.dumps(node_facts(node), allow_nan=False))
    assert (facts["id"], facts["category"], facts["version"]) == (id, node.category, node.version)
    sockets: dict[str, Socket] = {**node.inputs, **{name: output.socket for name, output in node.outputs.items()}}
    said = {**facts["inputs"], **facts["outputs"]}
    assert len(said) == len(sockets) == len(node.inputs) + len(node.outputs), "no input has the name of an output"
    for name, socket in sockets.items():
        channels = str(socket.channels) if socket.kind is Kind.VECTOR else ""
        assert said[name]["type"] == f"{socket.kind.value}{channels}" and said[name]["doc"] == socket.doc
    follows = {name: fact["follows"] for name, fact in facts["outputs"].items() if "follows" in fact}
    assert follows == {name: output.follows for name, output in node.outputs.items() if output.follows}
    for name, value in node.values.items():
        fact = facts["values"][name]
        ends = [*fact["soft"], *fact["hard"]]
        wanted = (value.low, value.high, value.minimum, value.maximum)
        assert ends == [end if math.isfinite(end) else None for end in wanted], name


def test_an_output_that_follows_an_input_may_be_a_field() -> None:
    types = {output_type(output) for output in catalogue()["gaussian_blur"].outputs.values()}
    assert types == {"Image or Field as image"}
    assert output_type(OutputSocket()) == "Image"
