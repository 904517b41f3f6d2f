"""halation export --to python: lamps that light a render again."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from exr_files import write_exr
from geometry import ball
from halation.errors import GraphError
from halation.nodes import look_at
from halation.renderer import Renderer, open_device
from halation.resources.sandbox import UNRESTRICTED
from numpy_scripts import export_output, load_graph, render_outputs, run_scripts

WIDTH, HEIGHT, SAMPLES = 72, 48, 4
EYE, TARGET, FOCAL = (3.0, -7.0, 2.5), (0.4, 0.3, 1.1), 1.3
KINDS = {"albedo": "Image", "depth": "Field", "material": "Vector2", "emission": "Image", "occlusion": "Field"}

LIGHTS: dict[str, dict[str, Any]] = {
    "point": {"kind": "point", "place": [1.5, -2.0, 3.0], "color": [1.0, 0.6, 0.3], "intensity": 20.0},
    "reach": {"kind": "point", "place": [1.0, -0.5, 2.5], "color": [0.3, 0.6, 1.0], "intensity": 20.0, "reach": 2.6},
    "spot": {"kind": "spot", "place": [2.5, -3.5, 2.0], "direction": [-0.5, 1.0, -0.3], "inner": 8.0, "outer": 16.0,
             "intensity": 30.0, "temperature": 3200.0},
    "sun": {"kind": "sun", "direction": [-1.0, 2.0, -1.5], "color": [1.0, 0.9, 0.7], "exposure": 1.5},
    "sphere": {"kind": "sphere", "place": [2.0, -1.5, 3.0], "color": [1.0, 0.5, 0.7], "intensity": 15.0, "size": 0.9},
    "dark": {"kind": "point", "place": [-0.5, -1.5, 2.2], "intensity": -6.0, "reach": 5.0},
    "off": {"kind": "rectangle", "on": False},
}  # fmt: skip
SWARM = {"swarm": 9, "swarm_seed": 3, "swarm_reach": 2.5, "swarm_place": [0.0, -1.0, 1.5]}


@pytest.fixture(scope="module")
def renderer():
    return Renderer(open_device(sandbox=UNRESTRICTED), sandbox=UNRESTRICTED)


def write_scene(folder: Path) -> Path:
    """A ball before a larger one, whose normals and colors are filtered, and its depth is that of one sample."""
    camera = look_at(EYE, TARGET, (FOCAL, FOCAL * WIDTH / HEIGHT))
    front, back = (
        ball(camera, place, radius, SAMPLES * WIDTH, SAMPLES * HEIGHT)
        for place, radius in ((TARGET, 1.1), ((1.6, 6.0, 1.4), 2.5))
    )
    is_front, there = front["depth"] < back["depth"], np.minimum(front["depth"], back["depth"]) < 1e9
    fine = {name: np.where(is_front if front[name].ndim == 2 else is_front[..., None], front[name], back[name])
            for name in front}  # fmt: skip
    color = np.where(is_front[..., None], (0.8, 0.3, 0.1, 1.0), (0.1, 0.4, 0.7, 1.0)) * there[..., None]
    middle = SAMPLES // 2
    position, depth = (fine[name][middle::SAMPLES, middle::SAMPLES] for name in ("position", "depth"))
    filtered = [each.reshape(HEIGHT, SAMPLES, WIDTH, SAMPLES, -1).mean(axis=(1, 3)) for each in (color, fine["normal"])]
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    pixels = {
        "albedo": filtered[0],
        "normal": filtered[1],
        "position": position,
        "depth": depth[..., None],
        "material": np.where(is_front[middle::SAMPLES, middle::SAMPLES, None], (0.2, 0.3), (0.9, 0.6)),
        "emission": np.stack([0.1 + 0.1 * np.sin(0.3 * x), 0.02 * y / HEIGHT, 0.0 * x, 1.0 + 0.0 * x], axis=-1),
        "occlusion": 0.5 + 0.5 * np.cos(0.1 * (x + y))[..., None],
    }
    layers = {name: layer.astype(np.float32) for name, layer in pixels.items()}
    return write_exr(folder / "scene.exr", layers, dict.fromkeys(layers, "float"))


def make_graph(file: Path, inputs: tuple[str, ...], values: dict[str, Any], has_camera: bool = True) -> dict[str, Any]:
    """A graph of the node, which reads layers of a file."""
    place = {"eye": list(EYE), "target": list(TARGET), "focal": FOCAL * 36.0}
    links = {f"it.{name}": f"inputs.{name}" for name in inputs}
    return {
        "halation": 1,
        "settings": {"size": [WIDTH, HEIGHT]},
        "inputs": {name: {"type": KINDS.get(name, "Vector3"), "file": file.name, "layer": name} for name in inputs},
        "nodes": {
            "it": {"type": "deferred_lighting", "values": {"lights": LIGHTS, **values}, "version": 2},
            "eye": {"type": "camera", "values": place},
        },
        "links": links | ({"it.camera": "eye.camera"} if has_camera else {}),
    }


PLACED = ("albedo", "normal", "position", "material")
CASES: dict[str, tuple[Any, ...]] = {
    "microfacets": (PLACED, {}),
    "phong": (PLACED, {"model": "phong", "intensity": 0.7}),
    "all inputs": ((*PLACED, "depth", "emission", "occlusion"), {"ambient_intensity": 0.8}),
    "depth alone": (("albedo", "depth"), {"roughness": 0.3, "metal": 0.4, "specular": 0.8}),
    "clay": (("depth",), SWARM),
    "solo": (PLACED, {"lights": {**LIGHTS, "sun": {**LIGHTS["sun"], "solo": True}}}),
    "no camera": (("albedo", "normal", "position"), {}, False),
}


@pytest.mark.parametrize("case", CASES)
def test_a_render_is_lit_as_by_the_node(renderer, tmp_path: Path, case: str) -> None:
    """All outputs, within 1e-3, at the edges of both balls too."""
    graph = load_graph(tmp_path / "it.json", make_graph(write_scene(tmp_path), *CASES[case]))
    outputs = render_outputs(graph, renderer, ["out", "diffuse", "specular_light"])
    pairs = [(tmp_path / f"{name}.py", tmp_path / f"{name}.npy") for name in outputs]
    for name, (script, _) in zip(outputs, pairs, strict=True):
        export_output(graph, name, script)
    run_scripts(pairs, is_fresh=False)
    for (name, ours), (_, made) in zip(outputs.items(), pairs, strict=True):
        errors = np.abs(np.load(made) - ours) / np.maximum(1.0, np.abs(ours))
        assert ours[..., :3].max() > 0.05
        assert errors.max() <= 1e-3, name


@pytest.mark.parametrize(
    ("light", "said"),
    [
        ({"kind": "rectangle"}, "its light 'lamp' is a rectangle, and numpy text knows point, spot, sun, sphere alone"),
        ({"kind": "spot", "shadow": True}, "its light 'lamp' has a shadow, a matte or a cookie"),
        ({"kind": "sun", "matte": 2}, "its light 'lamp' has a shadow, a matte or a cookie"),
    ],
)
def test_a_light_without_a_formula_is_named(tmp_path: Path, light: dict[str, Any], said: str) -> None:
    graph = make_graph(write_scene(tmp_path), PLACED, {"lights": {"lamp": light}})
    with pytest.raises(GraphError, match=f"node 'it': {said}"):
        export_output(load_graph(tmp_path / "it.json", graph), "out", tmp_path / "no.py")
