"""Meshes that are drawn into the channels of a picture."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct

StageName = Literal["stage", "corner", "blocks"]


class BuiltInScene(Struct, frozen=True):
    """One of the scenes that need no file."""

    name: StageName


class SceneFile(Struct, frozen=True):
    """Meshes of a file: glTF, OBJ, PLY, STL. `up` is the axis that points up in it; the world's is z."""

    path: str
    up: Literal["y", "z"] = "y"


Scene = BuiltInScene | SceneFile

Motion = tuple[float, ...]
"""Rows of the 3 x 4 matrix that moves what can move: (x, y, z, 1) to a place in the world."""
