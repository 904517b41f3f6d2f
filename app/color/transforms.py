"""Converts color to and from the working space.

OpenColorIO is imported only when a file needs it: sRGB to linear Rec.709, the usual case, is a table.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from functools import cache, lru_cache
from typing import Any, Literal

import numpy as np

from ..resources.machine import available_cores
from .file_space import FileSpace
from .management import LINEAR_REC709, ColorManager, OcioColorSpace, load_ocio

_LARGEST = 65504.0
"""The largest half float: what passes keep."""
_LEAST_ALPHA = float(np.finfo(np.float32).tiny)
"""Below this alpha, division would amplify rounding. OpenImageIO's colorconvert has the same limit."""

_BAND_NUMBERS = 1 << 20
"""Numbers for which another thread is worth its start, 0.1 ms: even a plain curve takes 5 ms for so many."""

Array = np.ndarray


def is_in_working_space(file_space: FileSpace, manager: ColorManager) -> bool:
    """True if the numbers of a file are used unchanged."""
    if file_space.described is not None:
        return False
    return (
        file_space.space is None
        or file_space.space.data
        or (not manager.is_plain and file_space.space == manager.working)
    )


def is_linear(file_space: FileSpace, manager: ColorManager) -> bool:
    """True if a matrix converts a file to the working space: then it does not matter whether its color is multiplied by
    alpha."""
    if file_space.described is not None:
        return file_space.described.is_linear
    if file_space.space is None or (not manager.is_chosen and _is_srgb(file_space.space)):
        return file_space.space is None
    return is_matrix(_make_reading_group(manager, file_space.space))


def is_display_referred(file_space: FileSpace, manager: ColorManager) -> bool:
    """True for color that is encoded for a screen; False for light of a scene, linear or on a logarithmic curve.

    A config says so by the `encoding` of a space; spaces that have none count as light of a scene. So do spaces of HDR
    screens, because only a view can fit their highlights into a picture of standard range.
    """
    if file_space.described is not None:
        return not file_space.described.is_linear and not file_space.described.is_film
    space = file_space.space
    if space is None or space.data:
        return False
    return _is_srgb(space) or manager.find_encoding(space) == "sdr-video"


def is_matrix(group: Any) -> bool:
    """True for a group of matrices without offset."""
    return all(isinstance(part, load_ocio().MatrixTransform) and not any(part.getOffset()) for part in group)


def convert_premultiplied(rgb: Array, alpha: Array, convert: Callable[[Array], Array]) -> Array:
    """Premultiplied colors [h, w, 3] through a color change with a curve, float32.

    The curve applies to straight color, so color is divided by alpha first, and multiplied by it afterwards. In three
    cases it is converted as it is: where alpha is 0 and color is a glow, where alpha is negative, and where division by
    a tiny alpha exceeds the range of the curve or of 32-bit floats.
    """
    divisible = alpha > _LEAST_ALPHA
    straight = np.array(rgb, np.float32)
    with np.errstate(over="ignore", invalid="ignore"):
        np.divide(straight, alpha, out=straight, where=divisible)
        converted = convert(straight)
        np.multiply(converted, alpha, out=converted, where=divisible)
    lost = divisible[..., 0] & ~np.isfinite(converted).all(axis=-1) & np.isfinite(rgb).all(axis=-1)
    if lost.any():
        converted[lost] = convert(np.array(rgb[lost], np.float32)[None])[0]
    return converted


def to_working(rgb: Array, file_space: FileSpace, manager: ColorManager) -> Array:
    """Colors [..., 3] of any dtype (integers fill 0..1) in the working space, float32.

    sRGB by IEC 61966-2-1 unless someone chose a config; other spaces through OpenColorIO.

    Raises:
        GraphError, UsageError: the config cannot say how.
    """
    if is_in_working_space(file_space, manager):
        return np.ascontiguousarray(to_float(rgb), dtype=np.float32)
    if file_space.described is not None:
        light = file_space.described.to_rec709(to_float(rgb))
        return light if manager.is_plain else _convert_to_working(light, rgb, manager, _find_rec709(manager))
    assert file_space.space is not None
    if not manager.is_chosen and _is_srgb(file_space.space):
        has_table = rgb.dtype == np.uint8 or rgb.dtype == np.uint16
        light = _make_srgb_table(rgb.dtype.str)[rgb] if has_table else decode_srgb(rgb).astype(np.float32)
        if manager.is_plain:
            return light
        return _convert_to_working(light, rgb, manager, OcioColorSpace(LINEAR_REC709, True))
    return _convert_to_working(np.ascontiguousarray(to_float(rgb), dtype=np.float32), rgb, manager, file_space.space)


def from_working(rgb: Array, space: OcioColorSpace, manager: ColorManager) -> Array:
    """Working-space colors [..., 3] in another space, float32. Raises as `to_working`."""
    converted = np.array(rgb, dtype=np.float32, order="C")
    if processor := find_writing_processor(space, manager):
        apply_processor(processor, converted)
    return converted


def find_writing_processor(space: OcioColorSpace, manager: ColorManager) -> Any | None:
    """What turns working-space colors into those of a space; None where they are the same. Raises as `to_working`."""
    if space.data or space == manager.working:
        return None
    return _make_exact(manager.make_processor(manager.working, space))


def decode_srgb(encoded: Array) -> Array:
    """Linear light of sRGB-encoded numbers (IEC 61966-2-1), mirrored for negative ones."""
    size = np.abs(encoded)
    return np.copysign(np.where(size <= 0.04045, size / 12.92, ((size + 0.055) / 1.055) ** 2.4), encoded)


