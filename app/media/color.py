"""Color in and out of the working space, which is linear Rec.709 for now.

OpenColorIO is imported when a file needs it: sRGB, the common case of reading, is a table.
"""

from __future__ import annotations

import difflib
import os
from functools import cache
from typing import Any, Literal

import numpy as np

from ..errors import InputError, UsageError

WORKING = "lin_rec709_scene"
NO_VIEW = "none"
_DISPLAY = "sRGB - Display"
_PLAIN_VIEW = "Un-tone-mapped"
_CONFIG = "ocio://default"
_LINEAR = ("", WORKING, "linear", "scene_linear", "data", "raw", "unknown")
_SRGB = ("srgb_rec709_scene", "srgb_rec709_display", "srgb")
_LARGEST = 65504.0
_PROFILES = {"Display P3": "srgb_p3d65_scene", "Adobe RGB (1998)": "g22_adobergb_scene"}
_GAMUTS = {
    (0.713, 0.293, 0.165, 0.830, 0.128, 0.044): "lin_ap1_scene",
    (0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077): "lin_ap0_scene",
    (0.708, 0.292, 0.170, 0.797, 0.131, 0.046): "lin_rec2020_scene",
    (0.680, 0.320, 0.265, 0.690, 0.150, 0.060): "lin_p3d65_scene",
}

Array = np.ndarray


def space_of(tag: str, profile: str, primaries: tuple[float, ...], integer: bool) -> str:
    """The space of a file's pixels: its tag, ICC profile or EXR chromaticities; else integers are sRGB."""
    if profile in _PROFILES:
        return _PROFILES[profile]
    if tag:
        return tag
    for gamut, name in _GAMUTS.items():
        if len(primaries) == 8 and np.allclose(primaries[:6], gamut, atol=1e-3):
            return name
    return _SRGB[0] if integer else WORKING


def available_cores() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def is_linear(space: str) -> bool:
    """True where the numbers are used as they are."""
    return space.casefold() in _LINEAR


def to_linear(rgb: Array, space: str, path: str = "") -> Array:
    """Colors [..., 3] of any dtype (integers fill 0..1) in the working space, float32.

    sRGB by IEC 61966-2-1; other spaces through OpenColorIO's built-in config.

    Raises:
        InputError: nobody knows the space.
    """
    if space.casefold() in _SRGB:
        if rgb.dtype == np.uint8 or rgb.dtype == np.uint16:
            return _srgb_table(rgb.dtype.str)[rgb]
        return decode_srgb(rgb).astype(np.float32)
    linear = np.ascontiguousarray(as_float(rgb), dtype=np.float32)
    if is_linear(space):
        return linear
    try:
        processor = config().getProcessor(space, WORKING).getDefaultCPUProcessor()
    except ocio().Exception as error:
        raise InputError(f"{path}: its color space '{space}' is unknown: save it as linear Rec.709 or sRGB") from error
    linear = linear.copy() if linear is rgb else linear
    _apply(processor, linear)
    return linear


def decode_srgb(encoded: Array) -> Array:
    """Linear light of sRGB-encoded numbers (IEC 61966-2-1), mirrored for negative ones."""
    size = np.abs(encoded)
    return np.copysign(np.where(size <= 0.04045, size / 12.92, ((size + 0.055) / 1.055) ** 2.4), encoded)


def as_float(array: Array) -> Array:
    """8- and 16-bit integers as 0..1 in float32; 32-bit ones are counts and stay; floats stay."""
    if array.dtype in (np.uint8, np.uint16):
        return array.astype(np.float32) / np.float32(np.iinfo(array.dtype).max)
    return array.astype(np.float32) if array.dtype.kind in "ui" else array


@cache
def _srgb_table(dtype: str) -> Array:
    count = np.iinfo(dtype).max
    return decode_srgb(np.arange(count + 1) / count).astype(np.float32)


def displays() -> tuple[str, ...]:
    """The kinds of screen that pictures can be shown on, the default first."""
    return tuple(config().getDisplays())


def views(display: str = "") -> tuple[str, ...]:
    """The views that a picture on a display may have, the default first; `none` only encodes as sRGB.

    Raises:
        UsageError: unknown display.
    """
    return (*config().getViews(_find_display(display)), NO_VIEW)


def find_view(name: str, display: str = "") -> str:
    """The view that `name`, or its beginning in any case, means; "" is the default.

    Raises:
        UsageError: there is none, or more than one.
    """
    known = views(display)
    if not name:
        return known[0]
    wanted = name.casefold()
    match = [view for view in known if view.casefold() == wanted] or [
        view for view in known if view.casefold().startswith(wanted)
    ]
    if len(match) == 1:
        return match[0]
    folded = {word: view for view in known for word in (view.casefold(), view.casefold().split()[0])}
    guess = difflib.get_close_matches(wanted, folded, 1, 0.4)
    hint = f"did you mean '{folded[guess[0]]}'? Choose" if guess else "choose"
    raise UsageError(f"there is no view '{name}': {hint} from {', '.join(known)}")


def _find_display(name: str) -> str:
    known = displays()
    if name and name not in known:
        raise UsageError(f"there is no display '{name}': choose from {', '.join(known)}")
    return name or _DISPLAY


def to_display(array: Array, view: str = "", *, bits: Literal[8, 16, 32] = 8, display: str = "") -> Array:
    """Working-space pixels [h, w, 3 or 4] as seen on a display, sRGB by default, the same shape.

    Four channels are premultiplied on the way in and straight on the way out, since no display transform is
    linear; color without alpha (a glow over nothing) stays as bright as it is. NaN becomes black.

    Returns uint8, uint16 or float32, by `bits`.

    Raises:
        UsageError: unknown view or display.
    """
    processor = display_processor(view, display).getDefaultCPUProcessor()
    pixels = np.array(array, dtype=np.float32)
    np.nan_to_num(pixels, copy=False, nan=0.0, posinf=_LARGEST, neginf=-_LARGEST)
    rgb = np.ascontiguousarray(pixels[..., :3])
    if pixels.shape[2] == 4:
        alpha = pixels[..., 3:]
        np.divide(rgb, alpha, out=rgb, where=alpha > 0.0)
    np.clip(rgb, -_LARGEST, _LARGEST, out=rgb)
    _apply(processor, rgb)
    pixels[..., :3] = rgb
    if bits == 32:
        return pixels
    top = (1 << bits) - 1
    np.clip(pixels, 0.0, 1.0, out=pixels)
    return (pixels * top + 0.5).astype(np.uint8 if bits == 8 else np.uint16)


def ocio() -> Any:
    """OpenColorIO, which comes without types."""
    import PyOpenColorIO

    return PyOpenColorIO


@cache
def config() -> Any:
    """The built-in config."""
    return ocio().Config.CreateFromBuiltinConfig(_CONFIG)


@cache
def display_processor(view: str, display: str) -> Any:
    """From the working space to what a display shows."""
    screen, chosen = _find_display(display), find_view(view, display)
    if chosen == NO_VIEW:
        screen, chosen = _DISPLAY, _PLAIN_VIEW
    return config().getProcessor(WORKING, screen, chosen, ocio().TRANSFORM_DIR_FORWARD)


def _apply(processor: Any, rgb: Array) -> None:
    """Transform contiguous float32 colors in place, a band of rows per core: ACES costs 0.3 us per pixel."""
    from concurrent.futures import ThreadPoolExecutor

    cores = min(available_cores(), rgb.shape[0])
    bands = [band for band in np.array_split(rgb, cores) if band.size]
    with ThreadPoolExecutor(cores) as pool:
        list(pool.map(processor.applyRGB, bands))
