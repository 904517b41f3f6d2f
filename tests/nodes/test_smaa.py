"""SMAA against a model of the paper in 64 bits, itself held against Blender; and against the true coverage of edges."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from halation.nodes.aa.smaa import Smaa
from scipy.ndimage import gaussian_filter

REACH = {"low": (8, 0), "medium": (16, 0), "high": (32, 8), "ultra": (64, 16)}
FINE = (np.arange(2000) + 0.5) / 2000


def encoded(light: np.ndarray) -> np.ndarray:
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def edges_of(tones: np.ndarray, threshold: float, contrast: float) -> np.ndarray:
    """Of [h, w, channels]: whether there is an edge left of and above every pixel."""
    wide = np.pad(tones, ((2, 2), (2, 2), (0, 0)), mode="edge")

    def moved(x: int, y: int) -> np.ndarray:
        return wide[2 + y : 2 + y + tones.shape[0], 2 + x : 2 + x + tones.shape[1]]

    def step(a: tuple[int, int], b: tuple[int, int]) -> np.ndarray:
        return np.abs(moved(*a) - moved(*b)).max(-1)

    left, top, right, bottom = (step((0, 0), way) for way in ((-1, 0), (0, -1), (1, 0), (0, 1)))
    strongest = np.max([left, top, right, bottom, step((-1, 0), (-2, 0)), step((0, -1), (0, -2))], axis=0)
    return np.stack([(one >= threshold) & (contrast * one >= strongest - 1e-9) for one in (left, top)], axis=-1)


def line_area(pattern: tuple[int, int], left: int, right: int) -> np.ndarray:
    """What the line of a pattern leaves below and above the edge; ends are 1 for up, 3 for down, 4 for both."""
    size, x = left + right + 1.0, left + FINE
    ends = [{0: 0.0, 1: 0.5, 3: -0.5, 4: 0.0}[one] for one in pattern]
    if pattern[0] == 4:
        ends[0] = -ends[1]
    if pattern[1] == 4:
        ends[1] = -ends[0]
    if ends[0] * ends[1] < 0.0:
        height = ends[0] + (ends[1] - ends[0]) * x / size
        return np.array([np.maximum(-height, 0.0).mean(), np.maximum(height, 0.0).mean()])
    halves = [ends[0] * np.maximum(1.0 - 2.0 * x / size, 0.0), ends[1] * np.maximum(2.0 * x / size - 1.0, 0.0)]
    areas = [np.array([np.maximum(-half, 0.0).mean(), np.maximum(half, 0.0).mean()]) for half in halves]
    if ends[0] * ends[1] > 0.0:
        share = min(size / 32.0, 1.0)
        areas = [share * area + (1.0 - share) * 0.5 * np.sqrt(2.0 * area) for area in areas]
    return areas[0] + areas[1]


STARTS = {0: [(0, 0), (1, 0)], 1: [(1, 0), (1, 0)], 2: [(1, 1), (1, 1)], 3: [(1, 1), (1, 0)]}
ENDS = {0: [(0, 0), (1, 0)], 1: [(1, 1), (1, 1)], 2: [(1, 0), (1, 0)], 3: [(1, 1), (1, 0)]}


def stair_area(pattern: tuple[int, int], left: int, right: int) -> np.ndarray:
    """What a diagonal line cuts off the pixels below and above the edge: the mean of its two possible places."""
    areas = []
    for start, end in zip(STARTS[pattern[0]], ENDS[pattern[1]], strict=True):
        rise = (end[1] + left + right + 1.0 - start[1]) / (end[0] + left + right + 1.0 - start[0])
        height = start[1] + rise * (1.0 + left + FINE - start[0]) - left
        areas.append([1.0 - np.clip(height, 0.0, 1.0).mean(), np.clip(height - 1.0, 0.0, 1.0).mean()])
    return np.mean(areas, axis=0)


def table_line_area(pattern: tuple[int, int], left: int, right: int) -> np.ndarray:
    """As read from the authors' table: bytes at square distances, interpolated between them."""
    total, (x, y) = np.zeros(2), np.sqrt([left, right])
    for a in (int(x), int(x) + 1):
        for b in (int(y), int(y) + 1):
            weight = (1.0 - abs(x - a)) * (1.0 - abs(y - b))
            total += weight * np.floor(255.0 * line_area(pattern, a * a, b * b) + 1e-4) / 255.0
    return total


