"""Meshes without normals get those that trimesh computes with scipy, to the bit, and without scipy."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from halation.media.meshes.load import load_mesh
from halation.nodes import SceneFile
from halation.resources.sandbox import UNRESTRICTED

SHAPES = {
    "ball": trimesh.creation.icosphere(3),
    "ring": trimesh.creation.torus(2.0, 0.5),
    "rubbish": trimesh.Trimesh(
        np.random.default_rng(1).random((400, 3)), np.random.default_rng(2).integers(0, 400, (900, 3)), process=False
    ),
}


@pytest.mark.parametrize("ending", ["obj", "ply", "stl", "glb", "gltf"])
@pytest.mark.parametrize("name", SHAPES)
def test_normals_are_those_of_trimesh(tmp_path, name, ending):
    path = tmp_path / f"a.{ending}"
    options = {"include_normals": False} if ending in ("obj", "glb") else {}
    exported = trimesh.Scene(SHAPES[name]).export(file_type=ending, **options)
    for file, content in (exported if isinstance(exported, dict) else {path.name: exported}).items():
        target = path if file.endswith(ending) else tmp_path / file
        target.write_bytes(content if isinstance(content, bytes) else content.encode())
    mesh = load_mesh(SceneFile(str(path), "z"), sandbox=UNRESTRICTED)
    (geometry,) = trimesh.load_scene(path).geometry.values()
    geometry = geometry.copy()
    geometry.apply_transform(np.eye(4))
    np.testing.assert_array_equal(mesh.vertices[:, 3:6], np.asarray(geometry.vertex_normals, np.float32))
