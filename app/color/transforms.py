"""Color in and out of the working space.

OpenColorIO is imported when a file needs it: sRGB into linear Rec.709, the common case of reading, is a table.
"""

from __future__ import annotations

import difflib
from functools import cache, lru_cache
from typing import Any, Literal

import numpy as np
from halation.nodes import ColorSettings

from ..errors import UsageError
from ..resources.machine import available_cores
from .file_space import FileSpace
from .management import BUILT_IN, DEFAULT_COLOR, LINEAR_REC709, Managed, Space, builtin, managed, ocio, studio

NO_VIEW = "none"
NO_LOOK = "none"
_DISPLAY = "sRGB - Display"
_PLAIN_VIEW = "Un-tone-mapped"
_LARGEST = 65504.0

Array = np.ndarray


def is_working(found: FileSpace, manager: Managed) -> bool:
    """True where the numbers of a file are used as they are."""
    return found.space is None or found.space.data or (not manager.plain and found.space == manager.working)


def to_working(rgb: Array, found: FileSpace, manager: Managed) -> Array:
    """Colors [..., 3] of any dtype (integers fill 0..1) in the working space, float32.

    sRGB by IEC 61966-2-1 unless someone chose a config; other spaces through OpenColorIO.

    Raises:
        GraphError, UsageError: the config cannot say how.
    """
    if is_working(found, manager):
        return np.ascontiguousarray(as_float(rgb), dtype=np.float32)
    assert found.space is not None
    if not manager.chosen and _is_srgb(found.space):
        srgb = rgb.dtype == np.uint8 or rgb.dtype == np.uint16
        light = _srgb_table(rgb.dtype.str)[rgb] if srgb else decode_srgb(rgb).astype(np.float32)
        if manager.plain:
            return light
        return _through(light, rgb, manager, Space(LINEAR_REC709, True))
    return _through(np.ascontiguousarray(as_float(rgb), dtype=np.float32), rgb, manager, found.space)


def from_working(rgb: Array, space: Space, manager: Managed) -> Array:
    """Working-space colors [..., 3] in another space, float32. Raises as `to_working`."""
    made = np.array(rgb, dtype=np.float32, order="C")
    if not space.data and space != manager.working:
        _apply(_exact(manager.processor(manager.working, space)), made)
    return made


def decode_srgb(encoded: Array) -> Array:
    """Linear light of sRGB-encoded numbers (IEC 61966-2-1), mirrored for negative ones."""
    size = np.abs(encoded)
    return np.copysign(np.where(size <= 0.04045, size / 12.92, ((size + 0.055) / 1.055) ** 2.4), encoded)


def as_float(array: Array) -> Array:
    """8- and 16-bit integers as 0..1 in float32; 32-bit ones are counts and stay; floats stay."""
    if array.dtype in (np.uint8, np.uint16):
        return array.astype(np.float32) / np.float32(np.iinfo(array.dtype).max)
    return array.astype(np.float32) if array.dtype.kind in "ui" else array


def displays(color: ColorSettings = DEFAULT_COLOR) -> tuple[str, ...]:
    """The kinds of screen that pictures can be shown on, the default first.

    Raises:
        GraphError, UsageError: no config.
    """
    config = managed(color).config
    first = config.getDefaultDisplay()
    return (*([first] if first else ()), *(name for name in config.getDisplays() if name != first))


def views(display: str = "", color: ColorSettings = DEFAULT_COLOR) -> tuple[str, ...]:
    """The views that a picture on a display may have, the default first; `none` only encodes as sRGB.

    Raises:
        UsageError: unknown display.
        GraphError, UsageError: no config.
    """
    config, screen = managed(color).config, find_display(display, color)
    first = config.getDefaultView(screen) if screen else ""
    known = tuple(config.getViews(screen)) if screen else ()
    return (*([first] if first in known else ()), *(name for name in known if name != first), NO_VIEW)


