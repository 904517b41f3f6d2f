"""What a link may carry, end to end: constants of the graph, measured numbers, fields, pictures of other sizes."""

from __future__ import annotations

import numpy as np
import pytest
from halation.graph import Graph, Input, Output, Port, Settings
from halation.nodes import Kind, catalogue
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.renderer import RenderRequest
from halation.resources.sandbox import UNRESTRICTED

RNG = np.random.default_rng(11)
PICTURE = RNG.random((20, 30, 4), np.float32)


def wired(node, links: dict[str, str], inputs: dict[str, Input], output: str = "node.out") -> Graph:
    """One node between graph inputs and the output `image`."""
    graph = Graph(inputs=inputs, outputs={"image": Output()}, settings=Settings((30, 20))).add("node", node)
    for target, source in links.items():
        graph = graph.connect(Port.parse(source), Port.parse(target))
    return graph.connect(Port.parse(output), Port("outputs", "image"))


def image(renderer, graph: Graph, **arrays) -> np.ndarray:
    return renderer.render(graph, RenderRequest(arrays, precision="float"))["image"]


def test_a_number_of_the_graph_drives_a_value(renderer):
    inputs = {"beauty": Input(Kind.IMAGE), "gain": Input(Kind.NUMBER, default=2.0)}
    graph = wired(Exposure(), {"node.image": "inputs.beauty", "node.stops": "inputs.gain"}, inputs)
    np.testing.assert_allclose(image(renderer, graph, beauty=PICTURE)[..., :3], PICTURE[..., :3] * 4.0, rtol=1e-6)


def test_a_field_drives_a_value_for_every_pixel(renderer):
    inputs = {"beauty": Input(Kind.IMAGE), "mask": Input(Kind.FIELD)}
    graph = wired(Exposure(), {"node.image": "inputs.beauty", "node.stops": "inputs.mask"}, inputs)
    mask = RNG.uniform(-3.0, 3.0, (20, 30)).astype(np.float32)
    expected = PICTURE[..., :3] * np.exp2(mask.astype(np.float64))[..., None]
    np.testing.assert_allclose(image(renderer, graph, beauty=PICTURE, mask=mask)[..., :3], expected, rtol=2e-6)


def test_a_wired_value_is_clamped_to_its_hard_range(renderer):
    saturation = catalogue()["saturation"]
    inputs = {"beauty": Input(Kind.IMAGE), "amount": Input(Kind.NUMBER, default=-5.0)}
    graph = wired(saturation(), {"node.image": "inputs.beauty", "node.saturation": "inputs.amount"}, inputs)
    grey = wired(saturation(saturation=0.0), {"node.image": "inputs.beauty"}, {"beauty": Input(Kind.IMAGE)})
    assert saturation.values["saturation"].minimum == 0.0
    np.testing.assert_array_equal(image(renderer, graph, beauty=PICTURE), image(renderer, grey, beauty=PICTURE))


@pytest.mark.parametrize("node", [Exposure(stops=1.0), GaussianBlur(sigma=3.0)], ids=["pointwise", "filter"])
def test_a_color_of_the_graph_stands_for_a_flat_picture(renderer, node):
    inputs = {"paint": Input(Kind.COLOR, default=(0.1, 0.2, 0.3, 1.0))}
    result = image(renderer, wired(node, {"node.image": "inputs.paint"}, inputs))
    factor = 2.0 if isinstance(node, Exposure) else 1.0
    assert result.shape == (20, 30, 4)
    np.testing.assert_allclose(result[7, 9], [0.1 * factor, 0.2 * factor, 0.3 * factor, 1.0], rtol=2e-6)


def test_a_field_is_a_grey_opaque_picture(renderer):
    field = RNG.random((20, 30), np.float32)
    for node in (Exposure(stops=1.0), GaussianBlur(sigma=0.0)):
        graph = wired(node, {"node.image": "inputs.depth"}, {"depth": Input(Kind.FIELD)})
        graph = graph.add("again", Exposure(stops=1.0)).disconnect(Port("outputs", "image"))
        graph = graph.connect(Port("node", "out"), Port("again", "image"))
        result = image(renderer, graph.connect(Port("again", "out"), Port("outputs", "image")), depth=field)
        gain = 4.0 if isinstance(node, Exposure) else 2.0
        np.testing.assert_allclose(result[..., 1], field * gain, rtol=1e-6)
        np.testing.assert_array_equal(result[..., 3], np.ones_like(field))


