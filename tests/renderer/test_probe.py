"""Numbers read back from results, and where broken ones come from."""

from __future__ import annotations

import numpy as np
import pytest
from device_textures import upload_texture
from halation.compiler import Library, load_library
from halation.compiler.library import parse
from halation.errors import UsageError
from halation.graph import Graph, Group, Input, Output, Port
from halation.nodes import Kind, catalogue
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.renderer import NonfinitePixel, PixelProbe, Renderer, RenderRequest, find_first_nonfinite, open_device
from halation.resources.sandbox import UNRESTRICTED

NODES = catalogue()
IMAGE = Port("outputs", "image")
RNG = np.random.default_rng(7)


@pytest.fixture
def probe(renderer):
    made = PixelProbe(renderer.device)
    yield made
    made.close()


@pytest.fixture
def texture(renderer):
    """`texture(pixels)` with its channels and precision."""
    made = []

    def uploaded(pixels):
        made.append(upload_texture(renderer.device, pixels))
        return made[-1]

    yield uploaded
    with renderer.device.make_current():
        for one in made:
            one.release()


@pytest.mark.parametrize("channels", [1, 2, 4])
@pytest.mark.parametrize("dtype", [np.float16, np.float32])
def test_pixels_and_regions(probe, texture, channels, dtype):
    pixels = RNG.normal(0.0, 100.0, (11, 13, channels)).astype(dtype)
    made = texture(pixels)
    assert probe.read_pixel(made, 12, 0) == tuple(pixels[0, 12].astype(float))
    assert probe.read_pixel(made, 3, 10) == tuple(pixels[10, 3].astype(float))
    np.testing.assert_array_equal(probe.read_region(made, (2, 3, 7, 5)), pixels[3:8, 2:9].astype(np.float32))


@pytest.mark.parametrize("rect", [(-1, 0, 2, 2), (0, 0, 14, 1), (13, 0, 1, 1), (0, 10, 1, 2), (0, 0, 0, 1)])
def test_outside_of_a_picture_there_is_nothing(probe, texture, rect):
    with pytest.raises(UsageError, match="not inside a picture of 13x11"):
        probe.read_region(texture(np.zeros((11, 13, 4), np.float32)), rect)


@pytest.mark.parametrize("channels", [1, 2, 4])
def test_a_small_copy_holds_pixels_of_the_large_one(probe, texture, channels):
    pixels = RNG.normal(0.0, 1.0, (30, 60, channels)).astype(np.float32)
    small = probe.read_small(texture(pixels), 20)
    np.testing.assert_array_equal(small, pixels[1::3, 1::3])
    np.testing.assert_array_equal(probe.read_small(texture(pixels), 999), pixels)


def test_broken_numbers_come_back_as_they_are(probe, texture):
    pixels = np.ones((2, 2, 4), np.float32)
    pixels[1, 0] = (np.nan, np.inf, -np.inf, -0.5)
    np.testing.assert_array_equal(probe.read_region(texture(pixels), (0, 0, 2, 2)), pixels)


# --- the first that is not finite ------------------------------------------------------------------------------------


def divided() -> Graph:
    """A group that adds a picture, between two nodes that do no harm."""
    body = Graph(inputs={"a": Input(), "b": Input()}, outputs={"out": Output()})
    body = body.add("light", Exposure(stops=1.0)).add("sum", NODES["merge"](mode="plus"))
    body = body.connect(Port("inputs", "a"), Port("light", "image")).connect(Port("light", "out"), Port("sum", "a"))
    body = body.connect(Port("inputs", "b"), Port("sum", "b")).connect(Port("sum", "out"), Port("outputs", "out"))
    graph = Graph(inputs={"a": Input(), "b": Input()}, outputs={"image": Output(Kind.IMAGE)})
    graph = graph.add("blur", GaussianBlur(sigma=1.0)).add("group", Group(body)).add("after", Exposure(stops=1.0))
    graph = graph.connect(Port("inputs", "a"), Port("blur", "image")).connect(Port("blur", "out"), Port("group", "a"))
    graph = graph.connect(Port("inputs", "b"), Port("group", "b"))
    graph = graph.connect(Port("group", "out"), Port("after", "image"))
    return graph.connect(Port("after", "out"), Port("outputs", "image"))


def search(renderer, graph, pictures, port=IMAGE) -> tuple[list[None], NonfinitePixel | None]:
    *steps, last = find_first_nonfinite(renderer, graph, RenderRequest(pictures, precision="float"), port)
    return steps, last


def pictures(**changes) -> dict[str, np.ndarray]:
    return {name: np.full((9, 12, 4), 0.5, np.float32) for name in ("a", "b")} | changes


def test_a_broken_picture_is_found_where_it_comes_in(renderer):
    broken = np.full((9, 12, 4), 0.5, np.float32)
    broken[4, 7, 2] = np.inf
    steps, found = search(renderer, divided(), pictures(b=broken))
    assert steps == [None] * len(steps) and steps
    assert found is not None and (found.path, found.pixel) == ("inputs.b", (7, 4))
    assert found.value == (0.5, 0.5, np.inf, 0.5)


def test_the_node_that_breaks_it_is_found_inside_a_group():
    large = np.full((9, 12, 4), 1e38, np.float32)
    careless = "vec4 exposure(vec4 image, float stops) { return vec4(image.rgb * exp2(stops), image.a); }"
    library = Library({**load_library().texts, "color/exposure": parse("color/exposure", careless)})
    engine = Renderer(open_device(sandbox=UNRESTRICTED), library=library, sandbox=UNRESTRICTED)
    _, found = search(engine, divided().override("group.light.stops", 9.0), pictures(a=large))
    engine.close()
    assert found is not None and found.path == "group/light" and found.port == Port("group/light", "out")


def test_nothing_is_found_where_all_is_finite(renderer):
    steps, found = search(renderer, divided(), pictures())
    assert found is None and len(steps) >= 5


def test_what_is_not_upstream_does_not_matter(renderer):
    broken = np.full((9, 12, 4), np.nan, np.float32)
    _, found = search(renderer, divided(), pictures(b=broken), Port("blur", "out"))
    assert found is None
