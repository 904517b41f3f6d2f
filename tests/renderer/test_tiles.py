"""Pictures made tile by tile have the same bits as those that fit: any nodes and sizes, both forms of passes."""

from __future__ import annotations

import re
import weakref
from pathlib import Path

import numpy as np
import pytest
from conftest import graph_of
from devices import form_to_test
from halation import document
from halation.compiler import Region, Request, Upload, examine, explain
from halation.compiler.tiling import tiling
from halation.errors import DeviceError
from halation.graph import Graph, Input, Output, Port
from halation.inputs.provider import MediaProvider
from halation.nodes import CameraModel, Filter, Kind, Reader, Temporal, catalogue, look_at
from halation.presets import paths
from halation.renderer import FrameRenderer, Renderer, RenderRequest, open_device
from halation.renderer.execution.tiles import _PictureCache as PictureCache
from halation.resources.picture import Picture
from halation.resources.sandbox import UNRESTRICTED
from msgspec.structs import replace
from random_graphs import pictures, random_graph
from selection import list_seeds

NODES = catalogue()


def limited(side: int = 16384, memory: int = 0) -> Renderer:
    """A renderer on a device that holds no more."""
    device = open_device(form_to_test(), memory, sandbox=UNRESTRICTED)
    return Renderer(device.with_target(replace(device.target, max_size=side)), budget=0, sandbox=UNRESTRICTED)


@pytest.fixture(scope="module")
def fitting():
    made = limited()
    yield made
    made.close()


@pytest.fixture
def in_pieces(monkeypatch):
    """Everything is made in the smallest tiles that there are."""
    monkeypatch.setattr(tiling, "MIN_TILE", 16)
    monkeypatch.setattr(tiling, "_find_excess", lambda *_: "a test")
    monkeypatch.setattr(tiling._StagePlanner, "_fits", lambda *_: False)


def same_bits(one, other) -> None:
    assert one.keys() == other.keys()
    for name in one:
        assert one[name].dtype == other[name].dtype
        np.testing.assert_array_equal(one[name].view(np.uint8), other[name].view(np.uint8), name)


def remembers(graph) -> bool:
    return any(isinstance(node, Temporal) for node in graph.nodes.values())


def chain(*nodes) -> Graph:
    """Nodes in a row, from `inputs.image` to `outputs.image`."""
    graph, port = Graph().add_input("image", Input(Kind.IMAGE)), Port("inputs", "image")
    for number, node in enumerate(nodes):
        graph = graph.add(f"n{number}", node).connect(port, Port(f"n{number}", "image"))
        port = Port(f"n{number}", "out")
    return graph.add_output("image", Output()).connect(port, Port("outputs", "image"))


def noise(width: int, height: int) -> np.ndarray:
    return np.random.default_rng(width).gamma(0.6, 1.0, (height, width, 4)).astype(np.float32)


# --- the same bits ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", [case for case in list_seeds(3, 12) if not remembers(random_graph(case.values[0]))])
def test_random_graphs_have_the_same_bits(fitting, in_pieces, seed):
    plan = fitting.compile(random_graph(seed), RenderRequest(pictures(seed), precision="float"))
    assert plan.tiling is not None
    same_bits(fitting.runner.run(plan), fitting.runner.run(replace(plan, tiling=None)))


@pytest.mark.parametrize("name", ["auto_exposed", "city_lights", "comic_ink", "lens_character", "neon_edges"])
def test_presets_have_the_same_bits(fitting, in_pieces, name):
    graph = next(document.load(path, sandbox=UNRESTRICTED) for path in paths() if path.stem == name)
    plan = fitting.compile(graph, RenderRequest(scale=0.04))
    same_bits(fitting.runner.run(plan), fitting.runner.run(replace(plan, tiling=None)))


@pytest.mark.parametrize("edge", ["clamp", "wrap", "reflect", "mirror", "black"])
def test_every_edge_has_the_same_bits(fitting, in_pieces, edge):
    blurs = (NODES["gaussian_blur"](sigma=sigma, edge=edge) for sigma in (2.0, 9.0))
    graph = chain(*blurs, NODES["convolve3x3"](edge=edge))
    plan = fitting.compile(graph, RenderRequest({"image": noise(83, 47)}, scale=0.9, precision="half"))
    same_bits(fitting.runner.run(plan), fitting.runner.run(replace(plan, tiling=None)))


def deep(width: int, height: int) -> np.ndarray:
    """A floor that goes far away, and boxes before it."""
    depth = np.geomspace(30.0, 2.0, height)[:, None] * np.ones(width)
    for x in range(5, width, 30):
        depth[x % height : x % height + 20, x : x + 12] = 1.0 + x / 40.0
    return depth.astype(np.float32)


