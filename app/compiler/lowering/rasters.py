"""Meshes that a camera sees: one operation with all pictures of them."""

from __future__ import annotations

from halation.nodes import CameraModel, Motion, Size

from ...resources.mesh import Mesh
from ..ir import Builder, PictureShape, Raster, Ref
from ..raster import CHANNELS
from .node_inputs import DrawnPicture


def add_raster(
    builder: Builder,
    owner: str,
    size: Size,
    mesh: Mesh,
    motions: tuple[Motion, Motion, Motion],
    cameras: tuple[CameraModel, CameraModel, CameraModel],
    near: float,
) -> dict[str, DrawnPicture]:
    """The pictures of a mesh by channel; motions and cameras are those of now, before and after."""
    shapes = tuple(PictureShape(size, channels, data) for channels, data, _ in CHANNELS.values())
    camera_rows = tuple(part for camera in cameras for part in camera.rows)
    motion_rows = tuple(part for motion in motions for part in motion)
    first = builder.add(Raster(shapes, owner, mesh, camera_rows, motion_rows, near))
    return {name: DrawnPicture(Ref(first.op, at), shapes[at]) for at, name in enumerate(CHANNELS)}
