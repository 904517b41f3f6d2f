"""Conventions of data layers: which depth, whose axes, which direction of motion.

This module knows the habits of renderers; `evidence` finds conventions in the pixels, which count more.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import StrEnum
from types import MappingProxyType

from msgspec import Struct

from ..media.layers import normalize_name
from .naming import RenderProgram, Role


class DepthKind(StrEnum):
    """The kind of a depth layer. `Convention.scale` and `offset` make all kinds planar except radial and inverse."""

    PLANAR = "planar"
    """The distance along the axis of the camera."""
    RADIAL = "radial"
    """The distance from the eye."""
    INVERSE = "inverse"
    """1 / planar."""
    NEGATIVE = "negative"
    """Minus planar: the camera looks along -z."""
    NORMALIZED = "normalized"
    """Planar, scaled to 0..1."""


class VectorSpace(StrEnum):
    """The axes of vectors."""

    WORLD = "world"
    CAMERA = "camera"
    """x right, y up, z towards the viewer."""
    CAMERA_AHEAD = "camera_ahead"
    """x right, y up, z away from the viewer."""


class MotionDirection(StrEnum):
    """The frames between which motion is measured, after `Convention.scale` has made it pixels, x right and y down."""

    FROM_PREVIOUS = "from_previous"
    """The position of a surface, minus that one frame before."""
    TO_NEXT = "to_next"
    """The position one frame later, minus that now."""


class Convention(Struct, frozen=True):
    """The convention of a layer: its kind, and the `scale` and then `offset` that convert its channels to standard
    numbers.

    Standard numbers are distances along the axis (planar), from the eye (radial) or their inverse; unit vectors;
    pixels, x right, y down. One number stands for all channels. `measured` means that the pixels prove it. An unknown
    kind is "".
    """

    kind: str
    reason: str
    is_measured: bool = False
    scale: tuple[float, ...] = (1.0,)
    offset: tuple[float, ...] = (0.0,)

    @property
    def words(self) -> str:
        """The convention in words."""
        return self.kind.replace("_", " ") or "not known"


class _Habit(Struct, frozen=True):
    """The habit of one renderer for layers with one of these names, unless pixels prove otherwise."""

    renderer: RenderProgram
    role: Role
    names: str
    convention: Convention


def _make_habit(
    renderer: RenderProgram, role: Role, names: str, kind: str, reason: str, scale: tuple[float, ...] = (1.0,)
) -> _Habit:
    return _Habit(renderer, role, names, Convention(kind, reason, scale=scale))


_UP = "in pixels, y up"
_HABITS: Sequence[_Habit] = (
    _make_habit(RenderProgram.BLENDER, Role.DEPTH, "depth z", DepthKind.PLANAR, "Blender writes planar depth"),
    _make_habit(RenderProgram.ARNOLD, Role.DEPTH, "z depth", DepthKind.PLANAR, "Arnold's Z is not its ray length"),
    _make_habit(RenderProgram.KARMA, Role.DEPTH, "depth hitpz", DepthKind.PLANAR, "Karma's hitPz is planar"),
    _make_habit(
        RenderProgram.KARMA, Role.DEPTH, "hitdist", DepthKind.RADIAL, "Karma's hitdist is the length of the ray"
    ),
    _make_habit(RenderProgram.KARMA, Role.DEPTH, "pz", DepthKind.NEGATIVE, "Mantra's Pz is z in camera space", (-1.0,)),
    _make_habit(
        RenderProgram.RENDERMAN, Role.DEPTH, "z zfiltered depth", DepthKind.PLANAR, "RenderMan's z is its camera's"
    ),
    _make_habit(
        RenderProgram.MITSUBA, Role.DEPTH, "depth dd", DepthKind.RADIAL, "Mitsuba's depth is the length of the ray"
    ),
    _make_habit(RenderProgram.NUKE, Role.DEPTH, "depth z", DepthKind.INVERSE, "Nuke's ScanlineRender writes 1 / z"),
    _make_habit(
        RenderProgram.VRAY,
        Role.DEPTH,
        "vrayzdepth zdepth z",
        "",
        "V-Ray scales, clamps and turns around its Z-depth as its settings say",
    ),
    _make_habit(RenderProgram.BLENDER, Role.NORMAL, "normal", VectorSpace.WORLD, "Blender writes normals of the world"),
    _make_habit(RenderProgram.ARNOLD, Role.NORMAL, "n", VectorSpace.WORLD, "Arnold's N is in world space"),
    _make_habit(RenderProgram.KARMA, Role.NORMAL, "ngcamera ncamera", VectorSpace.CAMERA, "its name says camera"),
    _make_habit(RenderProgram.KARMA, Role.NORMAL, "n ng", VectorSpace.WORLD, "Karma's N is in world space"),
    _make_habit(
        RenderProgram.RENDERMAN, Role.NORMAL, "nn normal", VectorSpace.CAMERA_AHEAD, "RenderMan shades in camera space"
    ),
    _make_habit(RenderProgram.RENDERMAN, Role.NORMAL, "nworld", VectorSpace.WORLD, "its name says world"),
    _make_habit(
        RenderProgram.BLENDER, Role.POSITION, "position", VectorSpace.WORLD, "Blender writes places in the world"
    ),
    _make_habit(RenderProgram.ARNOLD, Role.POSITION, "p", VectorSpace.WORLD, "Arnold's P is in world space"),
    _make_habit(RenderProgram.KARMA, Role.POSITION, "p", VectorSpace.WORLD, "Karma's P is in world space"),
    _make_habit(RenderProgram.KARMA, Role.POSITION, "pcamera", VectorSpace.CAMERA, "its name says camera"),
    _make_habit(
        RenderProgram.RENDERMAN, Role.POSITION, "p", VectorSpace.CAMERA_AHEAD, "RenderMan shades in camera space"
    ),
    _make_habit(RenderProgram.RENDERMAN, Role.POSITION, "pworld", VectorSpace.WORLD, "its name says world"),
    _make_habit(
        RenderProgram.BLENDER,
        Role.VELOCITY,
        "vector",
        MotionDirection.FROM_PREVIOUS,
        f"Blender's X and Y are previous minus current, {_UP}; Z and W current minus next",
        (-1.0, 1.0, -1.0, 1.0),
    ),
    _make_habit(
        RenderProgram.NUKE,
        Role.VELOCITY,
        "backward",
        MotionDirection.FROM_PREVIOUS,
        f"Nuke's backward vectors point to the previous frame, {_UP}",
        (-1.0, 1.0),
    ),
    _make_habit(
        RenderProgram.NUKE,
        Role.VELOCITY,
        "forward motion",
        MotionDirection.TO_NEXT,
        f"Nuke's forward vectors point to the next frame, {_UP}",
        (1.0, -1.0),
    ),
)
_FALLBACKS: Mapping[Role, Convention] = MappingProxyType(
    {
        Role.DEPTH: Convention(DepthKind.PLANAR, "what most renderers write; nothing in the file proves it"),
        Role.NORMAL: Convention(VectorSpace.WORLD, "what most renderers write; nothing in the file proves it"),
        Role.POSITION: Convention(VectorSpace.WORLD, "what most renderers write; nothing in the file proves it"),
        Role.VELOCITY: Convention("", "renderers differ in it; the frame before would tell"),
    }
)


def find_habit(role: Role, name: str, renderer: RenderProgram | None) -> Convention | None:
    """The habit of the renderer for this name; for an unknown renderer, the habit that all renderers with this name
    share.

    Else the usual convention; None for roles without conventions.
    """
    word = normalize_name(name.rpartition(".")[2])
    conventions = [
        item.convention
        for item in _HABITS
        if item.role is role and renderer in (None, item.renderer) and word in item.names.split()
    ]
    agreed = len({(item.kind, item.scale) for item in conventions}) == 1
    return conventions[0] if agreed else _FALLBACKS.get(role)
