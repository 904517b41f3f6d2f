"""Temporal antialiasing against 64 samples per pixel of the same scene, and against its formulas in numpy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from halation.graph import Graph, Input, Key, Keys, Output, Port, Settings
from halation.nodes import Kind
from halation.nodes.aa.temporal_aa import TemporalAa
from halation.nodes.channel.separate import Separate
from halation.nodes.input.constant import Constant
from halation.nodes.input.scene import Scene
from halation.renderer import FrameRenderer, RenderRequest
from scipy.ndimage import maximum_filter, minimum_filter
from sequences import make_flat_frames, render_frames, shot_graph

SIZE, LAST, FINE = (160, 90), 32, 8
WEIGHTS = np.array((0.2126, 0.7152, 0.0722))


def toned(light: np.ndarray) -> np.ndarray:
    """How samples are mixed: c / (1 + luminance) (Karis 2014)."""
    rgb = light[..., :3].astype(float)
    return rgb / (1 + rgb @ WEIGHTS)[..., None]


def rms(found: np.ndarray, expected: np.ndarray) -> float:
    return float(np.sqrt(((found - expected) ** 2).mean()))


def scene_graph(scene: Scene, node: TemporalAa | None = None) -> Graph:
    graph = Graph(settings=Settings(SIZE, (1, LAST))).add("scene", scene).add_output("out", Output())
    graph = graph.add_output("ids", Output(Kind.FIELD)).connect(Port("scene", "object_id"), Port("outputs", "ids"))
    if node is None:
        return graph.connect(Port("scene", "color"), Port("outputs", "out"))
    graph = graph.add("node", node)
    for made, taken in (("color", "image"), ("velocity", "velocity"), ("depth", "depth")):
        graph = graph.connect(Port("scene", made), Port("node", taken))
    return graph.connect(Port("node", "out"), Port("outputs", "out"))


def still(renderer, scene: Scene, frame: int = LAST, output: str = "out", fine: int = 1) -> np.ndarray:
    """One sample in the middle of every pixel."""
    size = (SIZE[0] * fine, SIZE[1] * fine)
    wanted = RenderRequest({}, {"it": Port("outputs", output)}, size, frame=frame, precision="float")
    return renderer.render(scene_graph(replace(scene, jitter=0.0)), wanted)["it"]


def smooth(renderer, scene: Scene, node: TemporalAa) -> np.ndarray:
    reel = FrameRenderer(
        renderer, scene_graph(scene, node), RenderRequest({}, {"out": Port("outputs", "out")}, precision="float")
    )
    try:
        return reel.render_frame(LAST)["out"]
    finally:
        reel.close()


def mean_of_64(fine: np.ndarray) -> np.ndarray:
    return fine.reshape(SIZE[1], FINE, SIZE[0], FINE, -1).mean((1, 3))


@pytest.mark.parametrize(
    ("motion", "most"),
    [
        ({}, 0.3),
        ({"orbit": 0.1}, 0.5),
        ({"drift": (-0.06, 0.0, 0.0)}, 0.35),
    ],
    ids=["still", "orbit", "ball"],
)
@pytest.mark.parametrize("weigh_light", [True, False])
def test_it_is_nearer_to_64_samples(renderer, motion, most, weigh_light):
    scene = Scene(jitter=1.0, **motion)
    how = toned if weigh_light else lambda light: light[..., :3].astype(float)
    expected = mean_of_64(how(still(renderer, scene, fine=FINE)))
    single = rms(how(still(renderer, scene)), expected)
    error = rms(how(smooth(renderer, scene, TemporalAa(weigh_light=weigh_light))), expected)
    print(motion, weigh_light, error / single)
    assert error < most * single


def test_the_ball_leaves_no_ghost(renderer):
    """Where it was in the eight frames before, away from edges: within 2 percent of white of 64 samples."""
    scene = Scene(jitter=1.0, drift=(-0.06, 0.0, 0.0))
    expected = mean_of_64(toned(still(renderer, scene, fine=FINE)))
    now, ball = still(renderer, scene, LAST, "ids")[..., 0], 3
    behind = np.zeros(now.shape, bool)
    for frame in range(LAST - 8, LAST):
        behind |= (still(renderer, scene, frame, "ids")[..., 0] == ball) & (now != ball)
    behind &= maximum_filter(now, 5) == minimum_filter(now, 5)
    assert behind.sum() > 200
    held, loose = (
        np.abs(toned(smooth(renderer, scene, node)) - expected).max(-1)[behind].max()
        for node in (TemporalAa(), TemporalAa(gamma=100.0, tolerance=1e6))
    )
    print(held, loose)
    assert held < 0.02 and loose > 0.1, "without neighborhood and depth there is one"


def moving(frame: int, speed: float = 2.0) -> np.ndarray:
    """Smooth light that goes right by whole pixels."""
    x = np.arange(24) - speed * frame
    row = 0.5 + 0.3 * np.sin(x / 3.0)
    picture = np.broadcast_to(row[None, :, None], (9, 24, 4)).astype(np.float32).copy()
    picture[..., 3] = 1.0
    return picture


def velocity(speed: float, sign: float = 1.0):
    pixels = np.zeros((9, 24, 4), np.float32)
    pixels[..., 0] = sign * speed
    return lambda _: pixels


def test_it_follows_the_velocity(renderer):
    """What moves by whole pixels with its velocity stays exactly as it is; the other way it does not."""
    shot = {"image": moving, "velocity": velocity(2.0)}
    found = render_frames(renderer, shot_graph(TemporalAa(gamma=100.0), shot, (1, 8)), shot, [8])[0]
    np.testing.assert_allclose(found, moving(8), atol=2e-5)
    wrong = shot | {"velocity": velocity(2.0, -1.0)}
    away = render_frames(renderer, shot_graph(TemporalAa(gamma=100.0), wrong, (1, 8)), wrong, [8])[0]
    assert np.abs(away - moving(8)).max() > 0.1


@pytest.mark.parametrize("kernel", ["catmull-rom", "lanczos"])
def test_it_reads_sharply_between_pixels(renderer, kernel):
    """Frames of half a pixel: of waves six pixels long bilinear reading leaves cos(pi / 6) each time."""

    def wave(frame: int) -> np.ndarray:
        row = 0.5 + 0.3 * np.sin(2 * np.pi * (np.arange(48) - 0.5 * frame) / 6)
        return np.broadcast_to(row[None, :, None], (3, 48, 4)).astype(np.float32).copy()

    pixels = np.zeros((3, 48, 4), np.float32)
    pixels[..., 0] = 0.5
    shot = {"image": wave, "velocity": lambda _: pixels}
    node = TemporalAa(gamma=100.0, kernel=kernel, weigh_light=False)
    found = render_frames(renderer, shot_graph(node, shot, (1, 12)), shot, [12])[0]
    left = np.ptp(found[1, 24:36, 0]) / np.ptp(wave(12)[1, 24:36, 0])
    keep = 0.75 * np.cos(np.pi / 6)
    bilinear = 0.25 * sum(keep**back for back in range(11)) + keep**11 / 0.75
    print(kernel, left, bilinear)
    assert abs(left - 1.0) < {"lanczos": 0.06, "catmull-rom": 0.08}[kernel] and bilinear < 0.75


def test_still_light_is_an_exponential_average(renderer):
    """Without motion and limits: y = (1 - share) y' + share x of toned light."""
    node = TemporalAa(share=0.3, gamma=100.0)
    noise = np.random.default_rng(1).uniform(0.0, 2.0, (8, 5, 6, 4)).astype(np.float32)
    shot = {"image": lambda frame: noise[frame - 1], "velocity": lambda _: np.zeros((5, 6, 4), np.float32)}
    found = render_frames(renderer, shot_graph(node, shot, (1, 8)), shot, range(1, 9))
    past = toned(noise[0])
    for frame, made in enumerate(found):
        past = past if frame == 0 else 0.7 * past + 0.3 * toned(noise[frame])
        np.testing.assert_allclose(toned(made), past, atol=2e-6)


