"""The same look at every size: lengths in fractions of the height and in pixels at a reference height."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from conftest import graph_of
from halation.graph import Graph, Group, Input, Output, Port, Settings
from halation.nodes import Kind, catalogue
from scipy.ndimage import gaussian_filter

NODES = catalogue()
SIGMA = Port("node", "sigma")
REFERENCE = Settings(reference_height=60)


def make_picture(scale: int = 1) -> np.ndarray:
    """A soft picture of 90x60 pixels, drawn at a multiple of that size; nothing of it is close to its border."""
    small = np.zeros((60, 90, 4))
    small[20:40, 25:65] = np.random.default_rng(5).random((20, 40, 4))
    small = gaussian_filter(small, (2, 2, 0))
    return cv2.resize(small, None, fx=scale, fy=scale, interpolation=cv2.INTER_CUBIC).astype(np.float32)


def shrink(picture: np.ndarray, size: tuple[int, int] = (90, 60)) -> np.ndarray:
    return cv2.resize(picture, size, interpolation=cv2.INTER_AREA)


def make_blur(settings: Settings, sigma: float = 5.0) -> Graph:
    picture = make_picture()
    return replace(graph_of(NODES["gaussian_blur"](sigma=sigma), {"image": picture}), settings=settings)


def test_a_reference_of_the_own_height_changes_no_bit(run) -> None:
    given = {"image": make_picture()}
    np.testing.assert_array_equal(run(make_blur(REFERENCE), given), run(make_blur(Settings()), given))


@pytest.mark.parametrize("scale", [2, 4])
def test_a_larger_picture_looks_the_same(run, scale: int) -> None:
    """Against scipy at the reference height; pixels of the picture would blur a fraction of that."""
    expected = gaussian_filter(make_picture().astype(np.float64), (5, 5, 0), mode="nearest")
    made = shrink(run(make_blur(REFERENCE), {"image": make_picture(scale)}))
    plain = shrink(run(make_blur(Settings()), {"image": make_picture(scale)}))
    assert np.abs(made - expected).max() < 0.004 < 0.02 < np.abs(plain - expected).max()


@pytest.mark.parametrize("unit", ["height", "px@60", "px@600"])
def test_a_unit_of_one_value_looks_the_same_at_every_size(run, unit: str) -> None:
    number = {"height": 5.0 / 60.0, "px@60": 5.0, "px@600": 50.0}[unit]
    graph = make_blur(Settings()).override("node.sigma.unit", unit).set(SIGMA, number)
    expected = run(make_blur(Settings()), {"image": make_picture()})
    np.testing.assert_allclose(run(graph, {"image": make_picture()}), expected, atol=2e-6)
    assert np.abs(shrink(run(graph, {"image": make_picture(2)})) - expected).max() < 0.004


def test_pixels_of_the_picture_remain_in_a_graph_with_a_reference(run) -> None:
    graph = make_blur(REFERENCE).override("node.sigma.unit", "px")
    given = {"image": make_picture(2)}
    np.testing.assert_array_equal(run(graph, given), run(make_blur(Settings()), given))


def test_a_fraction_of_the_height_may_be_given_in_pixels(run) -> None:
    node = NODES["chromatic_aberration"](amount=0.05)
    graph = graph_of(node, {"image": make_picture()})
    expected = run(graph, {"image": make_picture()})
    pixels = graph.override("node.amount.unit", "px").set(Port("node", "amount"), 3.0)
    np.testing.assert_allclose(run(pixels, {"image": make_picture()}), expected, atol=2e-6)


def test_a_proxy_is_the_picture_made_smaller(run) -> None:
    graph, given = make_blur(REFERENCE), {"image": make_picture(2)}
    proxy = run(graph, given, scale=0.5)
    assert np.abs(proxy - shrink(run(graph, given))).max() < 0.004


@pytest.mark.parametrize("kind", [Kind.NUMBER, Kind.FIELD])
def test_linked_numbers_pass_through_the_same_factor(run, kind: Kind) -> None:
    graph = Graph({"node": NODES["checker"](size=5.0)}, settings=replace(REFERENCE, size=(180, 120)))
    graph = graph.add_output("out", Output()).connect(Port("node", "out"), Port("outputs", "out"))
    linked = graph.add_input("n", Input(kind, default=5.0)).connect(Port("inputs", "n"), Port("node", "size"))
    np.testing.assert_array_equal(run(linked), run(graph))
    assert not np.array_equal(run(linked), run(replace(linked, settings=Settings(size=(180, 120)))))


def test_a_crop_does_not_change_the_look(run) -> None:
    """Lengths after a crop follow the whole picture, also when the part is resized and through groups."""
    whole = run(make_blur(REFERENCE), {"image": make_picture(2)})
    crop = NODES["crop"](top_left=(0.0, 0.0), bottom_right=(1.0, 0.75))
    graph = make_blur(REFERENCE).add("crop", crop)
    graph = graph.connect(Port("inputs", "image"), Port("crop", "image"))
    cropped = graph.connect(Port("crop", "out"), Port("node", "image"))
    part = run(cropped, {"image": make_picture(2)})
    assert part.shape[:2] == (90, 180)
    np.testing.assert_allclose(part[:60], whole[:60], atol=2e-5)
    body = replace(make_blur(REFERENCE), folder="")
    outer = Graph(graph.nodes | {"node": Group(body)}, cropped.links, graph.inputs, graph.outputs, settings=Settings())
    np.testing.assert_array_equal(run(outer, {"image": make_picture(2)}), part)
    resized = cropped.add("resize", NODES["resize"](scale=(0.5, 0.5)))
    resized = resized.connect(Port("crop", "out"), Port("resize", "image"))
    resized = resized.connect(Port("resize", "out"), Port("node", "image"))
    made = run(resized, {"image": make_picture(2)})
    assert made.shape[:2] == (45, 90)
    assert np.abs(made[:30] - shrink(whole)[:30]).max() < 0.004


def test_a_resized_input_does_not_change_the_look(run) -> None:
    graph = make_blur(REFERENCE).add("resize", NODES["resize"](scale=(0.5, 0.5)))
    graph = graph.connect(Port("inputs", "image"), Port("resize", "image"))
    graph = graph.connect(Port("resize", "out"), Port("node", "image"))
    expected = shrink(run(make_blur(REFERENCE), {"image": make_picture(2)}))
    assert np.abs(run(graph, {"image": make_picture(2)}) - expected).max() < 0.004


@pytest.mark.parametrize("kind", ["kuwahara", "oil"])
def test_whether_a_length_changes_anything_depends_on_its_pixels(run, kind: str) -> None:
    """A radius below a pixel does nothing: 0.05 of the height is 3 pixels, and 3 px@6000 are less than one."""
    graph, port = graph_of(NODES[kind](), {"image": make_picture()}), Port("node", "radius")
    given = {"image": make_picture()}
    tall = graph.override("node.radius.unit", "height").set(port, 0.05)
    expected = run(graph.set(port, 3.0), given)
    np.testing.assert_allclose(run(tall, given), expected, atol=2e-6)
    assert not np.array_equal(expected, make_picture())
    tiny = graph.override("node.radius.unit", "px@6000").set(port, 3.0)
    np.testing.assert_array_equal(run(tiny, given), make_picture())


def test_groups_have_a_reference_height_of_their_own(run) -> None:
    body = make_blur(REFERENCE)
    outer = Graph(
        {"g": Group(body)},
        {Port("g", "image"): Port("inputs", "image"), Port("outputs", "out"): Port("g", "out")},
        {"image": Input()},
        {"out": Output()},
        settings=Settings(reference_height=1080),
    )
    given = {"image": make_picture(2)}
    np.testing.assert_array_equal(run(outer, given), run(body, given))
