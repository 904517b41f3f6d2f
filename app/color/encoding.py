"""Encodes color for a file: through a view for people, or as numbers of a color space for programs."""

from __future__ import annotations

from typing import Literal

import numpy as np
from msgspec import Struct, field

from ..errors import UsageError
from ..resources.render_choices import Dither
from .display import VIDEO_VIEW, check_view, find_display, find_view, to_display
from .dithering import make_dither
from .management import LINEAR_REC709, ColorManager, OcioColorSpace, get_default_color_manager
from .primaries import find_chromaticities
from .transforms import (
    Array,
    apply_to_rgb,
    convert_premultiplied,
    find_writing_processor,
    from_working,
    is_matrix,
    quantize,
    run_side_by_side,
    unpremultiply,
)

SRGB = "srgb_rec709_scene"
VIDEO_SPACE = "g24_rec709_scene"
"""What a BT.1886 display shows with primaries of BT.709."""

_IN_PNG = (SRGB, "srgb_p3d65_scene", "g22_rec709_scene", "lin_rec709_scene")
_USE_DISPLAY_NAME = "<USE_DISPLAY_NAME>"
_BAND_ROWS = 64
"""Rows that are encoded at a time: the dither repeats after as many, and their numbers stay in the cache of a core."""


class Encoding(Struct, frozen=True):
    """How color is written. Formats for people show it through a `view` of a `display`; a `look` replaces the looks of
    the view. With a `space`, every format holds numbers of that color space."""

    view: str = ""
    display: str = ""
    look: str = ""
    space: str = ""
    dither: Dither = "none"
    """How `to_codes` rounds colors to 8 or 10 bits."""
    manager: ColorManager = field(default_factory=get_default_color_manager)
    """The color manager; by default the one for graphs without color settings."""

    @property
    def is_plain(self) -> bool:
        """True if linear Rec.709 is written unchanged."""
        return not self.space and self.manager.is_plain

    def check_names(self) -> None:
        """Raise UsageError for a view, display, look or space that does not exist; GraphError if the graph's own config
        is at fault."""
        if self.space and (self.view or self.display or self.look):
            raise UsageError("a picture is written through a view or into a color space: give one of them")
        if self.space:
            _ = self._target
        if self.view or self.display or self.look:
            check_view(self.view, self.display, self.look, self.manager)

    def to_numbers(self, array: Array) -> Array:
        """Working-space color [h, w, c] in the color space that is written; premultiplied if it has four channels."""
        if self.is_plain or not self.space or array.shape[2] < 3:
            return array
        return self._convert(array, self._target)

    def to_radiance(self, array: Array) -> Array:
        """The same for Radiance files, which hold linear Rec.709 unless a space is given."""
        if self.is_plain:
            return array
        target = self._target if self.space else self.manager.find(LINEAR_REC709)
        return self._convert(array, target or OcioColorSpace(LINEAR_REC709, False))

    def to_codes(self, array: Array, bits: Literal[8, 10, 16], *, is_data: bool = False, frame: int = 1) -> Array:
        """Pixels [h, w, 3 or 4] as integers: color through the view or in the color space, with straight alpha.

        Data is its number times the largest integer: no view and no color space applies. 10 bits are the upper ones
        of 16. Color is dithered up to 10 bits, alpha and data are not. `frame` chooses the pattern.
        """
        height, width = array.shape[:2]
        codes = np.empty(array.shape, np.uint8 if bits == 8 else np.uint16)
        noise = None
        if bits < 16 and self.dithers(is_data):
            noise = make_dither(width, _BAND_ROWS, frame) / np.float32((1 << bits) - 1)

        def encode(top: int) -> None:
            rows = slice(top, top + _BAND_ROWS)
            encoded = self.to_encoded(array[rows], is_data=is_data)
            if noise is not None:
                for channel in range(3):  # the same for all: gray stays gray. Numpy adds four times as fast one by one
                    encoded[..., channel] += noise[: len(encoded)]
            codes[rows] = quantize(encoded, bits)

        run_side_by_side(encode, range(0, height, _BAND_ROWS))
        return np.rint(codes * (65535 / 1023)).astype(np.uint16) if bits == 10 else codes  # white stays white

    def dithers(self, is_data: bool = False) -> bool:
        """True if numbers are dithered where they are rounded to 10 bits or fewer."""
        return self.dither == "blue" and not is_data and not (self.space and self._target.data)

    def to_encoded(self, array: Array, *, is_data: bool = False) -> Array:
        """The same as numbers of 32 bits, from 0 for black to 1 for the largest integer, or beyond."""
        if is_data:
            return np.nan_to_num(array.astype(np.float32), nan=0.0)
        if not self.space:
            return to_display(array, self.view, bits=32, display=self.display, look=self.look, manager=self.manager)
        encoded = unpremultiply(array)
        if processor := find_writing_processor(self._target, self.manager):
            apply_to_rgb(processor, encoded)
        return encoded

    @property
    def header_space(self) -> str:
        """The name of the space of `numbers` in a header."""
        if self.is_plain:
            return LINEAR_REC709
        return self.manager.find_header_name(self._target) if self.space else self.manager.header_name

    @property
    def header_chromaticities(self) -> tuple[float, ...]:
        """The chromaticities of `numbers`, if they are not those of a header without any."""
        if self.is_plain or self.header_space == LINEAR_REC709:
            return ()
        return find_chromaticities(self.manager, self._target if self.space else self.manager.working)

    @property
    def display_space(self) -> str:
        """The name of the space of `codes` in a header."""
        if self.space:
            return self.manager.find_header_name(self._target)
        if self.view.casefold() == VIDEO_VIEW:
            return VIDEO_SPACE
        if not self.display and self.manager.is_plain:
            return SRGB
        config, display = self.manager.config, find_display(self.display, self.manager)
        view = find_view(self.view, display, self.manager)
        name = config.getDisplayViewColorSpaceName(display, view) if view in config.getViews(display) else ""
        space = config.getColorSpace(display if name == _USE_DISPLAY_NAME else name)
        interop_name = str(getattr(space, "getInteropID", str)() or "") if space else ""
        return (
            interop_name.removesuffix("_display") + "_scene"
            if interop_name.endswith("_display")
            else interop_name or SRGB
        )

    @property
    def _target(self) -> OcioColorSpace:
        manager = self.manager
        space = manager.find(self.space)
        if space is None:
            raise UsageError(f"there is no color space '{self.space}'{manager.suggest_space(self.space)}")
        return space

    def _convert(self, array: Array, target: OcioColorSpace) -> Array:
        manager, converted = self.manager, np.array(array, dtype=np.float32)
        rgb, alpha = converted[..., :3], converted[..., 3:]

        def convert(straight: Array) -> Array:
            return from_working(straight, target, manager)

        if alpha.shape[2] and not is_matrix(manager.make_processor(manager.working, target).createGroupTransform()):
            converted[..., :3] = convert_premultiplied(rgb, alpha, convert)
        else:
            converted[..., :3] = convert(rgb)
        return converted


def choose_png_space(name: str) -> str:
    """The color space, if PNG has chunks for it; "" for others, which PNG would name wrongly."""
    return name if name in _IN_PNG else ""
