"""Packages of rectangles, discs and tubes of light: a driver of OpenGL and WebGPU give our pixels."""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from exr_files import read
from halation.presets import paths

SAMPLE = Path(paths()[0]).parent / "samples/neon.exr"
SIZE = ("--size", "96x54")
LIGHTS = {
    "window": {
        "kind": "rectangle",
        "place": [-2.5, -3.0, 2.5],
        "direction": [0.6, 1.0, -0.5],
        "width": 2.0,
        "roll": 20.0,
    },
    "plate": {"kind": "disc", "place": [1.5, -2.0, 3.5], "direction": [-0.3, 0.5, -1.0], "color": [1.0, 0.6, 0.3]},
    "neon": {"kind": "tube", "place": [0.5, -2.5, 0.3], "direction": [1.0, 0.2, 0.1], "length": 2.5, "reach": 6.0},
    "matte": {"kind": "rectangle", "place": [2.0, -4.0, 1.0], "direction": [-0.5, 1.0, 0.0], "matte": 1},
}
READERS = {"glsl": "read_package.py", "wgsl": "read_wgsl.py"}


def has_vulkan() -> bool:
    """Whether WebGPU finds a device."""
    try:
        import wgpu

        return bool(wgpu.gpu.request_adapter_sync())
    except (ImportError, RuntimeError):
        return False


def write_graph(file: Path) -> Path:
    """The sample frame without its own light, lit by one light of each kind; the fourth shines on the left half."""
    layers = {"albedo": "Diffuse Color", "normal": "Normal", "position": "Position", "depth": "Depth"}
    kinds = {"albedo": "Image", "depth": "Field"}
    graph = {
        "halation": 1,
        "inputs": {
            name: {"type": kinds.get(name, "Vector3"), "file": str(SAMPLE), "layer": layer}
            for name, layer in layers.items()
        },
        "nodes": {
            "it": {
                "type": "deferred_lighting",
                "values": {"lights": LIGHTS, "metal": 0.3, "roughness": 0.3},
                "version": 2,
            },
            "eye": {"type": "solve_camera", "values": {"path": str(SAMPLE)}},
            "half": {"type": "ramp", "values": {"start": [0.4, 0.5], "end": [0.6, 0.5]}},
            "matte": {"type": "luminance"},
        },
        "links": {f"it.{name}": f"inputs.{name}" for name in layers}
        | {"it.camera": "eye.camera", "matte.image": "half.out", "it.matte_1": "matte.out", "outputs.image": "it.out"},
        "outputs": {"image": {"type": "Image"}},
    }
    file.write_text(json.dumps(graph))
    return file


@pytest.mark.parametrize("kind", READERS)
def test_a_package_has_our_area_lights(cli, kind: str, tmp_path: Path) -> None:
    if kind == "wgsl" and importlib.util.find_spec("slangpy") is None:
        pytest.skip("slangpy is not installed")
    if kind == "wgsl" and not has_vulkan():
        pytest.skip("there is no driver of Vulkan")
    graph, folder = write_graph(tmp_path / "it.json"), tmp_path / "look"
    result = cli("export", graph, "--to", kind, "-o", folder, *SIZE)
    assert result.code == 0, result.err
    assert cli("render", graph, "-o", tmp_path / "ours.exr", "--precision", "float", *SIZE).code == 0
    reader = [sys.executable, folder / READERS[kind], folder, tmp_path / "theirs.npy"]
    subprocess.run(reader, check=True, timeout=100)
    ours = read(tmp_path / "ours.exr")
    theirs = np.load(tmp_path / "theirs.npy")[..., : ours.shape[2]]
    assert (ours[..., :3].max(axis=2) > 0.05).mean() > 0.4
    assert np.abs(theirs - ours).max() <= 2e-3 * np.abs(ours).max()
