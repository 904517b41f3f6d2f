"""Temporal accumulation against means of frames that numpy takes, moved by scipy."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from exr_files import write_exr
from halation.graph import Graph, Input, Output, Port, Settings
from halation.nodes import Kind
from halation.nodes.time.temporal_accumulation import TemporalAccumulation
from scipy.ndimage import shift
from sequences import Array, Shot, make_flat_frames, render_frames, shot_graph

SIZE = (24, 16)
STILL = np.zeros((*SIZE[::-1], 4), np.float32)


def noise(frame: int) -> Array:
    """Light of rays: new in every frame, of unit mean."""
    return np.random.default_rng(frame).gamma(0.5, 2.0, (*SIZE[::-1], 4)).astype(np.float32)


def going(speed: tuple[float, float]) -> Array:
    pixels = STILL.copy()
    pixels[..., :2] = speed
    return pixels


def render(renderer, node: TemporalAccumulation, shot: Shot, frame: int, output: str = "out") -> Array:
    (found,) = render_frames(renderer, shot_graph(node, shot, (1, 16)), shot, [frame], output)
    return found


def render_files(renderer, folder: Path, node: TemporalAccumulation, shot: Shot, frame: int, output: str) -> Array:
    """As `render`, of a sequence of files, whose pictures differ also where a node looks back."""
    for number in range(1, frame + 1):
        layers = {name: picture(number) for name, picture in shot.items()}
        parts = {name: np.atleast_3d(layer).astype(np.float32) for name, layer in layers.items()}
        write_exr(folder / f"shot.{number:04}.exr", parts, dict.fromkeys(parts, "float"))
    kinds = {"image": Kind.IMAGE, "depth": Kind.FIELD, "normal": Kind.VECTOR, "velocity": Kind.VECTOR}
    graph = Graph(settings=Settings(frames=(1, frame))).add("node", node).add_output("out", Output())
    for name in shot:
        width = {"normal": 3, "velocity": 4}.get(name)
        declared = Input(kinds[name], width=width, file=str(folder / "shot.####.exr"), layer=name)
        graph = graph.add_input(name, declared).connect(Port("inputs", name), Port("node", name))
    graph = graph.connect(Port("node", output), Port("outputs", "out"))
    (found,) = render_frames(renderer, graph, {}, [frame])
    return found


def accumulate(pictures: list[Array], frames: int) -> Array:
    """The sum of the docs: weight 1 / n for the n-th picture, down to 1 / frames."""
    mean = pictures[0].astype(np.float64)
    for number, picture in enumerate(pictures[1:], 2):
        mean += (picture - mean) / min(number, frames)
    return mean


@pytest.mark.parametrize(("frames", "frame"), [(16, 1), (16, 6), (4, 12), (1, 5)])
def test_what_stands_still_is_the_mean_of_its_frames(renderer, frames, frame):
    shot = {"image": noise, "velocity": lambda _: STILL}
    pictures = [noise(number) for number in range(1, frame + 1)]
    found = render(renderer, TemporalAccumulation(frames=frames, gamma=0.0), shot, frame)
    np.testing.assert_allclose(found, accumulate(pictures, frames), rtol=1e-5, atol=1e-6)
    if frame <= frames:
        np.testing.assert_allclose(found, np.mean(pictures, axis=0), rtol=1e-5, atol=1e-6)
    count = render(renderer, TemporalAccumulation(frames=frames, gamma=0.0), shot, frame, "count")
    assert (count == min(frames, frame)).all()


@pytest.mark.parametrize("speed", [(2.0, -1.0), (0.5, 0.25)])
def test_it_goes_with_the_surfaces(renderer, speed):
    """Against scipy's linear shift of the mean so far; what enters at the borders is new."""
    shot = {"image": noise, "velocity": lambda _: going(speed)}
    found = render(renderer, TemporalAccumulation(gamma=0.0), shot, 5)
    mean = noise(1).astype(np.float64)
    for frame in range(2, 6):
        moved = shift(mean, (speed[1], speed[0], 0.0), order=1, mode="nearest")
        mean = moved + (noise(frame) - moved) / frame
    inner = (slice(2, -5), slice(9, -2))
    np.testing.assert_allclose(found[inner], mean[inner], rtol=2e-5, atol=1e-5)
    count = render(renderer, TemporalAccumulation(gamma=0.0), shot, 5, "count")[..., 0]
    assert (count[inner] == 5.0).all()
    if speed == (2.0, -1.0):
        assert (count[:, :2] == 1.0).all() and (count[-1] == 1.0).all()


