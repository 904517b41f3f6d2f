"""Every preset is sound, and looks on the sample as it looked when a person last approved it.

After a change that is meant to be seen, look at the pictures (`./dev demo`), then renew thumbnails and docs/images:
    HALATION_RENEW=1 python -m pytest tests/presets tests/cli/test_gallery.py
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Container, Iterator
from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import pairwise, product
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from halation import document, media
from halation.graph import Control, Graph, problems
from halation.graph.graph import find_setting
from halation.media.comparison.contact_sheet import make_sheet, show_light
from halation.nodes import Kind
from halation.presets import paths
from halation.presets import picture as thumbnail
from halation.renderer import FrameRenderer, Renderer, RenderRequest
from halation.renderer.jobs.job import OutputSettings, run_job
from halation.resources.sandbox import UNRESTRICTED

Array = np.ndarray

PLAIN = RenderRequest()
RENEW = bool(os.environ.get("HALATION_RENEW"))
IMAGES = Path(__file__).parents[2] / "docs" / "images"
PRESETS = {path.stem: path for path in paths()}
ASKED = {"soft_bloom", "cinematic_grade", "night_street", "emboss_and_edges", "dreamy_glow", "underwater"}
GEOMETRY = {"geometry", "lens", "light"}
TIME = {
    "dolly_zoom",
    "feedback_tunnel",
    "heartbeat",
    "ink_boil",
    "light_painting",
    "long_exposure",
    "morph",
    "out_of_the_tunnel",
    "rack_focus",
    "turntable",
}
"""Presets that move."""
FINE = {
    "canny",
    "convolve3x3",
    "crosshatch",
    "crt",
    "difference_of_gaussians",
    "edge_detect",
    "film_grain",
    "geometry_edges",
    "halftone",
}
"""Their lines, dots and grains are a pixel or two wide, so a proxy shows them bolder or not at all."""
LAYERS = {
    "beauty": "Combined",
    "depth": "Depth",
    "normal": "Normal",
    "position": "Position",
    "albedo": "Diffuse Color",
    "emission": "Emission",
    "ids": "Object Index",
}
"""What inputs are called, so that a render's layers find theirs in every preset."""

each = pytest.mark.parametrize("name", PRESETS, scope="module")
"""All tests of a preset one after the other: they share its picture and its programs."""


def each_day(part: int, always: Container[str] = ()) -> list[Any]:
    """All presets: one in so many is tried by day, and those named; the others by night."""
    return [
        pytest.param(name, marks=() if name in always or not number % part else pytest.mark.nightly)
        for number, name in enumerate(PRESETS)
    ]


@cache
def loaded(name: str) -> Graph:
    return document.load(PRESETS[name], sandbox=UNRESTRICTED)


def used(name: str, what: str) -> set[str]:
    """Ids or categories of a preset's nodes."""
    return {getattr(node, what, "") for node in loaded(name).nodes.values()}


def moment(graph: Graph, part: float = 0.5) -> int:
    """A frame on the way from the first to the last: the middle stands for all."""
    first, last = graph.settings.frames or (1, 1)
    return first + int((last - first) * part)


def rendered(renderer: Renderer, graph: Graph, wanted: RenderRequest = PLAIN, part: float = 0.5) -> Array:
    """The output at such a frame, with the history that it has by then."""
    reel = FrameRenderer(renderer, graph, wanted)
    try:
        return reel.render_frame(moment(graph, part))["image"]
    finally:
        reel.close()


def picture(renderer: Renderer, graph: Graph, scale: float = 1.0, part: float = 0.5) -> Array:
    """The output as light of the display, [h, w, 3] within 0..1."""
    return show_light(rendered(renderer, graph, RenderRequest(scale=scale), part), graph.outputs["image"].view)


def encoded(light: Array) -> Array:
    """What the eye compares: sRGB in steps of 8 bits."""
    return 255.0 * np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def size_of(graph: Graph) -> tuple[int, int]:
    """Of the sample, or of what the graph makes from nothing."""
    return graph.settings.size or (480, 270)


def small_scale(name: str) -> float:
    """The scale at which a preset is rendered often: smaller where frames before it or a scene take long."""
    if FINE & used(name, "id"):
        return 1.0
    return 0.25 if loaded(name).settings.size or name in TIME else 0.5


def list_views(name: str) -> list[tuple[float, float]]:
    """Scales and parts of the range of frames, quick ones first: a control need not show in all of them."""
    return [*product((0.125, 0.25, small_scale(name)), (0.2, 0.5) if name in TIME else (0.5,))]


def shrunk(light: Array, width: int, height: int) -> Array:
    return cv2.resize(light, (width, height), interpolation=cv2.INTER_AREA)


@dataclass(frozen=True)
class FullPicture:
    """What a preset makes at full size."""

    light: Array
    """Light of the display, [height, width, 3] within 0..1."""
    brightest: float
    """The largest scene-linear number; NaN where a pixel is not finite."""


FullPictures = Callable[[str], FullPicture]


