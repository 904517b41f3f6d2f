"""Transform against scipy and OpenImageIO."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.compiler import explain
from halation.graph import Graph, Input, Output, Port
from halation.nodes import Kind
from halation.nodes.color.exposure import Exposure
from halation.nodes.distort.transform import Transform
from halation.renderer import RenderRequest
from oiio_pictures import make_buffer
from scipy.ndimage import map_coordinates

KERNELS = Transform.values["kernel"].choices
MOVES = [
    {"position": (3.3, -1.7)},
    {"rotation": 27.0},
    {"scale": (1.7, 1.2), "pivot": (0.2, 0.9)},
    {"rotation": -133.0, "scale": (1.5, -1.1), "position": (2.0, 4.5), "pivot": (0.7, 0.4)},
    {"skew": (25.0, 0.0), "scale": (1.8, 1.8)},
    {"skew": (-20.0, 35.0), "scale": (2.6, 2.4), "rotation": 15.0, "position": (1.0, -2.0), "pivot": (0.3, 0.8)},
]


def forward(node: Transform, size: tuple[int, int]) -> np.ndarray:
    """The 3 x 3 matrix that takes image positions to result positions."""
    x, y = node.pivot[0] * size[0], node.pivot[1] * size[1]
    turn = np.radians(node.rotation)
    to_pivot = np.array([[1, 0, -x], [0, 1, -y], [0, 0, 1.0]])
    scale = np.diag([*node.scale, 1.0])
    spin = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1.0]])
    lean, fall = np.tan(np.radians(node.skew))
    shear = np.array([[1, lean, 0], [fall, 1, 0], [0, 0, 1.0]])
    back = np.array([[1, 0, x + node.position[0]], [0, 1, y + node.position[1]], [0, 0, 1.0]])
    return back @ spin @ shear @ scale @ to_pivot


def sampled(picture: np.ndarray, matrix: np.ndarray, mode: str) -> np.ndarray:
    y, x = np.mgrid[: picture.shape[0], : picture.shape[1]] + 0.5
    where = np.einsum("ij,jyx->iyx", np.linalg.inv(matrix), np.stack([x, y, np.ones_like(x)])) - 0.5
    channels = np.moveaxis(picture.astype(np.float64), -1, 0)
    return np.stack([map_coordinates(c, where[1::-1], order=1, mode=mode) for c in channels], -1)


@pytest.mark.parametrize("move", MOVES, ids=str)
@pytest.mark.parametrize("size", [(31, 22), (3, 2), (1, 1)])
def test_bilinear_is_scipys(run, hdr, edge, move, size):
    picture, node = hdr(*size), Transform(kernel="triangle", edge=edge.name, **move)
    expected = sampled(picture, forward(node, size), edge.scipy_map)
    assert np.abs(run(node, {"image": picture}) - expected).max() < 1e-5 * picture.max()


@pytest.mark.parametrize(
    ("kernel", "name"),
    [
        ("triangle", "triangle"),
        ("catmull-rom", "catmull-rom"),
        ("mitchell", "mitchell"),
        ("lanczos", "lanczos3"),
    ],
)
def test_turned_it_is_openimageios(run, hdr, kernel, name):
    picture = hdr(48, 40)
    node = Transform(rotation=20.0, position=(2.25, -3.5), kernel=kernel)
    matrix = tuple(float(part) for part in forward(node, (48, 40)).T.ravel())
    expected = oiio.ImageBufAlgo.warp(make_buffer(picture), matrix, name, wrap="black").get_pixels("float")
    error = np.abs(run(node, {"image": picture}) - expected)[12:-12, 12:-12]
    assert error.max() < 1e-5 * picture.max()


@pytest.mark.parametrize("kernel", KERNELS)
def test_whole_steps_and_quarter_turns_are_exact(run, hdr, kernel):
    picture = hdr(24, 24)
    if kernel != "mitchell":  # which softens even where nothing moves
        moved = run(Transform(position=(3.0, -5.0), edge="wrap", kernel=kernel), {"image": picture})
        assert np.abs(moved - np.roll(picture, (-5, 3), (0, 1))).max() < 1e-5 * picture.max()
        turned = run(Transform(rotation=90.0, kernel=kernel), {"image": picture})
        assert np.abs(turned - np.rot90(picture, -1)).max() < 1e-5 * picture.max()
        mirrored = run(Transform(scale=(-1.0, 1.0), kernel=kernel), {"image": picture})
        assert np.abs(mirrored - picture[:, ::-1]).max() < 1e-5 * picture.max()


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("scale", [0.05, 0.3, 2.5])
def test_an_even_picture_stays_even(run, kernel, scale):
    node = Transform(scale=(scale, scale), rotation=33.0, kernel=kernel, edge="clamp")
    taps = (6 / min(scale, 1.0)) ** 2  # each of which rounds
    assert np.abs(run(node, {"image": np.full((13, 17, 4), 0.37)}) - 0.37).max() < 6e-8 * 0.37 * taps + 1e-7


@pytest.mark.parametrize("kernel", [kernel for kernel in KERNELS if kernel != "nearest"])
def test_shrinking_does_not_alias(run, kernel):
    """Stripes finer than the result's pixels become their average."""
    stripes = np.zeros((64, 64, 4), np.float32)
    stripes[:, ::2] = 1.0
    out = run(Transform(scale=(0.25, 0.25), rotation=10.0, kernel=kernel, edge="wrap"), {"image": stripes})
    assert np.abs(out - 0.5).max() < 0.02


