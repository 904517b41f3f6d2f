"""Finds the color space of a file, and the reason for it."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from ..errors import GraphError, InputError
from .header_space import REC709, HeaderSpace
from .management import LINEAR_REC709, ColorManager, OcioColorSpace

AUTO = ("", "auto")
"""Values that ask to recognize the space."""

SRGB = "srgb_rec709_scene"
_LINEAR_TAGS = ("linear", "scene_linear")
_PROFILES = {"Display P3": "srgb_p3d65_scene", "Adobe RGB (1998)": "g22_adobergb_scene"}
CHROMATICITIES = {
    "lin_rec709_scene": REC709,
    "lin_ap1_scene": (0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767),
    "lin_ap0_scene": (0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077, 0.32168, 0.33767),
    "lin_rec2020_scene": (0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290),
    "lin_p3d65_scene": (0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290),
    "lin_ciexyzd65_scene": (1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0 / 3.0, 1.0 / 3.0),
}
"""Linear spaces by the chromaticities of red, green, blue and white."""


_FILM_TAGS = ("kodaklog", "cineon")
_SAME_PRIMARIES = 1e-3
"""How far chromaticities may be from those of a known space: files have three decimals at least."""

_SAME_GAMMA = 0.01
"""OpenImageIO names gammas with two digits (`g22_rec709_scene`), so a name may stand for half of this on each side,
and encoders round 1 / 2.2 to five digits."""


class ColorHints(Struct, frozen=True):
    """The facts of a header about color: a tag, the meaning of the format without a tag, an ICC profile, the exponent
    that decodes it, chromaticities, and whether it holds integers.

    `is_own_tag`: the author of the file wrote the tag; otherwise OpenImageIO concluded it from other fields.
    """

    tag: str = ""
    usual: str = ""
    profile: str = ""
    primaries: tuple[float, ...] = ()
    integer: bool = False
    gamma: float = 0.0
    is_own_tag: bool = True

    @property
    def profile_space(self) -> str:
        """The space of the ICC profile, "" if it is unknown."""
        return _PROFILES.get(self.profile, "")


class FileSpace(Struct, frozen=True):
    """A color space by name, and the reason for it. Without a `space` or `described` the numbers are used unchanged.

    `described` is a space that the numbers of the header define. `warning` is the rest of a sentence about a part of
    the header that cannot be used, or "".
    """

    name: str
    reason: str
    space: OcioColorSpace | None = None
    described: HeaderSpace | None = None
    warning: str = ""


def find_file_space(path: str, hints: ColorHints, managed: ColorManager, requested: str = "") -> FileSpace:
    """The color space of a file: the requested one, that of its header, that of a file rule of the config, else the
    usual one: sRGB for integers, the working space for the rest.

    Raises:
        GraphError: what is requested is unknown.
        InputError: the name that the author of the file wrote is unknown, or that of a rule.
    """
    if space := find_requested_space(requested, managed):
        return FileSpace(space.name, "as color_space says", space)
    if named := _read_name(path, hints, managed):
        return named
    warning = ""
    if hints.tag and not hints.profile_space:
        warning = f"its header says '{hints.tag}', which is no color space that is known: give the input a color_space"
    elif hints.primaries and not hints.profile_space:
        if (space := _read_chromaticities(hints.primaries, managed)) is not None:
            return space
        numbers = ", ".join(f"{number:g}" for number in hints.primaries)
        warning = f"its chromaticities ({numbers}) are those of no colors: give the input a color_space"
    if managed.is_chosen and (space := _apply_file_rule(path, managed)):
        return replace(space, warning=warning)
    return replace(_usual_space(hints, managed, bool(warning)), warning=warning)


def _usual_space(hints: ColorHints, managed: ColorManager, is_doubtful: bool) -> FileSpace:
    """The usual space of files of this kind."""
    usual = hints.usual or (SRGB if hints.integer else "")
    if usual == SRGB:
        reason = "integers are sRGB unless someone says otherwise"
        return FileSpace(SRGB, reason, OcioColorSpace(SRGB, True) if managed.is_plain else managed.find(SRGB))
    if usual and not managed.is_plain:
        return FileSpace(usual, "that is what such files hold", managed.find(usual))
    working = LINEAR_REC709 if managed.is_plain else managed.working.name
    because = "its header cannot be used" if is_doubtful else "nothing says otherwise"
    return FileSpace(working, f"the working space, for {because}")


def find_requested_space(name: str, managed: ColorManager) -> OcioColorSpace | None:
    """The space of that name; None if it shall be recognized. Raises GraphError for an unknown name."""
    if name in AUTO:
        return None
    space = managed.find(name)
    if space is None:
        raise GraphError(f"color_space '{name}' is unknown{managed.suggest_space(name)}")
    return space


def _read_name(path: str, hints: ColorHints, managed: ColorManager) -> FileSpace | None:
    """The space that the header names; None if it names none, or an unknown one that only OpenImageIO concluded.

    The most certain statement counts: an ICC profile, then a gamma that the name does not have already, then the name.
    Names that only say "linear" mean the working space, since renderers write them whatever their primaries are.

    Raises:
        InputError: the author of the file wrote a name that is unknown.
    """
    name, reason = hints.tag, "its header says so"
    if profile_space := hints.profile_space:
        name, reason = profile_space, f"its ICC profile is {hints.profile}"
    elif hints.gamma and not (_names_gamma(name, hints.gamma) and managed.find(name)):
        described = HeaderSpace(gamma=hints.gamma)
        return FileSpace(described.name, "its gamma", described=described) if described.is_valid else None
    elif name.casefold() in _FILM_TAGS and managed.find(name) is None:
        return FileSpace(HeaderSpace(is_film=True).name, reason, described=HeaderSpace(is_film=True))
    if not name:
        return None
    if name.casefold() in _LINEAR_TAGS and not (managed.is_chosen and managed.find(name)):
        return FileSpace(managed.working.name if not managed.is_plain else LINEAR_REC709, reason)
    if managed.is_plain and name in (LINEAR_REC709, SRGB):
        return FileSpace(name, reason, None if name == LINEAR_REC709 else OcioColorSpace(SRGB, True))
    if (space := managed.find(name)) is not None:
        return FileSpace(name, reason, space)
    if hints.is_own_tag:
        raise InputError(
            f"{path}: its color space '{name}' is unknown: give the input a color_space{managed.suggest_space(name)}"
        )
    return None


def _names_gamma(name: str, gamma: float) -> bool:
    """True for names such as `g22_rec709_scene` whose exponent is this one."""
    match = re.match(r"g(\d)(\d)_", name)
    return match is not None and abs(int(match[1]) + int(match[2]) / 10.0 - gamma) < _SAME_GAMMA


def _read_chromaticities(primaries: tuple[float, ...], managed: ColorManager) -> FileSpace | None:
    """The linear space of these primaries and white: one that has a name, else a matrix; None for impossible ones."""
    reason = "its chromaticities"
    for name, gamut in CHROMATICITIES.items():
        if len(primaries) == 8 and np.allclose(primaries, gamut, atol=_SAME_PRIMARIES):
            if managed.is_plain and name == LINEAR_REC709:
                return FileSpace(name, reason)
            if (space := managed.find(name)) is not None:
                return FileSpace(name, reason, space)
    described = HeaderSpace(tuple(float(number) for number in primaries))
    return FileSpace(described.name, reason, described=described) if described.is_valid else None


def _apply_file_rule(path: str, managed: ColorManager) -> FileSpace | None:
    """The space that a file rule of the config gives a path. The last rule, which matches every path, is ignored."""
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
