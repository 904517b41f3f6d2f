"""What every node promises on a real picture: the same bytes every time, and the same look at half size."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
import OpenImageIO as oiio
import pytest
from devices import open_renderer
from exr_files import write_exr
from halation import document, media
from halation.color.transforms import decode_srgb
from halation.compiler import load_library
from halation.media.comparison.data_range import find_data_range
from halation.nodes import Kind, Node, Pointwise, built_in_nodes
from halation.presets import sample
from halation.reference.specimen import drawable_outputs, show_on_sample
from halation.renderer import Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED

Array = np.ndarray

WIDTH, HEIGHT = 480, 270

BRIGHTEST = 4.0
"""Four and a half stops above middle gray: next to suns, one pixel more or less is all that counts."""

LIMIT = 0.03
"""Mean FLIP (Andersson et al. 2020) at 67 pixels per degree."""

AFAR = 0.02
"""Mean difference of light, 0..1, between averages over a sixteenth of the width."""

NODES = tuple(node for node in built_in_nodes().values() if drawable_outputs(node))


def noted(node: type[Node], differs: str) -> frozenset[str]:
    """The outputs of which the node says that a proxy differs so."""
    return frozenset(name for note in node.proxy_notes if note.differs == differs for name in note.outputs)


def knows_places(node: type[Node]) -> bool:
    """False where each pixel is computed from the same pixel alone: then a proxy cannot differ."""
    words = frozenset({"pixel", "extent", "proxy"})
    return not issubclass(node, Pointwise) or load_library().uses(f"{node.category}/{node.id}", words, node.id)


@pytest.fixture(scope="module")
def picture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sample without its brightest light, as sharp as half as many pixels can be: a proxy loses nothing."""

    def layer(name: str, kind: Kind, width: int, size: tuple[int, int]) -> Array:
        pixels = media.read_layer(sample(), name, kind, width, sandbox=UNRESTRICTED).array.astype(np.float32)
        pixels = np.minimum(pixels, BRIGHTEST) if kind is Kind.IMAGE else pixels
        return cv2.resize(pixels, size, interpolation=cv2.INTER_AREA if kind is Kind.IMAGE else cv2.INTER_NEAREST)

    small = layer("Combined", Kind.IMAGE, 4, (WIDTH // 2, HEIGHT // 2))
    layers = {
        "Combined": cv2.resize(small, (WIDTH, HEIGHT), interpolation=cv2.INTER_LINEAR),
        "Depth": layer("Depth", Kind.FIELD, 1, (WIDTH, HEIGHT))[..., None],
        "Normal": layer("Normal", Kind.VECTOR, 3, (WIDTH, HEIGHT)),
        "Position": layer("Position", Kind.VECTOR, 3, (WIDTH, HEIGHT)),
        "Vector": layer("Vector", Kind.VECTOR, 4, (WIDTH, HEIGHT)),
        "Object Index": layer("Object Index", Kind.FIELD, 1, (WIDTH, HEIGHT))[..., None],
        "CryptoObject00": layer("CryptoObject00", Kind.VECTOR, 4, (WIDTH, HEIGHT)),
    }
    formats = dict.fromkeys(layers, "float") | {"Combined": "half"}
    return write_exr(tmp_path_factory.mktemp("picture") / "soft.exr", layers, formats)


@pytest.fixture(scope="module")
def another() -> Iterator[Renderer]:
    """A second context with programs and textures of its own."""
    renderer = open_renderer(budget=0)
    yield renderer
    renderer.close()


def rendered(engine: Renderer, node: type[Node], picture: Path, scale: float) -> dict[str, Array]:
    """All outputs of a node at its defaults, by way of a file."""
    graph = document.loads(document.dumps(show_on_sample(node, picture)), sandbox=UNRESTRICTED)
    found = engine.render(graph, RenderRequest(scale=scale, frame=7))
    return {name: array.astype(np.float32) for name, array in found.items()}


def halved(array: Array, filter: str) -> Array:
    """By OpenImageIO's triangle filter, which is also that of proxies, or by means of 2 x 2 pixels."""
    source, (height, width) = oiio.ImageBuf(np.ascontiguousarray(array, np.float32)), array.shape[:2]
    made = oiio.ImageBufAlgo.resize(source, filtername=filter, roi=oiio.ROI(0, width // 2, 0, height // 2))
    return made.get_pixels(oiio.FLOAT).reshape(height // 2, width // 2, -1)


def seen(array: Array, reference: Array, kind: Kind) -> Array:
    """What a display shows, as linear light: scene light compressed by Reinhard's L / (1 + L), data by its range."""
    if kind is Kind.IMAGE:
        light = array if reference[..., :3].max() <= 1.0 else array / (1.0 + np.maximum(array, 0.0))
    else:
        low, high = find_data_range(reference)
        light = decode_srgb(np.clip((array - low) / (high - low), 0.0, 1.0))
    light = np.pad(light, ((0, 0), (0, 0), (0, 1))) if light.shape[2] == 2 else light
    light = light[..., [0, 0, 0]] if light.shape[2] == 1 else light[..., :3]
    return np.clip(np.ascontiguousarray(light, np.float32), 0.0, 1.0)


def flip(reference: Array, test: Array) -> float:
    """The mean difference that the eye would notice."""
    made = oiio.ImageBufAlgo.FLIP_diff(oiio.ImageBuf(reference), oiio.ImageBuf(test), hdr=0)
    return float(made.spec()["FLIP:meanerror"])


def from_afar(light: Array) -> Array:
    """Averages over a sixteenth of the width."""
    return cv2.resize(light, (16, 9), interpolation=cv2.INTER_AREA)


@pytest.mark.parametrize("node", NODES, ids=lambda node: node.id)
def test_the_same_graph_and_frame_give_the_same_bytes(
    node: type[Node], renderer: Renderer, another: Renderer, picture: Path
) -> None:
    first, second = (rendered(engine, node, picture, 0.5) for engine in (renderer, another))
    for name, array in first.items():
        assert array.tobytes() == second[name].tobytes(), name


@pytest.mark.parametrize("node", [node for node in NODES if knows_places(node)], ids=lambda node: node.id)
def test_half_size_looks_the_same(node: type[Node], renderer: Renderer, picture: Path) -> None:
    """In one of the ways to shrink the result: as light, as a crisp drawing, or as data, which is never mixed."""
    whole, half = (rendered(renderer, node, picture, scale) for scale in (1.0, 0.5))
    for name, now in whole.items():
        output = node.outputs[name]
        kind, place = output.socket.kind, f"{node.id}.{name}"
        if output.socket.single or name in noted(node, "look"):
            continue
        assert half[name].shape[:2] == (now.shape[0] // 2, now.shape[1] // 2), place
        shrunk = [halved(now, "triangle"), halved(now, "box"), *([now[1::2, 1::2]] if kind is not Kind.IMAGE else [])]
        expected, found = [seen(one, now, kind) for one in shrunk], seen(half[name], now, kind)
        assert np.abs(from_afar(expected[1]) - from_afar(found)).mean() < AFAR, place
        assert name in noted(node, "detail") or any(flip(one, found) < LIMIT for one in expected), (
            f"{place}: a proxy of half the size looks different; mend it, or say why in proxy_notes"
        )


@pytest.mark.parametrize("node", NODES, ids=lambda node: node.id)
def test_proxy_notes_name_outputs(node: type[Node]) -> None:
    detail, look = noted(node, "detail"), noted(node, "look")
    assert node.outputs.keys() >= detail | look and not detail & look
    assert all(note.reason and note.outputs for note in node.proxy_notes)