def test_the_past_is_held_within_what_is_around(renderer):
    """A flat picture that changes changes at once."""
    shot = {
        "image": make_flat_frames(lambda frame: float(frame)),
        "velocity": lambda _: np.zeros((2, 3, 4), np.float32),
    }
    found = render_frames(renderer, shot_graph(TemporalAa(), shot, (1, 4)), shot, [4])[0]
    assert np.abs(toned(found) - 0.8).max() < 1e-3


def test_what_comes_into_the_picture_is_new(renderer):
    shot = {"image": moving, "velocity": velocity(30.0)}
    found = render_frames(renderer, shot_graph(TemporalAa(gamma=100.0), shot, (1, 4)), shot, [4])[0]
    np.testing.assert_allclose(found, moving(4), atol=1e-6)


def test_what_was_hidden_is_new(renderer):
    """The past was nearer here: another thing, although it looks as likely."""
    noise = np.random.default_rng(1).uniform(0.0, 2.0, (3, 5, 6, 4)).astype(np.float32)
    graph = Graph(settings=Settings(frames=(1, 3))).add("node", TemporalAa(gamma=100.0)).add("depth", Constant())
    graph = graph.add("near", Separate()).connect(Port("depth", "out"), Port("near", "image"))
    graph = graph.connect(Port("near", "red"), Port("node", "depth")).add_output("out", Output())
    graph = graph.connect(Port("node", "out"), Port("outputs", "out"))
    for name, kind in (("image", Kind.IMAGE), ("velocity", Kind.VECTOR)):
        graph = graph.add_input(name, Input(kind)).connect(Port("inputs", name), Port("node", name))
    shot = {"image": lambda frame: noise[frame - 1], "velocity": lambda _: np.zeros((5, 6, 4), np.float32)}
    found = {}
    for before in (9.0, 8.5, 5.0):
        keys = Keys((Key(2, (before, 0.0, 0.0, 1.0), "constant"), Key(3, (9.0, 0.0, 0.0, 1.0), "constant")))
        found[before] = render_frames(renderer, graph.animate(Port("depth", "color"), keys), shot, [3])[0]
    np.testing.assert_array_equal(found[9.0], found[8.5])
    np.testing.assert_allclose(toned(found[5.0]), toned(noise[2]), atol=2e-6)
    assert np.abs(found[9.0] - found[5.0]).max() > 0.3


