"""Scene against a numpy ray cast of the same triangles, and against what trimesh wrote to files."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from halation.errors import InputError
from halation.graph import Graph, Output, Port
from halation.media.meshes.load import load_mesh
from halation.nodes import BuiltInScene, Kind
from halation.nodes.input.scene import Scene
from halation.renderer import RenderRequest
from halation.resources.sandbox import UNRESTRICTED
from scipy.stats import qmc

SIZE = (96, 54)
CHANNELS = (
    "albedo",
    "normal",
    "position",
    "depth",
    "emission",
    "material",
    "velocity",
    "uv",
    "object_id",
    "material_id",
)


def rendered(renderer, node, frame=1, size=SIZE, scale=1.0):
    graph = Graph().add("scene", node)
    for name in CHANNELS:
        socket = Scene.outputs[name].socket
        graph = graph.add_output(name, Output(socket.kind, socket.channels))
        graph = graph.connect(Port("scene", name), Port("outputs", name))
    found = renderer.render(graph, RenderRequest({}, {}, size, scale, frame=frame, precision="float"))
    return {name: array.astype(np.float64) for name, array in found.items()}


def camera_of(node: Scene, frame: int = 1, size=SIZE):
    """The same camera, as the node says, in working units."""
    return node.to_working_units(1.0, size[1])._camera(frame, size[0] / size[1])


def cast(mesh, camera, pixels, size=SIZE):
    """The nearest triangle behind every pixel's middle: its number, barycentric coordinates and depth; -1 for none."""
    vertices, faces = mesh.vertices.astype(np.float64), mesh.indices.reshape(-1, 3)
    inverse, eye = np.reshape(camera.inverse, (3, 4)), np.array(camera.eye)
    uv = (pixels + 0.5) / size
    rays = np.column_stack([uv, np.ones(len(uv))]) @ inverse[:, :3].T
    a, b, c = (vertices[faces[:, k], :3] for k in range(3))
    ab, ac, out = b - a, c - a, []
    for ray in rays:
        p = np.cross(ray, ac)
        det = (ab * p).sum(1)
        safe = np.where(np.abs(det) < 1e-14, np.nan, det)
        t = eye - a
        u = (t * p).sum(1) / safe
        q = np.cross(t, ab)
        v = (q @ ray) / safe
        depth = (ac * q).sum(1) / safe
        hit = np.where((u >= 0) & (v >= 0) & (u + v <= 1) & (depth > 0), depth, np.inf)
        best = int(np.argmin(hit))
        out.append((best if np.isfinite(hit[best]) else -1, 1 - u[best] - v[best], u[best], v[best], hit[best]))
    return np.array(out)


@pytest.mark.parametrize("scene", ["stage", "corner", "blocks"])
def test_it_is_the_ray_cast_of_its_triangles(renderer, scene):
    node = Scene(scene=scene)
    found = rendered(renderer, node)
    mesh = load_mesh(BuiltInScene(scene), sandbox=UNRESTRICTED)
    rng = np.random.default_rng(2)
    pixels = np.column_stack([rng.integers(0, SIZE[0], 150), rng.integers(0, SIZE[1], 150)])
    hits = cast(mesh, camera_of(node), pixels)
    nothing = hits[:, 0] < 0
    at = tuple(pixels.T[::-1])
    assert (found["depth"][at][nothing, 0] == np.float32(1e10)).all() and not found["albedo"][at][nothing].any()
    faces = mesh.indices.reshape(-1, 3)[hits[:, 0].astype(int)]
    exact = (hits[:, 1:4, None] * mesh.vertices[faces].astype(np.float64)).sum(1)
    # Where two surfaces meet within a pixel's rounding, either may be seen.
    same = ~nothing & (found["object_id"][at][:, 0] == exact[:, 16].round())
    assert same.sum() >= 0.98 * (~nothing).sum()
    distance = hits[same, 4]
    assert (np.abs(found["depth"][at][same, 0] - distance) / distance).max() < 1e-5
    assert (np.abs(found["position"][at][same] - exact[same, :3]).max(1) / distance).max() < 1e-5
    normal = exact[same, 3:6] / np.linalg.norm(exact[same, 3:6], axis=1, keepdims=True)
    away = ((np.array(camera_of(node).eye) - exact[same, :3]) * normal).sum(1)
    normal *= np.where(away < 0, -1.0, 1.0)[:, None]
    clear = np.abs(away) > 1e-3
    assert np.abs(found["normal"][at][same] - normal)[clear].max() < 1e-4
    for name, columns in (("albedo", slice(8, 11)), ("emission", slice(11, 14)), ("material", slice(14, 16))):
        width = columns.stop - columns.start
        assert np.abs(found[name][at][same][:, :width] - exact[same, columns]).max() < 1e-5, name
    assert np.abs(found["uv"][at][same] - exact[same, 6:8]).max() < 1e-4
    assert (found["material_id"][at][same, 0] == exact[same, 17].round()).all()


