"""The table of links: every kind against every kind, and against every type of value."""

from __future__ import annotations

import re
from itertools import product
from typing import Any

import pytest
from halation.errors import GraphError
from halation.graph import Graph, Input, Port, conversion, did_you_mean
from halation.graph.conversion import make_socket
from halation.nodes import Kind, Pointwise, Socket, catalogue
from toy_nodes import Gain

KINDS = {
    "Image": make_socket(Kind.IMAGE),
    "Field": make_socket(Kind.FIELD),
    "Number": make_socket(Kind.NUMBER),
    "Color": make_socket(Kind.COLOR),
    **{f"Vector{width}": make_socket(Kind.VECTOR, width) for width in (2, 3, 4)},
}

FITS = {
    "Image": "Image",
    "Field": "Image Field Vector2 Vector3 Vector4",
    "Number": "Image Field Number Color Vector2 Vector3 Vector4",
    "Color": "Image Color",
    "Vector2": "Vector2",
    "Vector3": "Vector3",
    "Vector4": "Vector4",
}

VALUES = {
    "gain": "Number Field",
    "steps": "Number Field",
    "clamp": "Number Field",
    "mode": "",
    "note": "",
    "tint": "Color Image Field Number",
    "center": "Vector2 Field Number",
}


@pytest.mark.parametrize(("source", "target"), list(product(KINDS, KINDS)))
def test_sockets(source: str, target: str) -> None:
    reason = conversion(KINDS[source], KINDS[target])
    assert (reason is None) == (target in FITS[source].split())
    if reason:
        assert re.match(rf"an? {source} does not fit an? {target}\b", reason)


@pytest.mark.parametrize(("source", "name"), list(product(KINDS, VALUES)))
def test_values(source: str, name: str) -> None:
    value = Gain.values[name]
    reason = conversion(KINDS[source], value)
    assert (reason is None) == (source in VALUES[name].split())
    assert (VALUES[name] == "") == (not value.wireable)


@pytest.mark.parametrize(
    ("kind", "default"), [*product(KINDS, (2, 0.5)), ("Image", (1, 2, 3, 4)), ("Color", (0.1, 0.2, 0.3, 1.0))]
)
def test_a_default_is_kept(kind: str, default: Any) -> None:
    """One number or one per channel, as `Input` is given it."""
    end = Input(KINDS[kind].kind, 3, default=default).socket("end")
    assert end.default == default and isinstance(end.default, float | tuple)
    assert Input(KINDS[kind].kind, 3, default="#ff0000").socket("end").default is None


def test_only_values_of_pointwise_nodes_are_wired() -> None:
    """A number for every value of every node."""
    nodes = {id: node() for id, node in catalogue().items()}
    values = {Port(id, value.name): node for id, node in nodes.items() for value in node.values.values()}
    ports = {port: node for port, node in values.items() if node.values[port.socket].type == "float"}
    faults = Graph(nodes, dict.fromkeys(ports, Port("histogram", "mean"))).link_faults
    refused = {port for port, why in faults.items() if "only values of pointwise nodes" in why}
    assert refused == {port for port, node in ports.items() if not isinstance(node, Pointwise)}


@pytest.mark.parametrize(("source", "target"), list(product(KINDS, KINDS)))
def test_the_advice_can_be_followed(source: str, target: str) -> None:
    """The nodes that a sentence names exist, take the source (pixels only) and end in something that fits."""
    reason = conversion(KINDS[source], KINDS[target]) or ""
    advice = reason.partition(" put ")[2] or reason.partition(" such as ")[2]
    assert bool(advice) == bool(reason)
    for alternative in advice.split(" or ") if advice else ():
        carried: Socket = KINDS[source]
        for name in re.findall(r"'(\w+)'", alternative):
            node = catalogue()[name]
            if " such as " not in reason:
                assert any(conversion(carried, socket) is None for socket in node.inputs.values())
            carried = next(iter(node.outputs.values())).socket
        assert conversion(carried, KINDS[target]) is None


def test_ports_read_and_print() -> None:
    assert Port.parse("bloom.image") == Port("bloom", "image")
    assert str(Port("bloom", "image")) == "bloom.image"
    for text in ("a.b.c.d", "a.b.0", "a.b.c.d.1"):  # a field of an item, and the channels of both
        assert str(Port.parse(text)) == text and Port.parse(text).whole == Port("a", "b")
    for text in ("", "bloom", "bloom.", ".image", "a.b.c", "a..b", "a..b.c", "a.b..c", "a.b.c.", ".a.b.c"):
        with pytest.raises(GraphError, match=r"write node\.socket"):
            Port.parse(text)
    assert sorted([Port("b", "a"), Port("a", "b")]) == [Port("a", "b"), Port("b", "a")]


def test_did_you_mean() -> None:
    assert did_you_mean("Bloom", ["bloom", "blur"]) == "; did you mean 'bloom'?"
    assert did_you_mean("xyz", ["bloom", "blur"]) == "; there is bloom, blur"
    assert did_you_mean("xyz", []) == ""
    assert did_you_mean("xyz", [*map(str, range(100))]) == ""