def test_a_measured_number_reaches_the_pixels(renderer):
    statistics = catalogue()["luminance_statistics"]
    graph = wired(Exposure(), {"node.image": "inputs.beauty"}, {"beauty": Input(Kind.IMAGE)})
    graph = graph.add("measure", statistics())
    graph = graph.connect(Port("inputs", "beauty"), Port("measure", "image"))
    graph = graph.connect(Port("measure", "average"), Port("node", "stops"))
    opaque = PICTURE.copy()
    opaque[..., 3] = 1.0
    average = float((opaque[..., :3].astype(np.float64) @ [0.2126, 0.7152, 0.0722]).mean())
    result = image(renderer, graph, beauty=opaque)
    np.testing.assert_allclose(result[..., :3], opaque[..., :3] * 2.0**average, rtol=1e-5)


MERGE = {"node.a": "inputs.a", "node.b": "inputs.b"}


@pytest.mark.parametrize("size", [(40, 60), (20, 60), (50, 7), (1, 3)])
@pytest.mark.parametrize("factor", [0.999999, 1.0], ids=["mixed", "neutral"])
def test_a_picture_of_another_size_covers_the_first(renderer, size, factor):
    """Whatever its shape, it has no empty borders."""
    mix = catalogue()["mix_images"]
    graph = wired(mix(factor=factor), MERGE, {"a": Input(Kind.IMAGE), "b": Input(Kind.IMAGE)})
    other = np.full((*size, 4), 0.25, np.float32)
    result = image(renderer, graph, a=PICTURE, b=other)
    assert result.shape == PICTURE.shape
    np.testing.assert_allclose(result, 0.25, rtol=1e-5)


def test_data_of_another_size_is_never_mixed(renderer):
    graph = wired(
        Exposure(),
        {"node.image": "inputs.beauty", "node.stops": "inputs.mask"},
        {"beauty": Input(Kind.IMAGE), "mask": Input(Kind.FIELD)},
    )
    mask = RNG.choice(np.array([-2.0, 0.0, 3.0], np.float32), (7, 11))
    result = image(renderer, graph, beauty=PICTURE, mask=mask)
    steps = np.log2(result[..., 0].astype(np.float64) / PICTURE[..., 0])
    assert np.abs(steps[..., None] - [-2.0, 0.0, 3.0]).min(axis=-1).max() < 1e-4


def test_half_intermediates_stay_within_half_rounding(renderer):
    """Fused, one rounding at the end; unfused, one per pass: both within half an ulp for each."""
    from halation.renderer import Renderer, open_device

    graph = Graph(inputs={"image": Input(Kind.IMAGE)}, outputs={"image": Output()})
    last = Port("inputs", "image")
    for number, stops in enumerate((0.4, -1.3, 2.2, 0.7)):
        graph = graph.add(f"n{number}", Exposure(stops=stops)).connect(last, Port(f"n{number}", "image"))
        last = Port(f"n{number}", "out")
    graph = graph.connect(last, Port("outputs", "image"))
    exact = PICTURE[..., :3].astype(np.float64) * 2.0**2.0
    unfused = Renderer(open_device(sandbox=UNRESTRICTED), budget=0, fusion=False, sandbox=UNRESTRICTED)
    for engine, roundings in ((renderer, 1), (unfused, 4)):
        result = engine.render(graph, RenderRequest({"image": PICTURE}, precision="half"))["image"][..., :3]
        assert np.abs(result / exact - 1.0).max() <= roundings * 2.0**-11 * 1.001
    unfused.close()


def test_the_background_gives_the_size_of_a_merge(renderer):
    merge = catalogue()["merge"]
    graph = wired(merge(), MERGE, {"a": Input(Kind.IMAGE), "b": Input(Kind.IMAGE)})
    clear = np.zeros((9, 44, 4), np.float32)
    np.testing.assert_allclose(image(renderer, graph, a=clear, b=PICTURE), PICTURE, rtol=1e-6)