def encode_srgb(light: Array) -> Array:
    """The inverse of `decode_srgb`."""
    size = np.abs(light)
    return np.copysign(np.where(size <= 0.0031308, 12.92 * size, 1.055 * size ** (1.0 / 2.4) - 0.055), light)


def to_float(array: Array) -> Array:
    """8- and 16-bit integers as 0..1 in float32. 32-bit integers are counts and keep their numbers; so do floats."""
    if array.dtype in (np.uint8, np.uint16):
        return array.astype(np.float32) / np.float32(np.iinfo(array.dtype).max)
    return array.astype(np.float32) if array.dtype.kind in "ui" else array


def unpremultiply(array: Array) -> Array:
    """A copy of pixels [h, w, 3 or 4] in float32, finite and within half floats, color not multiplied by alpha."""
    pixels = np.array(array, dtype=np.float32)
    np.nan_to_num(pixels, copy=False, nan=0.0, posinf=_LARGEST, neginf=-_LARGEST)
    if pixels.shape[2] == 4:
        alpha = pixels[..., 3]
        divisor = np.where(alpha > 0.0, alpha, np.float32(1.0))
        with np.errstate(over="ignore"):
            for channel in range(3):  # numpy is six times as fast one by one, and without a mask
                pixels[..., channel] /= divisor
    for channel in range(3):
        np.clip(pixels[..., channel], -_LARGEST, _LARGEST, out=pixels[..., channel])
    return pixels


def quantize(pixels: Array, bits: Literal[8, 10, 12, 16]) -> Array:
    """0..1 as integers of so many bits, rounded, in uint8 or uint16."""
    top = (1 << bits) - 1
    return (np.clip(pixels, 0.0, 1.0) * top + 0.5).astype(np.uint8 if bits == 8 else np.uint16)


def _is_srgb(space: OcioColorSpace) -> bool:
    return space.name in ("srgb_rec709_scene", "sRGB Encoded Rec.709 (sRGB)")


def _convert_to_working(light: Array, source_array: Array, manager: ColorManager, space: OcioColorSpace) -> Array:
    """Colors through OpenColorIO. The given array is never changed: it is copied if that has not happened yet."""
    light = light.copy() if light is source_array or np.shares_memory(light, source_array) else light
    apply_processor(_make_reading_processor(manager, space), light)
    return light


@lru_cache(maxsize=256)
def _make_reading_processor(manager: ColorManager, space: OcioColorSpace) -> Any:
    """The processor from a space to the working space."""
    return _make_exact(manager.make_processor(_find_named(manager, space), manager.working))


@lru_cache(maxsize=256)
def _make_reading_group(manager: ColorManager, space: OcioColorSpace) -> Any:
    """The transforms from a space to the working space."""
    return manager.make_processor(_find_named(manager, space), manager.working).createGroupTransform()


def _find_named(manager: ColorManager, space: OcioColorSpace) -> OcioColorSpace:
    return (manager.find(space.name) if space.name == LINEAR_REC709 else None) or space


def _find_rec709(manager: ColorManager) -> OcioColorSpace:
    """Linear Rec.709, of this config or of the studio config, which has it always."""
    space = manager.find(LINEAR_REC709)
    assert space is not None
    return space


def _make_exact(processor: Any) -> Any:
    """The CPU processor without OpenColorIO's fast approximations: it takes a fifth longer, and they are off by a
    thousandth of log codes."""
    return processor.getOptimizedCPUProcessor(load_ocio().OPTIMIZATION_LOSSLESS)


@cache
def _make_srgb_table(dtype: str) -> Array:
    count = np.iinfo(dtype).max
    return decode_srgb(np.arange(count + 1) / count).astype(np.float32)


def apply_processor(processor: Any, rgb: Array) -> None:
    """Transform contiguous float32 colors in place, a band of rows per core: ACES takes 0.3 us per pixel.

    OpenColorIO releases Python's lock meanwhile, so threads are enough.
    """
    bands = np.array_split(rgb, max(1, min(available_cores(), rgb.size // _BAND_NUMBERS)))
    run_side_by_side(processor.applyRGB, [band for band in bands if band.size])


def apply_to_rgb(processor: Any, pixels: Array) -> None:
    """Transform the first three channels of float32 pixels [h, w, 3 or 4] in place."""
    rgb = np.empty((*pixels.shape[:2], 3), np.float32)
    copy_rgb(pixels, rgb)
    apply_processor(processor, rgb)
    copy_rgb(rgb, pixels)


def copy_rgb(source: Array, target: Array) -> None:
    """Copy the first three channels: of pixels with four, numpy copies six times as fast one by one."""
    for channel in range(3):
        target[..., channel] = source[..., channel]


def run_side_by_side(work: Callable[[Any], object], parts: Collection[Any]) -> None:
    """Work on parts of a picture, on as many threads as there are cores. Raises what the work raises."""
    cores = min(available_cores(), len(parts))
    if cores < 2:
        for part in parts:
            work(part)
        return
    from concurrent.futures import ThreadPoolExecutor  # an import that most commands can spare

    with ThreadPoolExecutor(cores) as pool:
        for _ in pool.map(work, parts):
            pass


def to_three_channels(array: Array) -> Array:
    """[h, w, c] as three channels: one channel is gray, two are red and green; of more, the first three."""
    if array.shape[2] == 1:
        return np.repeat(array, 3, axis=2)
    return np.pad(array, ((0, 0), (0, 0), (0, max(0, 3 - array.shape[2]))))[..., :3]
