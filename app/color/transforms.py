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
from .management import (
    BUILT_IN,
    DEFAULT_COLOR,
    LINEAR_REC709,
    ColorManager,
    ColorSpace,
    get_color_manager,
    load_builtin_config,
    load_ocio,
    load_studio_config,
)

NO_VIEW = "none"
NO_LOOK = "none"
_DISPLAY = "sRGB - Display"
_PLAIN_VIEW = "Un-tone-mapped"
_LARGEST = 65504.0

Array = np.ndarray


def is_in_working_space(file_space: FileSpace, manager: ColorManager) -> bool:
    """True where the numbers of a file are used as they are."""
    return (
        file_space.space is None
        or file_space.space.data
        or (not manager.is_plain and file_space.space == manager.working)
    )


def to_working(rgb: Array, file_space: FileSpace, manager: ColorManager) -> Array:
    """Colors [..., 3] of any dtype (integers fill 0..1) in the working space, float32.

    sRGB by IEC 61966-2-1 unless someone chose a config; other spaces through OpenColorIO.

    Raises:
        GraphError, UsageError: the config cannot say how.
    """
    if is_in_working_space(file_space, manager):
        return np.ascontiguousarray(to_float(rgb), dtype=np.float32)
    assert file_space.space is not None
    if not manager.is_chosen and _is_srgb(file_space.space):
        has_table = rgb.dtype == np.uint8 or rgb.dtype == np.uint16
        light = _make_srgb_table(rgb.dtype.str)[rgb] if has_table else decode_srgb(rgb).astype(np.float32)
        if manager.is_plain:
            return light
        return _convert_to_working(light, rgb, manager, ColorSpace(LINEAR_REC709, True))
    return _convert_to_working(np.ascontiguousarray(to_float(rgb), dtype=np.float32), rgb, manager, file_space.space)


def from_working(rgb: Array, space: ColorSpace, manager: ColorManager) -> Array:
    """Working-space colors [..., 3] in another space, float32. Raises as `to_working`."""
    converted = np.array(rgb, dtype=np.float32, order="C")
    if not space.data and space != manager.working:
        _apply(_make_exact(manager.make_processor(manager.working, space)), converted)
    return converted


def decode_srgb(encoded: Array) -> Array:
    """Linear light of sRGB-encoded numbers (IEC 61966-2-1), mirrored for negative ones."""
    size = np.abs(encoded)
    return np.copysign(np.where(size <= 0.04045, size / 12.92, ((size + 0.055) / 1.055) ** 2.4), encoded)


def to_float(array: Array) -> Array:
    """8- and 16-bit integers as 0..1 in float32; 32-bit ones are counts and stay; floats stay."""
    if array.dtype in (np.uint8, np.uint16):
        return array.astype(np.float32) / np.float32(np.iinfo(array.dtype).max)
    return array.astype(np.float32) if array.dtype.kind in "ui" else array


def list_displays(color: ColorSettings = DEFAULT_COLOR) -> tuple[str, ...]:
    """The kinds of screen that pictures can be shown on, the default first.

    Raises:
        GraphError, UsageError: no config.
    """
    config = get_color_manager(color).config
    first = config.getDefaultDisplay()
    return (*([first] if first else ()), *(name for name in config.getDisplays() if name != first))


def list_views(display: str = "", color: ColorSettings = DEFAULT_COLOR) -> tuple[str, ...]:
    """The views that a picture on a display may have, the default first; `none` only encodes as sRGB.

    Raises:
        UsageError: unknown display.
        GraphError, UsageError: no config.
    """
    config, screen = get_color_manager(color).config, find_display(display, color)
    first = config.getDefaultView(screen) if screen else ""
    names = tuple(config.getViews(screen)) if screen else ()
    return (*([first] if first in names else ()), *(name for name in names if name != first), NO_VIEW)


def list_looks(color: ColorSettings = DEFAULT_COLOR) -> tuple[str, ...]:
    """The looks of the config. Raises GraphError, UsageError: no config."""
    return tuple(get_color_manager(color).config.getLookNames())


def find_view(name: str, display: str = "", color: ColorSettings = DEFAULT_COLOR) -> str:
    """The view that `name`, or its beginning in any case, means; "" is the default.

    Raises:
        UsageError: there is none, or more than one.
    """
    choices = list_views(display, color)
    return choices[0] if not name else _match_name(name, choices, "view")


def find_display(name: str, color: ColorSettings = DEFAULT_COLOR) -> str:
    """The display that `name`, or its beginning in any case, means; "" is the default. Raises UsageError."""
    choices = list_displays(color)
    return (choices[0] if choices else "") if not name else _match_name(name, choices, "display")


def find_look(name: str, color: ColorSettings = DEFAULT_COLOR) -> str:
    """The look that `name` means: "" is that of the view, `none` none at all. Raises UsageError."""
    return name if name in ("", NO_LOOK) else _match_name(name, (*list_looks(color), NO_LOOK), "look")


def check_view(view: str, display: str = "", look: str = "", color: ColorSettings = DEFAULT_COLOR) -> None:
    """Raise UsageError for a view, display or look that the config does not have."""
    find_view(view, display, color)
    find_look(look, color)


def _match_name(name: str, choices: tuple[str, ...], noun: str) -> str:
    word = name.casefold()
    matches = [one for one in choices if one.casefold() == word] or [
        one for one in choices if one.casefold().startswith(word)
    ]
    if len(matches) == 1:
        return matches[0]
    folded = {word: one for one in choices for word in (one.casefold(), one.casefold().split()[0])}
    close_names = difflib.get_close_matches(word, folded, 1, 0.4)
    hint = f"did you mean '{folded[close_names[0]]}'? Choose" if close_names else "choose"
    raise UsageError(f"there is no {noun} '{name}': {hint} from {', '.join(choices)}")


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
    processor = make_display_processor(view, display, look, color).getDefaultCPUProcessor()
    pixels = unpremultiply(array)
    rgb = np.ascontiguousarray(pixels[..., :3])
    _apply(processor, rgb)
    pixels[..., :3] = rgb
    return pixels if bits == 32 else quantize(pixels, bits)


