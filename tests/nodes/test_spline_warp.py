"""Spline warps against the pseudo code of Beier and Neely 1992 in 64 bits, and where it is a similarity."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes import CurvePair, name_curve_pairs
from halation.nodes.distort.spline_warp import SplineWarp
from warps import sample_bilinear, warp_picture, waves

Array = np.ndarray
WIDTH, HEIGHT = 72, 54
SIZE = np.array([WIDTH, HEIGHT])
BROW = CurvePair(
    from_start=(0.2, 0.3), from_middle=(0.35, 0.2), from_end=(0.5, 0.3),
    to_start=(0.25, 0.35), to_middle=(0.4, 0.33), to_end=(0.55, 0.3),
)  # fmt: skip
MOUTH = CurvePair(
    from_start=(0.3, 0.7), from_middle=(0.5, 0.8), from_end=(0.7, 0.7),
    to_start=(0.35, 0.75), to_middle=(0.5, 0.72), to_end=(0.8, 0.8),
)  # fmt: skip


def split(points: tuple[tuple[float, float], ...]) -> Array:
    """The ends of four lines along the parabola through three points, in pixels: numpy fits it."""
    fitted = np.polyfit([0.0, 0.5, 1.0], np.array(points), 2)
    return np.stack([np.polyval(fitted[:, axis], np.linspace(0, 1, 5)) for axis in (0, 1)], -1) * SIZE


def list_lines(pairs: list[CurvePair], amount: float) -> list[tuple[Array, Array, Array]]:
    """The ends [2, 2] of each line in the result, the first and the second picture."""
    lines = []
    for pair in pairs:
        first, second = split(pair.points_from), split(pair.points_to)
        mixed = (1 - amount) * first + amount * second
        lines += [(mixed[i : i + 2], first[i : i + 2], second[i : i + 2]) for i in range(4)]
    return lines


def find_source(lines: list[tuple[Array, Array]], a: float, b: float, p: float) -> tuple[Array, Array]:
    """The pseudo code of the paper for each pixel X: where X' lies in the source image."""
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    place = np.stack([x, y], -1)
    moved, weights = np.zeros_like(place), np.zeros_like(x)
    for (start, end), (other_start, other_end) in lines:
        line, other = end - start, other_end - other_start
        length = np.linalg.norm(line)
        u = (place - start) @ line / length**2
        v = (place - start) @ np.array([-line[1], line[0]]) / length
        target = other_start + u[..., None] * other
        target = target + v[..., None] * np.array([-other[1], other[0]]) / np.linalg.norm(other)
        far = np.where(u < 0, np.linalg.norm(place - start, axis=-1), np.abs(v))
        far = np.where(u > 1, np.linalg.norm(place - end, axis=-1), far)
        weight = (length**p / (a + far)) ** b
        moved += weight[..., None] * (target - place)
        weights += weight
    found = place + moved / weights[..., None]
    return found[..., 0], found[..., 1]


def make_pictures() -> dict[str, Array]:
    first = waves(WIDTH, HEIGHT)
    return {"image": first, "other": first[::-1, :, [2, 0, 1, 3]] * np.float32(0.7)}


def name(*pairs: CurvePair):
    return name_curve_pairs(**{f"curve_{number}": pair for number, pair in enumerate(pairs)})


@pytest.mark.parametrize("amount", [0.3, 1.0])
def test_it_is_the_papers_procedure(run, amount):
    node = SplineWarp(amount=amount, curves=name(BROW, MOUTH), reach=0.02, falloff=1.7, by_length=0.6)
    pictures, lines = make_pictures(), list_lines([BROW, MOUTH], amount)
    expected = 0.0
    for index, (part, picture) in enumerate(((1 - amount, "image"), (amount, "other"))):
        x, y = find_source([(line[0], line[1 + index]) for line in lines], 0.02 * HEIGHT, 1.7, 0.6)
        expected = expected + part * sample_bilinear(pictures[picture], x, y, "nearest")
    # Where the picture shrinks a pixel averages a few places of these smooth pictures.
    found = run(node, pictures)
    assert np.abs(found - expected).mean() < 5e-4 and np.abs(found - expected).max() < 0.02


def test_one_straight_curve_moves_and_turns_the_picture_and_stretches_it_along(run):
    """All its lines say the same. Distances beside a line stay, as the paper has them."""
    ends = (0.3, 0.4), (0.45, 0.45), (0.6, 0.5), (0.35, 0.6), (0.5, 0.6), (0.65, 0.6)
    names = [f"{side}_{part}" for side in ("from", "to") for part in ("start", "middle", "end")]
    pair = CurvePair(**dict(zip(names, ends, strict=True)))
    picture = waves(WIDTH, HEIGHT)
    out = run(SplineWarp(amount=1.0, curves=name(pair), show="first"), {"image": picture})
    start, end, other_start, other_end = (complex(*(np.array(ends[index]) * SIZE)) for index in (0, 2, 3, 5))
    way, other_way = (end - start) / abs(end - start), (other_end - other_start) / abs(other_end - other_start)
    stretch = abs(end - start) / abs(other_end - other_start)

    def source(x: Array, y: Array) -> tuple[Array, Array]:
        beside = (x + 1j * y - other_start) / other_way
        place = start + way * (stretch * beside.real + 1j * beside.imag)
        return place.real, place.imag

    expected, sure = warp_picture(picture, source)
    inside = (slice(1, -1), slice(1, -1))
    assert sure.all()
    np.testing.assert_allclose(out[inside], expected[inside], atol=2e-4)


def test_ends_and_what_does_not_count(run):
    pictures = make_pictures()
    node = SplineWarp(curves=name(BROW, MOUTH))
    assert node.with_values(amount=0.0).identity() == "image" and node.identity() is None
    np.testing.assert_allclose(run(node.with_values(amount=1.0), pictures), pictures["other"], atol=1e-5)
    off = node.with_values(curves=name(CurvePair(on=False)))
    expected = 0.5 * pictures["image"] + 0.5 * pictures["other"]
    np.testing.assert_allclose(run(off, pictures), expected, atol=1e-5)
    flat = CurvePair(from_start=(0.5, 0.5), from_middle=(0.5, 0.5), from_end=(0.5, 0.5))
    assert np.isfinite(run(node.with_values(curves=name(flat), reach=0.0), pictures)).all()


def test_a_feature_lies_halfway(run):
    """A dot on the curve of each picture: halfway there is one dot, as bright as the two, between their places."""
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    dots = [
        np.repeat(np.exp(-((x - at[0] * WIDTH) ** 2 + (y - at[1] * HEIGHT) ** 2) / 6)[..., None], 4, -1)
        for at in (MOUTH.from_middle, MOUTH.to_middle)
    ]
    out = run(SplineWarp(curves=name(MOUTH, BROW)), {"image": dots[0], "other": dots[1]})[..., 0]
    row, column = np.unravel_index(out.argmax(), out.shape)
    assert abs(column + 0.5 - 0.5 * WIDTH) <= 1.0 and abs(row + 0.5 - 0.76 * HEIGHT) <= 1.0 and out.max() > 0.85