def table_stair_area(pattern: tuple[int, int], left: int, right: int) -> np.ndarray:
    """As read from the authors' table: bytes of 30 by 30 samples."""
    x, y = np.meshgrid(np.arange(30) / 29.0, np.arange(30) / 29.0)
    ways = zip(STARTS[pattern[0]], ENDS[pattern[1]], strict=True)
    areas = []
    for start, end in ways if any(pattern) else (((1, 1), (1, 1)), ((1, 0), (1, 0))):
        dx, dy = np.subtract(end, start) + left + right + 1.0
        middle = (np.add(end, start) + left + right + 1.0) / 2.0
        below, above = (
            (dy * (1.0 + left + x - middle[0]) - dx * (left + row + y - middle[1]) > 0.0).mean() for row in (0, 1)
        )
        areas.append([1.0 - below, above])
    return np.floor(255.0 * np.mean(areas, axis=0)) / 255.0


class Model:
    """The searches of the paper, pixel by pixel; `edge(x, y, axis)` is an edge left of (0) or above (1) a pixel."""

    def __init__(self, edges, reach, rounding, areas=(line_area, stair_area)):
        self.edges, (self.reach, self.stairs), self.rounding, self.areas = edges, reach, rounding, areas

    def edge(self, x: int, y: int, axis: int) -> bool:
        height, width, _ = self.edges.shape
        return 0 <= x < width and 0 <= y < height and bool(self.edges[y, x, axis])

    def straight(self, x: int, y: int, axis: int) -> np.ndarray:
        def edge(along: int, side: int, of: int) -> bool:
            return self.edge(x + along, y + side, of) if axis == 1 else self.edge(x + side, y + along, of)

        left = right = 0
        while left < self.reach and not (edge(-left, 0, 1 - axis) or edge(-left, -1, 1 - axis)):
            if not edge(-left - 1, 0, axis):
                break
            left += 1
        while right < self.reach and not (edge(right + 1, 0, 1 - axis) or edge(right + 1, -1, 1 - axis)):
            if not edge(right + 1, 0, axis):
                break
            right += 1
        ends = -left, right + 1
        pattern = tuple(3 * edge(end, 0, 1 - axis) + edge(end, -1, 1 - axis) for end in ends)
        keep = np.ones(2)
        for end, nearer in zip(ends, (left <= right, right <= left), strict=True):
            part = nearer * (1.0 - self.rounding) / (2.0 if left == right else 1.0)
            keep -= part * np.array([edge(end, 1, 1 - axis), edge(end, -2, 1 - axis)])
        return self.areas[0](pattern, left, right) * np.clip(keep, 0.0, 1.0)

    def diagonal(self, x: int, y: int, rise: int) -> np.ndarray:
        ends = []
        for dx, dy in ((-1, -rise), (1, rise)):
            away = 0
            while away < self.stairs:
                upright = x + away * dx + max(dx, 0), y + away * dy + min(dy, 0)
                if not (self.edge(*upright, 0) and self.edge(x + (away + 1) * dx, y + (away + 1) * dy, 1)):
                    break
                away += 1
            upright = x + away * dx + max(dx, 0), y + away * dy + min(dy, 0)
            level = self.edge(x + (away + 1) * dx, y + away * dy, 1)
            ends.append((away, 0 if away == self.stairs else self.edge(*upright, 0) + 2 * level))
        (left, first), (right, last) = ends
        if left + right < 3:
            return np.zeros(2)
        area = self.areas[1]((first, last), left, right)
        return area if rise < 0 else area[::-1]

    def weights(self) -> np.ndarray:
        found = np.zeros((*self.edges.shape[:2], 4))
        for y, x in np.argwhere(self.edges.any(-1)):
            sloped = False
            if self.edge(x, y, 1):
                if self.stairs:
                    found[y, x, :2] = self.diagonal(x, y, -1) + self.diagonal(x, y, 1)
                sloped = bool(found[y, x].any())
                if not sloped:
                    found[y, x, :2] = self.straight(x, y, 1)
            if self.edge(x, y, 0) and not sloped:
                found[y, x, 2:] = self.straight(x, y, 0)
        return np.round(found, 9)  # what weighs the same should compare so

    def blended(self, picture: np.ndarray) -> np.ndarray:
        weights = np.pad(self.weights(), ((0, 1), (0, 1), (0, 0)))
        wide = np.pad(picture, ((1, 1), (1, 1), (0, 0)), "edge")
        found = picture.astype(np.float64)
        for y, x in np.ndindex(picture.shape[:2]):
            left, right, top, bottom = weights[y, x, 2], weights[y, x + 1, 3], weights[y, x, 0], weights[y + 1, x, 1]
            level = max(left, right) > max(top, bottom)
            parts = np.array([left, right] if level else [top, bottom])
            if parts.sum() > 0.0:
                ways = ((0, -1), (0, 1)) if level else ((-1, 0), (1, 0))
                others = np.array([wide[1 + y + dy, 1 + x + dx] for dy, dx in ways])
                mixed = parts[:, None] * others + (1.0 - parts[:, None]) * picture[y, x]
                found[y, x] = (parts[:, None] * mixed).sum(0) / parts.sum()
        return found


