"""What the proofs of filters share: pictures with the range of real light, and the names of edge modes elsewhere."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import resources

import numpy as np
import pytest
from exr_files import read


@dataclass(frozen=True)
class EdgeMode:
    """One edge mode as Halation, scipy's filters, scipy's map_coordinates and numpy's pad call it."""

    name: str
    scipy: str
    scipy_map: str
    numpy: str


EDGES = (
    EdgeMode("clamp", "nearest", "nearest", "edge"),
    EdgeMode("mirror", "mirror", "mirror", "reflect"),
    EdgeMode("reflect", "reflect", "reflect", "symmetric"),
    EdgeMode("wrap", "wrap", "grid-wrap", "wrap"),
    EdgeMode("black", "constant", "grid-constant", "constant"),
)


@pytest.fixture(params=EDGES, ids=lambda mode: mode.name)
def edge(request):
    """Each edge mode in turn."""
    return request.param


@pytest.fixture
def hdr():
    """`hdr(width, height)`: RGBA noise over 20 stops with a few suns, alpha in 0..1; the same on every call."""

    def make(width: int, height: int, opaque: bool = False) -> np.ndarray:
        random = np.random.default_rng(width * 10007 + height)
        picture = np.exp(random.normal(-1.0, 2.0, (height, width, 4))).astype(np.float32)
        picture[random.random((height, width)) > 0.99, :3] *= 50.0
        picture[..., 3] = 1.0 if opaque else random.random((height, width))
        return picture

    return make


@pytest.fixture(scope="session")
def rendered_frame() -> np.ndarray:
    """The color of the sample frame that ships with Halation, by OpenImageIO: [h, w, 4]."""
    with resources.as_file(resources.files("halation.presets") / "samples" / "neon.exr") as path:
        return np.ascontiguousarray(read(path)[..., :4])