def moving(width: int, height: int) -> np.ndarray:
    """Pixels from the frame before, and to the next: paths that are bent, some of which turn back."""
    found = np.random.default_rng(3).normal(0.0, 30.0, (height // 16 + 1, width // 16 + 1, 4))
    return found.repeat(16, 0).repeat(16, 1)[:height, :width].astype(np.float32)


LENS = {"focal": 1.0, "center": (0.45, 0.55)}
FAR_LOOKING = {
    "depth of field": NODES["depth_of_field"](max_blur=0.04, f_number=0.7),
    "small depth of field": NODES["depth_of_field"](max_blur=0.2, f_number=0.7, quality="draft", cat_eye=0.5),
    "bladed depth of field": NODES["depth_of_field"](
        max_blur=0.1, f_number=0.7, aperture="blades", ratio=1.5, focus="distance", quality="exact"
    ),
    "motion blur": NODES["motion_blur"](max_length=0.12),
    "sparse motion blur": NODES["motion_blur"](max_length=0.06, samples=2, phase="start", shutter=300.0),
    "glass": NODES["glass"](thickness=0.06),
    "barrel": NODES["lens_distortion"](k1=-0.1, **LENS),
    "folded barrel": NODES["lens_distortion"](k1=-0.45, zoom=0.7, **LENS),
    "pincushion": NODES["lens_distortion"](k1=0.1, k2=-0.05, **LENS),
    "straight": NODES["lens_distortion"](direction="undistort", k1=0.05, p1=0.02, zoom=1.3, edge="mirror", **LENS),
    "star": NODES["star"](length=0.03, angle=0.5, threshold=0.5),
    "zoom": NODES["radial_blur"](zoom=0.2),
    "spin": NODES["radial_blur"](kind="spin", angle=0.2, center=(0.3, 1.2), edge="reflect"),
    "ghosts": NODES["ghosts"](),
    "sun beams": NODES["sun_beams"](quality="quarter", radius=1.0, threshold=0.5),
    "histogram": NODES["auto_exposure"](),
    "surroundings": NODES["image_based_light"](),
}
"""Nodes whose values say how far they look, which is not as far as the picture goes."""


def cameras(node) -> dict[str, CameraModel]:
    """One for every input that takes one."""
    view = look_at((1.0, -5.0, 2.0), (0.0, 0.0, 0.0), (1.2, 2.0))
    return {name: view for name, item in type(node).inputs.items() if item.kind is Kind.CAMERA}


@pytest.mark.parametrize("name", FAR_LOOKING)
def test_what_looks_far_has_the_same_bits(fitting, in_pieces, monkeypatch, name):
    size, node = (120, 90), FAR_LOOKING[name]
    monkeypatch.setattr(tiling, "MIN_TILE", 36)
    known = {
        "image": noise(*size),
        "depth": deep(*size),
        "velocity": moving(*size),
        "surface": deep(*size) / 10.0,
        "normal": noise(*size)[..., :3] - 0.5,
        "environment": noise(*size),
    }
    given = {socket: known[socket] for socket in type(node).inputs if socket in known}
    plan = fitting.compile(graph_of(node, given | cameras(node)), RenderRequest(given, precision="float"))
    assert plan.tiling is not None
    same_bits(fitting.runner.run(plan), fitting.runner.run(replace(plan, tiling=None)))


@pytest.mark.parametrize("name", FAR_LOOKING)
def test_what_looks_far_goes_beyond_the_device(name):
    node, outside = FAR_LOOKING[name], MediaProvider(sandbox=UNRESTRICTED)
    given = {
        socket: np.ones((32, 32, item.channels), np.float32)
        for socket, item in type(node).inputs.items()
        if item.kind is not Kind.CAMERA
    }
    graph = graph_of(node, given | cameras(node))
    examine(graph, Request({}, outside.bind(graph, given), (17_000, 17_000)), outside)


def refused(node) -> str:
    """Why a node cannot be made of larger pictures than a device holds; "" if it can."""
    outside, sockets = MediaProvider(sandbox=UNRESTRICTED), type(node).inputs
    given = {
        name: np.ones((32, 32, item.channels), np.float32)
        for name, item in sockets.items()
        if item.kind is not Kind.CAMERA and not item.single
    }
    graph = graph_of(node, given | cameras(node))
    try:
        examine(graph, Request({}, outside.bind(graph, given), (17_000, 17_000)), outside)
    except DeviceError as error:
        return str(error)
    return ""


@pytest.mark.large
def test_the_manual_says_what_may_read_anywhere():
    manual = Path(__file__).parents[2] / "docs" / "running.md"
    rows = [line for line in manual.read_text().splitlines() if line.startswith("| ")]
    said = {name for line in rows for name in re.findall(r"`(\w+)`", line.split("|")[1])}
    nodes = [kind() for kind in NODES.values() if issubclass(kind, Filter) and not issubclass(kind, Reader | Temporal)]
    drawn = [node for node in nodes if all(item.socket.kind is not Kind.CAMERA for item in type(node).outputs.values())]
    found = {type(node).id for node in drawn if "it may need all" in refused(node)}
    assert found and found <= said


def test_long_rows_have_the_same_histogram(fitting, in_pieces):
    """They are looked at piece by piece."""
    given = {"image": noise(9000, 3)}
    plan = fitting.compile(graph_of(NODES["auto_exposure"](), given), RenderRequest(given, precision="float"))
    same_bits(fitting.runner.run(plan), fitting.runner.run(replace(plan, tiling=None)))


def test_a_region_has_the_bits_that_it_has_in_the_whole(fitting):
    for seed in range(6):
        graph, wanted = random_graph(seed), RenderRequest(pictures(seed), precision="float")
        whole = fitting.render(graph, wanted)
        plan = fitting.compile(graph, replace(wanted, region=Region(9, 5, 11, 7)))
        for name, pixels in fitting.runner.run(plan).items():
            part = plan.surfaces[plan.outputs[name]].window
            cut = whole[name][part.y : part.y + part.height, part.x : part.x + part.width] if part else whole[name]
            same_bits({name: pixels}, {name: np.ascontiguousarray(cut)})


# --- what fits -------------------------------------------------------------------------------------------------------


def test_a_device_holds_tiles_of_what_is_too_large_for_it(fitting):
    small, graph = limited(side=64), chain(NODES["bloom"](radius=0.05), NODES["exposure"](stops=1.0))
    wanted = RenderRequest({"image": noise(150, 90)})
    plan = small.compile(graph, wanted)
    assert plan.tiling is not None and "150x90 pixels is more than the 64" in explain(plan)
    same_bits(small.render(graph, wanted), fitting.render(graph, wanted))
    small.close()


@pytest.mark.parametrize(
    ("by_rows", "asked"),
    [(True, [(10, 30), (25, 40), None]), (False, [None])],
    ids=["rows", "whole"],
)
def test_only_the_rows_that_are_looked_at_are_read(by_rows, asked):
    """A window within the rows that were read last asks for none; without one, and of other formats, all are read."""
    pixels, loads = noise(60, 50), []

    def load(picture):
        loads.append(picture.rows)
        return pixels[slice(*picture.rows)] if picture.rows else pixels

    picture = Picture("a.exr", "", Kind.IMAGE, 4, by_rows=True)
    cache = PictureCache(load, by_rows=by_rows)
    for window in (Region(5, 10, 20, 20), Region(0, 15, 60, 10), Region(7, 25, 9, 15), None):
        part = cache.read(Upload(0, picture, "n", Region(0, 0, 60, 50)), window).picture.pixels
        whole = window is None or not by_rows
        cut = pixels if whole else pixels[window.y : window.y + window.height, window.x : window.x + window.width]
        np.testing.assert_array_equal(part, cut)
    assert loads == asked


def test_tiles_share_their_programs():
    graph, picture = chain(NODES["gaussian_blur"](sigma=2.0), NODES["convolve3x3"]()), noise(200, 150)
    compiled: list[int] = []
    for side in (100, 40):
        small = limited(side=side)
        small.render(graph, RenderRequest({"image": picture}))
        compiled.append(small.runner.programs.compiled)
        small.close()
    assert compiled[0] == compiled[1]


def test_no_more_is_held_than_may_be():
    graph = chain(*(NODES["gaussian_blur"](sigma=sigma) for sigma in (2.0, 3.0, 9.0)))
    wanted = RenderRequest({"image": noise(900, 700)})
    free = limited()
    whole, plan = free.render(graph, wanted), free.compile(graph, wanted)
    free.close()
    memory = 2 * 900 * 700 * 16 + plan.peak_bytes // 4  # both pictures, and a quarter of the textures
    tight = limited(memory=memory)
    tiled = tight.compile(graph, wanted)
    assert tiled.tiling is not None and tiled.tiling.nbytes <= memory
    same_bits(tight.runner.run(tiled), whole)
    assert tight.runner.textures.peak <= plan.peak_bytes // 4
    tight.close()


def through(reel: FrameRenderer, frames: int) -> list[dict[str, np.ndarray]]:
    """Frames one after the other; what each has in common with the next stays for that."""
    made: list[dict[str, np.ndarray]] = []
    for frame in range(1, frames + 1):
        kept = reel.renderer.runner.create_lease()
        for run in reel.start_runs(frame, kept, following=reel.plan_frame(frame + 1)):
            with run:
                list(run)
        made.append(reel.renderer.runner.download(reel.plan_frame(frame)))
        kept.close()
    return made


def test_what_a_frame_remembers_is_counted_twice(fitting):
    """Before a frame is done, what was remembered of the one before is still there."""
    graph, wanted = chain(NODES["light_trails"]()), RenderRequest({"image": noise(100, 50)}, precision="float")
    free = FrameRenderer(fitting, graph, wanted)
    memory = free.plan_frame(2).held_bytes
    tight = limited(memory=memory)
    for one, other in zip(through(FrameRenderer(tight, graph, wanted), 4), through(free, 4), strict=True):
        same_bits(one, other)
    assert tight.runner.textures.peak <= memory - 2 * 100 * 50 * 16
    tight.close()
    tighter = limited(memory=memory - 1)
    with pytest.raises(DeviceError, match="node 'n0': what it remembers of a frame"):
        FrameRenderer(tighter, graph, wanted).plan_frame(1)
    tighter.close()


def test_nothing_is_carried_on_that_there_is_no_room_for(fitting):
    """A still under noise that moves is made once where there is room, else in every frame."""
    graph = chain(NODES["median"](), NODES["film_grain"](), *[NODES["gaussian_blur"](sigma=2.0)] * 2)
    wanted = RenderRequest({"image": noise(300, 200)}, precision="float")
    plan = FrameRenderer(fitting, graph, wanted).plan_frame(1)
    peaks: list[int] = []
    for memory in (4 * plan.held_bytes, plan.held_bytes):
        tight = limited(memory=memory)
        through(FrameRenderer(tight, graph, wanted), 3)
        peaks.append(tight.runner.textures.peak)
        tight.close()
    assert peaks[1] <= plan.peak_bytes and peaks[1] < peaks[0]


def test_outputs_in_memory_go_with_their_lease(fitting, in_pieces):
    """Whether they were downloaded or not."""
    plan = fitting.compile(chain(NODES["exposure"](stops=1.0)), RenderRequest({"image": noise(60, 40)}))
    kept, other = fitting.runner.create_lease(), fitting.runner.create_lease()
    for lease in (kept, other):
        with fitting.runner.start_run(plan, lease) as run:
            list(run)
    kept.close()
    alone = weakref.ref(fitting.runner.download(plan)["image"])
    other.close()
    assert alone() is None
    with pytest.raises(KeyError):
        fitting.runner.download(plan)


# --- what cannot be --------------------------------------------------------------------------------------------------


def test_what_is_read_anywhere_must_fit_as_a_whole():
    small = limited(side=64)
    graph = graph_of(NODES["displace"](), {"image": noise(100, 50), "vector": noise(100, 50)[..., :2]})
    with pytest.raises(DeviceError, match=r"node 'node': it may need all 100x50 pixels .* render smaller with --scale"):
        small.compile(graph, RenderRequest({"image": noise(100, 50), "vector": noise(100, 50)[..., :2]}))
    small.close()


def test_tiles_are_as_large_as_the_device_can_hold(fitting):
    """However much memory the whole picture takes: that is not on the device."""
    wanted = RenderRequest({"image": noise(100, 50)}, size=(40_000, 20_000))
    made = fitting.compile(chain(NODES["exposure"](stops=1.0)), wanted).tiling
    assert made is not None and len(made.stages[-1].tiles) <= 16


def test_memory_that_no_tile_fits_into_is_refused():
    tight = limited(memory=2**16)
    with pytest.raises(DeviceError, match=r"only 64.0 KiB may be used; give more with --memory"):
        tight.compile(chain(NODES["convolve3x3"]()), RenderRequest({"image": noise(100, 50)}))
    tight.close()


def test_tiles_that_are_too_many_are_refused(monkeypatch):
    monkeypatch.setattr(tiling, "MAX_TILES", 5)
    tight = limited(memory=2 * 100 * 50 * 16 + 2**15)  # both pictures, and small tiles
    with pytest.raises(DeviceError, match=r"node 'n0': within 188.* its 100x50 pixels can only be made in tiles of"):
        tight.compile(chain(NODES["convolve3x3"]()), RenderRequest({"image": noise(100, 50)}))
    tight.close()


def test_what_remembers_frames_is_refused():
    tight = limited(memory=2**17)
    with pytest.raises(DeviceError, match="node 'n0': what it remembers of a frame"):
        tight.compile(chain(NODES["light_trails"]()), RenderRequest({"image": noise(100, 50)}))
    tight.close()
