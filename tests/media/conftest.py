"""Files made by OpenImageIO itself, for the media package to read."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
import pytest

Array = np.ndarray
Make = Callable[..., Path]


def made(
    path: Path,
    array: Array,
    *,
    format: str = "float",
    names: tuple[str, ...] = (),
    at: tuple[int, int] = (0, 0),
    display: tuple[int, int, int, int] | None = None,
    attributes: Mapping[str, Any] | None = None,
) -> Path:
    """Write [h, w, c]; `at` is where the data starts, `display` the display window as x, y, width, height."""
    height, width, channels = array.shape
    spec = oiio.ImageSpec(width, height, channels, format)
    spec.x, spec.y = at
    spec.full_x, spec.full_y, spec.full_width, spec.full_height = display or (0, 0, width, height)
    if names:
        spec.channelnames = names
        spec.alpha_channel = names.index("A") if "A" in names else -1
    for name, value in (attributes or {}).items():
        if isinstance(value, tuple):
            spec.attribute(name, value[0], value[1])
        else:
            spec.attribute(name, value)
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), spec) and output.write_image(np.ascontiguousarray(array)) and output.close()
    return path


@pytest.fixture
def make(tmp_path: Path) -> Make:
    """`make("a.png", array, format="uint8", ...)` writes a file and gives its path."""
    return lambda name, array, **options: made(tmp_path / name, array, **options)


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(7)
