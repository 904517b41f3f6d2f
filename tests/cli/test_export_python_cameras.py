"""halation export --to python: cameras, and what nodes make of them, on a rendered scene."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from exr_files import write_exr
from geometry import ball
from halation.errors import GraphError
from halation.export.python.functions import cameras
from halation.graph import Port
from halation.nodes import CameraModel, look_at
from halation.presets import sample
from halation.renderer import Renderer, RenderRequest, open_device
from halation.resources.sandbox import UNRESTRICTED
from numpy_scripts import export_output, load_graph, render_outputs, run_scripts

WIDTH, HEIGHT = 90, 60
EYE, TARGET, FOCAL = (3.0, -7.0, 2.5), (0.4, 0.3, 1.1), 1.3
CAMERA = look_at(EYE, TARGET, (FOCAL, FOCAL * WIDTH / HEIGHT))


TYPES = {"Depth": "Field", "Image": "Image"}


@pytest.fixture(scope="module")
def renderer():
    return Renderer(open_device(sandbox=UNRESTRICTED), sandbox=UNRESTRICTED)


def make_graph(file: Path, id: str, layers: dict[str, str], values: dict[str, Any], **links: str) -> dict[str, Any]:
    """A graph of one node that reads layers of a file, with a camera like `CAMERA` and one beside it."""
    place = {"eye": list(EYE), "target": list(TARGET), "focal": FOCAL * 36.0}
    beside = {"eye": [2.9, -7.1, 2.5], "target": [0.2, 0.3, 1.0], "focal": 46.0}
    return {
        "halation": 1,
        "settings": {"size": [WIDTH, HEIGHT]},
        "inputs": {
            name: {"type": TYPES.get(layer, "Vector3"), "file": file.name, "layer": layer}
            for name, layer in layers.items()
        },
        "nodes": {
            "it": {"type": id, "values": values},
            "here": {"type": "camera", "values": place},
            "there": {"type": "camera", "values": beside},
            "solved": {"type": "solve_camera", "values": {"path": str(sample())}},
        },
        "links": {**{f"it.{name}": f"inputs.{name}" for name in layers}, **{f"it.{a}": b for a, b in links.items()}},
    }


def write_scene(folder: Path) -> Path:
    """A ball before another one, with holes in what a renderer writes."""
    front, back = ball(CAMERA, TARGET, 0.9, WIDTH, HEIGHT), ball(CAMERA, (1.6, 6.0, 1.4), 2.5, WIDTH, HEIGHT)
    is_front = (front["depth"] < back["depth"])[..., None]
    layers = {
        "Depth": np.minimum(front["depth"], back["depth"])[..., None],
        "Position": np.where(is_front, front["position"], back["position"]),
        "Normal": np.where(is_front, front["normal"], back["normal"]),
    }
    layers["Normal"][::7, ::5] *= 0.9
    layers["Image"] = np.dstack([np.abs(layers["Normal"]), np.where(layers["Depth"] < 1e9, 1.0, 0.5)])
    layers["Depth"][3::11, 4::9] = 1e10
    pixels = {name: layer.astype(np.float32) for name, layer in layers.items()}
    return write_exr(folder / "scene.exr", pixels, dict.fromkeys(pixels, "float"))


DEPTH, PLACE, TURN, LOOK = {"depth": "Depth"}, {"position": "Position"}, {"normal": "Normal"}, {"image": "Image"}
LOW = {"mode": "height", "density": 0.4, "thickness": 0.7, "base": 0.3, "start": 2.0, "up": "z"}
SUN = {"sun": 0.8, "sun_direction": [-0.3, 0.9, 0.2], "sun_focus": 6.0}
CASES = {
    "positions": ("position_from_depth", DEPTH, {}, {"camera": "here.camera"}),
    "positions by a camera of a file": ("position_from_depth", DEPTH, {}, {"camera": "solved.camera"}),
    "depths": ("depth_from_position", PLACE, {}, {"camera": "here.camera"}),
    "normals": ("normal_from_depth", DEPTH, {"reach": 2.0}, {"camera": "here.camera"}),
    "bends of places": ("curvature", PLACE | TURN, {"radius": 1.0}, {}),
    "bends of depths": ("curvature", DEPTH | TURN, {"radius": 1.0, "reach": 2.0}, {"camera": "here.camera"}),
    "bends of normals": ("curvature", TURN, {"radius": 1.0, "reach": 3.0}, {"camera": "here.camera"}),
    "bends of normals alone": ("curvature", TURN, {}, {}),
    "facing": ("facing", TURN, {}, {"camera": "here.camera"}),
    "rims": ("rim_light", LOOK | TURN, {"focus": 0.7, "angle": 130.0}, {"camera": "here.camera"}),
    "fog along rays": ("fog", LOOK | DEPTH, SUN, {"camera": "here.camera"}),
    "fog on the ground": ("fog", LOOK | DEPTH, LOW | SUN, {"camera": "here.camera"}),
    "fog down to places": ("fog", LOOK | DEPTH | PLACE, LOW | {"eye": 2.5}, {}),
    "fog on no ground": ("fog", LOOK | DEPTH, LOW, {}),
    "a still camera": ("camera_velocity", DEPTH, {}, {"camera": "here.camera"}),
    "from another camera": ("camera_velocity", DEPTH, {}, {"camera": "here.camera", "before": "there.camera"}),
    "to another camera": ("camera_velocity", DEPTH, {}, {"camera": "there.camera", "after": "here.camera"}),
}


@pytest.mark.parametrize("case", CASES)
def test_what_cameras_see_is_what_the_renderer_makes(renderer, tmp_path: Path, case: str) -> None:
    """Every output, within 1e-4 of its largest number."""
    id, layers, values, links = CASES[case]
    graph = load_graph(tmp_path / "graph.json", make_graph(write_scene(tmp_path), id, layers, values, **links))
    outputs = render_outputs(graph, renderer, list(graph.nodes["it"].outputs))
    pairs = [(tmp_path / f"{name}.py", tmp_path / f"{name}.npy") for name in outputs]
    for name, (script, _) in zip(outputs, pairs, strict=True):
        export_output(graph, name, script)
    run_scripts(pairs, is_fresh=False)
    for (name, ours), (_, made) in zip(outputs.items(), pairs, strict=True):
        largest = np.abs(ours[np.abs(ours) < 1e9]).max(initial=1.0)
        np.testing.assert_allclose(np.broadcast_to(np.load(made), ours.shape), ours, atol=1e-4 * largest, err_msg=name)


@pytest.mark.parametrize(
    ("eye", "target", "up"),
    [(EYE, TARGET, "z"), ((1.0, 2.0, 3.0), (-2.0, 0.5, 1.0), "y"), ((1.0, 2.0, 3.0), (1.0, 2.0, -9.0), "z")],
)
def test_a_camera_is_that_of_the_node(eye, target, up) -> None:
    """The matrix and its inverse, straight down too."""
    rows = cameras.camera(eye, target, 35.0, 24.0, up, 64, 27)
    axis = (0.0, 0.0, 1.0) if up == "z" else (0.0, 1.0, 0.0)
    model = look_at(eye, target, (35.0 / 24.0, 35.0 / 24.0 * 64.0 / 27.0), axis)
    np.testing.assert_allclose(rows.ravel(), model.rows, atol=1e-12)
    np.testing.assert_allclose(cameras.camera_back(rows).ravel(), CameraModel(tuple(rows.ravel())).inverse, atol=1e-12)
    axes = [model.right, model.down, model.forward]
    np.testing.assert_allclose(cameras.camera_axes(rows), axes, atol=1e-12)


def test_a_camera_that_moves_is_read_at_other_frames(renderer, tmp_path: Path) -> None:
    """Its velocity is that since the frame before, and to the frame after."""
    graph = make_graph(write_scene(tmp_path), "camera_velocity", DEPTH, {}, camera="here.camera")
    graph["settings"]["frames"] = [1, 4]
    keys = [{"frame": 1, "value": 40.0}, {"frame": 3, "value": 55.0}, {"frame": 4, "value": 50.0}]
    graph["animation"] = {"here.focal": {"keys": keys}}
    loaded = load_graph(tmp_path / "graph.json", graph)
    export_output(loaded, "velocity", tmp_path / "it.py")
    run_scripts([(tmp_path / "it.py", tmp_path / "it.#.npy")], is_fresh=False, options=("--frames", "1", "4"))
    pictures: list[np.ndarray] = []
    for frame in range(1, 5):
        request = RenderRequest({}, {"it": Port("it", "velocity")}, frame=frame, precision="float")
        pictures.append(renderer.render(loaded, request)["it"])
        made, largest = np.load(tmp_path / f"it.{frame}.npy"), np.abs(pictures[-1]).max()
        np.testing.assert_allclose(made, pictures[-1], atol=1e-4 * largest)
    assert np.abs(pictures[1] - pictures[2]).max() > 1.0


def test_a_camera_of_a_file_that_moves_is_refused(tmp_path: Path) -> None:
    """A script has it as numbers, of one frame."""
    for frame in (1, 2):
        camera = look_at((3.0, -7.0, float(frame)), TARGET, (FOCAL, FOCAL * WIDTH / HEIGHT))
        seen = ball(camera, TARGET, 2.9, WIDTH, HEIGHT)
        layers = {name: np.atleast_3d(seen[name.lower()]).astype(np.float32) for name in ("Depth", "Position")}
        write_exr(tmp_path / f"shot.{frame}.exr", layers, dict.fromkeys(layers, "float"))
    graph = make_graph(write_scene(tmp_path), "camera_velocity", DEPTH, {}, camera="solved.camera")
    graph["nodes"]["solved"]["values"] = {"path": str(tmp_path / "shot.#.exr"), "missing": "hold"}
    with pytest.raises(GraphError, match="node 'solved': its camera is read at several frames"):
        export_output(load_graph(tmp_path / "graph.json", graph), "velocity", tmp_path / "no.py")


def test_depth_is_how_far_places_lie_in_front_of_the_camera() -> None:
    """A dot product with the axis; none behind it, none in its plane, and none where renderers write the background."""
    eye, target = (1.0, 2.0, 3.0), (4.0, 6.0, 3.0)
    axis = np.array([0.6, 0.8, 0.0])
    matrix = cameras.camera(eye, target, 35.0, 36.0, "z", 40, 30)
    along = np.array([-1e3, -1.0, 0.0, 1e-3, 1.0, 7.5, 9e8, 1.1e9, 1e10])
    aside = np.array([0.8, -0.6, 0.5])
    places = np.array(eye) + along[:, None] * axis + 0.25 * aside
    found = cameras.depth_from_position(places[None], matrix)[0, :, 0]
    expected = np.where((along > 0.0) & (along < 1e9), along, 1e10)
    sure = along != 0.0
    np.testing.assert_allclose(found[sure], expected[sure], rtol=1e-9, atol=1e-9)
    straight = np.array([[0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]])
    in_plane = np.array([[[0.0, 3.0, -2.0], [0.0, 0.0, 0.0], [np.nan, 1.0, 1.0], [np.inf, 0.0, 0.0]]])
    assert (cameras.depth_from_position(in_plane, straight) == 1e10).all()