@pytest.fixture(scope="module")
def full(renderer: Renderer) -> FullPictures:
    """The pictures of presets at full size: that of the last one is kept."""

    @lru_cache(maxsize=1)
    def render(name: str) -> FullPicture:
        pixels = rendered(renderer, loaded(name))
        brightest = float(pixels[..., :3].max()) if np.isfinite(pixels).all() else math.nan
        return FullPicture(show_light(pixels, loaded(name).outputs["image"].view), brightest)

    return render


@pytest.fixture
def forgetful() -> Iterator[Renderer]:
    """An engine that keeps no results."""
    made = Renderer(budget=0, sandbox=UNRESTRICTED)
    yield made
    made.close()


def test_the_collection_is_complete() -> None:
    assert PRESETS.keys() >= ASKED
    assert len(PRESETS) >= 20
    assert sum(bool(GEOMETRY & used(name, "category")) for name in PRESETS) >= 10
    assert {name for name in PRESETS if loaded(name).settings.frames} == TIME


@each
def test_file_is_sound(name: str) -> None:
    graph = loaded(name)
    assert document.dumps(graph) == PRESETS[name].read_text("utf-8")
    assert problems(graph) == ()
    assert not graph.extra
    assert set(graph.outputs) == {"image"}
    assert bool(graph.settings.size) != bool({*graph.inputs} - {"environment"})
    assert all(graph.inputs[end].layer == layer for end, layer in LAYERS.items() if end in graph.inputs)
    for end in graph.inputs.values():
        assert end.doc and not Path(end.file).is_absolute() and ".." not in Path(end.file).parts
        file = media.read_info(PRESETS[name].parent / end.file, sandbox=UNRESTRICTED)
        assert not end.layer or media.find_layer(file, end.layer).name == end.layer


@each
def test_the_canvas_has_a_place_for_everything(name: str) -> None:
    """Left to right along the links, and nothing on top of another."""
    graph = loaded(name)
    places = {key: (place["x"], place["y"]) for key, place in graph.ui["nodes"].items()}
    ends = {f"inputs.{end}" for end in graph.inputs} | {f"outputs.{end}" for end in graph.outputs}
    assert places.keys() == {*graph.nodes, *ends}
    assert len(set(places.values())) == len(places)
    for target, source in graph.links.items():
        left = places[source.node] if source.node in places else places[str(source)]
        right = places[target.node] if target.node in places else places[str(target)]
        assert left[0] < right[0]


def ends(graph: Graph, item: Control) -> tuple[object, ...]:
    """Both ends of a control, or another color, place or curve."""
    value = find_setting(graph.nodes[item.target.node], item.target.socket)
    assert value is not None
    now = value.default
    if isinstance(now, tuple):
        return (tuple(0.6 * part + 0.02 for part in now),)
    return type(now)(value.low), type(now)(value.high)


@each
def test_every_control_changes_the_picture(name: str, renderer: Renderer) -> None:
    """To either end, in a small picture; if need be in larger ones, and of what moves at two frames."""
    graph = loaded(name)
    assert 2 <= len(graph.controls) <= 5
    before: dict[tuple[float, float], Array] = {}
    for control, item in graph.controls.items():
        assert item.label and item.doc
        most = 0.0
        for view, end in product(list_views(name), ends(graph, item)):
            if view not in before:
                before[view] = encoded(picture(renderer, graph, *view))
            changed = encoded(picture(renderer, graph.set_control(control, end), *view))
            assert np.isfinite(changed).all(), (control, end)
            most = max(most, np.abs(changed - before[view]).mean())
            if most > 0.3 and end == ends(graph, item)[-1]:
                break
        assert most > 0.3, control


@pytest.mark.parametrize("name", sorted(TIME))
def test_it_moves(name: str, renderer: Renderer) -> None:
    """For one to three seconds. Of a shot with other frames, the nearest are shown."""
    graph = loaded(name)
    first, last = graph.settings.frames or (0, 0)
    assert first == 1 and 24 <= last <= 72 and graph.settings.rate == 24.0
    assert all(end.missing == "nearest" for key, end in graph.inputs.items() if key in LAYERS)
    frames = [encoded(picture(renderer, graph, 0.5, part)) for part in (0.0, 0.25, 0.5)]
    for before, after in pairwise(frames):
        assert np.abs(after - before).mean() > 0.5


@each
def test_nothing_is_crushed_or_clipped(name: str, full: FullPictures) -> None:
    light = full(name).light
    assert light.shape == (*size_of(loaded(name))[::-1], 3)
    assert math.isfinite(full(name).brightest)
    assert (light.max(2) < 0.001).mean() < 0.04
    assert (light.min(2) > 0.999).mean() < 0.01
    assert encoded(light).std() > 15.0