def looks(color: ColorSettings = DEFAULT_COLOR) -> tuple[str, ...]:
    """The looks of the config. Raises GraphError, UsageError: no config."""
    return tuple(managed(color).config.getLookNames())


def find_view(name: str, display: str = "", color: ColorSettings = DEFAULT_COLOR) -> str:
    """The view that `name`, or its beginning in any case, means; "" is the default.

    Raises:
        UsageError: there is none, or more than one.
    """
    known = views(display, color)
    return known[0] if not name else _found(name, known, "view")


def find_display(name: str, color: ColorSettings = DEFAULT_COLOR) -> str:
    """The display that `name`, or its beginning in any case, means; "" is the default. Raises UsageError."""
    known = displays(color)
    return (known[0] if known else "") if not name else _found(name, known, "display")


def find_look(name: str, color: ColorSettings = DEFAULT_COLOR) -> str:
    """The look that `name` means: "" is that of the view, `none` none at all. Raises UsageError."""
    return name if name in ("", NO_LOOK) else _found(name, (*looks(color), NO_LOOK), "look")


def check_shown(view: str, display: str = "", look: str = "", color: ColorSettings = DEFAULT_COLOR) -> None:
    """Raise UsageError for a view, display or look that the config does not have."""
    find_view(view, display, color)
    find_look(look, color)


def _found(name: str, known: tuple[str, ...], what: str) -> str:
    wanted = name.casefold()
    match = [one for one in known if one.casefold() == wanted] or [
        one for one in known if one.casefold().startswith(wanted)
    ]
    if len(match) == 1:
        return match[0]
    folded = {word: one for one in known for word in (one.casefold(), one.casefold().split()[0])}
    guess = difflib.get_close_matches(wanted, folded, 1, 0.4)
    hint = f"did you mean '{folded[guess[0]]}'? Choose" if guess else "choose"
    raise UsageError(f"there is no {what} '{name}': {hint} from {', '.join(known)}")


def to_display(
    array: Array,
    view: str = "",
    *,
    bits: Literal[8, 16, 32] = 8,
    display: str = "",
    look: str = "",
    color: ColorSettings = DEFAULT_COLOR,
) -> Array:
    """Working-space pixels [h, w, 3 or 4] as seen on a display, sRGB by default, the same shape.

    Four channels are premultiplied on the way in and straight on the way out, since no display transform is
    linear; color without alpha (a glow over nothing) stays as bright as it is. NaN becomes black.

    Returns uint8, uint16 or float32, by `bits`.

    Raises:
        UsageError: unknown view, display or look.
        GraphError, UsageError: no config.
    """
    processor = display_processor(view, display, look, color).getDefaultCPUProcessor()
    pixels = straight(array)
    rgb = np.ascontiguousarray(pixels[..., :3])
    _apply(processor, rgb)
    pixels[..., :3] = rgb
    return pixels if bits == 32 else quantized(pixels, bits)


def straight(array: Array) -> Array:
    """A copy of pixels [h, w, 3 or 4] in float32, finite and within half floats, color not multiplied by alpha."""
    pixels = np.array(array, dtype=np.float32)
    np.nan_to_num(pixels, copy=False, nan=0.0, posinf=_LARGEST, neginf=-_LARGEST)
    rgb = pixels[..., :3]
    if pixels.shape[2] == 4:
        alpha = pixels[..., 3:]
        np.divide(rgb, alpha, out=rgb, where=alpha > 0.0)
    np.clip(rgb, -_LARGEST, _LARGEST, out=rgb)
    return pixels


def quantized(pixels: Array, bits: Literal[8, 10, 12, 16]) -> Array:
    """0..1 as integers of so many bits, rounded, in uint8 or uint16."""
    top = (1 << bits) - 1
    return (np.clip(pixels, 0.0, 1.0) * top + 0.5).astype(np.uint8 if bits == 8 else np.uint16)


