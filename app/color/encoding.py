"""Color on its way out: through a view for people, or as the numbers of a color space for programs."""

from __future__ import annotations

import numpy as np
from halation.nodes import ColorSettings
from msgspec import Struct, field

from ..errors import UsageError
from .management import LINEAR_REC709, Managed, Space, managed, ocio
from .primaries import chromaticities
from .transforms import Array, check_shown, find_display, find_view, from_working, quantized, straight, to_display

SRGB = "srgb_rec709_scene"
_IN_PNG = (SRGB, "srgb_p3d65_scene", "g22_rec709_scene", "lin_rec709_scene")
_SHARED = "<USE_DISPLAY_NAME>"


class Encoding(Struct, frozen=True):
    """How color leaves. Formats for people show it through a `view` of a `display`, with a `look` in place of those of
    the view; with a `space` every format holds the numbers of that color space."""

    view: str = ""
    display: str = ""
    look: str = ""
    space: str = ""
    color: ColorSettings = field(default_factory=ColorSettings)

    @property
    def manager(self) -> Managed:
        """How colors are managed."""
        return managed(self.color)

    @property
    def plain(self) -> bool:
        """True for the numbers of linear Rec.709, as they are."""
        return not self.space and self.manager.plain

    def check(self) -> None:
        """Refuse what there is not. Raises UsageError; GraphError where the graph's own config is at fault."""
        if self.space and (self.view or self.display or self.look):
            raise UsageError("a picture is written through a view or into a color space: give one of them")
        if self.space:
            _ = self._target
        if self.view or self.display or self.look:
            check_shown(self.view, self.display, self.look, self.color)

    def numbers(self, array: Array) -> Array:
        """Working-space color [h, w, c], premultiplied where it has four channels, in the space that is written."""
        if self.plain or not self.space or array.shape[2] < 3:
            return array
        return self._changed(array, self._target)

    def radiance(self, array: Array) -> Array:
        """The same for Radiance files, which hold linear Rec.709 unless somebody says otherwise."""
        if self.plain:
            return array
        found = self._target if self.space else self.manager.find(LINEAR_REC709)
        return self._changed(array, found or Space(LINEAR_REC709, False))

    def codes(self, array: Array, bits: int) -> Array:
        """Color [h, w, 3 or 4] as integers: through the view, or in the color space; alpha is straight."""
        depth = 8 if bits == 8 else 16
        if not self.space:
            shown = to_display(
                array,
                self.view,
                bits=32 if bits == 10 else depth,
                display=self.display,
                look=self.look,
                color=self.color,
            )
        else:
            shown = straight(array)
            shown[..., :3] = from_working(shown[..., :3], self._target, self.manager)
        if shown.dtype != np.float32:
            return shown
        if bits == 10:  # in the upper bits of 16
            return np.rint(quantized(shown, 10) * (65535 / 1023)).astype(np.uint16)
        return quantized(shown, depth)

    @property
    def header(self) -> str:
        """What a header calls the space of `numbers`."""
        if self.plain:
            return LINEAR_REC709
        return self.manager.header_name(self._target) if self.space else self.manager.interop

    @property
    def gamut(self) -> tuple[float, ...]:
        """The chromaticities of `numbers`, where they are not those that a header without any means."""
        if self.plain or self.header == LINEAR_REC709:
            return ()
        return chromaticities(self.manager, self._target if self.space else self.manager.working)

    @property
    def shown_as(self) -> str:
        """What a header calls the space of `codes`."""
        if self.space:
            return self.manager.header_name(self._target)
        if not self.display and self.manager.plain:
            return SRGB
        config, display = self.manager.config, find_display(self.display, self.color)
        view = find_view(self.view, display, self.color)
        name = config.getDisplayViewColorSpaceName(display, view) if view in config.getViews(display) else ""
        found = config.getColorSpace(display if name == _SHARED else name)
        said = str(getattr(found, "getInteropID", str)() or "") if found else ""
        return said.removesuffix("_display") + "_scene" if said.endswith("_display") else said or SRGB

    @property
    def _target(self) -> Space:
        manager = self.manager
        found = manager.find(self.space)
        if found is None:
            raise UsageError(f"there is no color space '{self.space}'{manager.hint(self.space)}")
        return found

    def _changed(self, array: Array, target: Space) -> Array:
        manager = self.manager
        config = manager.spaces if target.own else None
        if array.shape[2] < 4 or (config and config.isColorSpaceLinear(target.name, ocio().REFERENCE_SPACE_SCENE)):
            made = np.array(array, dtype=np.float32)
            made[..., :3] = from_working(made[..., :3], target, manager)
            return made
        made = straight(array)
        alpha = made[..., 3:]
        made[..., :3] = from_working(made[..., :3], target, manager)
        np.multiply(made[..., :3], alpha, out=made[..., :3], where=alpha > 0.0)
        return made


def png_space(name: str) -> str:
    """A space that PNG has chunks for; "" for others, which would be told wrongly."""
    return name if name in _IN_PNG else ""
