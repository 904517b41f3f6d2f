"""Filters that follow the type of their input: a Field stays a Field. Against scipy, and the same node on a picture."""

from __future__ import annotations

import numpy as np
import pytest
from halation.errors import GraphError
from halation.graph import Graph, Input, Output, Port
from halation.nodes import Kind, Node, Socket, built_in_nodes
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.channel.combine import Combine
from halation.nodes.color.invert import Invert
from halation.nodes.distort.crop import Crop
from halation.nodes.distort.transform import Transform
from halation.nodes.matte.fill_holes import FillHoles
from halation.nodes.merge.mix_images import MixImages
from scipy.ndimage import gaussian_filter

SETTINGS: dict[str, dict[str, object]] = {
    "clip": {"low": 0.2, "high": 0.6},
    "curves": {"master": (0.0, 0.1, 1.0, 0.7)},
    "exposure": {"stops": -1.5},
    "levels": {"gamma": 1.7},
    "grid_warp": {"point_22": (0.4, 0.4)},
    "lens_distortion": {"k1": 0.3},
    "crop": {"top_left": (0.2, 0.1), "resize": False},
    "transform": {"rotation": 20.0, "scale": (0.8, 0.7)},
    "resize": {"scale": (0.5, 1.5)},
}

STILL = ("sanitize", "echo", "frame_average", "displace", "variable_blur", "inpaint")
"""Nodes that change nothing of a finite still picture, or nothing without another input."""


def follower(node: type[Node]) -> bool:
    return any(output.follows for output in node.outputs.values())


FOLLOWERS = [node for node in built_in_nodes().values() if follower(node) and node.id != "st_map"]


def matte(width: int, height: int, largest: float = 1.0) -> np.ndarray:
    random = np.random.default_rng(5)
    return (random.random((height, width)) * largest).astype(np.float32)


def chain(*nodes: Node, start: Kind = Kind.FIELD, end: Kind = Kind.FIELD) -> Graph:
    """A graph of nodes in a row."""
    graph = Graph().add_input("picture", Input(start)).add_output("out", Output(end))
    source = Port("inputs", "picture")
    for number, node in enumerate(nodes):
        graph = graph.add(f"n{number}", node).connect(source, Port(f"n{number}", "image"))
        source = Port(f"n{number}", "out")
    return graph.connect(source, Port("outputs", "out"))


@pytest.mark.parametrize("node", FOLLOWERS, ids=lambda node: node.id)
def test_a_field_comes_out_as_one_channel_of_an_opaque_gray_picture(run, node):
    picture = matte(48, 36)
    item = node(**SETTINGS.get(node.id, {}))
    gray = np.dstack([picture, picture, picture, np.ones_like(picture)])
    expected = run(chain(item, start=Kind.IMAGE, end=Kind.IMAGE), {"picture": gray})[..., 0]
    field = run(chain(item), {"picture": picture})[..., 0]
    assert field.shape == expected.shape
    np.testing.assert_allclose(field, expected, atol=2e-6)
    if node.id not in STILL:
        assert not np.array_equal(field, picture)


def test_a_row_of_filters_equals_scipy(run):
    picture = matte(64, 48, 1000.0)
    expected = 1000.0 - gaussian_filter(
        gaussian_filter(picture.astype(np.float64), 2.0, truncate=4.0, mode="nearest"),
        3.0,
        truncate=4.0,
        mode="nearest",
    )
    inverted = Invert(space="linear")
    blurred = run(chain(GaussianBlur(sigma=2.0), GaussianBlur(sigma=3.0)), {"picture": picture})[..., 0]
    np.testing.assert_allclose(blurred, 1000.0 - expected, rtol=2e-5)
    small = run(chain(GaussianBlur(sigma=2.0), inverted), {"picture": picture / 1000.0})[..., 0]
    np.testing.assert_allclose(
        small, 1.0 - gaussian_filter(picture.astype(np.float64) / 1000.0, 2.0, truncate=4.0, mode="nearest"), atol=2e-5
    )


def test_a_field_keeps_32_bits_where_pictures_are_half_floats(run):
    depth = np.full((20, 30), 12345.678, np.float32)
    blurred = run(chain(GaussianBlur(sigma=3.0), Crop(resize=True)), {"picture": depth}, precision="half")
    np.testing.assert_allclose(blurred[..., 0], depth, rtol=1e-6)


