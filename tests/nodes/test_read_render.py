"""Read Render on files whose every number is known: whatever a renderer means, the same data comes out."""

from __future__ import annotations

import numpy as np
import OpenImageIO as oiio
import pytest
from halation.errors import GraphError, InputError
from halation.graph import Graph, Output, Port
from halation.nodes import Kind, look_at
from halation.nodes.geometry.position_from_depth import PositionFromDepth
from halation.nodes.input.read_render import ReadRender
from halation.nodes.input.solve_camera import SolveCamera
from halation.renderer import RenderRequest

SIZE = (64, 36)
CAMERA = look_at((1.0, -6.0, 2.5), (0.2, 0.3, 0.4), (1.1, 1.1 * 64 / 36))


def scene() -> dict[str, np.ndarray]:
    """A bumpy floor seen by CAMERA: places, planar and radial depth, normals in the world and in the camera."""
    inverse, eye = np.reshape(CAMERA.inverse, (3, 4)), np.array(CAMERA.eye)
    y, x = np.mgrid[0 : SIZE[1], 0 : SIZE[0]]
    uv = np.stack([(x + 0.5) / SIZE[0], (y + 0.5) / SIZE[1], np.ones(x.shape)], -1)
    rays = uv @ inverse[:, :3].T
    # A plane for the upper half, a sphere far larger than the picture below: every ray meets one of them.
    normal = np.array([0.1, -0.8, 0.6]) / np.linalg.norm([0.1, -0.8, 0.6])
    depth = ((np.array([0.0, 3.0, 0.0]) - eye) @ normal) / (rays @ normal)
    center, radius = np.array([0.5, 2.0, -3.0]), 4.0
    b, c = ((eye - center) * rays).sum(-1), ((eye - center) ** 2).sum() - radius**2
    a = (rays**2).sum(-1)
    root = b * b - a * c
    ball = np.where(root > 0, (-b - np.sqrt(np.maximum(root, 0))) / a, np.inf)
    on_ball = (ball > 0) & (ball < depth)
    depth = np.where(on_ball, ball, depth)
    place = eye + rays * depth[..., None]
    normals = np.where(on_ball[..., None], (place - center) / radius, normal)
    frame = np.array([CAMERA.right, -np.array(CAMERA.down), -np.array(CAMERA.forward)])
    return {
        "position": place,
        "depth": depth[..., None],
        "radial": np.linalg.norm(place - eye, axis=-1, keepdims=True),
        "normal": normals,
        "camera_normal": normals @ frame.T,
    }


def write(path, layers: dict[str, np.ndarray], **attributes: str) -> str:
    """A multilayer EXR; keys are `layer.components`, or single channels."""
    names: list[str] = []
    for key, array in layers.items():
        layer, _, parts = key.rpartition(".")
        names += [f"{layer}.{part}" if layer else part for part in parts[: array.shape[2]]]
    data = np.concatenate(list(layers.values()), -1).astype(np.float32)
    spec = oiio.ImageSpec(*SIZE, len(names), "float")
    spec.channelnames = names
    for name, value in attributes.items():
        spec.attribute(name, value)
    out = oiio.ImageOutput.create(str(path))
    assert out.open(str(path), spec) and out.write_image(np.ascontiguousarray(data)) and out.close()
    return str(path)


def shown(renderer, node, *names: str) -> list[np.ndarray]:
    graph = Graph().add("node", node)
    for name in names:
        socket = type(node).outputs[name].socket
        graph = graph.add_output(name, Output(socket.kind, socket.channels))
        graph = graph.connect(Port("node", name), Port("outputs", name))
    found = renderer.render(graph, RenderRequest(precision="float"))
    return [found[name].astype(np.float64) for name in names]


COLOR = np.full((SIZE[1], SIZE[0], 3), 0.25)


@pytest.mark.parametrize("kind", ["planar", "radial", "inverse", "negative"])
@pytest.mark.parametrize("told", [False, True], ids=["found", "chosen"])
def test_depth_of_every_kind_comes_out_planar(renderer, tmp_path, kind, told):
    data = scene()
    stored = {
        "planar": data["depth"],
        "radial": data["radial"],
        "inverse": 1 / data["depth"],
        "negative": -data["depth"],
    }[kind]
    path = write(tmp_path / "a.exr", {"RGB": COLOR, "depth.Z": stored, "P.XYZ": data["position"]})
    (depth,) = shown(renderer, ReadRender(path=path, depth_is=kind if told else "found"), "depth")
    assert (np.abs(depth - data["depth"]) / data["depth"]).max() < 1e-5


@pytest.mark.parametrize("is_near_white", [False, True])
def test_depth_from_0_to_1_comes_out_planar(renderer, tmp_path, is_near_white):
    """What 0 and 1 mean is found by the positions."""
    data = scene()
    near, far = data["depth"].min() - 0.5, data["depth"].max() + 2.0
    stored = (data["depth"] - near) / (far - near)
    stored = 1.0 - stored if is_near_white else stored
    path = write(tmp_path / "a.exr", {"RGB": COLOR, "depth.Z": stored, "P.XYZ": data["position"]})
    (depth,) = shown(renderer, ReadRender(path=path), "depth")
    assert (np.abs(depth - data["depth"]) / data["depth"]).max() < 1e-5


