"""A house config in a folder, and no config from the environment."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from halation.nodes import ColorSettings
from house_config import read_config, write_house
from oiio_pictures import write_picture

Make = Callable[..., Path]


@pytest.fixture(autouse=True)
def no_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("OCIO", raising=False)


@pytest.fixture
def house(tmp_path: Path) -> Path:
    """The file of the house config."""
    return write_house(tmp_path)


@pytest.fixture
def reference(house: Path):
    """The house config as OpenColorIO reads it."""
    return read_config(house)


@pytest.fixture
def color(house: Path) -> ColorSettings:
    """Settings of a graph that works in ACEScg by the role of the house config."""
    return ColorSettings(str(house), "scene_linear")


@pytest.fixture
def light() -> np.ndarray:
    """Colors [24, 32, 3] over sixteen stops."""
    random = np.random.default_rng(5)
    return np.exp2(random.uniform(-10.0, 6.0, (24, 32, 3))).astype(np.float32)


@pytest.fixture
def make(tmp_path: Path) -> Make:
    """`make("a.png", array, format="uint8", ...)` writes a file and gives its path."""
    return lambda name, array, **options: write_picture(tmp_path / name, array, **options)


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(7)
