"""Older documents and nodes are brought up to date by pure steps."""

from __future__ import annotations

import json
from typing import Annotated, Any

import pytest
from halation.document import FORMAT, MIGRATIONS, dumps, loads
from halation.errors import DocumentError
from halation.graph import Group
from halation.nodes import Image, Pointwise, Slider
from halation.resources.sandbox import UNRESTRICTED
from toy_nodes import TOYS, Gain


class Glow(Pointwise):
    """Version 1 had `size` in percent, version 2 renamed it to `radius`, version 3 made it a fraction."""

    version = 3

    image = Image()
    radius: Annotated[float, Slider(0.0, 1.0, unit="height")] = 0.25

    @classmethod
    def upgrade(cls, version: int, values: dict[str, Any]) -> dict[str, Any]:
        if version == 1 and "size" in values:
            values = {name: value for name, value in values.items() if name != "size"} | {"radius": values["size"]}
        if version == 2:
            values = {**values, "radius": values.get("radius", 25.0) / 100.0}
        return values


def glow(version: int | None, values: dict[str, Any]) -> str:
    node = {"type": "glow", "values": values} | ({} if version is None else {"version": version})
    return json.dumps({"halation": 1, "nodes": {"g": node}})


@pytest.mark.parametrize(
    ("version", "values", "radius"),
    [
        (1, {"size": 50.0}, 0.5),
        (None, {"size": 50.0}, 0.5),
        (2, {"radius": 50.0}, 0.5),
        (3, {"radius": 0.5}, 0.5),
        (1, {}, 0.25),
    ],
)
def test_nodes_step_up(version: int | None, values: dict[str, Any], radius: float) -> None:
    graph = loads(glow(version, values), catalogue={"glow": Glow}, sandbox=UNRESTRICTED)
    assert graph.nodes["g"] == Glow(radius=radius)
    assert json.loads(dumps(graph))["nodes"]["g"]["version"] == 3


def test_an_upgrade_keeps_unknown_values() -> None:
    graph = loads(glow(1, {"size": 50.0, "other": 1}), catalogue={"glow": Glow}, sandbox=UNRESTRICTED)
    assert graph.extra["nodes.g.values"] == {"other": 1}


def test_an_upgrade_that_fails_says_where() -> None:
    with pytest.raises(
        DocumentError, match=r"nodes\.g\.values: the values do not fit version 2 of 'glow': correct them"
    ):
        loads(glow(2, {"radius": "wide"}), catalogue={"glow": Glow}, sandbox=UNRESTRICTED)
    with pytest.raises(DocumentError, match=r"nodes\.g\.version: version 4 of 'glow' is newer than 3"):
        loads(glow(4, {}), catalogue={"glow": Glow}, sandbox=UNRESTRICTED)


def links_were_lists(body: dict[str, Any]) -> dict[str, Any]:
    return {**body, "links": {end: start for start, end in body.get("links", [])}}


def exposure_was_called_stops(body: dict[str, Any]) -> dict[str, Any]:
    nodes = {
        id: {**node, "type": "gain"} if node["type"] == "stops" else node for id, node in body.get("nodes", {}).items()
    }
    return {**body, "nodes": nodes}


STEPS = {1: links_were_lists, 2: exposure_was_called_stops}
OLD_BODY: dict[str, Any] = {
    "inputs": {"i": {}},
    "outputs": {"o": {}},
    "nodes": {"a": {"type": "stops"}},
    "links": [["inputs.i", "a.image"], ["a.out", "outputs.o"]],
}


def test_documents_step_up_inline_groups_included() -> None:
    old = {**OLD_BODY, "halation": 1, "nodes": {"a": {"type": "stops"}, "g": {"type": "group", "graph": OLD_BODY}}}
    graph = loads(json.dumps(old), catalogue=TOYS, migrations=STEPS, sandbox=UNRESTRICTED)
    group = graph.nodes["g"]
    assert isinstance(group, Group)
    for body in (graph, group.graph):
        assert body.nodes["a"] == Gain()
        assert {str(end): str(start) for end, start in body.links.items()} == {
            "a.image": "inputs.i",
            "outputs.o": "a.out",
        }
    halfway = {**old, "halation": 2, "links": {"a.image": "inputs.i"}, "nodes": {"a": {"type": "stops"}}}
    assert loads(json.dumps(halfway), catalogue=TOYS, migrations=STEPS, sandbox=UNRESTRICTED).nodes["a"] == Gain()


@pytest.mark.parametrize("damage", [{"links": [1]}, {"links": [["a"]]}, {"nodes": 5}, {"nodes": {"a": {}}}])
def test_a_damaged_old_document(damage: dict[str, Any]) -> None:
    with pytest.raises(DocumentError, match=r"halation: the file is damaged: it says format 1.*format 3"):
        loads(
            json.dumps({"halation": 1, "links": [], **damage}), catalogue=TOYS, migrations=STEPS, sandbox=UNRESTRICTED
        )


def test_a_format_from_the_future() -> None:
    with pytest.raises(DocumentError, match=r"halation: format 4 is newer than 3, .*: update Halation"):
        loads('{"halation": 4}', migrations=STEPS, sandbox=UNRESTRICTED)


def test_the_table_has_no_gaps() -> None:
    assert sorted(MIGRATIONS) == list(range(1, FORMAT))