def test_velocity_is_where_the_same_point_was_and_will_be(renderer):
    node = Scene(scene="corner", orbit=2.0, drift=(0.1, 0.0, 0.05), turn=3.0)
    found = rendered(renderer, node, frame=4)
    cameras = [camera_of(node, frame) for frame in (4, 3, 5)]
    motions = [np.reshape(node.to_working_units(1.0, SIZE[1])._motion(frame), (3, 4)) for frame in (4, 3, 5)]
    moving = found["object_id"][..., 0] == 5
    assert 50 < moving.sum() < moving.size / 2
    place = found["position"].reshape(-1, 3)
    at = [project(cameras[0], place)]
    for k in (1, 2):
        still = (place - motions[0][:, 3]) @ motions[0][:, :3]
        moved = still @ motions[k][:, :3].T + motions[k][:, 3]
        at.append(project(cameras[k], np.where(moving.reshape(-1, 1), moved, place)))
    expected = np.concatenate([at[0] - at[1], at[2] - at[0]], 1).reshape(*found["velocity"].shape)
    assert np.abs(found["velocity"] - expected).max() < 1e-3
    half = rendered(renderer, node, frame=4, scale=0.5)["velocity"]
    assert abs(np.median(half) - np.median(found["velocity"])) < 0.2, "pixels of the full size"


def project(camera, places: np.ndarray) -> np.ndarray:
    seen = np.column_stack([places, np.ones(len(places))]) @ np.reshape(camera.rows, (3, 4)).T
    return seen[:, :2] / seen[:, 2:] * SIZE


def test_what_stands_still_does_not_move(renderer):
    assert not rendered(renderer, Scene(), frame=7)["velocity"].any()


@pytest.mark.parametrize("ending", ["glb", "obj", "ply", "stl"])
def test_files(renderer, tmp_path, ending):
    box = trimesh.creation.box((1.0, 2.0, 3.0))
    if ending == "glb":
        material = trimesh.visual.material.PBRMaterial(
            baseColorFactor=[0.8, 0.4, 0.2, 1.0],
            metallicFactor=0.25,
            roughnessFactor=0.75,
            emissiveFactor=[0.1, 0.2, 0.3],
        )
        box.visual = trimesh.visual.TextureVisuals(uv=np.zeros((len(box.vertices), 2)), material=material)
    path = tmp_path / f"box.{ending}"
    box.export(path)
    node = Scene(scene="file", file=str(path), target=(0.0, 0.0, 0.0), azimuth=30.0, elevation=20.0)
    found = rendered(renderer, node)
    # y up in the file: what was two high lies along z now.
    place = found["position"][found["object_id"][..., 0] > 0]
    assert len(place) > 200
    assert np.allclose(np.abs(place).max(0), [0.5, 1.5, 1.0], atol=0.05)
    on_face = np.abs(np.abs(place) - [0.5, 1.5, 1.0]).min(1)
    assert on_face.max() < 1e-5
    if ending == "glb":
        seen = found["object_id"][..., 0] > 0
        assert np.allclose(found["material"][seen], [0.25, 0.75], atol=1e-6)
        assert np.allclose(found["emission"][seen][:, :3], [0.1, 0.2, 0.3], atol=1e-6)
        assert np.abs(found["albedo"][seen][:, :3] - [0.8, 0.4, 0.2]).max() < 0.01
    upright = rendered(renderer, Scene(scene="file", file=str(path), up="z", target=(0.0, 0.0, 0.0)))
    place = upright["position"][upright["object_id"][..., 0] > 0]
    assert np.allclose(np.abs(place).max(0)[2], 1.5, atol=0.05)


