"""What the compiler needs to know of the device that runs a plan."""

from __future__ import annotations

from typing import ClassVar

from ..resources.record import Record
from ..resources.render_choices import Form, Precision

__all__ = ["NULL", "Form", "Precision", "Target"]


class Target(Record, frozen=True):
    """A GL implementation: its name, version (410, 430, ...), limits, and what suits it.

    `form` is how passes are emitted, and `why` says what decided it: see `devices`. `precision` is that of color
    between passes: the software rasterizer truncates half-float stores and gains nothing from them, so it takes float.
    """

    renderer: str
    version: int
    software: bool
    max_size: int = 16384
    max_images: int = 8
    max_samplers: int = 16
    max_targets: int = 8
    form: Form = "compute"
    precision: Precision = "float"
    memory: int = 0
    """Bytes that textures and pictures may take at once; 0 for as many as there are."""
    why: str = ""

    compare_exclude: ClassVar[frozenset[str]] = frozenset({"why"})

    @property
    def loads_images(self) -> bool:
        """True if compute passes read through image units: a third of a sampler's cost on the software rasterizer."""
        return self.form == "compute" and self.software

    def has_images_for(self, pictures: int) -> bool:
        """True if a pass that reads and writes so many pictures reads them through image units: if there are enough."""
        return self.loads_images and pictures <= self.max_images

    @property
    def rounds_halves(self) -> bool:
        """True if passes round to half floats in GLSL, as the processor does: to nearest even, and NaN stays."""
        return self.software and self.version >= 430

    @property
    def max_inputs(self) -> int:
        """How many pictures one pass may read."""
        return self.max_images - 1 if self.loads_images else self.max_samplers

    @property
    def name_in_sentences(self) -> str:
        """The name of the renderer; where a plan is made without one, "a device"."""
        return "a device" if self.renderer == NULL.renderer else self.renderer


NULL = Target("none", 430, software=True, why="planned without a device")
"""A target for plans that nothing runs."""
