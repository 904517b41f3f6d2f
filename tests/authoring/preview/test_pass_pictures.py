"""The passes of what the viewer shows, as pictures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from halation.authoring.preview.pass_pictures import PassPictures
from halation.authoring.preview.request import PreviewRequest
from halation.graph import Graph, Input, Port
from halation.media.pictures.writer import write_picture
from halation.nodes import Kind, Node
from halation.nodes.blur.box_blur import BoxBlur
from halation.nodes.glow.bloom import Bloom
from halation.renderer import Renderer
from halation.resources.sandbox import UNRESTRICTED
from scipy.ndimage import uniform_filter

SIZE = 96, 54


@pytest.fixture
def mask(tmp_path: Path) -> Path:
    """A field of one bright square on black."""
    pixels = np.zeros((SIZE[1], SIZE[0], 1), np.float32)
    pixels[20:30, 40:52] = 1.0
    path = tmp_path / "mask.exr"
    write_picture(path, {"mask": pixels}, kinds={"mask": Kind.FIELD}, precision="float", sandbox=UNRESTRICTED)
    return path


def make_graph(id: str, node: Node) -> Graph:
    return Graph(inputs={"mask": Input(Kind.FIELD)}).add(id, node).connect(Port("inputs", "mask"), Port(id, "image"))


def run(pictures: PassPictures, graph: Graph, port: str, bindings: dict[str, str]) -> None:
    pictures.want(PreviewRequest(graph, {"A": Port.parse(port)}, bindings, 1.0, 1, None))
    while pictures.work():
        pass


def test_a_box_blur_is_a_pass_along_x_and_one_along_y(renderer: Renderer, mask: Path) -> None:
    graph = make_graph("blur", BoxBlur(radius=3.0))
    pictures = PassPictures(renderer)
    run(pictures, graph, "blur.out", {"mask": str(mask)})
    assert [entry.number for entry in pictures.passes] == [0, 1, 2]
    pixels = np.zeros(SIZE[::-1])
    pixels[20:30, 40:52] = 1.0
    for entry, lengths in zip(pictures.passes, ((1, 1), (1, 7), (7, 7)), strict=True):
        low, high = entry.picture.span
        assert low == 0.0 and 0.8 < high <= 1.0, "without the brightest pixels"
        codes = 255.0 * np.clip(uniform_filter(pixels, lengths, mode="nearest") / high, 0.0, 1.0)
        np.testing.assert_allclose(entry.picture.codes[..., 0], codes, atol=1.0)
    assert pictures.passes[1].reads == ("mask",) and pictures.passes[2].reads == ("1",)
    assert len(pictures.seconds) == 2 and min(pictures.seconds) > 0.0
    pictures.close()


def test_a_pyramid_halves_its_sizes_and_reads_the_pass_before(renderer: Renderer, mask: Path) -> None:
    graph = make_graph("bloom", Bloom(radius=0.2))
    pictures = PassPictures(renderer)
    run(pictures, graph, "bloom.out", {"mask": str(mask)})
    sizes = [entry.makes.split()[0] for entry in pictures.passes]
    assert sizes[:5] == ["96x54", "96x54", "48x27", "24x14", "12x7"], "the file, as color, then halves, rounded up"
    assert pictures.passes[2].reads == ("1",)
    pictures.close()


def test_a_fault_is_a_sentence_and_the_next_request_is_shown(renderer: Renderer, mask: Path) -> None:
    graph = make_graph("blur", BoxBlur())
    pictures = PassPictures(renderer)
    run(pictures, graph, "blur.out", {"mask": str(mask.with_name("none.exr"))})
    assert "none.exr" in pictures.fault and not pictures.passes
    run(pictures, graph, "blur.out", {"mask": str(mask)})
    assert not pictures.fault and pictures.passes
    first = pictures.revision
    run(pictures, graph, "blur.out", {"mask": str(mask)})
    assert pictures.revision == first, "the same request costs nothing"
    pictures.close()
