"""Pictures with an overscan that do not fit on the device are made in tiles: the same to the bit."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from devices import form_to_test
from exr_files import create_output
from halation.errors import DeviceError
from halation.graph import Graph, Input, Output, Port, Settings
from halation.nodes import Filter, catalogue
from halation.renderer import Renderer, RenderRequest, open_device
from halation.resources.sandbox import UNRESTRICTED
from msgspec.structs import replace

NODES = catalogue()
WIDTH, HEIGHT, MARGIN = 301, 203, 24


def move(x: float, y: float, **values: object) -> Filter:
    return NODES["transform"](position=(x, y), **values)


CHAINS = {
    "moves": (move(40.0, 30.0), NODES["exposure"](stops=1.0), move(-40.0, -30.0)),
    "turns": (move(0.0, 0.0, rotation=30.0), NODES["invert"](), move(9.0, 0.0, rotation=-30.0)),
    "a blur": (move(40.0, 30.0), NODES["gaussian_blur"](sigma=3.0, edge="black"), move(-40.0, -30.0)),
    "a clamped blur": (move(-20.0, 9.0), NODES["gaussian_blur"](sigma=12.0), move(20.0, 9.0)),
    "a decimated blur": (move(-20.0, 9.0), NODES["gaussian_blur"](sigma=12.0, edge="black"), move(20.0, 9.0)),
}


def chain(*nodes: Filter, file: Path, overscan: float) -> Graph:
    graph = Graph(settings=Settings(overscan=overscan)).add_input("picture", Input(file=str(file)))
    last = Port("inputs", "picture")
    for number, node in enumerate(nodes):
        graph = graph.add(f"n{number}", node).connect(last, Port(f"n{number}", "image"))
        last = Port(f"n{number}", "out")
    return graph.add_output("out", Output()).connect(last, Port("outputs", "out"))


@pytest.fixture(scope="module")
def plate(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Noise with an overscan of `MARGIN` pixels."""
    path = tmp_path_factory.mktemp("plate") / "plate.exr"
    pixels = np.random.default_rng(1).random((HEIGHT + 2 * MARGIN, WIDTH + 2 * MARGIN, 4)).astype(np.float32)
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 4, "float")
    spec.x, spec.y, spec.full_width, spec.full_height = -MARGIN, -MARGIN, WIDTH, HEIGHT
    spec.full_x = spec.full_y = 0
    file = create_output(path)
    assert file.open(str(path), spec) and file.write_image(pixels) and file.close()
    return path


@pytest.fixture(scope="module")
def engines() -> Iterator[dict[str, Renderer]]:
    """A device that holds everything, one with small textures, and one with little memory."""
    device = open_device(form_to_test(), sandbox=UNRESTRICTED)
    limits = {"whole": {}, "small": {"max_size": 150}, "frugal": {"memory": 3_500_000}}
    targets = {name: replace(device.target, **limit) for name, limit in limits.items()}
    renderers = {
        name: Renderer(device.with_target(target), budget=0, sandbox=UNRESTRICTED) for name, target in targets.items()
    }
    yield renderers
    for renderer in renderers.values():
        renderer.close()


@pytest.mark.parametrize("overscan", [0.1, 1.0])
@pytest.mark.parametrize("name", CHAINS)
def test_tiles_are_the_whole_picture(engines: dict[str, Renderer], plate: Path, name: str, overscan: float) -> None:
    graph = chain(*CHAINS[name], file=plate, overscan=overscan)
    whole, small, frugal = (engines[kind].render(graph, RenderRequest(precision="float"))["out"] for kind in engines)
    np.testing.assert_array_equal(small, whole)
    np.testing.assert_array_equal(frugal, whole)


def test_small_memory_takes_tiles(engines: dict[str, Renderer], plate: Path) -> None:
    graph = chain(*CHAINS["moves"], file=plate, overscan=1.0)
    tiled = {kind: engine.compile(graph, RenderRequest(precision="float")).tiling for kind, engine in engines.items()}
    assert tiled["whole"] is None and tiled["small"] is not None and tiled["frugal"] is not None


def test_what_must_be_whole_is_refused_with_a_sentence(engines: dict[str, Renderer], plate: Path) -> None:
    graph = chain(*CHAINS["moves"], file=plate, overscan=0.1)
    request = RenderRequest(precision="float", whole=frozenset({"out"}))
    with pytest.raises(DeviceError, match="with those beyond the frame, which must be whole"):
        engines["small"].render(graph, request)
