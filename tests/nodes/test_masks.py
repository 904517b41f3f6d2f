"""The mask, the mix and the inversion that every node has which changes one picture: against the formula in NumPy."""

from __future__ import annotations

import numpy as np
import pytest
from halation.compiler import Request, compile_graph
from halation.graph import Graph, Input, Output, Port
from halation.nodes import Kind, Node, Temporal, built_in_nodes
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.nodes.color.invert import Invert
from halation.nodes.distort.crop import Crop
from halation.nodes.distort.noise_warp import NoiseWarp
from halation.regression.node_promises import find_changing_values, make_pictures, render_node
from halation.resources.picture import Picture
from headers import Headers

MASKABLE = [node for node in built_in_nodes().values() if node.has_mask]
OWN_MASK = [node for node in built_in_nodes().values() if node.has_mix and not node.has_mask]
CUBE = "tests/data/warm.cube"


def ramp(width: int, height: int) -> np.ndarray:
    return np.tile(np.linspace(0.0, 1.0, width, dtype=np.float32), (height, 1))


@pytest.mark.parametrize("node", MASKABLE, ids=lambda node: node.id)
def test_the_first_output_is_mixed_with_the_picture(renderer, node):
    """Bit-equal to the node without a mask where the mask is 1, to the picture where it is 0."""
    rng = np.random.default_rng(3)
    pictures = make_pictures(node, (24, 16), rng)
    pictures = {name: picture for name, picture in pictures.items() if name != "mask"}
    values = find_changing_values(node, CUBE)
    output = next(iter(node.outputs))
    after = render_node(renderer, node(**values), pictures)[output]
    mask = ramp(24, 16)[..., None]
    mask[:, :4], mask[:, -4:] = 0.0, 1.0
    masked = render_node(renderer, node(**values), pictures | {"mask": mask})[output]
    before = pictures["image"]
    np.testing.assert_array_equal(masked[:, :4], before[:, :4])
    np.testing.assert_array_equal(masked[:, -4:], after[:, -4:])
    rounding = 1e-6 * float(np.abs(after).max())
    np.testing.assert_allclose(masked, before + (after - before) * mask, rtol=1e-5, atol=rounding)


@pytest.mark.parametrize("node", OWN_MASK, ids=lambda node: node.id)
def test_a_node_with_a_mask_of_its_own_is_mixed_too(renderer, node):
    """Its mask works as ever, and what comes out is mixed with the picture."""
    pictures = make_pictures(node, (24, 16), np.random.default_rng(3))
    values, before, output = find_changing_values(node, CUBE), pictures["image"], next(iter(node.outputs))
    after = render_node(renderer, node(**values), pictures)[output]
    mixed = render_node(renderer, node(**values, mix=0.25), pictures)[output]
    rounding = 1e-6 * float(np.abs(after).max())
    np.testing.assert_allclose(mixed, before + (after - before) * 0.25, rtol=1e-5, atol=rounding)
    if not issubclass(node, Temporal):  # what it remembers is made all the same
        np.testing.assert_array_equal(render_node(renderer, node(**values, mix=0.0), pictures)[output], before)


@pytest.mark.parametrize("node", [Exposure(stops=-2.0), GaussianBlur(sigma=2.0)], ids=lambda node: node.id)
def test_mix_and_inversion(run, node):
    picture = np.random.default_rng(2).random((16, 24, 4)).astype(np.float32)
    mask = ramp(24, 16)
    after = run(node, {"image": picture})
    opposite = run(node.with_values(invert_mask=True, mix=0.5), {"image": picture, "mask": mask})
    np.testing.assert_allclose(opposite, picture + (after - picture) * 0.5 * (1.0 - mask[..., None]), atol=1e-6)
    quarter = run(node.with_values(mix=0.25, invert_mask=True), {"image": picture})
    np.testing.assert_allclose(quarter, picture + (after - picture) * 0.25, atol=1e-6)