def test_files_that_are_none(renderer, tmp_path):
    with pytest.raises(InputError, match=r"gone\.glb"):
        rendered(renderer, Scene(scene="file", file=str(tmp_path / "gone.glb")))
    broken = tmp_path / "broken.glb"
    broken.write_bytes(b"glTF nonsense")
    with pytest.raises(InputError, match=r"broken\.glb: is no mesh that can be read: "):
        rendered(renderer, Scene(scene="file", file=str(broken)))
    empty = tmp_path / "empty.obj"
    empty.write_text("# nothing\n")
    with pytest.raises(InputError, match=r"empty\.obj: "):
        rendered(renderer, Scene(scene="file", file=str(empty)))


def test_only_what_is_wanted_is_drawn(renderer):
    graph = Graph().add("scene", Scene()).add_output("depth", Output(Kind.FIELD))
    graph = graph.connect(Port("scene", "depth"), Port("outputs", "depth"))
    plan = renderer.compile(graph, RenderRequest({}, {}, SIZE))
    assert len(plan.passes[0].targets) == 1 and plan.passes[0].mesh is not None


def test_jitter_samples_pixels_elsewhere_by_halton(renderer):
    """Places lie on the rays through where scipy's sequence puts the samples of a frame."""
    halton = qmc.Halton(2, scramble=False).random(17)[1:]
    for frame in (1, 2, 7, 15, 16, 31):
        node = Scene(jitter=1.0, orbit=1.0)
        found = rendered(renderer, node, frame)
        seen = found["object_id"][..., 0] > 1  # places on the vast floor are as coarse as 32 bits are
        at = project(camera_of(node, frame), found["position"][seen])
        pixels = np.argwhere(seen)[:, ::-1]
        assert seen.sum() > 500 and np.abs(at - pixels - halton[frame % 16]).max() < 1e-3, frame


def test_jitter_is_no_motion(renderer):
    """Velocity is that of the surface: none where nothing moves, else that of the place that is seen."""
    assert not rendered(renderer, Scene(jitter=1.0), frame=7)["velocity"].any()
    node = Scene(jitter=1.0, orbit=2.0)
    found = rendered(renderer, node, frame=4)
    seen = found["object_id"][..., 0] > 0
    place = found["position"][seen]
    now, before, after = (project(camera_of(node, frame), place) for frame in (4, 3, 5))
    assert np.abs(found["velocity"][seen] - np.concatenate([now - before, after - now], 1)).max() < 1e-3


def test_colors_cover_what_is_there_and_data_stay_data(renderer):
    """Alpha is 1 on surfaces and 0 beside them; colors may be half floats, and everything else may not."""
    node = Scene(scene="blocks")
    found = rendered(renderer, node)
    there = found["depth"][..., 0] < 1e9
    assert 0.1 < there.mean() < 1.0
    for name in ("albedo", "emission"):
        np.testing.assert_array_equal(found[name][..., 3], there)
        assert not found[name][~there].any()
    graph = Graph().add("scene", node)
    for name in CHANNELS:
        socket = Scene.outputs[name].socket
        graph = graph.add_output(name, Output(socket.kind, socket.channels))
        graph = graph.connect(Port("scene", name), Port("outputs", name))
    plan = renderer.compile(graph, RenderRequest({}, {}, SIZE, precision="half"))
    depths = {name: plan.surfaces[number].depth for name, number in plan.outputs.items()}
    assert {name for name, depth in depths.items() if depth == "f2"} == {"albedo", "emission"}
