"""The pixel aspect ratio goes with a picture from file to file; `resize` follows it, and can make pixels square."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from exr_files import create_output, header, read
from halation.graph import Graph, Input, Output, Port, Settings
from halation.nodes import Kind, Node, catalogue
from halation.renderer import Renderer, RenderRequest
from halation.renderer.jobs.job import OutputSettings, run_job
from halation.resources.sandbox import UNRESTRICTED
from typer.testing import CliRunner

NODES = catalogue()
WIDTH, HEIGHT = 37, 24


def write_anamorphic(path: Path, aspect: float = 2.0, seed: int = 3) -> np.ndarray:
    """A picture as a camera with an anamorphic lens writes it."""
    pixels = np.random.default_rng(seed).random((HEIGHT, WIDTH, 3), np.float32)
    spec = oiio.ImageSpec(WIDTH, HEIGHT, 3, "float")
    spec.attribute("PixelAspectRatio", aspect)
    file = create_output(path)
    assert file.open(str(path), spec) and file.write_image(pixels) and file.close()
    return pixels


def chain(file: Path, *nodes: Node) -> Graph:
    """Nodes in a row, from the file to the output `out`."""
    graph = Graph(settings=Settings()).add_input("picture", Input(Kind.IMAGE, file=str(file)))
    last = Port("inputs", "picture")
    for number, node in enumerate(nodes):
        first = next(iter(node.inputs))
        graph = graph.add(f"n{number}", node).connect(last, Port(f"n{number}", first))
        last = Port(f"n{number}", "out")
    return graph.add_output("out", Output()).connect(last, Port("outputs", "out"))


def write(renderer: Renderer, graph: Graph, path: Path, **request) -> oiio.ImageSpec:
    settings = OutputSettings((("", path),), precision="float")
    run_job(renderer, graph, RenderRequest(**request), settings, (1,))
    return header(path)


def find_ratio(spec: oiio.ImageSpec) -> float:
    return spec.get_float_attribute("PixelAspectRatio", 1.0)


@pytest.mark.parametrize(
    "nodes",
    [
        (),
        (NODES["gaussian_blur"](sigma=9.0), NODES["exposure"](stops=1.0)),
        (NODES["crop"](top_left=(0.2, 0.1), bottom_right=(0.6, 0.9)),),
        (NODES["bloom"](), NODES["transform"](rotation=20.0, scale=(2.0, 1.0))),
        (NODES["upscale"](),),
    ],
    ids=lambda nodes: "+".join(type(node).__name__ for node in nodes) or "nothing",
)
def test_a_picture_keeps_the_shape_of_its_pixels(renderer, tmp_path: Path, nodes: tuple[Node, ...]) -> None:
    write_anamorphic(tmp_path / "a.exr")
    assert find_ratio(write(renderer, chain(tmp_path / "a.exr", *nodes), tmp_path / "b.exr")) == 2.0


def test_a_proxy_has_the_same_pixels(renderer, tmp_path: Path) -> None:
    write_anamorphic(tmp_path / "a.exr")
    graph = chain(tmp_path / "a.exr", NODES["exposure"](stops=1.0))
    assert find_ratio(write(renderer, graph, tmp_path / "half.exr", scale=0.5)) == 2.0


@pytest.mark.parametrize("order", [("image", "over"), ("over", "image")])
def test_what_is_generated_takes_the_shape_of_what_it_is_mixed_with(renderer, tmp_path: Path, order) -> None:
    write_anamorphic(tmp_path / "a.exr")
    graph = chain(tmp_path / "a.exr", NODES["exposure"](stops=1.0)).add("noise", NODES["noise"]())
    names = [name for name, socket in NODES["mix_images"].inputs.items() if socket.kind is Kind.IMAGE][:2]
    graph = graph.add("mix", NODES["mix_images"]())
    sources = {"image": Port("n0", "out"), "over": Port("noise", "out")}
    for name, source in zip(names, order, strict=True):
        graph = graph.connect(sources[source], Port("mix", name))
    graph = graph.connect(Port("mix", "out"), Port("outputs", "out"))
    assert find_ratio(write(renderer, graph, tmp_path / "b.exr")) == 2.0


@pytest.mark.parametrize(("scale", "expected"), [((2.0, 1.0), 1.0), ((1.0, 2.0), 4.0), ((3.0, 3.0), 2.0)])
def test_a_picture_that_is_made_wider_keeps_its_shape(renderer, tmp_path: Path, scale, expected: float) -> None:
    write_anamorphic(tmp_path / "a.exr")
    graph = chain(tmp_path / "a.exr", NODES["resize"](scale=scale))
    assert find_ratio(write(renderer, graph, tmp_path / "b.exr")) == pytest.approx(expected)


def test_square_pixels(renderer, tmp_path: Path) -> None:
    """With whole factors, a box filter repeats pixels."""
    pixels = write_anamorphic(tmp_path / "a.exr")
    graph = chain(tmp_path / "a.exr", NODES["resize"](square_pixels=True, kernel="box"))
    assert find_ratio(write(renderer, graph, tmp_path / "b.exr")) == 1.0
    np.testing.assert_allclose(read(tmp_path / "b.exr")[..., :3], pixels.repeat(2, axis=1), atol=1e-6)


@pytest.mark.parametrize("aspect", [1.5, 0.9091, 1.0667, 1.0])
def test_square_pixels_of_any_ratio(renderer, tmp_path: Path, aspect: float) -> None:
    """The width is rounded to whole pixels."""
    write_anamorphic(tmp_path / "a.exr", aspect)
    spec = write(renderer, chain(tmp_path / "a.exr", NODES["resize"](square_pixels=True)), tmp_path / "b.exr")
    assert (spec.width, spec.height, find_ratio(spec)) == (round(WIDTH * aspect), HEIGHT, 1.0)


def test_a_file_that_changes_changes_the_result(renderer, tmp_path: Path) -> None:
    """One renderer, which keeps plans and pictures, and the same pixels."""
    graph = chain(tmp_path / "a.exr", NODES["exposure"](stops=1.0), NODES["resize"](square_pixels=True))
    kept = chain(tmp_path / "a.exr", NODES["exposure"](stops=1.0))
    for aspect in (2.0, 1.0, 3.0):
        write_anamorphic(tmp_path / "a.exr", aspect)
        assert write(renderer, graph, tmp_path / "b.exr").width == WIDTH * aspect
        assert find_ratio(write(renderer, kept, tmp_path / "c.exr")) == aspect


@pytest.mark.parametrize("aspect", [100.0, 0.001, 1e6])
def test_a_ratio_that_cannot_be_meant_is_no_ratio(renderer, tmp_path: Path, aspect: float) -> None:
    write_anamorphic(tmp_path / "a.exr", aspect)
    spec = write(renderer, chain(tmp_path / "a.exr", NODES["resize"](square_pixels=True)), tmp_path / "b.exr")
    assert (spec.width, find_ratio(spec)) == (WIDTH, 1.0)


def test_info_and_explain_say_it(tmp_path: Path) -> None:
    from halation import document
    from halation.cli.program import app

    write_anamorphic(tmp_path / "a.exr")
    graph = chain(Path("a.exr"), NODES["exposure"](stops=1.0), NODES["resize"](square_pixels=True))
    document.save(graph, tmp_path / "graph.json", sandbox=UNRESTRICTED)
    said = CliRunner().invoke(app, ["info", str(tmp_path / "a.exr")]).output
    assert f"{WIDTH} x {HEIGHT}, pixel aspect 2, openexr" in said
    plan = CliRunner().invoke(app, ["explain", str(tmp_path / "graph.json")]).output
    assert f"{WIDTH}x{HEIGHT} pixel aspect 2 " in plan and f"{2 * WIDTH}x{HEIGHT} pixel aspect" not in plan