def unpremultiply(array: Array) -> Array:
    """A copy of pixels [h, w, 3 or 4] in float32, finite and within half floats, color not multiplied by alpha."""
    pixels = np.array(array, dtype=np.float32)
    np.nan_to_num(pixels, copy=False, nan=0.0, posinf=_LARGEST, neginf=-_LARGEST)
    rgb = pixels[..., :3]
    if pixels.shape[2] == 4:
        alpha = pixels[..., 3:]
        np.divide(rgb, alpha, out=rgb, where=alpha > 0.0)
    np.clip(rgb, -_LARGEST, _LARGEST, out=rgb)
    return pixels


def quantize(pixels: Array, bits: Literal[8, 10, 12, 16]) -> Array:
    """0..1 as integers of so many bits, rounded, in uint8 or uint16."""
    top = (1 << bits) - 1
    return (np.clip(pixels, 0.0, 1.0) * top + 0.5).astype(np.uint8 if bits == 8 else np.uint16)


def make_display_processor(view: str, display: str, look: str = "", color: ColorSettings = DEFAULT_COLOR) -> Any:
    """From the working space to what a display shows. A `look` stands in place of those of the view.

    Raises:
        UsageError: unknown view, display or look.
        GraphError, UsageError: no config, or one that lacks something.
    """
    if view.casefold() == NO_VIEW and look in ("", NO_LOOK):
        return _make_plain_processor(get_color_manager(color))
    screen, chosen_view, chosen_look = (
        find_display(display, color),
        find_view(view, display, color),
        find_look(look, color),
    )
    if chosen_view == NO_VIEW and chosen_look in ("", NO_LOOK):
        return _make_plain_processor(get_color_manager(color))
    return _make_view_processor(get_color_manager(color), screen, chosen_view, chosen_look)


@lru_cache(maxsize=64)
def _make_plain_processor(manager: ColorManager) -> Any:
    """From the working space to sRGB."""
    return manager.attempt(
        lambda: _make_builtin_view_processor(manager, load_builtin_config(BUILT_IN), _DISPLAY, _PLAIN_VIEW)
    )


def _make_builtin_view_processor(manager: ColorManager, config: Any, display: str, view: str) -> Any:
    forward, working = load_ocio().TRANSFORM_DIR_FORWARD, manager.working
    if not manager.is_chosen and (space := config.getColorSpace(working.name)):
        return config.getProcessor(space.getName(), display, view, forward)
    source = manager.spaces if working.own else load_studio_config()
    return load_ocio().Config.GetProcessorFromConfigs(source, working.name, config, display, view, forward)


@lru_cache(maxsize=64)
def _make_view_processor(manager: ColorManager, display: str, view: str, look: str) -> Any:
    api = load_ocio()
    if not manager.is_chosen and not look:
        return manager.attempt(lambda: _make_builtin_view_processor(manager, manager.config, display, view))

    def make() -> Any:
        group, space = manager.bridge_to_views()
        if look not in ("", NO_LOOK):
            group.appendTransform(api.LookTransform(space, space, look))
        if view == NO_VIEW:
            plain = api.Config.GetProcessorFromConfigs(
                manager.config, space, load_builtin_config(BUILT_IN), _DISPLAY, _PLAIN_VIEW, api.TRANSFORM_DIR_FORWARD
            )
            group.appendTransform(plain.createGroupTransform())
            return manager.config.getProcessor(group)
        group.appendTransform(api.DisplayViewTransform(space, display, view, looksBypass=look != ""))
        return manager.config.getProcessor(group)

    return manager.attempt(make)


def _is_srgb(space: ColorSpace) -> bool:
    return space.name in ("srgb_rec709_scene", "sRGB Encoded Rec.709 (sRGB)")


def _convert_to_working(light: Array, source_array: Array, manager: ColorManager, space: ColorSpace) -> Array:
    """Colors through OpenColorIO; what is not a copy of what was given yet becomes one."""
    light = light.copy() if light is source_array or np.shares_memory(light, source_array) else light
    _apply(_make_reading_processor(manager, space), light)
    return light


@lru_cache(maxsize=256)
def _make_reading_processor(manager: ColorManager, space: ColorSpace) -> Any:
    """From a space to the working space."""
    source = manager.find(space.name) if space.name == LINEAR_REC709 else space
    return _make_exact(manager.make_processor(source or space, manager.working))


def _make_exact(processor: Any) -> Any:
    """On the CPU without short cuts: a fifth slower, and those are off by a part of a thousand of log codes."""
    return processor.getOptimizedCPUProcessor(load_ocio().OPTIMIZATION_LOSSLESS)


@cache
def _make_srgb_table(dtype: str) -> Array:
    count = np.iinfo(dtype).max
    return decode_srgb(np.arange(count + 1) / count).astype(np.float32)


def _apply(processor: Any, rgb: Array) -> None:
    """Transform contiguous float32 colors in place, a band of rows per core: ACES costs 0.3 us per pixel."""
    from concurrent.futures import ThreadPoolExecutor

    cores = min(available_cores(), rgb.shape[0])
    bands = [band for band in np.array_split(rgb, cores) if band.size]
    with ThreadPoolExecutor(cores) as pool:
        list(pool.map(processor.applyRGB, bands))
