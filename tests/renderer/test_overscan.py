"""Pictures that go on beyond their frame: what leaves it comes back, and costs nothing where nobody reads it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from exr_files import create_output
from halation.graph import Graph, Input, Output, Port, Settings
from halation.nodes import CurvePair, Filter, Kind, catalogue, name_curve_pairs
from halation.renderer import Renderer, RenderRequest, open_device
from halation.renderer.jobs.job import OutputSettings, run_job
from halation.resources.sandbox import UNRESTRICTED
from random_graphs import pictures, random_graph
from scipy.ndimage import gaussian_filter
from selection import list_seeds

NODES = catalogue()
WIDTH, HEIGHT = 64, 48
MOVED = (12.0, 9.0)


def make_picture(seed: int = 1, size: tuple[int, int] = (WIDTH, HEIGHT)) -> np.ndarray:
    rng = np.random.default_rng(seed)
    picture = np.ones((size[1], size[0], 4), np.float32)
    picture[..., :3] = gaussian_filter(rng.random((size[1], size[0], 3)), (2, 2, 0))
    return picture


def chain(*nodes: Filter, overscan: float = 0.5, file: str = "") -> Graph:
    """Nodes in a row, from the input `picture` to the output `out`."""
    graph = Graph(settings=Settings(overscan=overscan)).add_input("picture", Input(file=file))
    last = Port("inputs", "picture")
    for number, node in enumerate(nodes):
        graph = graph.add(f"n{number}", node).connect(last, Port(f"n{number}", "image"))
        last = Port(f"n{number}", "out")
    return graph.add_output("out", Output()).connect(last, Port("outputs", "out"))


def move(x: float, y: float) -> Filter:
    return NODES["transform"](position=(x, y), kernel="nearest")


AWAY, BACK = move(*MOVED), move(-MOVED[0], -MOVED[1])


@pytest.mark.parametrize("overscan", [0.25, 0.5, 2.0])
def test_what_a_move_takes_out_of_the_frame_comes_back(run, overscan: float) -> None:
    """Through a node in between, which keeps two transforms from being joined to one."""
    picture = make_picture()
    graph = chain(AWAY, NODES["exposure"](stops=1.0), BACK, overscan=overscan)
    np.testing.assert_array_equal(run(graph, {"picture": picture})[..., :3], 2.0 * picture[..., :3])


def test_what_a_warp_takes_out_of_the_frame_comes_back(run) -> None:
    """A grid whose points all move alike, and a pair of curves that does."""
    across, down = MOVED[0] / WIDTH, MOVED[1] / HEIGHT
    points = {
        f"point_{row + 1}{column + 1}": (column / 3 + across, row / 3 + down) for row in range(4) for column in range(4)
    }
    places = {"start": (0.3, 0.2), "middle": (0.4, 0.5), "end": (0.3, 0.8)}
    pair = {f"from_{name}": place for name, place in places.items()}
    pair |= {f"to_{name}": (place[0] + across, place[1] + down) for name, place in places.items()}
    curves = name_curve_pairs(curve=CurvePair(**pair))
    picture = make_picture()
    for warp in (
        NODES["grid_warp"](**points, kernel="nearest"),
        NODES["spline_warp"](curves=curves, amount=1.0, show="first", edge="black"),
    ):
        made = run(chain(warp, NODES["exposure"](stops=1.0), BACK), {"picture": picture})
        np.testing.assert_allclose(made[1:-1, 1:-1, :3], 2.0 * picture[1:-1, 1:-1, :3], atol=1e-4)


def test_without_overscan_it_is_lost(run) -> None:
    picture = make_picture()
    made = run(chain(AWAY, NODES["exposure"](stops=1.0), BACK, overscan=0.0), {"picture": picture})
    expected = 2.0 * picture
    expected[HEIGHT - 9 :] = expected[:, WIDTH - 12 :] = 0.0
    np.testing.assert_array_equal(made[..., :3], expected[..., :3])


def test_overscan_ends_where_it_is_set(run) -> None:
    """An eighth of 48 lines is 6, of the 9 and 12 that the picture is moved."""
    picture = make_picture()
    made = run(chain(AWAY, NODES["exposure"](stops=1.0), BACK, overscan=0.125), {"picture": picture})
    expected = 2.0 * picture
    expected[HEIGHT - 3 :] = expected[:, WIDTH - 6 :] = 0.0
    np.testing.assert_array_equal(made[..., :3], expected[..., :3])


def test_a_blur_beyond_the_frame_is_scipys(run) -> None:
    """The picture is blurred before it comes back: where it was outside of the frame as well, and around itself."""
    picture, sigma = make_picture(), 1.5
    graph = chain(AWAY, NODES["gaussian_blur"](sigma=sigma, edge="black"), BACK)
    expected = gaussian_filter(picture.astype(np.float64), (sigma, sigma, 0), mode="constant", truncate=8)
    np.testing.assert_allclose(run(graph, {"picture": picture}), expected, atol=3e-5)


@pytest.mark.parametrize("sigma", [3.0, 9.0, 24.0])
def test_a_large_blur_keeps_all_pixels_beyond_the_frame(renderer, tmp_path: Path, sigma: float) -> None:
    """It is made on a smaller picture, which has pixels around its own that the edge mode makes up."""
    pixels = make_picture(5, (WIDTH + 40, HEIGHT + 40))
    file = write_overscan(tmp_path / "plate.exr", (20, 20), pixels)
    graph = chain(NODES["gaussian_blur"](sigma=sigma, edge="clamp"), overscan=0.5, file=file)
    made = renderer.render(graph, RenderRequest(precision="float", whole=frozenset({"out"})))["out"]
    expected = gaussian_filter(pixels.astype(np.float64), (sigma, sigma, 0), mode="nearest", truncate=8)
    assert made.shape == pixels.shape
    np.testing.assert_allclose(made, expected, atol=2e-3)


@pytest.mark.parametrize("seed", list_seeds(4, 24))
def test_random_moves_and_their_inverse(run, seed: int) -> None:
    rng, picture = np.random.default_rng(seed), make_picture(seed)
    moves = [(float(x), float(y)) for x, y in rng.integers(-20, 20, (3, 2))]
    shade = NODES["saturation"](saturation=0.5)
    nodes = [node for x, y in moves for node in (move(x, y), shade)]
    nodes += [node for x, y in reversed(moves) for node in (move(-x, -y), shade)]
    expected = run(chain(*([shade] * 6)), {"picture": picture})
    np.testing.assert_allclose(run(chain(*nodes, overscan=2.0), {"picture": picture}), expected, atol=1e-6)


@pytest.mark.parametrize(("edge", "ring"), [("clamp", 2), ("black", 5)])
@pytest.mark.parametrize("k1", [0.1, -0.08])
def test_a_lens_and_back_loses_nothing(run, k1: float, edge: str, ring: int) -> None:
    """Barrel distortion takes corners in, pincushion distortion out of the frame.

    Where black begins at the frame, two kernels of two pixels, one of them stretched, reach it from a ring of five.
    """
    y, x = np.mgrid[0:120, 0:160] / 120
    picture = np.stack([0.5 + 0.4 * np.sin(3 * x + 2 * y), x, y, np.ones_like(x)], axis=2).astype(np.float32)
    lens = {"k1": k1, "kernel": "catmull-rom", "edge": edge}
    out, back = NODES["lens_distortion"](**lens), NODES["lens_distortion"](**lens, direction="undistort")
    made = run(chain(out, NODES["exposure"](stops=1.0), back, overscan=1.0), {"picture": picture})
    inner = (slice(ring, -ring), slice(ring, -ring), slice(3))
    assert np.abs(made / 2.0 - picture)[inner].max() < 1e-3
    lost = run(chain(out, NODES["exposure"](stops=1.0), back, overscan=0.0), {"picture": picture})
    assert k1 < 0 or np.abs(lost / 2.0 - picture)[inner].max() > 0.02


@pytest.mark.parametrize("channel", ["depth", "albedo"])
def test_a_scene_is_drawn_beyond_its_frame(run, channel: str) -> None:
    """As a camera with a larger sensor draws it, whose pixels are the same."""
    across, down = WIDTH // 4, HEIGHT // 4

    def draw(focal: float, size: tuple[int, int], *nodes: Filter) -> np.ndarray:
        graph = Graph(settings=Settings(size=size, overscan=0.5)).add("scene", NODES["scene"](focal=focal))
        last = Port("scene", channel)
        for number, node in enumerate(nodes):
            graph = graph.add(f"n{number}", node).connect(last, Port(f"n{number}", "image"))
            last = Port(f"n{number}", "out")
        graph = graph.add_output("out", Output(Kind.IMAGE if channel == "albedo" else Kind.FIELD))
        return run(graph.connect(last, Port("outputs", "out")))

    wide = draw(40.0 * WIDTH / (WIDTH + 2 * across), (WIDTH + 2 * across, HEIGHT + 2 * down))[:HEIGHT, :WIDTH]
    made = draw(40.0, (WIDTH, HEIGHT), move(float(across), float(down)))
    differs = np.abs(made[..., :3] - wide[..., :3]).max(axis=2) > 1e-4 * (1.0 + np.abs(wide[..., :3]).max(axis=2))
    assert differs.mean() < 0.003  # pixels on an edge fall to one side or the other
    assert np.abs(made[:down, :, :3]).max() > 0.1


def write_overscan(path: Path, margin: tuple[int, int], pixels: np.ndarray) -> str:
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 4, "float")
    spec.full_x, spec.full_y, spec.full_width, spec.full_height = 100, 50, WIDTH, HEIGHT
    spec.x, spec.y = 100 - margin[0], 50 - margin[1]
    file = create_output(path)
    assert file.open(str(path), spec) and file.write_image(pixels) and file.close()
    return str(path)


@pytest.mark.parametrize("seed", range(3))
def test_a_render_with_overscan_arrives_whole(renderer, tmp_path: Path, seed: int) -> None:
    across, down = (int(side) for side in np.random.default_rng(seed).integers(4, 12, 2))
    pixels = make_picture(seed, (WIDTH + 2 * across, HEIGHT + 2 * down))
    file = write_overscan(tmp_path / "plate.exr", (across, down), pixels)
    made = renderer.render(chain(move(-float(across), 3.0), overscan=0.5, file=file))["out"]
    np.testing.assert_array_equal(made, pixels[down - 3 :][:HEIGHT, 2 * across :][:, :WIDTH])
    frame = renderer.render(chain(move(0.0, 0.0), overscan=0.5, file=file))["out"]
    np.testing.assert_array_equal(frame, pixels[down:-down, across:-across])


def test_a_data_window_inside_the_frame_stays_there(renderer, tmp_path: Path) -> None:
    pixels = make_picture(3, (20, 10))
    file = write_overscan(tmp_path / "small.exr", (-30, -20), pixels)
    made = renderer.render(chain(move(5.0, 0.0), file=file))["out"]
    assert not made[:20].any()
    np.testing.assert_array_equal(made[20:30, 35:55], pixels)


def test_nobody_pays_for_what_nobody_reads(renderer) -> None:
    request = RenderRequest({"picture": make_picture()})
    nodes = (NODES["gaussian_blur"](sigma=3.0), AWAY, NODES["exposure"](stops=1.0))
    plain, wide = (renderer.compile(chain(*nodes, overscan=overscan), request) for overscan in (0.0, 1.0))
    assert [surface.size for surface in wide.surfaces] == [surface.size for surface in plain.surfaces]
    back = renderer.compile(chain(*nodes, BACK, overscan=1.0), request)
    largest = max(surface.size for surface in back.surfaces)
    assert WIDTH < largest[0] <= WIDTH + 12 + 2 and largest[1] <= HEIGHT + 9 + 2


@pytest.fixture(scope="module")
def unfused():
    engine = Renderer(open_device(sandbox=UNRESTRICTED), budget=0, fusion=False, sandbox=UNRESTRICTED)
    yield engine
    engine.close()


@pytest.mark.parametrize("seed", list_seeds(6, 60))
def test_fused_equals_unfused_to_the_bit(renderer, unfused, seed: int) -> None:
    graph = random_graph(seed)
    graph = replace(graph, settings=replace(graph.settings, overscan=0.4))
    request = RenderRequest(pictures(seed), precision="float")
    made, expected = renderer.render(graph, request), unfused.render(graph, request)
    for name in expected:
        np.testing.assert_array_equal(made[name].view(np.uint8), expected[name].view(np.uint8), name)


def test_an_edited_graph_is_planned_as_a_new_one(renderer) -> None:
    """How far a picture is made beyond its frame follows the numbers that are dragged."""
    picture = make_picture()
    for x in (12.0, 3.0, 20.0, 12.0):
        graph = chain(move(x, 0.0), NODES["exposure"](stops=1.0), move(-x, 0.0))
        made = renderer.render(graph, RenderRequest({"picture": picture}))["out"]
        np.testing.assert_array_equal(made[..., :3], 2.0 * picture[..., :3])


def render_files(renderer: Renderer, graph: Graph, *paths: Path) -> None:
    settings = OutputSettings([("out", path) for path in paths], precision="float")
    run_job(renderer, graph, RenderRequest(), settings, (1,))


@pytest.mark.parametrize("overscan", [0.0, 0.125, 1.0])
def test_an_output_with_overscan_is_written_whole(renderer, tmp_path: Path, overscan: float) -> None:
    """By OpenImageIO's account: the display window is the frame, the data window what there is of it and around."""
    pixels = make_picture(4, (WIDTH + 20, HEIGHT + 16))
    graph = chain(NODES["exposure"](stops=1.0), file=write_overscan(tmp_path / "plate.exr", (10, 8), pixels))
    graph = replace(
        graph,
        settings=Settings(overscan=overscan),
        outputs={"out": replace(graph.outputs["out"], overscan=True)},
    )
    render_files(renderer, graph, tmp_path / "whole.exr", tmp_path / "frame.png")
    margin = min(10, int(overscan * HEIGHT)), min(8, int(overscan * HEIGHT))
    buffer = oiio.ImageBuf(str(tmp_path / "whole.exr"))
    spec = buffer.spec()
    assert (spec.x, spec.y, spec.width, spec.height) == (
        -margin[0], -margin[1], WIDTH + 2 * margin[0], HEIGHT + 2 * margin[1],
    )  # fmt: skip
    assert (spec.full_x, spec.full_y, spec.full_width, spec.full_height) == (0, 0, WIDTH, HEIGHT)
    expected = pixels[8 - margin[1] : 8 + HEIGHT + margin[1], 10 - margin[0] : 10 + WIDTH + margin[0]]
    np.testing.assert_array_equal(buffer.get_pixels(oiio.FLOAT)[..., :3], 2.0 * expected[..., :3])
    shown = oiio.ImageBuf(str(tmp_path / "frame.png")).spec()
    assert (shown.width, shown.height) == (WIDTH, HEIGHT)
    again = chain(NODES["exposure"](stops=-1.0), move(3.0, 0.0), file=str(tmp_path / "whole.exr"))
    made = renderer.render(again)["out"]
    np.testing.assert_array_equal(made[:, 3:, :3], pixels[8:-8, 10:-13, :3])
    np.testing.assert_array_equal(made[:, : 3 - min(margin[0], 3)], 0.0)


def test_an_output_that_others_read_is_the_frame(renderer) -> None:
    graph = chain(AWAY, NODES["exposure"](stops=1.0), BACK)
    graph = graph.add_output("moved", Output()).connect(Port("n1", "out"), Port("outputs", "moved"))
    picture = make_picture()
    made = renderer.render(graph, RenderRequest({"picture": picture}))
    assert made["moved"].shape == picture.shape
    np.testing.assert_array_equal(made["moved"][9:, 12:, :3], 2.0 * picture[:-9, :-12, :3])
    np.testing.assert_array_equal(made["out"][..., :3], 2.0 * picture[..., :3])
