"""Loads the triangles of scenes: built-in ones, and those of files."""

from __future__ import annotations

import logging
from functools import lru_cache
from hashlib import blake2b
from io import BytesIO
from pathlib import Path, PurePath
from typing import Any

import numpy as np
from halation.nodes import BuiltInScene, Scene

from ...errors import InputError
from ...resources.input_files import fingerprint, open_file, read_bytes
from ...resources.library_names import is_utf8
from ...resources.mesh import ATTRIBUTES, Mesh
from ...resources.sandbox import Sandbox
from .built_in import BUILT_IN, ROUGH, MeshPart

Array = np.ndarray
_GRAY = 204, 204, 204
"""sRGB codes of a mesh without a color: it reflects 60 % of the light. Chosen by judgement."""
MESH_ENDINGS = frozenset({".glb", ".gltf", ".obj", ".ply", ".stl"})

_COLUMNS = sum(ATTRIBUTES.values())
_MOST_TRIANGLES = 20_000_000
"""The most triangles of a scene. A vertex takes 76 bytes, so they need 1 GB if they share vertices and 5 GB if not.
Chosen by judgement as what a workstation can hold."""
_Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""From y up to z up, as Blender's importers turn scenes."""


def load_mesh(scene: Scene, sandbox: Sandbox) -> Mesh:
    """The triangles of a scene, z up.

    Raises:
        InputError: the file is missing, holds no triangles, or cannot be read.
    """
    return _load(
        scene, "" if isinstance(scene, BuiltInScene) else fingerprint(scene.path, sandbox=sandbox), sandbox=sandbox
    )


@lru_cache(maxsize=8)  # chosen by judgement: more scenes than a graph has; one may take hundreds of MB
def _load(scene: Scene, mark: str, sandbox: Sandbox) -> Mesh:
    if isinstance(scene, BuiltInScene):
        return _join_parts(BUILT_IN[scene.name]())
    parts = _read_parts(scene.path, sandbox=sandbox)
    if scene.up == "y":
        parts = [part.rotate(_Y_UP) for part in parts]
    return _join_parts(parts)


def _join_parts(parts: list[MeshPart]) -> Mesh:
    """All pieces as one mesh; objects and materials are numbered from 1."""
    vertices: list[Array] = []
    indices: list[Array] = []
    materials: dict[tuple[float, ...], int] = {}
    start = 0
    for number, part in enumerate(parts, 1):
        material = materials.setdefault(part.material, len(materials) + 1)
        block = np.empty((len(part.positions), _COLUMNS), np.float32)
        constant = (*part.albedo, *part.emission, part.metal, part.rough, number, material, float(part.is_moving))
        block[:, 0:3], block[:, 3:6], block[:, 6:8], block[:, 8:] = part.positions, part.normals, part.uvs, constant
        vertices.append(block)
        indices.append(part.triangles.astype(np.uint32).ravel() + np.uint32(start))
        start += len(block)
    all_vertices, all_indices = np.concatenate(vertices), np.concatenate(indices)
    digest = blake2b(all_vertices.tobytes(), digest_size=16)
    digest.update(all_indices.tobytes())
    return Mesh(digest.hexdigest(), all_vertices, all_indices)


def _read_parts(path: str, sandbox: Sandbox) -> list[MeshPart]:
    """The meshes of a file, at their places in the scene."""
    import trimesh

    logging.getLogger("trimesh").addHandler(logging.NullHandler())  # without this it prints reports
    if not Path(path).is_file():
        raise InputError(f"{path}: there is no such file: choose a .glb, .gltf, .obj, .ply or .stl")
    resolver, file_type = _make_resolver(path, sandbox), Path(path).suffix.removeprefix(".")
    try:
        with open_file(path, sandbox) as file:
            source = file if is_utf8(path) else BytesIO(file.read())  # trimesh hashes the name of a file as UTF-8
            scene: Any = trimesh.load_scene(source, file_type=file_type, resolver=resolver)
        nodes = [_read_part(scene, name) for name in scene.graph.nodes_geometry]
    except InputError:
        raise
    except Exception as fault:
        reason = (str(fault).strip() or type(fault).__name__).splitlines()[0]
        raise InputError(f"{path}: is no mesh that can be read: {reason}") from fault
    parts = [part for part in nodes if part is not None]
    if not parts:
        raise InputError(f"{path}: holds no triangles")
    if sum(len(piece.triangles) for piece in parts) > _MOST_TRIANGLES:
        raise InputError(f"{path}: holds more than {_MOST_TRIANGLES:,} triangles: thin it out first")
    return parts


