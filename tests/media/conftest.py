"""Files made by OpenImageIO itself, for the media package to read."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from oiio_pictures import write_picture

Make = Callable[..., Path]


@pytest.fixture
def make(tmp_path: Path) -> Make:
    """`make("a.png", array, format="uint8", ...)` writes a file and gives its path."""
    return lambda name, array, **options: write_picture(tmp_path / name, array, **options)


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(7)