@pytest.mark.parametrize("space", ["world", "camera"])
@pytest.mark.parametrize("told", [False, True], ids=["found", "chosen"])
@pytest.mark.parametrize("packed", [False, True], ids=["signed", "from 0 to 1"])
def test_normals_come_out_in_the_world(renderer, tmp_path, space, told, packed):
    data = scene()
    stored = data["normal"] if space == "world" else data["camera_normal"]
    stored = 0.5 + 0.5 * stored if packed else stored
    path = write(tmp_path / "a.exr", {"RGB": COLOR, "N.XYZ": stored, "P.XYZ": data["position"]})
    (normal,) = shown(renderer, ReadRender(path=path, normal_is=space if told else "found"), "normal")
    assert np.abs(normal - data["normal"]).max() < 2e-5


def test_blenders_vectors_are_turned_to_ours(renderer, tmp_path):
    rng = np.random.default_rng(1)
    since, until = rng.normal(0, 3, (*SIZE[::-1], 2)), rng.normal(0, 3, (*SIZE[::-1], 2))
    # Blender: where it was minus where it is, where it is minus where it will be, y up.
    stored = np.concatenate([-since * [1, -1], -until * [1, -1]], -1)
    path = write(
        tmp_path / "a.exr", {"ViewLayer.Combined.RGB": COLOR, "ViewLayer.Vector.XYZW": stored}, Software="Blender 4.5.1"
    )
    (velocity,) = shown(renderer, ReadRender(path=path), "velocity")
    assert np.abs(velocity - np.concatenate([since, until], -1)).max() < 1e-6


@pytest.mark.parametrize(
    ("choice", "sign", "half"),
    [("from previous", 1, 0), ("to previous", -1, 0), ("to next", 1, 1), ("from next", -1, 1)],
)
def test_motion_that_nobody_explains_is_told(renderer, tmp_path, choice, sign, half):
    moved = np.random.default_rng(2).normal(0, 3, (*SIZE[::-1], 2))
    path = write(tmp_path / "a.exr", {"RGB": COLOR, "velocity.XY": sign * moved})
    (velocity,) = shown(renderer, ReadRender(path=path, velocity_is=choice), "velocity")
    assert np.abs(velocity[..., 2 * half : 2 * half + 2] - moved).max() < 1e-6


def test_a_layer_may_be_named(renderer, tmp_path):
    data = scene()
    path = write(tmp_path / "a.exr", {"RGB": COLOR, "depth.Z": data["depth"], "mine.Z": data["depth"] * 2})
    (depth,) = shown(renderer, ReadRender(path=path, depth_layer="mine"), "depth")
    assert np.abs(depth / data["depth"] - 2).max() < 1e-6


@pytest.mark.parametrize("role", [name.removesuffix("_layer") for name in ReadRender.values if name.endswith("_layer")])
def test_every_output_takes_the_layer_that_is_named(renderer, tmp_path, role):
    """Whatever the file calls it, and whatever else it finds; as data, the numbers of the file."""
    mine = np.random.default_rng(4).random((*SIZE[::-1], 4)).astype(np.float32)
    path = write(tmp_path / "a.exr", {"RGB": COLOR, "mine.XYZW": mine})
    options = {f"{role}_layer": "mine"}
    options |= {"velocity": {"velocity_is": "from previous"}, "depth": {"depth_is": "planar"}}.get(role, {})
    (found,) = shown(renderer, ReadRender(path=path, **options), role)
    socket = ReadRender.outputs[role].socket
    count = min(socket.channels, 3) if socket.kind is Kind.IMAGE else socket.channels
    assert np.abs(found[..., :count] - mine[..., :count]).max() < 1e-6


def test_a_layer_that_is_named_is_measured_too(renderer, tmp_path):
    """The depth that somebody chose is radial, the one that was found is not."""
    data = scene()
    layers = {"RGB": COLOR, "depth.Z": data["depth"], "other.Z": data["radial"], "P.XYZ": data["position"]}
    path = write(tmp_path / "a.exr", layers)
    (depth,) = shown(renderer, ReadRender(path=path, depth_layer="other"), "depth")
    assert (np.abs(depth - data["depth"]) / data["depth"]).max() < 1e-5


def test_the_camera_goes_on(renderer, tmp_path):
    """Positions out of depth and the camera that was solved are those of the file."""
    data = scene()
    path = write(tmp_path / "a.exr", {"RGB": COLOR, "Z": data["depth"], "P.XYZ": data["position"]})
    for node in (ReadRender(path=path), SolveCamera(path=path)):
        graph = Graph().add("render", ReadRender(path=path)).add("camera", node).add("position", PositionFromDepth())
        graph = graph.connect(Port("render", "depth"), Port("position", "depth"))
        graph = graph.connect(Port("camera", "camera"), Port("position", "camera"))
        socket = PositionFromDepth.outputs["position"].socket
        graph = graph.add_output("p", Output(socket.kind, socket.channels))
        graph = graph.connect(Port("position", "position"), Port("outputs", "p"))
        position = renderer.render(graph, RenderRequest(precision="float"))["p"]
        assert np.abs(position - data["position"]).max() < 1e-4


def test_what_a_file_does_not_hold_is_said(renderer, tmp_path):
    path = write(tmp_path / "a.exr", {"RGB": COLOR})
    with pytest.raises(GraphError, match="node 'node': its file has no layer for its output 'depth'"):
        shown(renderer, ReadRender(path=path), "depth")
    with pytest.raises(InputError, match=r"gone\.exr"):
        shown(renderer, ReadRender(path=str(tmp_path / "gone.exr")), "color")
    assert np.abs(shown(renderer, ReadRender(path=path), "color")[0][..., :3] - 0.25).max() < 1e-6