def square(frame: int) -> Array:
    """Where a square is that goes two pixels to the right in each frame."""
    inside = np.zeros(SIZE[::-1], bool)
    inside[4:12, 2 * frame : 2 * frame + 6] = True
    return inside


def front(frame: int) -> Array:
    return np.where(square(frame), 2.0, 5.0).astype(np.float32)


def facing(frame: int) -> Array:
    return np.where(square(frame)[..., None], (0.0, 0.0, 1.0), (0.0, -1.0, 0.0)).astype(np.float32)


def carried(frame: int) -> Array:
    return np.where(square(frame)[..., None], going((2.0, 0.0)), STILL).astype(np.float32)


@pytest.mark.parametrize("told_by", [{"depth": front}, {"normal": facing}, {"depth": front, "normal": facing}])
def test_what_was_hidden_begins_anew(renderer, tmp_path, told_by):
    shot = {"image": noise, "velocity": carried} | told_by
    node = TemporalAccumulation(gamma=0.0)
    found, count = (render_files(renderer, tmp_path, node, shot, 4, output) for output in ("out", "count"))
    uncovered = square(3) & ~square(4)
    assert uncovered.sum() == 16 and (count[uncovered][:, 0] == 1.0).all()
    np.testing.assert_array_equal(found[uncovered], noise(4)[uncovered])
    ground = ~np.any([square(frame) for frame in range(1, 5)], axis=0)
    np.testing.assert_allclose(found[ground], np.mean([noise(f) for f in range(1, 5)], axis=0)[ground], rtol=1e-5)
    rows, columns = np.nonzero(square(4))
    own = np.mean([noise(frame)[rows, columns - 2 * (4 - frame)] for frame in range(1, 5)], axis=0)
    np.testing.assert_allclose(found[square(4)], own, rtol=1e-5, atol=1e-6)
    blind = {name: pictures for name, pictures in shot.items() if name not in told_by}
    assert (render_files(renderer, tmp_path, node, blind, 4, "count")[uncovered][:, 0] > 1.0).all()


def test_a_light_that_goes_out_leaves_no_trail(renderer):
    shot = {"image": make_flat_frames(lambda frame: 1.0 if frame < 5 else 0.25, SIZE), "velocity": lambda _: STILL}
    quick, slow = (render(renderer, TemporalAccumulation(gamma=gamma), shot, 5) for gamma in (2.0, 0.0))
    np.testing.assert_allclose(quick[..., :3], 0.25, atol=1e-6)
    np.testing.assert_allclose(slow[..., :3], 0.85, atol=1e-6)


def test_noise_falls_as_statistics_say(renderer):
    """Of n independent frames the variance is 1 / n; the limit by the colors around takes away bright single pixels."""
    shot = {"image": noise, "velocity": lambda _: STILL}
    free, limited = (render(renderer, TemporalAccumulation(gamma=gamma), shot, 16).std() for gamma in (0.0, 2.0))
    one = noise(16).std()
    assert free == pytest.approx(one / 4.0, rel=0.1) and limited < 0.5 * one


def test_bad_pixels_do_not_stay(renderer):
    """NaN, infinities and velocities out of all bounds."""

    def bad(frame: int) -> Array:
        picture = noise(frame)
        if frame == 2:
            picture[3, 3], picture[4, 4] = np.nan, np.inf
        return picture

    wild = STILL.copy()
    wild[5, 5, :2], wild[6, 6, :2], wild[7, 7, :2] = np.nan, np.inf, 1e30
    shot = {"image": bad, "velocity": lambda _: wild}
    found = render(renderer, TemporalAccumulation(), shot, 5)
    assert np.isfinite(found).all()