def test_one_frame_is_the_picture(renderer, hdr):
    picture = hdr(9, 7)
    shot = {"image": lambda _: picture, "velocity": lambda _: np.full((7, 9, 4), 3.0, np.float32)}
    found = render_frames(renderer, shot_graph(TemporalAa(), shot), shot, [1])[0]
    np.testing.assert_allclose(found, picture, rtol=2e-3, atol=1e-5)


def test_velocity_counts_pixels_of_the_full_size(renderer):
    """At half size what moves by two pixels is read one pixel away."""

    def doubled(frame: int) -> np.ndarray:
        return np.kron(moving(frame, 1.0), np.ones((2, 2, 1), np.float32))

    pixels = np.zeros((18, 48, 4), np.float32)
    pixels[..., 0] = 2.0
    shot = {"image": doubled, "velocity": lambda _: pixels}
    node = TemporalAa(gamma=100.0)
    found = render_frames(renderer, shot_graph(node, shot, (1, 8)), shot, [8], scale=0.5)[0]
    alone = render_frames(renderer, shot_graph(node, shot, (8, 8)), shot, [8], scale=0.5)[0]
    np.testing.assert_allclose(found[:, 9:-1], alone[:, 9:-1], atol=2e-5)  # all that was inside all along


def lamp(frame: int) -> np.ndarray:
    """A small lamp over empty ground that goes right by 0.3 pixels, antialiased."""
    picture = np.zeros((9, 32, 4), np.float32)
    left = 3.0 + 0.3 * frame
    cover = np.clip(np.minimum(np.arange(32) + 1, left + 4) - np.maximum(np.arange(32), left), 0.0, 1.0)
    picture[3:6] = cover[:, None] * (5e3, 4e3, 2e3, 1.0)
    return picture


@pytest.mark.parametrize("gamma", [1.0, 100.0])
def test_nothing_flashes_beside_lamps(renderer, gamma):
    """Sharp kernels overshoot; of light that was weighed that would be blown up without end."""
    pixels = np.zeros((9, 32, 4), np.float32)
    pixels[..., 0] = 0.3
    shot = {"image": lamp, "velocity": lambda _: pixels}
    found = render_frames(renderer, shot_graph(TemporalAa(gamma=gamma), shot, (1, 24)), shot, range(1, 25))
    assert max(made.max() for made in found) < 5e3 * 1.005
    assert min(made.min() for made in found) >= -1e-3


def test_empty_ground_stays_empty(renderer):
    """What passed leaves no trace of coverage where all around is empty."""
    shot = {"image": lamp, "velocity": lambda _: np.zeros((9, 32, 4), np.float32)}
    found = render_frames(renderer, shot_graph(TemporalAa(), shot, (1, 40)), shot, [40])[0]
    assert (found[:, :12, 3] == 0.0).all() and found[4, 15:19, 3].max() > 0.5