def test_a_blur_inside_a_mask_reads_what_lies_outside_of_it(run):
    """The mask limits where the blur is seen, and never what it reads."""
    picture = np.zeros((20, 30, 4), np.float32)
    picture[:, 14:16] = 1.0
    mask = np.zeros((20, 30), np.float32)
    mask[:, 16:] = 1.0
    whole = run(GaussianBlur(sigma=3.0), {"image": picture})
    masked = run(GaussianBlur(sigma=3.0), {"image": picture, "mask": mask})
    np.testing.assert_array_equal(masked[:, 16:], whole[:, 16:])
    np.testing.assert_array_equal(masked[:, :16], picture[:, :16])


def test_a_mask_of_another_size_is_fitted(run):
    picture = np.full((16, 32, 4), 0.5, np.float32)
    brighter = run(Exposure(stops=1.0), {"image": picture, "mask": ramp(16, 8)})
    assert brighter.shape == picture.shape
    np.testing.assert_allclose(brighter[0, [0, -1], 0], (0.5, 1.0), atol=1e-6)


def test_a_masked_field_stays_a_field(run):
    field = np.full((8, 12), 2.0, np.float32)
    graph = Graph().add("invert", Invert(space="linear")).add_output("out", Output(Kind.FIELD))
    for name in ("image", "mask"):
        graph = graph.add_input(name, Input(Kind.FIELD)).connect(Port("inputs", name), Port("invert", name))
    graph = graph.connect(Port("invert", "out"), Port("outputs", "out"))
    inverted = run(graph, {"image": field, "mask": np.full((8, 12), 0.5, np.float32)})
    np.testing.assert_allclose(inverted[..., 0], 0.5 * (2.0 + run(graph, {"image": field, "mask": field})[..., 0]))


def test_what_the_mask_is_not_finite_for_stays(run):
    picture, mask = np.ones((4, 4, 4), np.float32), np.full((4, 4), np.nan, np.float32)
    assert np.isfinite(run(Exposure(stops=3.0), {"image": picture, "mask": mask})).all()
    beyond = run(Exposure(stops=1.0), {"image": picture, "mask": np.full((4, 4), 7.0, np.float32)})
    np.testing.assert_array_equal(beyond[..., 0], 2.0)


def single(node: Node, mask: bool = False) -> Graph:
    graph = Graph().add("node", node).add_input("image", Input(default=0.5)).add_output("out", Output())
    graph = graph.connect(Port("inputs", "image"), Port("node", "image"))
    if mask:
        graph = graph.add_input("mask", Input(Kind.FIELD, default=0.5)).connect(
            Port("inputs", "mask"), Port("node", "mask")
        )
    return graph.connect(Port("node", "out"), Port("outputs", "out"))


def count_passes(graph: Graph) -> int:
    bindings = {
        name: Picture(name, "", end.kind, end.socket().channels, in_memory=True) for name, end in graph.inputs.items()
    }
    return len(compile_graph(graph, Request(bindings=bindings), Headers((64, 64))).passes)


def test_without_a_mask_nothing_is_added():
    assert count_passes(single(GaussianBlur(sigma=2.0))) == 2
    assert count_passes(single(Exposure(stops=1.0), mask=True)) == count_passes(single(Exposure(stops=1.0)))


def test_a_mix_of_zero_passes_the_picture_through(run):
    picture = np.random.default_rng(1).random((8, 8, 4)).astype(np.float32)
    np.testing.assert_array_equal(run(GaussianBlur(sigma=9.0, mix=0.0), {"image": picture}), picture)
    assert count_passes(single(GaussianBlur(sigma=9.0, mix=0.0))) <= 1


def test_nodes_of_another_size_and_with_masks_of_their_own_have_none():
    assert not Crop.has_mask and not Crop.has_mix
    assert not NoiseWarp.has_mask and "invert_mask" not in NoiseWarp.values
    assert NoiseWarp.inputs["mask"].doc == "Factor on the amount, pixel by pixel."
