"""Read Image against files that OpenImageIO writes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.errors import InputError
from halation.graph import Graph, Output, Port
from halation.nodes import Kind
from halation.nodes.input.read_image import ReadImage
from halation.renderer import RenderRequest

KINDS = {"out": Kind.IMAGE, "field": Kind.FIELD, "vector": Kind.VECTOR}


def graph_of(path: str, layer: str, outputs: tuple[str, ...]) -> Graph:
    graph = Graph().add("read", ReadImage(path=path, layer=layer))
    for name in outputs:
        graph = graph.add_output(name, Output(KINDS[name], 3)).connect(Port("read", name), Port("outputs", name))
    return graph


@pytest.fixture
def passes(tmp_path: Path) -> tuple[str, dict[str, np.ndarray]]:
    """A file with a color, a depth and a normal layer of 37 x 23 pixels, and the pixels of each."""
    random = np.random.default_rng(7)
    layers = {
        "Combined": random.random((23, 37, 4), np.float32),
        "Depth": np.where(random.random((23, 37, 1)) > 0.8, 1e10, random.random((23, 37, 1)) * 50.0).astype(np.float32),
        "Normal": random.uniform(-1.0, 1.0, (23, 37, 3)).astype(np.float32),
    }
    names = [*(f"Combined.{c}" for c in "RGBA"), "Depth.Z", *(f"Normal.{c}" for c in "XYZ")]
    spec = oiio.ImageSpec(37, 23, len(names), "float")
    spec.channelnames = names
    path = tmp_path / "shot.exr"
    file = oiio.ImageOutput.create(str(path))
    pixels = np.concatenate(list(layers.values()), axis=2)
    assert file.open(str(path), spec) and file.write_image(pixels) and file.close()
    return str(path), layers


@pytest.mark.parametrize(
    ("output", "layer", "expected"),
    [
        ("out", "", "Combined"),
        ("out", "Combined", "Combined"),
        ("field", "Depth", "Depth"),
        ("vector", "Normal", "Normal"),
    ],
)
def test_every_kind_of_layer_arrives_exactly(run, passes, output, layer, expected):
    path, layers = passes
    np.testing.assert_array_equal(run(graph_of(path, layer, (output,)), output=output), layers[expected])


def test_only_what_is_wanted_is_read(renderer, passes):
    path, _ = passes
    graph = graph_of(path, "Combined", ("out", "field", "vector"))
    plan = renderer.compile(graph, RenderRequest(targets={"field": Port("outputs", "field")}))
    assert [upload.picture.kind for upload in plan.uploads] == [Kind.FIELD]
    assert len(renderer.compile(graph, RenderRequest()).uploads) == 3


def test_a_relative_path_starts_at_the_graph(run, passes):
    path, layers = passes
    graph = graph_of(Path(path).name, "", ("out",))
    folder = Graph(**{**vars(graph), "folder": str(Path(path).parent)})
    np.testing.assert_array_equal(run(folder), layers["Combined"])


@pytest.mark.parametrize(("path", "layer", "said"), [("missing.exr", "", "missing.exr"), ("", "Mist", "Mist")])
def test_what_cannot_be_read_is_an_input_error(run, passes, path, layer, said):
    with pytest.raises(InputError, match=said):
        run(graph_of(path or passes[0], layer, ("out",)))
