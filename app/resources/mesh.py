"""Triangles, as scenes are drawn from them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from .record import Record

ATTRIBUTES: Mapping[str, int] = {
    "place": 3,
    "normal": 3,
    "uv": 2,
    "albedo": 3,
    "emission": 3,
    "metal_rough": 2,
    "object_material_moving": 3,
}
"""What a vertex holds, in order, and how many floats of each."""


class Mesh(Record, frozen=True):
    """Triangles: float32 [vertices, floats of ATTRIBUTES], uint32 [3 * triangles]. Equal digests, equal triangles."""

    digest: str
    vertices: object
    indices: object

    compare_exclude: ClassVar[frozenset[str]] = frozenset({"vertices", "indices"})
