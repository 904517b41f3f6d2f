"""Which form of passes suits a device: the requested one, that of a table, or the one that was measured to be faster.

Pure: the facts of a device come as text and numbers, so every choice can be tested without one.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from msgspec import Struct

from ..errors import DeviceError
from .target import Form

COMPUTE = 430
"""The version of OpenGL that introduced compute shaders, 4.3, as GLSL writes it."""

_SOFTWARE = re.compile("llvmpipe|softpipe|swiftshader|swrast|lavapipe|software|basic render", re.IGNORECASE)

_TABLE: tuple[tuple[re.Pattern[str], Form, str], ...] = (
    (_SOFTWARE, "compute", "a software rasterizer loads from images for a third of what samplers cost it"),
    (
        re.compile(r"\b(H20|H100|H200|H800|GH200)\b"),
        "compute",
        "few units of this chip can draw, and all of them compute",
    ),
)
"""Renderers by name, the form that suits them, and why. All others are measured: chips of one maker differ.

Of a Hopper chip's processing clusters two can draw (NVIDIA H100 Tensor Core GPU Architecture, 2022).
"""


class FormChoice(Struct, frozen=True):
    """A form, and in a few words what decided it."""

    form: Form
    why: str


class FormTimings(Struct, frozen=True):
    """Seconds that the same passes took in either form; infinite where the driver refused them."""

    compute: float
    fragment: float

    @property
    def is_usable(self) -> bool:
        """True if the numbers can be compared: clocks of some drivers stand still."""
        return min(self.compute, self.fragment) > 0.0 and math.isfinite(min(self.compute, self.fragment))


def is_software(renderer: str) -> bool:
    """True for the name of a renderer that is no GPU."""
    return _SOFTWARE.search(renderer) is not None


def choose_form(
    renderer: str, version: int, requested: Form | None, measure: Callable[[], FormTimings | None]
) -> FormChoice:
    """The form of passes on a device. `measure` is called only if neither the user nor the table decides.

    Raises DeviceError for compute passes on an OpenGL without them.
    """
    number = f"{version / 100:.1f}"
    if requested == "compute" and version < COMPUTE:
        raise DeviceError(
            f"{renderer} offers OpenGL {number}, but compute passes need {COMPUTE / 100:.1f}: use fragment passes"
        )
    if requested:
        return FormChoice(requested, "asked for")
    if version < COMPUTE:
        return FormChoice("fragment", f"by the table: OpenGL {number} has no compute passes")
    for words, form, why in _TABLE:
        if words.search(renderer):
            return FormChoice(form, f"by the table: {why}")
    timings = measure()
    if timings is None or not timings.is_usable:
        return FormChoice("compute", "by the table: nothing could be measured, and blurs load less in compute passes")
    form = "compute" if timings.compute <= timings.fragment else "fragment"
    return FormChoice(form, f"measured: {_compare_timings(timings, form)}")


def _compare_timings(timings: FormTimings, form: Form) -> str:
    better, worse = sorted((timings.compute, timings.fragment))
    other_form = "fragment" if form == "compute" else "compute"
    if math.isinf(worse):
        return f"the driver refuses {other_form} passes"
    return f"{better * 1e3:.2f} ms against {worse * 1e3:.2f} in {other_form} passes"
