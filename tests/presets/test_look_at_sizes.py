"""The same look at every size: each preset at two heights, the larger picture shrunk to the smaller one.

Every day 270 and 540 lines of some presets of each kind; `--nightly` of more, and 540 and 2160 lines of all presets.
Inputs are the sample enlarged: the smaller picture is the larger one averaged, and data are those of surfaces that go
on between the pixels of the sample, so both show the same scene.

A tone curve and an average do not commute: `agx_look`, which has no length, already differs by 0.018 on this sample.
Where pixels are only repeated, they do, and what is left is the look's own.
Presets that draw lines, dots or grains of a few pixels differ more in FLIP, since a small picture cannot hold their
edges; of these the dots are counted.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import cv2
import numpy as np
import pytest
from enlarged_layers import enlarge_data, enlarge_light
from halation import document, media
from halation.graph import Graph, Input
from halation.media.comparison.contact_sheet import show_light
from halation.media.comparison.metrics import measure_flip
from halation.nodes import Kind
from halation.presets import paths
from halation.renderer import FrameRenderer, Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED
from scipy.ndimage import gaussian_filter1d
from selection import list_cases

Array = np.ndarray

PRESETS = {path.stem: path for path in paths()}
SMOOTH = (
    "film_halation",
    "light_painting",
    "vintage_photo",
    "miniature",
    "lens_character",
    "rack_focus",
    "depth_mist",
    "ground_fog",
    "photographic_glare",
    "dreamy_glow",
)
"""Looks whose lengths are blurs, grain and glow: FLIP is at most 0.02."""
GRADED = (
    "auto_exposed",
    "cyanotype",
    "anaglyph",
    "broadcast_clean",
    "cleaned_plate",
    "heartbeat",
    "moving_ball",
    "morph",
)
"""Looks that differ by more than 0.02 only because light at edges of lamps is averaged before or after a tone curve."""
LINES = {"blueprint": 0.2, "neon_edges": 0.07, "hologram": 0.025, "emboss_and_edges": 0.05, "watercolor": 0.05}
"""Drawn looks, and the most that FLIP may be: between 270 and 1080 lines it was 0.30 (blueprint), 0.42 (neon_edges) and
0.19 (hologram) while their lines were a pixel wide at every size."""
DOTS = ("newspaper_print", "comic_ink", "risograph")
DRAWN = (*DOTS, "blueprint", "emboss_and_edges", "ink_boil", "oil_painting", "pencil_sketch", "toon_ink")
"""Looks of lines, dots or strokes that a small picture cannot hold."""
RELIT = ("studio_light",)
"""Mirrors of metals at edges, where enlarged colors are means of two surfaces and enlarged normals are not."""


@cache
def load_preset(name: str) -> Graph:
    return document.load(PRESETS[name], sandbox=UNRESTRICTED)


def read_input(name: str, end: Input) -> Array:
    file = PRESETS[name].parent / end.file
    pixels = media.read_layer(file, end.layer, end.kind, end.socket().channels, sandbox=UNRESTRICTED)
    return np.asarray(pixels.array, np.float32)


def enlarge(name: str, end: Input, height: int, step: int) -> Array:
    """An input of a preset as a render of `height` lines has it: see enlarged_layers.py."""
    layer = read_input(name, end)
    if end.kind is Kind.IMAGE:
        return enlarge_light(layer, height, step)
    depth, surface = (
        read_input(name, replace(end, layer=other, kind=Kind.FIELD)) for other in ("Depth", "Object Index")
    )
    if end.layer == "Normal":
        length = np.linalg.norm(layer, axis=-1, keepdims=True)
        turned, length = (enlarge_data(data, depth, surface, height, step) for data in (layer, length))
        return turned * length / np.maximum(np.linalg.norm(turned, axis=-1, keepdims=True), 1e-6)
    return enlarge_data(layer, depth, surface, height, step)


def repeat(name: str, end: Input, height: int, step: int) -> Array:
    """A picture of a preset whose pixels are repeated, at a multiple of its height; data are those of surfaces."""
    if end.kind is not Kind.IMAGE:
        return enlarge(name, end, height, step)
    layer = read_input(name, end)
    return layer.repeat(height // len(layer), 0).repeat(height // len(layer), 1)


def render_at(
    renderer: Renderer, name: str, height: int, step: int = 1, scale: float = 1.0, repeated: bool = False
) -> Array:
    """The third frame of a preset as light of the display, at a height; inputs are made at `step` times that."""
    graph = load_preset(name)
    made = {key: end for key, end in graph.inputs.items() if key != "environment"}
    arrays = {
        key: repeat(name, end, height, step) if repeated else enlarge(name, end, height, step)
        for key, end in made.items()
    }
    size = None
    if graph.settings.size:
        size = (round(graph.settings.size[0] * height / graph.settings.size[1]), height)
    frames = FrameRenderer(renderer, graph, RenderRequest(arrays, size=size, scale=scale))
    try:
        first = (graph.settings.frames or (1, 1))[0]
        picture = frames.render_frame(first + 2 if graph.settings.frames else first)["image"]
    finally:
        frames.close()
    return show_light(picture, graph.outputs["image"].view)


def measure_sizes(
    renderer: Renderer, name: str, low: int, high: int, repeated: bool = False
) -> tuple[float, Array, Array]:
    """FLIP's mean between both heights, and both pictures at the lower one."""
    step = high // low
    small = render_at(renderer, name, low, step, repeated=repeated)
    large = render_at(renderer, name, high, repeated=repeated)
    shrunk = cv2.resize(large, small.shape[1::-1], interpolation=cv2.INTER_AREA)
    return measure_flip(encode(small), encode(shrunk), linear=False), small, shrunk