def _make_resolver(path: str, sandbox: Sandbox) -> Any:
    """Finds files that a mesh names, such as buffers and materials, if they may be read.

    As in trimesh, they must lie in the folder of the mesh or below; a name without a file is looked up in the folder
    itself. trimesh would follow a link there, and wait for a FIFO.
    """
    from trimesh.resolvers import FilePathResolver

    class SandboxedResolver(FilePathResolver):
        def get(self, name: str) -> bytes:
            name, folder = name.strip(), Path(self.parent).resolve()
            sandbox.check(Path(folder, name))
            for candidate in dict.fromkeys((name, name.lstrip("/"), PurePath(name).name)):
                asset = Path(folder, candidate)
                if asset.resolve().is_relative_to(folder) and asset.exists():
                    return read_bytes(asset, sandbox)
            raise FileNotFoundError(name)

    # trimesh names objects by the file, and hashes their names as UTF-8
    return SandboxedResolver(path if is_utf8(path) else str(Path(path).with_name("mesh")))


def _read_part(scene: Any, node: str) -> MeshPart | None:
    matrix, geometry = scene.graph[node]
    mesh = scene.geometry[geometry]
    if len(getattr(mesh, "faces", ())) == 0:
        return None
    mesh = mesh.copy()
    mesh.apply_transform(matrix)
    visual = getattr(mesh, "visual", None)
    uvs, material = getattr(visual, "uv", None), getattr(visual, "material", None)
    return MeshPart(
        np.asarray(mesh.vertices),
        _read_normals(mesh),
        np.asarray(mesh.faces),
        np.zeros((len(mesh.vertices), 2)) if uvs is None else np.asarray(uvs)[:, :2],
        albedo=_base_color(visual, material),
        emission=_color_factor(material, "emissiveFactor", (0.0, 0.0, 0.0)),
        metal=_number_factor(material, "metallicFactor", 0.0),
        rough=_number_factor(material, "roughnessFactor", ROUGH),
        is_moving=True,
    )


def _read_normals(mesh: Any) -> Array:
    """Normals of vertices: those of the file, else the mean of the adjacent faces, weighted by their angles there.

    trimesh keeps the normals of the file in its cache. It would compute the others itself, but with scipy, which
    Halation does not require; the sums here are the same, in the same order (Thuermer and Wuethrich, Computing Vertex
    Normals from Polygonal Facets, 1998).
    """
    from trimesh.util import unitize

    if "vertex_normals" in mesh._cache:
        return np.asarray(mesh.vertex_normals)
    has_area = (np.asarray(mesh.face_normals) ** 2).sum(axis=1) > 0.5
    faces, normals, angles = (
        np.asarray(of_faces)[has_area] for of_faces in (mesh.faces, mesh.face_normals, mesh.face_angles)
    )
    corners, count = faces.ravel(), len(mesh.vertices)
    sums = [np.bincount(corners, (angles * normals[:, axis : axis + 1]).ravel(), count) for axis in range(3)]
    return np.asarray(unitize(np.stack(sums, axis=1)))


def _base_color(visual: Any, material: Any) -> tuple[float, float, float]:
    """The base color: scene-linear in glTF, sRGB in the other formats."""
    from ...color.transforms import decode_srgb, to_float

    base = getattr(material, "baseColorFactor", None)
    if base is not None:
        linear = to_float(np.asarray(base)[:3])
    else:
        base = getattr(material or visual, "main_color", None)
        linear = decode_srgb(to_float(np.asarray(_GRAY if base is None else base, np.uint8)[:3]))
    red, green, blue = (float(part) for part in linear)
    return red, green, blue


def _color_factor(material: Any, name: str, default: tuple[float, float, float]) -> tuple[float, float, float]:
    factor = getattr(material, name, None)
    if factor is None:
        return default
    red, green, blue = (float(part) for part in np.asarray(factor)[:3])
    return red, green, blue


def _number_factor(material: Any, name: str, default: float) -> float:
    factor = getattr(material, name, None)
    return default if factor is None else float(factor)
