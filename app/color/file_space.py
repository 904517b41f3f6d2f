"""Which color space the numbers of a file are in, and how that is known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from msgspec import Struct

from ..errors import GraphError, InputError
from .management import LINEAR_REC709, ColorManager, OcioColorSpace

AUTO = ("", "auto")
"""What stands for finding out."""

SRGB = "srgb_rec709_scene"
_LINEAR_TAGS = ("linear", "scene_linear")
_PROFILES = {"Display P3": "srgb_p3d65_scene", "Adobe RGB (1998)": "g22_adobergb_scene"}
CHROMATICITIES = {
    "lin_rec709_scene": (0.640, 0.330, 0.300, 0.600, 0.150, 0.060, 0.3127, 0.3290),
    "lin_ap1_scene": (0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767),
    "lin_ap0_scene": (0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077, 0.32168, 0.33767),
    "lin_rec2020_scene": (0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290),
    "lin_p3d65_scene": (0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290),
}
"""Linear spaces by the chromaticities of red, green, blue and white."""


class ColorHints(Struct, frozen=True):
    """What a header says of color: a tag that someone wrote, what its format means without one, an ICC profile,
    chromaticities, and whether it holds integers."""

    tag: str = ""
    usual: str = ""
    profile: str = ""
    primaries: tuple[float, ...] = ()
    integer: bool = False


class FileSpace(Struct, frozen=True):
    """A color space by name, and how it is known. Without a `space` the numbers are taken as they are."""

    name: str
    reason: str
    space: OcioColorSpace | None = None


def find_file_space(path: str, hints: ColorHints, managed: ColorManager, requested: str = "") -> FileSpace:
    """The space of color in a file: what is `wanted`, what its header says, what a rule of the config says, else what
    is usual for such files: sRGB for integers, the working space for the rest.

    Raises:
        GraphError: what is wanted is unknown.
        InputError: what the header or a rule says is unknown.
    """
    if space := find_requested_space(requested, managed):
        return FileSpace(space.name, "as color_space says", space)
    for name, reason in _read_hints(hints):
        if name.casefold() in _LINEAR_TAGS and not (managed.is_chosen and managed.find(name)):
            return FileSpace(managed.working.name if not managed.is_plain else LINEAR_REC709, reason)
        if managed.is_plain and name in (LINEAR_REC709, SRGB):
            return FileSpace(name, reason, None if name == LINEAR_REC709 else OcioColorSpace(SRGB, True))
        space = managed.find(name)
        if space is not None:
            return FileSpace(name, reason, space)
        raise InputError(
            f"{path}: its color space '{name}' is unknown: give the input a color_space{managed.suggest_space(name)}"
        )
    if managed.is_chosen and (space := _apply_file_rule(path, managed)):
        return space
    usual = hints.usual or (SRGB if hints.integer else "")
    if usual == SRGB:
        reason = "integers are sRGB unless someone says otherwise"
        return FileSpace(SRGB, reason, OcioColorSpace(SRGB, True) if managed.is_plain else managed.find(SRGB))
    if usual and not managed.is_plain:
        return FileSpace(usual, "that is what such files hold", managed.find(usual))
    working = LINEAR_REC709 if managed.is_plain else managed.working.name
    return FileSpace(working, "the working space, for nothing says otherwise")


def find_requested_space(name: str, managed: ColorManager) -> OcioColorSpace | None:
    """The space of that name; None for finding out. Raises GraphError for one that nobody knows."""
    if name in AUTO:
        return None
    space = managed.find(name)
    if space is None:
        raise GraphError(f"color_space '{name}' is unknown{managed.suggest_space(name)}")
    return space


def _read_hints(hints: ColorHints) -> list[tuple[str, str]]:
    """The name that the header gives, the strongest first, with the reason."""
    if hints.profile in _PROFILES:
        return [(_PROFILES[hints.profile], f"its ICC profile is {hints.profile}")]
    if hints.tag:
        return [(hints.tag, "its header says so")]
    for name, gamut in CHROMATICITIES.items():
        if len(hints.primaries) == 8 and np.allclose(hints.primaries[:6], gamut[:6], atol=1e-3):
            return [(name, "its chromaticities")]
    return []


def _apply_file_rule(path: str, managed: ColorManager) -> FileSpace | None:
    """What a rule of the config says of a path; the last one, for whatever matches no other, says nothing."""
    config = managed.config
    full = Path(path).absolute().as_posix()
    if config.filepathOnlyMatchesDefaultRule(full):
        return None
    name, number = config.getColorSpaceFromFilepath(full)
    space = managed.find(name)
    rule = config.getFileRules().getName(number)
    if space is None:
        raise InputError(
            f"{path}: the file rule '{rule}' of {managed.where} names the color space '{name}', which it does not have"
        )
    return FileSpace(space.name, f"the file rule '{rule}'", space)
