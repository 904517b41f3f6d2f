"""Dither: its patterns against their authors' definitions, and what quantizing must keep."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from conftest import graph_of
from halation.graph import Port
from halation.nodes.color.dither import Dither
from halation.renderer import RenderRequest

PATTERNS = Dither.values["pattern"].choices
SIZE = 64


def void_and_cluster() -> np.ndarray:
    """Ulichney 1993, "The void-and-cluster method for dither array generation": ranks of SIZE x SIZE pixels.

    Distances are weighed by a Gaussian of sigma 1.5 that wraps around, in whole numbers: the same on every machine.
    """
    axis = np.minimum(np.arange(SIZE), SIZE - np.arange(SIZE))
    weight = np.rint(2.0**40 * np.exp(-(axis[:, None] ** 2 + axis[None] ** 2) / (2 * 1.5**2))).astype(np.int64)
    spread = np.tile(weight, (2, 2))
    count = SIZE * SIZE
    near = np.zeros((SIZE, SIZE), np.int64)
    on = np.zeros((SIZE, SIZE), bool)

    def put(index: int, sign: int) -> None:
        y, x = divmod(index, SIZE)
        on[y, x] = sign > 0
        near[:] += sign * spread[SIZE - y : 2 * SIZE - y, SIZE - x : 2 * SIZE - x]

    def cluster() -> int:
        return int(np.where(on, near, -1).argmax())

    def void() -> int:
        return int(np.where(on, np.iinfo(np.int64).max, near).argmin())

    first = count // 10
    for index in np.random.RandomState(1).permutation(count)[:first]:  # a generator that numpy keeps as it is
        put(int(index), 1)
    while True:
        taken = cluster()
        put(taken, -1)
        given = void()
        put(given, 1)
        if given == taken:
            break
    rank = np.zeros(count, int)
    start, begin = on.copy(), near.copy()
    for number in reversed(range(first)):
        rank[taken := cluster()] = number
        put(taken, -1)
    on[:], near[:] = start, begin
    for number in range(first, count):
        rank[given := void()] = number
        put(given, 1)
    return rank.reshape(SIZE, SIZE)


def bayer(order: int) -> np.ndarray:
    """Bayer 1973 by recursion: every step puts four copies between each other."""
    matrix = np.zeros((1, 1), int)
    for _ in range(order):
        matrix = np.block([[4 * matrix, 4 * matrix + 2], [4 * matrix + 3, 4 * matrix + 1]])
    return matrix


def gray(level: float, size: int = SIZE) -> np.ndarray:
    picture = np.full((size, size, 4), level, np.float32)
    picture[..., 3] = 1.0
    return picture


def thresholds(run, pattern: str, steps: int) -> np.ndarray:
    """For each pixel, how many of `steps` even grays stay black."""
    node = Dither(pattern=pattern, levels=2, space="linear")
    levels = np.arange(steps) / steps
    return sum((run(node, {"image": gray(level)})[..., 0] == 0.0).astype(int) for level in levels)


def test_the_blue_noise_is_void_and_cluster():
    text = (Path(__file__).parents[2] / "shaders" / "lib" / "blue_noise.glsl").read_text(encoding="utf-8")
    packed = np.array([int(word, 16) for word in re.findall(r"0x([0-9a-f]{8})u", text)], np.uint32)
    found = packed.view(np.uint8) if packed.dtype.byteorder in "=<|" else packed.byteswap().view(np.uint8)
    np.testing.assert_array_equal(found.reshape(SIZE, SIZE), void_and_cluster() * 256 // (SIZE * SIZE))


def test_the_blue_noise_is_even_and_blue(run):
    """Every threshold is as frequent as any other; low frequencies hold next to nothing of white noise's power."""
    found = thresholds(run, "blue noise", 32)
    np.testing.assert_array_equal(np.bincount(found.ravel())[1:], SIZE * SIZE // 32)
    power = np.abs(np.fft.fft2(found - found.mean())) ** 2 / found.size / found.var()
    frequency = np.fft.fftfreq(SIZE)
    distance = np.hypot(*np.meshgrid(frequency, frequency))
    assert power[(distance > 0) & (distance < 0.15)].mean() < 0.02
    assert power[distance > 0.3].mean() > 0.9


def test_bayer_is_bayers(run):
    found = thresholds(run, "bayer", 64)
    np.testing.assert_array_equal(found[:8, :8] - 1, bayer(3))
    np.testing.assert_array_equal(found, np.tile(found[:8, :8], (8, 8)))


@pytest.mark.parametrize("pattern", PATTERNS)
def test_light_is_kept_on_average(run, pattern):
    """Exactly the thresholds' count for a pattern that has each as often; within noise for white."""
    node = Dither(pattern=pattern, levels=5, space="linear")
    for level in (0.1, 0.4375, 0.8, 1.3):
        out = run(node, {"image": gray(level)})[..., 0]
        wanted = {"blue noise": 1e-3, "bayer": 2e-3 * 4, "white": 5 / 4 / SIZE / np.sqrt(12) * 2}[pattern]
        assert abs(out.mean() - level) < wanted
        assert np.abs(out - level).max() <= 0.25 + 1e-6


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize("space", ["display", "linear"])
def test_there_are_only_so_many_levels(run, hdr, pattern, space):
    picture = hdr(33, 21, opaque=True) * np.float32([0.1, 0.1, 0.1, 1.0])
    out = run(Dither(pattern=pattern, levels=9, space=space, colored=True), {"image": picture})[..., :3]
    code = out.astype(np.float64)
    if space == "display":
        code = np.where(code <= 0.0031308, 12.92 * code, 1.055 * np.maximum(code, 1e-9) ** (1 / 2.4) - 0.055)
    assert np.abs(code * 8 - np.round(code * 8)).max() < 1e-4


def test_it_ends_banding_in_eight_bits(run):
    """A ramp over two codes, averaged over stripes, follows the light and not the codes."""
    code = np.broadcast_to(np.linspace(100, 102, SIZE)[None] / 255, (SIZE, SIZE))
    light = ((code + 0.055) / 1.055) ** 2.4
    picture = np.stack([light, light, light, np.ones_like(light)], -1).astype(np.float32)
    out = run(Dither(), {"image": picture})[..., 0].astype(np.float64)
    shown = (1.055 * out ** (1 / 2.4) - 0.055) * 255
    assert np.abs(shown.round() - shown).max() < 1e-3
    stripes = (shown - code * 255).reshape(SIZE, 8, 8).mean((0, 2))
    assert np.abs(stripes).max() < 0.02


def test_levels_that_are_there_stay(run):
    codes = np.arange(5) / 4
    picture = np.stack([codes, codes, codes, np.ones(5)], -1)[None].repeat(5, 0).astype(np.float32)
    for pattern in PATTERNS:
        out = run(Dither(pattern=pattern, levels=5, space="linear"), {"image": picture})
        np.testing.assert_array_equal(out, picture)


def test_dots_grow_with_size_and_colors_differ_on_demand(run):
    picture = gray(0.5, 32)
    small = run(Dither(levels=2, space="linear"), {"image": picture})
    large = run(Dither(levels=2, space="linear", size=4.0), {"image": picture})
    np.testing.assert_array_equal(large[::4, ::4], small[:8, :8])
    np.testing.assert_array_equal(small[..., 0], small[..., 1])
    colored = run(Dither(levels=2, space="linear", colored=True), {"image": picture})
    assert (colored[..., 0] != colored[..., 1]).mean() > 0.3


def test_frames_differ_on_demand(renderer):
    picture = gray(0.5)
    for animate in (False, True):
        node = Dither(levels=2, space="linear", animate=animate)
        graph = graph_of(node, {"image": picture})
        targets = {"out": Port("outputs", "out")}
        one, same, other = (
            renderer.render(graph, RenderRequest({"image": picture}, targets, precision="float", frame=frame))["out"]
            for frame in (3, 3, 4)
        )
        assert np.array_equal(one, same) and np.array_equal(one, other) != animate
        assert abs(other[..., 0].mean() - 0.5) < 1e-3