def test_inverse_is_the_inverse_matrix():
    pivot = (12.0, 9.0)
    node = Transform(position=(5.0, -3.0), rotation=40.0, scale=(1.5, 0.7), pivot=(0.3, 0.3), skew=(20.0, -35.0))
    node = node.to_working_units(1.0, 30)
    matrices = [
        np.array([*node.with_values(direction=direction).backward(pivot), 0, 0, 1]).reshape(3, 3)
        for direction in ("forward", "inverse")
    ]
    assert np.abs(matrices[0] @ matrices[1] - np.eye(3)).max() < 1e-12


def test_a_proxy_moves_as_far(run):
    y, x = np.mgrid[:64, :64] + 0.5
    picture = np.repeat(np.exp(-((x - 20) ** 2 / 60 + (y - 26) ** 2 / 150))[..., None], 4, -1)
    node = Transform(position=(16.0, 8.0), rotation=90.0)
    full, half = (run(node, {"image": picture}, scale=scale)[..., 3] for scale in (1.0, 0.5))
    assert np.abs(half - full.reshape(32, 2, 32, 2).mean((1, 3))).max() < 0.02


def test_standing_still_vanishes():
    assert Transform().identity() == "image" and Transform(rotation=1.0).identity() is None


# --- transforms in a row ---------------------------------------------------------------------------------------------


def chain(nodes) -> Graph:
    """One node after the other; every result is an output, `out0`, `out1`, ..."""
    graph = Graph().add_input("image", Input(Kind.IMAGE, 4))
    source = Port("inputs", "image")
    for number, node in enumerate(nodes):
        graph = graph.add(f"n{number}", node).connect(source, Port(f"n{number}", "image"))
        source = Port(f"n{number}", "out")
        name = f"out{number}"
        graph = graph.add_output(name, Output(Kind.IMAGE, 4)).connect(source, Port("outputs", name))
    return graph


def planned(renderer, nodes, picture, wanted):
    targets = {name: Port("outputs", name) for name in wanted}
    return renderer.compile(chain(nodes), RenderRequest({"image": picture}, targets))


def moves(seed: int, count: int, **more) -> list[Transform]:
    """At random, none of which shrinks."""
    random = np.random.default_rng(seed)
    return [
        Transform(
            position=tuple(random.uniform(-6, 6, 2)),
            rotation=random.uniform(-180, 180),
            pivot=tuple(random.random(2)),
            scale=tuple(random.uniform(1.0, 1.2, 2) * random.choice([-1, 1], 2)),
            **more,
        )
        for _ in range(count)
    ]


def product(nodes, size) -> np.ndarray:
    found = np.eye(3)
    for node in nodes:
        found = forward(node, size) @ found
    return found


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("size", [(33, 26), (3, 5)])
def test_five_in_a_row_sample_once_by_their_product(run, hdr, edge, seed, size):
    picture, nodes = hdr(*size), moves(seed, 5, edge=edge.name)
    expected = sampled(picture, product(nodes, size), edge.scipy_map)
    found = run(chain(nodes), {"image": picture}, output="out4")
    assert np.abs(found - expected).max() < 1e-5 * picture.max()


def test_the_last_kernel_filters_them_all(run, hdr):
    picture, nodes = hdr(48, 40), moves(7, 4, kernel="nearest")
    nodes.append(Transform(rotation=9.0, kernel="lanczos"))
    nodes = [node.with_values(scale=(1.0, 1.0)) for node in nodes]
    matrix = tuple(float(part) for part in product(nodes, (48, 40)).T.ravel())
    expected = oiio.ImageBufAlgo.warp(make_buffer(picture), matrix, "lanczos3", wrap="black").get_pixels("float")
    found = run(chain(nodes), {"image": picture}, output="out4")
    # Where all of the kernel lies in the picture: OpenImageIO has its own way with rims.
    within = run(chain(nodes), {"image": np.ones_like(picture)}, output="out4")[..., :1]
    deep = np.abs(within - 1.0) < 1e-6
    assert deep.mean() > 0.3
    assert (np.abs(found - expected) * deep).max() < 1e-5 * picture.max()