def encode(light: Array) -> Array:
    """Light of a display in sRGB."""
    light = np.clip(light, 0.0, 1.0)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def find_frequency(light: Array) -> float:
    """How often the strongest pattern repeats over the height, from the spectrum of the luminance."""
    gray = encode(light).mean(axis=2)
    gray -= cv2.GaussianBlur(gray, (0, 0), gray.shape[0] / 60.0)
    height, width = gray.shape
    window = np.hanning(height)[:, None] * np.hanning(width)[None, :]
    power = np.abs(np.fft.fft2(gray * window)) ** 2
    down = np.fft.fftfreq(height)[:, None] * height
    across = np.fft.fftfreq(width)[None, :] * height
    frequency = np.hypot(down, across)
    power[(frequency < 20.0) | (frequency > 120.0)] = 0.0
    return float(frequency.flat[power.argmax()])


def count_lines(light: Array) -> int:
    """How many level lines at equal distances the height holds: the harmonic product spectrum (Noll 1970).

    Thin lines have overtones nearly as strong as their fundamental, so that the strongest frequency may be any of them.
    The fundamental is the one whose first four multiples are strong together.
    """
    profile = encode(light).mean(axis=(1, 2))
    height = len(profile)
    profile = (profile - gaussian_filter1d(profile, height / 20.0)) * np.hanning(height)
    power = np.abs(np.fft.rfft(profile))
    counts = np.arange(5, height // 8)
    return int(counts[np.prod([power[k * counts] for k in (1, 2, 3, 4)], axis=0).argmax()])


@pytest.mark.parametrize("count", [7, 10, 23])
def test_lines_are_counted_and_not_their_overtones(count: int) -> None:
    """Thin lines over large soft shapes."""
    down, across = np.meshgrid((np.arange(270) + 0.5) / 270, (np.arange(480) + 0.5) / 270, indexing="ij")
    lines = (down * count) % 1.0 < 0.1
    light = 0.3 + 0.2 * np.sin(3.0 * down + 2.0 * across) + 0.3 * lines
    assert count_lines(np.dstack([light] * 3)) == count


@pytest.mark.parametrize("height", [270, 540])
def test_a_blueprint_has_as_many_lines_at_each_size(renderer: Renderer, height: int) -> None:
    squares = load_preset("blueprint").nodes["squares"].size
    assert count_lines(render_at(renderer, "blueprint", height, 540 // height)) == 1080 // squares


@pytest.mark.parametrize("name", list_cases(SMOOTH[::2], SMOOTH[1::2]))
def test_a_smooth_look_is_the_same_at_twice_the_size(name: str, renderer: Renderer) -> None:
    assert measure_sizes(renderer, name, 270, 540)[0] <= 0.02


@pytest.mark.parametrize("name", list_cases(GRADED[:2], GRADED[2:]))
def test_a_graded_look_of_repeated_pixels_is_the_same_at_twice_the_size(name: str, renderer: Renderer) -> None:
    assert measure_sizes(renderer, name, 270, 540, repeated=True)[0] <= 0.02


@pytest.mark.parametrize("name", list_cases([*LINES][::2], [*LINES][1::2]))
def test_lines_are_as_wide_at_twice_the_size(name: str, renderer: Renderer) -> None:
    """As much of the picture is bright, and FLIP is far below that of lines of one pixel."""
    difference, small, large = measure_sizes(renderer, name, 270, 540)
    assert difference <= LINES[name]
    assert encode(large).mean() == pytest.approx(encode(small).mean(), rel=0.06)


@pytest.mark.parametrize("name", DOTS)
def test_as_many_dots_fit_into_the_height(name: str, renderer: Renderer) -> None:
    small, large = render_at(renderer, name, 270, 2), render_at(renderer, name, 540)
    assert find_frequency(large) == pytest.approx(find_frequency(small), rel=0.02)


@pytest.mark.parametrize("name", ["newspaper_print", "film_halation"])
def test_a_proxy_is_the_same_look(name: str, renderer: Renderer) -> None:
    """A proxy of 540 lines by half is the picture of 270 lines, but for how its input is made smaller."""
    proxy, small = render_at(renderer, name, 540, scale=0.5), render_at(renderer, name, 270, 2)
    assert proxy.shape == small.shape
    assert measure_flip(encode(proxy), encode(small), linear=False) <= 0.02


@pytest.mark.parametrize("name", PRESETS)
def test_lengths_are_meant_for_1080_lines(name: str) -> None:
    assert load_preset(name).settings.reference_height == 1080


@pytest.mark.nightly
@pytest.mark.timeout(900)
@pytest.mark.parametrize("name", PRESETS)
def test_every_preset_at_540_and_2160_lines(name: str, renderer: Renderer) -> None:
    """A third of the presets has lines, dots or hard edges, which FLIP sees in the smaller picture."""
    difference, small, large = measure_sizes(renderer, name, 540, 2160)
    assert difference <= 0.11
    assert encode(large).mean() == pytest.approx(encode(small).mean(), rel=0.1)


@pytest.mark.nightly
@pytest.mark.timeout(900)
@pytest.mark.parametrize("name", sorted(PRESETS.keys() - {*DRAWN, *RELIT}))
def test_every_smooth_look_of_repeated_pixels_is_the_same_at_540_and_2160_lines(name: str, renderer: Renderer) -> None:
    assert measure_sizes(renderer, name, 540, 2160, repeated=True)[0] <= 0.02
