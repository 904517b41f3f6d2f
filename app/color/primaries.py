"""The primaries of the working space, for shaders and headers."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from .file_space import CHROMATICITIES
from .header_space import primaries_to_xyz
from .management import LINEAR_REC709, ColorManager, OcioColorSpace, load_studio_config

if TYPE_CHECKING:
    from ..resources.working_space import WorkingSpace

REC709_LUMINANCE = (0.2126, 0.7152, 0.0722)
"""How much red, green and blue of Rec.709 add to luminance, and of its display values to luma (ITU-R BT.709-6)."""

_MATRIX_TOLERANCE = 2e-4
"""The largest difference of elements of two matrices that count as equal. Configs write matrices with 4 to 7 digits; 4
digits change products with an inverse by 5e-5. The closest two known gamuts, AP1 and Rec.2020, differ by 0.045."""


def find_working_space(manager: ColorManager) -> WorkingSpace | None:
    """The constants of the working space for shaders; None for linear Rec.709.

    Raises:
        GraphError: nobody knows the space, or it is not linear.
        UsageError: $OCIO names no config.
    """
    return None if manager.is_plain else _make_working_space(manager)


def find_luminance_weights(manager: ColorManager) -> tuple[float, ...]:
    """How much red, green and blue of the working space add to luminance, as shaders have it. Raises as
    `find_working_space`."""
    space = find_working_space(manager)
    return space.luminance if space else REC709_LUMINANCE


def find_chromaticities(manager: ColorManager, space: OcioColorSpace) -> tuple[float, ...]:
    """x and y of red, green, blue and white of a linear space with a known name; else nothing."""
    if space.data:
        return ()
    name = manager.find_header_name(space)
    return CHROMATICITIES.get(name) or ()


@lru_cache(maxsize=16)
def _make_working_space(manager: ColorManager) -> WorkingSpace | None:
    from ..resources.working_space import WorkingSpace  # reading files does not need it

    rec709 = OcioColorSpace("Linear Rec.709 (sRGB)", False)
    to = _conversion_matrix(manager, manager.working, manager.find(LINEAR_REC709) or rec709)
    if np.allclose(to, np.eye(3), atol=_MATRIX_TOLERANCE):
        return None
    return WorkingSpace(_luminance_weights(to), tuple(to.ravel().tolist()), tuple(np.linalg.inv(to).ravel().tolist()))


def _conversion_matrix(manager: ColorManager, source: OcioColorSpace, target: OcioColorSpace) -> np.ndarray:
    """The matrix from one linear space to another, by rows."""
    colors = np.eye(3, dtype=np.float32)
    manager.make_processor(source, target).getDefaultCPUProcessor().applyRGB(colors)
    return colors.T.astype(np.float64)


def _luminance_weights(to_rec709: np.ndarray) -> tuple[float, ...]:
    """The luminance weights of the standard that defines these primaries; for others, computed through Rec.709."""
    for name, gamut in CHROMATICITIES.items():
        to_rec709_by_name = np.eye(3, dtype=np.float32)
        load_studio_config().getProcessor(name, LINEAR_REC709).getDefaultCPUProcessor().applyRGB(to_rec709_by_name)
        if np.allclose(to_rec709, to_rec709_by_name.T, atol=_MATRIX_TOLERANCE):
            return tuple(primaries_to_xyz(gamut)[1].tolist())
    return tuple((primaries_to_xyz(CHROMATICITIES[LINEAR_REC709])[1] @ to_rec709).tolist())