def test_it_takes_one_pass_and_explain_says_so(renderer, hdr):
    plan = planned(renderer, moves(1, 5), hdr(33, 26), ["out4"])
    assert len(plan.passes) == 1
    assert plan.passes[0].nodes == ("n0", "n1", "n2", "n3", "n4")
    assert "place x 5  [n0, n1, n2, n3, n4]" in explain(plan)


@pytest.mark.parametrize("kernel", KERNELS)
def test_there_and_back_is_the_picture_itself(run, hdr, renderer, kernel):
    picture = hdr(37, 26)
    for seed in range(5):
        there = moves(seed, 3, kernel=kernel)
        back = [node.with_values(direction="inverse") for node in reversed(there)]
        np.testing.assert_array_equal(run(chain([*there, *back]), {"image": picture}, output="out5"), picture)
    turns = [Transform(rotation=angle, kernel=kernel) for angle in (33.3, -33.3)]
    np.testing.assert_array_equal(run(chain(turns), {"image": picture}, output="out1"), picture)
    assert not planned(renderer, turns, picture, ["out1"]).passes


def test_what_left_the_frame_in_between_is_not_lost(run, hdr):
    picture = hdr(20, 16)
    nodes = [Transform(position=(30.0, 0.0)), Transform(rotation=90.0), Transform(position=(0.0, -30.0))]
    out = chain(nodes)
    assert not run(out, {"image": picture}, output="out0").any()
    turned = run(Transform(rotation=90.0), {"image": picture})
    assert np.abs(run(out, {"image": picture}, output="out2") - turned).max() < 1e-5 * picture.max()


def test_the_frame_counts_where_edges_differ(run, hdr, renderer):
    picture = hdr(20, 16)
    nodes = [Transform(position=(8.0, 0.0), edge="black"), Transform(position=(-8.0, 0.0), edge="wrap")]
    expected = np.roll(np.where(np.arange(20)[:, None] < 8, 0, np.roll(picture, 8, 1)), -8, 1)
    found = run(chain(nodes), {"image": picture}, output="out1")
    assert np.abs(found - expected).max() < 1e-5 * picture.max()
    assert len(planned(renderer, nodes, picture, ["out1"]).passes) == 2


def test_who_looks_in_between_sees_what_is_there(run, hdr, renderer):
    """Each result is filtered once, whether others are wanted too or not."""
    picture, nodes = hdr(21, 18), moves(3, 3)
    plan = planned(renderer, nodes, picture, ["out0", "out1", "out2"])
    assert [one.nodes for one in plan.passes] == [("n0",), ("n0", "n1"), ("n0", "n1", "n2")]
    for count in (1, 2, 3):
        expected = sampled(picture, product(nodes[:count], (21, 18)), "grid-constant")
        found = run(chain(nodes), {"image": picture}, output=f"out{count - 1}")
        assert np.abs(found - expected).max() < 1e-5 * picture.max()


def test_other_nodes_and_muted_ones(renderer, hdr):
    picture, (one, two) = hdr(9, 8), moves(5, 2)
    assert len(planned(renderer, [one, Exposure(stops=1.0), two], picture, ["out2"]).passes) == 3
    targets = {"out": Port("outputs", "out2")}
    muted = renderer.compile(
        chain([one, Exposure(stops=1.0), two]).mute("n1"), RenderRequest({"image": picture}, targets)
    )
    assert [item.nodes for item in muted.passes] == [("n0", "n2")]


def test_a_chain_shows_the_same_at_half_size(run):
    y, x = np.mgrid[:64, :64] + 0.5
    picture = np.repeat(np.exp(-((x - 20) ** 2 / 60 + (y - 26) ** 2 / 150))[..., None], 4, -1)
    nodes = [Transform(position=(40.0, 8.0), rotation=90.0), Transform(position=(44.0, -4.0), scale=(-1.0, 1.0))]
    full, half = (run(chain(nodes), {"image": picture}, scale=scale, output="out1")[..., 3] for scale in (1.0, 0.5))
    assert full.max() > 0.5
    assert np.abs(half - full.reshape(32, 2, 32, 2).mean((1, 3))).max() < 0.02
