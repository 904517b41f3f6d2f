"""What is read ahead is what would be read, and nothing else is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from halation.graph import Graph, Input, Output, Port
from halation.inputs.prefetch import MAX_WAITING, Prefetcher
from halation.inputs.provider import MediaProvider
from halation.media import LayerRequest, read_layer, write_picture
from halation.nodes import Kind
from halation.resources.picture import Picture
from halation.resources.sandbox import UNRESTRICTED


def graph(**inputs: Input) -> Graph:
    """Every input is an output."""
    links = {Port("outputs", name): Port("inputs", name) for name in inputs}
    return Graph(inputs=inputs, outputs={name: Output(kind=end.kind) for name, end in inputs.items()}, links=links)


@pytest.fixture
def picture(tmp_path: Path) -> str:
    path = tmp_path / "picture.exr"
    pixels = np.random.default_rng(1).random((5, 7, 4), np.float32)
    write_picture(
        path,
        {"": pixels, "depth": pixels[..., :1]},
        kinds={"": Kind.IMAGE, "depth": Kind.FIELD},
        precision="float",
        sandbox=UNRESTRICTED,
    )
    return str(path)


def test_it_is_what_would_be_read(picture: str) -> None:
    ahead = Prefetcher(
        graph(a=Input(), z=Input(Kind.FIELD)), {"a": picture, "z": f"{picture}:depth"}, sandbox=UNRESTRICTED
    )
    pictures = MediaProvider(prefetcher=ahead, sandbox=UNRESTRICTED)
    for what in (Picture(picture, "", Kind.IMAGE, 4), Picture(picture, "depth", Kind.FIELD, 1)):
        alone = read_layer(what.path, what.layer, what.kind, what.width, sandbox=UNRESTRICTED).array
        for _ in range(2):  # read ahead, and read again
            np.testing.assert_array_equal(pictures.load_pixels(what), alone, strict=True)


def test_it_is_there_once(picture: str) -> None:
    ahead = Prefetcher(graph(a=Input()), {"a": picture}, sandbox=UNRESTRICTED)
    assert ahead.take((picture, LayerRequest("depth"))) is None
    assert ahead.take((picture, LayerRequest(""))) is not None
    assert ahead.take((picture, LayerRequest(""))) is None


def test_an_input_asks_for_a_layer_that_the_file_may_lack(picture: str) -> None:
    """As `MediaProvider.bind` has it: a plain picture stands for any layer of color."""
    made = graph(a=Input(layer="Combined"))
    bound = MediaProvider(sandbox=UNRESTRICTED).bind(made, {"a": picture})["a"]
    assert (
        Prefetcher(made, {"a": picture}, sandbox=UNRESTRICTED).take((bound.path, LayerRequest(bound.layer))) is not None
    )


def test_files_of_the_graph_are_beside_it(picture: str) -> None:
    made = Graph(
        inputs={"a": Input(file="picture.exr")},
        outputs={"a": Output()},
        folder=str(Path(picture).parent),
        links={Port("outputs", "a"): Port("inputs", "a")},
    )
    assert Prefetcher(made, {}, sandbox=UNRESTRICTED).take((picture, LayerRequest(""))) is not None


def test_what_nobody_is_sure_to_want_is_not_read(picture: str, tmp_path: Path) -> None:
    made = graph(a=Input(file=picture), b=Input(file=picture), c=Input())
    other = tmp_path / "other.exr"
    other.write_bytes(Path(picture).read_bytes())
    ahead = Prefetcher(made, {"a": str(other), "c": str(tmp_path / "picture.####.exr")}, sandbox=UNRESTRICTED)
    assert ahead.take((picture, LayerRequest(""))) is None  # b follows a to the other file
    assert ahead.take((str(tmp_path / "picture.####.exr"), LayerRequest(""))) is None
    assert ahead.take((str(other), LayerRequest(""))) is not None
    idle = Graph(inputs={"a": Input()}, outputs={"a": Output()})
    assert Prefetcher(idle, {"a": picture}, sandbox=UNRESTRICTED).take((picture, LayerRequest(""))) is None


def test_few_pictures_wait(picture: str, tmp_path: Path) -> None:
    names = [f"a{number}" for number in range(MAX_WAITING + 2)]
    files = {name: str(tmp_path / f"{name}.exr") for name in names}
    for file in files.values():
        Path(file).write_bytes(Path(picture).read_bytes())
    ahead = Prefetcher(graph(**{name: Input() for name in names}), files, sandbox=UNRESTRICTED)
    assert [ahead.take((file, LayerRequest(""))) is None for file in files.values()] == [False] * MAX_WAITING + [
        True
    ] * 2


def test_a_damaged_file_is_found_out_by_who_wants_it(tmp_path: Path) -> None:
    path = tmp_path / "damaged.exr"
    path.write_bytes(b"no picture")
    for layer in ("", "Combined"):
        Prefetcher(graph(a=Input(layer=layer)), {"a": str(path)}, sandbox=UNRESTRICTED)
