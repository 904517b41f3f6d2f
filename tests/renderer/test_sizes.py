"""Sizes: pictures fitted to each other, proxies, and what is made from nothing or from one value."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import graph_of
from halation.graph import Graph, Input, Output, Port, Settings
from halation.nodes import Kind, catalogue
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.renderer import RenderRequest
from scipy.ndimage import gaussian_filter

NODES = catalogue()
PLAIN = Exposure(stops=0.0)
PICTURE = np.random.default_rng(2).random((20, 30, 4), np.float32)


def ramp(width: int, height: int) -> np.ndarray:
    """x, y as fractions of the picture, at pixel centers."""
    y, x = np.mgrid[0:height, 0:width]
    return np.stack([(x + 0.5) / width, (y + 0.5) / height, 0 * x, 0 * x + 1], axis=-1).astype(np.float32)


@pytest.mark.parametrize("size", [(30, 20), (20, 12), (33, 7), (45, 30), (45, 29), (45, 28), (270, 180), (181, 121)])
def test_a_linear_ramp_stays_where_it_is(run, size):
    """Neither shrinking nor enlarging shifts a picture, by a twentieth of a pixel at most (the triangle wobbles)."""
    found = run(graph_of(PLAIN, {"image": ramp(90, 60)}), {"image": ramp(90, 60)}, size=size)
    # The picture is scaled to cover: what sticks out on two sides is cut off.
    width, height = size
    step = min(90 / width, 60 / height) if abs(90 * height / (60 * width) - 1) > 1 / min(size) else None
    across, down = (step, step) if step else (90 / width, 60 / height)
    y, x = np.mgrid[0:height, 0:width]
    expected = np.stack([0.5 + (x + 0.5 - width / 2) * across / 90, 0.5 + (y + 0.5 - height / 2) * down / 60], axis=-1)
    margin = int(np.ceil(2 / min(across, down))) + 2
    inner = (slice(margin, -margin), slice(margin, -margin))
    np.testing.assert_allclose(found[..., :2][inner] * (90, 60), expected[inner] * (90, 60), atol=0.05)


@pytest.mark.parametrize("factor", [2, 3, 5])
def test_shrinking_by_whole_factors_averages_like_openimageio(run, factor):
    import OpenImageIO as oiio

    picture = np.random.default_rng(3).random((12 * factor, 14 * factor, 4), np.float32)
    small = oiio.ImageBuf(oiio.ImageSpec(14, 12, 4, "float"))
    oiio.ImageBufAlgo.resize(small, oiio.ImageBuf(picture), filtername="triangle", filterwidth=2.0)
    found = run(graph_of(PLAIN, {"image": picture}), {"image": picture}, size=(14, 12))
    np.testing.assert_allclose(found[2:-2, 2:-2], small.get_pixels()[2:-2, 2:-2], atol=3e-6)


@pytest.mark.parametrize("scale", [0.5, 1 / 3])
@pytest.mark.parametrize("sigma", [6.0, 12.0, 40.0])
def test_a_blurred_proxy_is_the_shrunk_result(run, scale, sigma):
    """For pictures without much at their borders: what lies beyond repeats another pixel in the proxy."""
    picture = np.zeros((120, 180, 4))
    picture[40:80, 50:130] = np.random.default_rng(4).random((40, 80, 4))
    picture = gaussian_filter(picture, (2, 2, 0)).astype(np.float32)
    graph = graph_of(GaussianBlur(sigma=sigma), {"image": picture})
    full = run(graph, {"image": picture})
    shrunk = run(graph_of(PLAIN, {"image": full}), {"image": full}, scale=scale)
    proxy = run(graph, {"image": picture}, scale=scale)
    assert np.abs(proxy - shrunk).max() < 0.01 * np.ptp(full)


def test_a_hundredth_is_still_a_pixel(run):
    assert run(graph_of(PLAIN, {"image": PICTURE}), {"image": PICTURE}, scale=0.01).shape == (1, 1, 4)


def test_size_and_scale_together(run):
    graph = graph_of(PLAIN, {"image": PICTURE})
    assert run(graph, {"image": PICTURE}, size=(64, 40), scale=0.25).shape == (10, 16, 4)


def linked(nodes, links: dict[str, str], inputs, outputs, **rest) -> Graph:
    ports = {Port.parse(target): Port.parse(source) for target, source in links.items()}
    return Graph(nodes=nodes, links=ports, inputs=inputs, outputs=outputs, **rest)


IMAGE = {"image": Input(Kind.IMAGE)}
MEASURED = {"measure.image": "inputs.image"}


def test_a_pattern_colored_by_a_measurement_fills_the_canvas(renderer):
    nodes = {"measure": NODES["luminance_statistics"](), "checker": NODES["checker"](size=4.0)}
    links = {**MEASURED, "checker.first": "measure.average", "outputs.image": "checker.out"}
    found = renderer.render(linked(nodes, links, IMAGE, {"image": Output()}), RenderRequest({"image": PICTURE}))[
        "image"
    ]
    luminance = PICTURE[..., :3].astype(np.float64) @ [0.2126, 0.7152, 0.0722]
    assert found.shape == (20, 30, 4)
    np.testing.assert_allclose(found[0, 0, :3], luminance.mean(), rtol=1e-5)
    np.testing.assert_array_equal(found[0, 4], [0.5, 0.5, 0.5, 1.0])


def test_a_number_bound_as_a_picture_is_no_canvas(renderer):
    inputs = {"amount": Input(Kind.NUMBER), "image": Input(Kind.IMAGE)}
    graph = linked({"c": NODES["checker"]()}, {"outputs.image": "c.out"}, inputs, {"image": Output()})
    bound = {"amount": np.ones((1, 1), np.float32), "image": PICTURE}
    assert renderer.render(graph, RenderRequest(bound))["image"].shape == (20, 30, 4)


ENDS = {
    "Number": Output(Kind.NUMBER),
    "Field": Output(Kind.FIELD),
    "Color": Output(Kind.COLOR),
    "Image": Output(Kind.IMAGE),
    "Vector": Output(Kind.VECTOR, 2),
}


@pytest.mark.parametrize("kind", ENDS)
def test_a_constant_is_shown_as_the_output_says(renderer, kind):
    graph = linked(
        {},
        {"outputs.o": "inputs.n"},
        {"n": Input(Kind.NUMBER, default=2.0)},
        {"o": ENDS[kind]},
        settings=Settings((8, 6)),
    )
    found = renderer.render(graph)["o"]
    size = (1, 1) if ENDS[kind].socket().single else (6, 8)
    expected = np.full((*size, ENDS[kind].socket().channels), 2.0)
    if expected.shape[2] == 4:
        expected[..., 3] = 1.0
    np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("size", [(1, 1), (5, 3), (7, 1)])
@pytest.mark.parametrize("kind", ["Field", "Image", "Vector"])
def test_a_field_is_shown_as_the_output_says(renderer, kind, size):
    field = np.random.default_rng(1).random(size, np.float32)
    graph = linked({}, {"outputs.o": "inputs.f"}, {"f": Input(Kind.FIELD)}, {"o": ENDS[kind]})
    found = renderer.render(graph, RenderRequest({"f": field}, precision="float"))["o"]
    channels = ENDS[kind].socket().channels
    expected = np.repeat(field[..., None], channels, axis=2)
    if channels == 4:
        expected[..., 3] = 1.0
    np.testing.assert_array_equal(found, expected)


def test_data_that_changes_its_type_keeps_32_bits(renderer):
    """Depth of 1000.123 has no half float."""
    depth = np.full((3, 5), 1000.123, np.float32)
    graph = linked({}, {"outputs.o": "inputs.f"}, {"f": Input(Kind.FIELD)}, {"o": ENDS["Vector"]})
    found = renderer.render(graph, RenderRequest({"f": depth}, precision="half"))["o"]
    np.testing.assert_array_equal(found, np.repeat(depth[..., None], 2, axis=2))


@pytest.mark.parametrize("number", [2.6, 3, 2.5, -1e30, 1e30])
def test_a_number_drives_whole_numbers_and_switches(renderer, number):
    """Rounded like a picture would be, within the hard range."""

    def noise(**values) -> Graph:
        return Graph(outputs={"o": Output(Kind.FIELD)}, settings=Settings((8, 6))).add("n", NODES["noise"](**values))

    value = NODES["noise"].values["octaves"]
    octaves = int(np.floor(np.clip(number, value.minimum, value.maximum) + 0.5))
    wired = noise().add_input("by", Input(Kind.NUMBER, default=number))
    wired = wired.connect(Port("inputs", "by"), Port("n", "octaves"))
    found, expected = (
        renderer.render(graph.connect(Port("n", "value"), Port("outputs", "o")))["o"]
        for graph in (wired, noise(octaves=octaves))
    )
    np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("bound", [1.0, np.float32(1.0), np.ones((1, 1)), [[1.0]]])
def test_a_number_is_bound_by_its_value(renderer, bound):
    inputs = {**IMAGE, "stops": Input(Kind.NUMBER)}
    links = {"light.image": "inputs.image", "light.stops": "inputs.stops", "outputs.image": "light.out"}
    graph = linked({"light": PLAIN}, links, inputs, {"image": Output()})
    found = renderer.render(graph, RenderRequest({"image": PICTURE, "stops": bound}, precision="float"))["image"]
    np.testing.assert_allclose(found[..., :3], 2.0 * PICTURE[..., :3], rtol=1e-6)


@pytest.mark.parametrize(
    "change",
    [
        lambda a: a.astype(np.float64),
        lambda a: np.asfortranarray(a),
        lambda a: np.repeat(a, 2, axis=1)[:, ::2],
        lambda a: a[::-1][::-1],
        lambda a: np.frombuffer(a.tobytes(), np.float32).reshape(a.shape),
        lambda a: a.tolist(),
    ],
    ids=["float64", "fortran", "strided", "backward", "read-only", "list"],
)
def test_any_layout_of_an_array_will_do(run, renderer, change):
    found = renderer.render(
        graph_of(Exposure(stops=1.0), {"image": PICTURE}), RenderRequest({"image": change(PICTURE)}, precision="float")
    )["out"]
    np.testing.assert_array_equal(found, run(Exposure(stops=1.0), {"image": PICTURE}))