def gray(picture: np.ndarray) -> np.ndarray:
    rgba = np.ones((*picture.shape, 4), np.float32)
    rgba[..., :3] = picture[..., None]
    return rgba


def blender() -> tuple[np.ndarray, np.ndarray]:
    stored = np.load(Path(__file__).parents[1] / "data" / "blender_smaa.npz")
    return stored["picture"].astype(np.float64), stored["found"]


def pictures() -> dict[str, np.ndarray]:
    random = np.random.default_rng(8)
    jagged = blender()[0]
    soft = gaussian_filter(random.random((34, 31, 3)), (1.2, 1.2, 0.0))
    colors = gray(np.zeros((34, 31)))
    colors[..., :3] = np.where(soft > 0.5, 0.9, soft)
    return {
        "star": gray(0.02 + 0.7 * jagged[4:52, 4:52]),
        "details": gray(jagged[3:53, 50:]),
        "dust": gray(random.random((27, 33)) > 0.6),
        "colors": colors,
    }


@pytest.mark.parametrize("quality", REACH)
@pytest.mark.parametrize("name", pictures())
def test_it_equals_the_model(run, name, quality):
    picture = pictures()[name]
    detection, rounding = ("color", 0.6) if name == "colors" else ("luminance", 0.25)
    light = picture[..., :3].astype(np.float64)
    tones = encoded(light if detection == "color" else (light @ [0.2126, 0.7152, 0.0722])[..., None])
    expected = Model(edges_of(tones, 0.07, 2.5), REACH[quality], rounding).blended(picture)
    node = Smaa(quality=quality, detection=detection, threshold=0.07, contrast=2.5, corner_rounding=rounding)
    found = run(node, {"image": picture})
    assert np.abs(expected - picture).max() > 0.2
    np.testing.assert_allclose(found, expected, atol=2e-5)


def test_the_model_with_the_authors_table_equals_blender():
    """Blender's rows go up; bytes that lie between two may round either way."""
    picture, found = blender()
    edges = edges_of(picture[::-1, :, None], 0.1, 2.0)
    ours = Model(edges, (32, 8), 0.25, (table_line_area, table_stair_area)).blended(gray(picture[::-1]))
    np.testing.assert_allclose(ours[::-1, :, 0], found, atol=1e-4)


def test_it_is_as_close_to_blender_as_the_table_is_to_the_areas(run):
    """Between square distances the authors' table is off by some hundredths; ours are the areas themselves."""
    picture, theirs = blender()
    found = run(Smaa(), {"image": gray(picture[::-1])})[::-1, :, 0]
    assert np.abs(found - theirs).max() <= 0.08
    assert np.sqrt(((found - theirs) ** 2).mean()) <= 0.007


def half_plane(angle: float, offset: float, samples: int) -> np.ndarray:
    """Black and white on either side of a line, each pixel the mean of `samples` by `samples`."""
    y, x = np.mgrid[:56, :56]
    normal = np.sin(np.radians(angle)), np.cos(np.radians(angle))
    finer = (np.arange(samples) + 0.5) / samples - 0.5
    return gray(
        np.mean(
            [(x + dx - 27.8) * normal[0] + (y + dy - 27.7) * normal[1] > offset for dx in finer for dy in finer], axis=0
        )
    )


