"""The primaries of the working space, as shaders and headers want them."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from halation.nodes import ColorSettings

from .file_space import GAMUTS
from .management import LINEAR_REC709, Managed, Space, managed, studio

if TYPE_CHECKING:
    from ..resources.working_space import WorkingSpace

_CLOSE = 2e-4


def working_of(color: ColorSettings) -> WorkingSpace | None:
    """What shaders know of the working space; None is linear Rec.709.

    Raises:
        GraphError: nobody knows the space, or it is not linear.
        UsageError: $OCIO names no config.
    """
    manager = managed(color)
    return None if manager.plain else _working(manager)


def chromaticities(manager: Managed, space: Space) -> tuple[float, ...]:
    """x and y of red, green, blue and white of a linear space that the world has a name for; else nothing."""
    if space.data:
        return ()
    said = manager.header_name(space)
    return GAMUTS.get(said) or ()


@lru_cache(maxsize=16)
def _working(manager: Managed) -> WorkingSpace | None:
    from ..resources.working_space import WorkingSpace  # what reads files has no need of it

    rec709 = Space("Linear Rec.709 (sRGB)", False)
    to = _matrix(manager, manager.working, manager.find(LINEAR_REC709) or rec709)
    if np.allclose(to, np.eye(3), atol=_CLOSE):
        return None
    return WorkingSpace(_luminance(to), tuple(to.ravel().tolist()), tuple(np.linalg.inv(to).ravel().tolist()))


def _matrix(manager: Managed, source: Space, target: Space) -> np.ndarray:
    """From one linear space to another, by rows."""
    colors = np.eye(3, dtype=np.float32)
    manager.processor(source, target).getDefaultCPUProcessor().applyRGB(colors)
    return colors.T.astype(np.float64)


def _luminance(to_rec709: np.ndarray) -> tuple[float, ...]:
    """The weights of the standard that these primaries are from; else those of what Rec.709 makes of them."""
    for name, gamut in GAMUTS.items():
        known = np.eye(3, dtype=np.float32)
        studio().getProcessor(name, LINEAR_REC709).getDefaultCPUProcessor().applyRGB(known)
        if np.allclose(to_rec709, known.T, atol=_CLOSE):
            return tuple(xyz_of(gamut)[1].tolist())
    return tuple((xyz_of(GAMUTS[LINEAR_REC709])[1] @ to_rec709).tolist())


def xyz_of(gamut: tuple[float, ...]) -> np.ndarray:
    """The matrix to CIE XYZ of primaries by their chromaticities, white being (1, 1, 1) (SMPTE RP 177)."""
    points = np.array([(x / y, 1.0, (1.0 - x - y) / y) for x, y in zip(gamut[::2], gamut[1::2], strict=True)]).T
    return points[:, :3] * np.linalg.solve(points[:, :3], points[:, 3])