def display_processor(view: str, display: str, look: str = "", color: ColorSettings = DEFAULT_COLOR) -> Any:
    """From the working space to what a display shows. A `look` stands in place of those of the view.

    Raises:
        UsageError: unknown view, display or look.
        GraphError, UsageError: no config, or one that lacks something.
    """
    if view.casefold() == NO_VIEW and look in ("", NO_LOOK):
        return _plain_processor(managed(color))
    screen, chosen, how = find_display(display, color), find_view(view, display, color), find_look(look, color)
    if chosen == NO_VIEW and how in ("", NO_LOOK):
        return _plain_processor(managed(color))
    return _display_processor(managed(color), screen, chosen, how)


@lru_cache(maxsize=64)
def _plain_processor(manager: Managed) -> Any:
    """From the working space to sRGB."""
    return manager.attempt(lambda: _views_of(manager, builtin(BUILT_IN), _DISPLAY, _PLAIN_VIEW))


def _views_of(manager: Managed, config: Any, display: str, view: str) -> Any:
    forward, working = ocio().TRANSFORM_DIR_FORWARD, manager.working
    if not manager.chosen and (known := config.getColorSpace(working.name)):
        return config.getProcessor(known.getName(), display, view, forward)
    source = manager.spaces if working.own else studio()
    return ocio().Config.GetProcessorFromConfigs(source, working.name, config, display, view, forward)


@lru_cache(maxsize=64)
def _display_processor(manager: Managed, display: str, view: str, look: str) -> Any:
    api = ocio()
    if not manager.chosen and not look:
        return manager.attempt(lambda: _views_of(manager, manager.config, display, view))

    def make() -> Any:
        group, space = manager.bridged()
        if look not in ("", NO_LOOK):
            group.appendTransform(api.LookTransform(space, space, look))
        if view == NO_VIEW:
            plain = api.Config.GetProcessorFromConfigs(
                manager.config, space, builtin(BUILT_IN), _DISPLAY, _PLAIN_VIEW, api.TRANSFORM_DIR_FORWARD
            )
            group.appendTransform(plain.createGroupTransform())
            return manager.config.getProcessor(group)
        group.appendTransform(api.DisplayViewTransform(space, display, view, looksBypass=look != ""))
        return manager.config.getProcessor(group)

    return manager.attempt(make)


def _is_srgb(space: Space) -> bool:
    return space.name in ("srgb_rec709_scene", "sRGB Encoded Rec.709 (sRGB)")


def _through(light: Array, given: Array, manager: Managed, space: Space) -> Array:
    """Colors through OpenColorIO; what is not a copy of what was given yet becomes one."""
    light = light.copy() if light is given or np.shares_memory(light, given) else light
    _apply(_reading(manager, space), light)
    return light


@lru_cache(maxsize=256)
def _reading(manager: Managed, space: Space) -> Any:
    """From a space to the working space."""
    known = manager.find(space.name) if space.name == LINEAR_REC709 else space
    return _exact(manager.processor(known or space, manager.working))


def _exact(processor: Any) -> Any:
    """On the CPU without short cuts: a fifth slower, and those are off by a part of a thousand of log codes."""
    return processor.getOptimizedCPUProcessor(ocio().OPTIMIZATION_LOSSLESS)


@cache
def _srgb_table(dtype: str) -> Array:
    count = np.iinfo(dtype).max
    return decode_srgb(np.arange(count + 1) / count).astype(np.float32)


def _apply(processor: Any, rgb: Array) -> None:
    """Transform contiguous float32 colors in place, a band of rows per core: ACES costs 0.3 us per pixel."""
    from concurrent.futures import ThreadPoolExecutor

    cores = min(available_cores(), rgb.shape[0])
    bands = [band for band in np.array_split(rgb, cores) if band.size]
    with ThreadPoolExecutor(cores) as pool:
        list(pool.map(processor.applyRGB, bands))
