"""What the proofs of lens effects share: what Blender made (see data/README.md), and how near a picture is to it."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from types import MappingProxyType

import numpy as np

Array = np.ndarray


@cache
def blender(name: str = "lens") -> MappingProxyType[str, Array]:
    """All of blender_lens.npz, or of another file."""
    with np.load(Path(__file__).parent / "data" / f"blender_{name}.npz") as data:
        return MappingProxyType({name: data[name] for name in data.files})


def opaque(light: Array) -> Array:
    """Red, green, blue as a picture."""
    return np.dstack([light.astype(np.float32), np.ones(light.shape[:2], np.float32)])


def psnr(picture: Array, expected: Array, where: Array | None = None) -> float:
    """Peak signal to noise of red, green, blue, in dB; the peak is the brightest of what is expected."""
    expected = expected.astype(float)
    error = ((picture[..., :3] - expected) ** 2).mean(-1)
    return float(10.0 * np.log10(expected.max() ** 2 / (error if where is None else error[where]).mean()))
