"""Makes pictures of differences, for reports and folders."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from msgspec.structs import replace

from ..color.transforms import to_three_channels
from ..errors import OutputError
from ..media.comparison.metrics import amplify_difference
from ..media.pictures.stored import StoredPart, copy_picture, encode_for_viewing, encode_png, write_difference
from ..resources.atomic_write import write_bytes_atomically
from ..resources.sandbox import Sandbox
from .cases import Case
from .comparison import PictureParts
from .results import PictureCheck, PictureViews

_BRIGHTEST = 99.5
"""The percentile of differences that is shown white, so that a few outliers do not hide the rest. Chosen by eye."""

Array = np.ndarray

_UNSAFE = re.compile(r"[^\w.+-]+")


def make_views(check: PictureCheck, actual_parts: PictureParts, golden_parts: PictureParts, view: str) -> PictureViews:
    """Views of the worst layer: both pictures, and their difference, as bright as it can be shown."""
    name = check.layer if check.layer in actual_parts else next(iter(actual_parts))
    actual, expected = actual_parts[name], golden_parts.get(name)
    if expected is None:
        return PictureViews(encode_png(encode_for_viewing(actual, view, _measure_range(actual))))
    span, gain = _measure_range(expected), 1.0
    first, second = actual.array, expected.array
    if first.shape == second.shape:
        # Bright lights differ by large numbers, beside which all other differences would be black.
        size = np.maximum(1.0, np.abs(np.where(np.isfinite(second), second, 0.0)))
        first, second = first / size, second / size
        gain = _choose_gain(np.abs(first - second))
    light = amplify_difference(first, second, gain)
    views = (encode_png(encode_for_viewing(actual, view, span)), encode_png(encode_for_viewing(expected, view, span)))
    return PictureViews(*views, encode_png(light ** (1.0 / 2.2)), gain)


def write_failure_pictures(
    check: PictureCheck,
    case: Case,
    actual: Path,
    actual_parts: PictureParts,
    golden_parts: PictureParts,
    folder: Path,
    sandbox: Sandbox,
) -> PictureCheck:
    """Write the pictures of a failed check to a folder: as stored and as PNG; differences as EXR and PNG.

    Raises OutputError.
    """
    folder = folder / _UNSAFE.sub("_", case.suite.name.partition(".")[0]) / _UNSAFE.sub("_", case.name)
    if reason := sandbox.find_write_fault(folder):
        raise OutputError(f"{folder}: {reason}")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        raise OutputError(f"{folder}: the folder cannot be made ({fault.strerror}); choose another --out") from None
    stem = check.golden.stem
    files = [folder / f"{stem}.actual{actual.suffix}"]
    copy_picture(files[0], actual, sandbox=sandbox)
    if golden_parts:
        files.append(folder / f"{stem}.expected{check.golden.suffix}")
        copy_picture(files[1], check.golden, sandbox=sandbox)
        layer = (
            check.layer
            if check.layer in actual_parts and check.layer in golden_parts
            else next(iter(actual_parts.keys() & golden_parts), "")
        )
        if layer in actual_parts and layer in golden_parts:
            files.append(folder / f"{stem}.difference.exr")
            write_difference(
                files[2], {layer: _subtract(actual_parts[layer].array, golden_parts[layer].array)}, sandbox=sandbox
            )
    if check.views:
        for word in ("actual", "expected", "difference"):
            data: bytes = getattr(check.views, word)
            if data:
                files.append(folder / f"{stem}.{word}.view.png")
                write_bytes_atomically(files[-1], data, sandbox)
    return replace(check, files=tuple(files))


def _subtract(actual: Array, expected: Array) -> Array:
    """The absolute difference; for pictures of different sizes, a picture that shows that."""
    same = actual.shape == expected.shape
    return (
        np.abs(to_three_channels(actual) - to_three_channels(expected))
        if same
        else amplify_difference(actual, expected, 1.0)
    )


def _choose_gain(difference: Array) -> float:
    """The factor that makes a high percentile of differences white."""
    differences = difference[np.isfinite(difference) & (difference > 0.0)]
    return 1.0 / float(np.percentile(differences, _BRIGHTEST)) if differences.size else 1.0


def _measure_range(part: StoredPart) -> tuple[float, float]:
    """The numbers that are shown black and white for data."""
    finite = part.array[np.isfinite(part.array)]
    return (float(finite.min()), float(finite.max())) if part.is_data and finite.size else (0.0, 1.0)