@pytest.mark.parametrize("name", each_day(3), scope="module")
def test_half_size_looks_the_same(name: str, renderer: Renderer, full: FullPictures) -> None:
    """Mean difference of sRGB below 6/255; where fine lines or dots are drawn, a correlation above 0.75.

    Every day a third of the presets: tests/nodes/test_promises.py asks every node for it.
    """
    graph = loaded(name)
    proxy = encoded(picture(renderer, graph, scale=0.5))
    width, height = size_of(graph)
    expected = encoded(shrunk(full(name).light, width // 2, height // 2))
    if FINE & used(name, "id"):
        assert np.corrcoef(proxy.ravel(), expected.ravel())[0, 1] > 0.75
    else:
        assert np.abs(proxy - expected).mean() < 6.0


@pytest.mark.parametrize("name", each_day(12, TIME))
def test_rendering_twice_gives_the_same_bytes(name: str, forgetful: Renderer) -> None:
    """Every day what moves and a twelfth of the others: tests/nodes/test_promises.py asks every node for it."""
    wanted, part = RenderRequest(scale=small_scale(name)), 0.1 if name in TIME else 0.5
    first = rendered(forgetful, loaded(name), wanted, part).tobytes()
    passes = forgetful.runner.counters.passes
    assert rendered(forgetful, loaded(name), wanted, part).tobytes() == first
    assert forgetful.runner.counters.passes > passes


@each
def test_another_picture_of_another_size(name: str, renderer: Renderer) -> None:
    """Sizes follow the picture that is bound, and light from black to suns stays finite."""
    graph = loaded(name)
    light = np.exp2(np.random.default_rng(3).uniform(-20.0, 14.0, (37, 61, 4))).astype(np.float32)
    light[..., 3] = 1.0
    arrays = {key: light[..., : item.socket().channels] for key, item in graph.inputs.items()}
    made = rendered(renderer, graph, RenderRequest(arrays, size=(61, 37) if graph.settings.size else None), 0.1)
    assert made.shape == (37, 61, 4)
    assert np.isfinite(made).all()


@each
def test_thumbnail_is_as_approved(name: str, full: FullPictures) -> None:
    """Mean difference of what JPEG makes of both below 2/255: other devices round differently."""
    small = encoded(shrunk(full(name).light, 320, 180))[..., ::-1].round().astype(np.uint8)
    fine = (cv2.IMWRITE_JPEG_QUALITY, 88, cv2.IMWRITE_JPEG_SAMPLING_FACTOR, cv2.IMWRITE_JPEG_SAMPLING_FACTOR_444)
    made, file = cv2.imencode(".jpg", small, fine)[1], thumbnail(PRESETS[name])
    if RENEW:
        file.write_bytes(made.tobytes())
    golden, now = cv2.imread(str(file)), cv2.imdecode(made, cv2.IMREAD_COLOR)
    assert np.abs(now.astype(np.float32) - golden).mean() < 2.0


def test_no_thumbnail_is_left_over() -> None:
    assert {file.stem for file in thumbnail(paths()[0]).parent.iterdir()} == PRESETS.keys()


@each
def test_a_display_view_goes_with_tone_mapping(name: str, full: FullPictures) -> None:
    """What ends at 1 is finished, and needs no view, but for what is lit anew: that may just be dim."""
    lit = "deferred_lighting" in used(name, "id")
    ends = full(name).light.size > 0 and full(name).brightest < 1.5
    assert loaded(name).outputs["image"].view == ("none" if ends and not lit else "")


@pytest.mark.parametrize(("view", "expected"), [("", "none"), ("ACES", "ACES")])
def test_a_finished_picture_has_a_view_if_someone_asks_for_one(
    view: str, expected: str, renderer: Renderer, tmp_path: Path
) -> None:
    """What a tone map finished is not tone mapped again by the view."""
    graph, file = loaded("night_street"), tmp_path / "night.png"
    run_job(renderer, graph, RenderRequest(), OutputSettings((("image", file),), view))
    wanted = encoded(show_light(renderer.render(graph)["image"], expected))
    assert np.abs(cv2.imread(str(file))[..., ::-1] - wanted).max() < 1.5


def test_pictures_of_the_documentation_are_current(renderer: Renderer, full: FullPictures) -> None:
    """docs/images: the sample before and after one of the presets."""
    sample = document.loads(
        '{"halation": 1, "inputs": {"beauty": {"file": "samples/neon.exr", "layer": "Combined"}},'
        ' "outputs": {"image": {}}, "links": {"outputs.image": "inputs.beauty"}}',
        folder=str(PRESETS["night_street"].parent),
        sandbox=UNRESTRICTED,
    )
    hero = {"the render": picture(renderer, sample), "night_street": full("night_street").light}
    made, file = make_sheet(hero, 2), IMAGES / "hero.png"
    if RENEW:
        media.write_picture(file, {"image": made}, kinds={"image": Kind.IMAGE}, view="none", sandbox=UNRESTRICTED)
    assert file.stat().st_size <= 400_000
    there = cv2.imread(str(file))[..., ::-1].astype(np.float32)
    assert np.abs(there - encoded(made)).mean() < 2.0
