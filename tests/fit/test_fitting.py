"""Values that are known are found again; what a search may take is kept to."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from halation import document
from halation.errors import UsageError
from halation.graph import Graph, Input, Output, Port
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.curves import Curves
from halation.nodes.color.exposure import Exposure
from halation.nodes.color.saturation import Saturation
from halation.nodes.distort.kaleidoscope import Kaleidoscope
from halation.presets import paths
from halation.renderer import RenderRequest
from halation.resources.sandbox import UNRESTRICTED
from scipy.interpolate import RegularGridInterpolator

from .conftest import decode, encode, fit_to

PRESETS = {
    "bleach_bypass": 4,
    "cinematic_grade": 5,
    "depth_mist": 6,
    "film_halation": 5,
    "lens_character": 5,
    "miniature": 9,
    "night_vision": 4,
    "photographic_glare": 5,
    "silver_print": 7,
    "soft_bloom": 4,
    "technicolor": 7,
    "vintage_photo": 8,
}
"""Twelve presets, and how many numbers their controls have."""


def chain(*nodes) -> Graph:
    """A picture through these nodes."""
    graph, port = Graph().add_input("picture", Input()), Port("inputs", "picture")
    for node in nodes:
        name = type(node).__name__.lower()
        graph = graph.add(name, node).connect(port, Port(name, "image"))
        port = Port(name, "out")
    return graph.add_output("image", Output()).connect(port, Port("outputs", "image"))


@pytest.fixture(scope="module")
def picture() -> np.ndarray:
    """Smooth spots of many colors, RGBA."""
    light = np.random.default_rng(5).random((12, 16, 3)).astype(np.float32)
    light = light.repeat(3, axis=0).repeat(3, axis=1) * np.linspace(0.1, 0.9, 48, dtype=np.float32)[None, :, None]
    return np.concatenate([light, np.ones((36, 48, 1), np.float32)], axis=2)


def test_known_values_are_found_again(recover, picture):
    graph = chain(Exposure(stops=0.4), Saturation(saturation=0.7), GaussianBlur(sigma=3.0))
    request = RenderRequest({"picture": picture}, precision="float")
    found = recover(graph, ["*.stops", "*.saturation", "*.sigma"], 1, request)
    assert found.off.max() < 2e-3 and all(item.is_determined for item in found.result.values)
    assert found.result.delta_e[1] < 0.3 and found.result.renders < 100


def test_of_two_exposures_the_picture_shows_only_the_sum(renderer, picture):
    graph = replace(chain(Exposure()).add("second", Exposure()))
    graph = graph.connect(Port("exposure", "out"), Port("second", "image"))
    graph = graph.connect(Port("second", "out"), Port("outputs", "image"))
    request = RenderRequest({"picture": picture}, precision="float")
    result = fit_to(renderer, graph, request, picture[..., :3] * 0.5, "*.stops")
    assert sum(item.after for item in result.values) == pytest.approx(-1.0, abs=1e-3)
    assert not any(item.is_determined for item in result.values)


def test_whole_numbers_are_found_by_evolution(renderer, picture):
    """What a number of mirrors shows cannot be followed along slopes."""
    request = RenderRequest({"picture": picture}, precision="float")
    graph = chain(Exposure(), Kaleidoscope(segments=12))
    wanted = chain(Exposure(stops=-0.5), Kaleidoscope(segments=5))
    reference = renderer.render(wanted, request)["image"][..., :3]
    result = fit_to(renderer, graph, request, reference, "*.stops", "*.segments", renders=400)
    after = {item.name: item.after for item in result.values}
    assert after["kaleidoscope.segments"] == 5 and after["exposure.stops"] == pytest.approx(-0.5, abs=0.01)


def test_the_look_of_a_picture_with_other_things_in_it(renderer, picture):
    """The same spots elsewhere, darker and paler: what makes the look is found, to a tenth of what can be seen."""
    graph = chain(Exposure(), Saturation())
    request = RenderRequest({"picture": picture}, precision="float")
    gray = picture[..., :3] @ np.array([0.2126, 0.7152, 0.0722], np.float32)
    pale = (gray[..., None] + 0.6 * (picture[..., :3] - gray[..., None])) * 0.5
    result = fit_to(renderer, graph, request, pale[::-1, ::-1], "*.stops", "*.saturation", by="look")
    after = {item.name: item.after for item in result.values}
    assert after["exposure.stops"] == pytest.approx(-1.0, abs=0.02)
    assert after["saturation.saturation"] == pytest.approx(0.6, abs=0.02)
    assert result.delta_e is None


def test_a_search_ends_with_its_budget_and_keeps_the_best(renderer, picture):
    graph = chain(Exposure(), Curves())
    request = RenderRequest({"picture": picture}, precision="float")
    reference = picture[..., :3] * 0.7
    result = fit_to(renderer, graph, request, reference, "*.stops", "*.master", renders=12)
    assert result.renders <= 13 and result.stopped == "after 12 renders" and result.errors[1] < result.errors[0]
    calls = iter(range(100))
    stopped = fit_to(renderer, graph, request, reference, "*.stops", should_stop=lambda: next(calls) > 8)
    assert stopped.stopped == "interrupted" and stopped.errors[1] < stopped.errors[0]


def test_a_graph_that_is_like_the_reference_stays_as_it_is(renderer, picture):
    graph = chain(Exposure(stops=0.25))
    request = RenderRequest({"picture": picture}, precision="float")
    result = fit_to(renderer, graph, request, picture[..., :3] * 2.0**0.25, "*.stops")
    assert result.values[0].after == pytest.approx(0.25, abs=1e-3) and result.errors[1] <= result.errors[0] + 1e-6


def test_frames_of_another_shape_are_refused(renderer, picture):
    with pytest.raises(UsageError, match="both must show the same frame; for the look of another picture add --by"):
        fit_to(renderer, chain(Exposure()), RenderRequest({"picture": picture}), picture[:20, :, :3], "*.stops")


@pytest.mark.nightly
@pytest.mark.parametrize("name", PRESETS)
def test_presets_are_recovered(recover, name):
    """To 2 % of each range that the picture determines, in 200 renders."""
    graph = document.load({path.stem: path for path in paths()}[name], sandbox=UNRESTRICTED)
    found = recover(graph, ["*"], len(name), RenderRequest(size=(320, 180), precision="float"))
    assert len(found.result.values) == PRESETS[name] and found.result.renders <= 200
    assert any(item.is_determined for item in found.result.values)
    assert found.off_where_determined <= 0.02 and found.result.errors[1] < 0.05 * found.result.errors[0]


def look_up(codes: np.ndarray) -> np.ndarray:
    """A look as a table of 17 x 17 x 17 colors: an S curve, split tones, less saturation, colors that leak."""
    axis = np.linspace(0.0, 1.0, 17)
    color = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1)
    luma = color @ np.array([0.2126, 0.7152, 0.0722])
    bent = color**1.15 * (1.5 - color) + 0.5 * color
    middle = luma * (1.0 - luma)
    red = 1.04 * bent[..., 0] + 0.02 * (1.0 - luma) - 0.05 * middle
    green = 0.97 * bent[..., 1] + 0.03 * middle
    blue = 0.90 * bent[..., 2] + 0.07 * (1.0 - luma)
    toned = np.stack([red, green, blue], axis=-1)
    gray = (toned @ np.array([0.2126, 0.7152, 0.0722]))[..., None]
    pale = gray + (toned - gray) * (0.82 + 0.3 * middle)[..., None]
    leak = np.stack([0.06 * (luma - 0.4), 0.0 * luma, -0.05 * (luma - 0.4)], axis=-1)
    table = np.clip(pale + leak * color.max(axis=-1, keepdims=True), 0.0, 1.0)
    return RegularGridInterpolator((axis,) * 3, table)(codes)


@pytest.mark.nightly
@pytest.mark.timeout(900)
def test_an_unseen_table_of_colors_is_met(renderer, tmp_path: Path):
    """Curves, curves over the hue and a matrix come as close as 2 (CIEDE2000) to a graded frame of 8 bits."""
    preset = next(path for path in paths() if path.stem == "soft_bloom")
    shot = json.loads(preset.read_text("utf-8"))["inputs"]["beauty"]
    graph = {
        "halation": 1,
        "inputs": {"beauty": {**shot, "file": str(preset.parent / shot["file"])}},
        "outputs": {"image": {"type": "Image", "view": "none"}},
        "nodes": {
            "display": {"type": "tone_map"},
            "matrix": {"type": "color_matrix", "values": {"preset": "custom"}},
            "tone": {"type": "curves"},
            "hue": {"type": "hue_curves"},
        },
        "links": {
            "display.image": "inputs.beauty",
            "matrix.image": "display.out",
            "tone.image": "matrix.out",
            "hue.image": "tone.out",
            "outputs.image": "hue.out",
        },
    }
    path = tmp_path / "grade.json"
    path.write_text(json.dumps(graph), encoding="utf-8")
    opened = document.load(path, sandbox=UNRESTRICTED)
    request = RenderRequest(size=(160, 90), precision="float")
    plain = renderer.render(opened, request)["image"][..., :3].astype(np.float64)
    codes = look_up(np.clip(encode(plain), 0.0, 1.0))
    reference = decode(np.round(codes * 255.0) / 255.0).astype(np.float32)
    values = ("matrix.matrix", "matrix.offset", "tone.master", "tone.red", "tone.green", "tone.blue", "hue.*")
    result = fit_to(renderer, opened, request, reference, *values, points=7)
    assert result.delta_e[0] > 10.0 and result.delta_e[1] <= 2.0