@pytest.mark.parametrize("edge", ["clamp", "black"])
def test_readers_of_a_picture_get_what_they_got_before(run, edge):
    """A blurred Field in a picture's place is the blur of an opaque gray picture, to the bit: transparent outside."""
    picture = matte(40, 30)
    blur = GaussianBlur(sigma=4.0, edge=edge)
    graph = chain(blur, Transform(rotation=10.0), end=Kind.IMAGE)
    gray = Graph().add_input("picture", Input(Kind.FIELD)).add_output("out", Output())
    gray = gray.add("gray", Combine()).add("n0", blur).add("n1", Transform(rotation=10.0))
    for channel in ("red", "green", "blue"):
        gray = gray.connect(Port("inputs", "picture"), Port("gray", channel))
    for start, end in (("gray.out", "n0.image"), ("n0.out", "n1.image"), ("n1.out", "outputs.out")):
        gray = gray.connect(Port.parse(start), Port.parse(end))
    for precision in ("float", "half"):
        before = run(gray, {"picture": picture}, precision=precision)
        np.testing.assert_array_equal(run(graph, {"picture": picture}, precision=precision), before)
    assert before[0, 0, 3] < 0.9


def test_one_output_feeds_readers_of_both_types(run):
    """A mask that is blurred drives a value, and its picture is seen elsewhere."""
    picture = matte(40, 30)
    graph = chain(GaussianBlur(sigma=2.0), end=Kind.IMAGE).add("mix", MixImages())
    graph = graph.add_output("mixed", Output()).connect(Port("n0", "out"), Port("mix", "a"))
    graph = graph.connect(Port("n0", "out"), Port("mix", "factor")).connect(Port("n0", "out"), Port("mix", "b"))
    graph = graph.connect(Port("mix", "out"), Port("outputs", "mixed"))
    blurred = gaussian_filter(picture.astype(np.float64), 2.0, truncate=4.0, mode="nearest")
    np.testing.assert_allclose(run(graph, {"picture": picture}, output="mixed")[..., 0], blurred, atol=1e-5)


def test_types_are_checked_through_a_row_of_filters():
    fields, images = chain(GaussianBlur(), Invert()), chain(GaussianBlur(), Invert(), start=Kind.IMAGE, end=Kind.IMAGE)
    assert kind(fields.source(Port("n1", "out"))) is Kind.FIELD
    assert kind(images.source(Port("n1", "out"))) is Kind.IMAGE
    with pytest.raises(GraphError, match="an Image does not fit a Field: put 'luminance'"):
        images.add_output("matte", Output(Kind.FIELD)).connect(Port("n1", "out"), Port("outputs", "matte"))


def test_a_filter_without_a_link_says_what_would_make_it_a_field():
    graph = Graph().add("blur", GaussianBlur()).add_output("matte", Output(Kind.FIELD))
    with pytest.raises(GraphError, match=r"'blur\.out' is a Field where a Field is linked to 'blur\.image'"):
        graph.connect(Port("blur", "out"), Port("outputs", "matte"))


def test_each_of_two_filters_of_one_class_is_checked_for_itself():
    graph = Graph().add_input("matte", Input(Kind.FIELD)).add_input("image", Input(Kind.IMAGE))
    nodes = {"soft": GaussianBlur(), "blurred": GaussianBlur(), "filled": FillHoles(), "wrong": FillHoles()}
    links = {
        Port("soft", "image"): Port("inputs", "matte"),
        Port("filled", "matte"): Port("soft", "out"),
        Port("blurred", "image"): Port("inputs", "image"),
        Port("wrong", "matte"): Port("blurred", "out"),
    }
    faults = Graph(nodes=nodes, links=links, inputs=graph.inputs).link_faults
    assert [f"{target}" for target in faults] == ["wrong.matte"]
    assert "an Image does not fit a Field" in faults[Port("wrong", "matte")]


def test_a_long_row_of_filters_is_checked_in_linear_time():
    graph = Graph().add_input("picture", Input(Kind.FIELD)).add_output("out", Output(Kind.FIELD))
    nodes = {f"n{number}": Invert() for number in range(10_000)}
    links = {Port(f"n{number}", "image"): Port(f"n{number - 1}", "out") for number in range(1, 10_000)}
    links |= {Port("n0", "image"): Port("inputs", "picture"), Port("outputs", "out"): Port("n9999", "out")}
    assert Graph(nodes=nodes, links=links, inputs=graph.inputs, outputs=graph.outputs).link_faults == {}


def test_a_circle_of_filters_has_no_followed_type():
    links = {Port("a", "image"): Port("b", "out"), Port("b", "image"): Port("a", "out")}
    graph = Graph(nodes={"a": Invert(), "b": Invert()}, links=links)
    assert kind(graph.source(Port("a", "out"))) is Kind.IMAGE


def kind(socket: Socket | None) -> Kind:
    assert socket is not None
    return socket.kind