@pytest.mark.parametrize("angle", [2, 5, 9, 14, 20, 26, 31, 36, 40, 43, 44, 46, 47, 50, 54, 59, 64, 70, 76, 81, 85, 88])
def test_jagged_edges_come_closer_to_the_truth(run, angle):
    middle = np.s_[10:46, 10:46, 0]
    squares = np.zeros(2)
    for offset in (0.0, 0.3):
        jagged, true = half_plane(angle, offset, 1), half_plane(angle, offset, 16)
        found = run(Smaa(), {"image": jagged})
        squares += [((picture - true)[middle] ** 2).mean() for picture in (jagged, found)]
    assert squares[1] <= 0.25 * squares[0]


@pytest.mark.parametrize("angle", [0.0, 45.0, 90.0])
def test_what_stairs_cannot_tell(run, angle):
    """Without stairs, or with equal ones, nothing shows where between the pixels the edge lies; it never gets worse."""
    for offset in (0.0, 0.1, 0.4):
        jagged, true = half_plane(angle, offset, 1), half_plane(angle, offset, 16)
        found = run(Smaa(), {"image": jagged})
        if angle != 45.0:
            np.testing.assert_array_equal(found, jagged)
        middle = np.s_[10:46, 10:46]
        assert np.abs((found - true)[middle]).mean() <= np.abs((jagged - true)[middle]).mean()


def test_what_is_smooth_stays(run, hdr):
    flat = np.full((9, 12, 4), 0.3, np.float32)
    np.testing.assert_array_equal(run(Smaa(), {"image": flat}), flat)
    faint = gray(0.5 + 0.02 * np.random.default_rng(4).random((12, 15)))
    np.testing.assert_array_equal(run(Smaa(), {"image": faint}), faint)
    x = np.arange(24) - 11.7
    soft = gray(np.clip(0.5 + np.add.outer(0.05 * x, 0.02 * x), 0.0, 1.0) ** 2.2)
    np.testing.assert_array_equal(run(Smaa(), {"image": soft}), soft)


def test_a_box_keeps_its_corners_if_told_to(run):
    box = np.zeros((20, 24))
    box[6:13, 5:18] = 1.0
    np.testing.assert_array_equal(run(Smaa(corner_rounding=0.0), {"image": gray(box)}), gray(box))
    corners = [run(Smaa(corner_rounding=share), {"image": gray(box)})[6, 5, 0] for share in (0.0, 0.25, 1.0)]
    assert corners[0] == 1.0 > corners[1] > corners[2] > 0.5


@pytest.mark.parametrize("quality", ["low", "medium"])
def test_without_diagonals_turning_and_mirroring_change_nothing(run, quality):
    picture = pictures()["star"][:44]
    still = run(Smaa(quality=quality), {"image": picture})
    for turn in (np.rot90, np.flipud, np.fliplr, lambda a: a.transpose(1, 0, 2)):
        turned = run(Smaa(quality=quality), {"image": np.ascontiguousarray(turn(picture))})
        np.testing.assert_allclose(turned, turn(still), atol=1e-6)


@pytest.mark.parametrize("mirror", [np.fliplr, np.flipud])
def test_with_diagonals_mirroring_changes_little(run, mirror):
    """An edge belongs to the pixel right of it or below, which alone decides whether a diagonal stands for it."""
    picture = pictures()["star"]
    still = run(Smaa(), {"image": picture})
    mirrored = run(Smaa(), {"image": np.ascontiguousarray(mirror(picture))})
    different, changed = (np.sqrt((one**2).mean()) for one in (mirror(mirrored) - still, still - picture))
    assert different <= 0.12 * changed


def test_transparent_edges_are_premultiplied(run):
    white = np.repeat(blender()[0][..., None], 4, axis=-1).astype(np.float32)
    found = run(Smaa(), {"image": white})
    np.testing.assert_allclose(found, np.repeat(found[..., 3:], 4, axis=-1), atol=1e-6)
    assert 0.2 < np.abs(found - white).max() < 0.6
