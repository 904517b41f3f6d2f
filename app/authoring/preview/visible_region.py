"""The visible region of pictures: if it is a small part of them, it is computed first."""

from __future__ import annotations

import math
from collections.abc import Mapping

from halation.nodes import Size
from msgspec import Struct

from ...compiler import Region, scale_size
from ...graph import Port
from ...renderer import Renderer
from .request import PreviewRequest

Box = tuple[float, float, float, float]
"""Left, top, right, bottom as fractions of a picture."""

MARGIN = 1 / 16
"""The margin beyond each edge, as a fraction of the visible region: small moves of the view need nothing new."""

GRID = 16
"""Pixels: the least margin, and the grid to which regions are rounded, so that a view that is moved makes few plans. A
choice."""

LARGEST = 0.5
"""The fraction of a picture above which the whole is computed at once: a part would save little."""

SMALL = 2**18
"""Pixels (512 x 512) below which the whole picture is computed at once: it is fast enough."""


class VisibleRegion(Struct, frozen=True):
    """The box that panels of these `names` show of pictures that are of the size `picture` at scale 1."""

    box: Box
    picture: Size
    names: frozenset[str]

    def region(self, size: Size) -> Region | None:
        """The region to compute of a picture of a size; None if it is nearly the whole."""
        spans: list[tuple[int, int]] = []
        for length, low, high in zip(size, self.box[:2], self.box[2:], strict=True):
            more = max(GRID, math.ceil((high - low) * length * MARGIN))
            first, end = math.floor(low * length) - more, math.ceil(high * length) + more
            spans.append((max(first // GRID * GRID, 0), min(-(-end // GRID) * GRID, length)))
        region, pixels = Region.of(spans[0], spans[1]), size[0] * size[1]
        return region if pixels >= SMALL and region.width * region.height <= LARGEST * pixels else None

    def share(self, scale: float) -> float:
        """The area that is computed first at a scale, as a fraction of the pictures."""
        size = scale_size(self.picture, scale)
        region = self.region(size)
        return region.width * region.height / (size[0] * size[1]) if region else 1.0


class PictureRegion(Struct, frozen=True):
    """A region of pictures of `size` pixels."""

    region: Region
    size: Size

    def shows(self, glimpse: VisibleRegion) -> bool:
        """True if the region contains everything visible."""
        for axis, (first, end) in enumerate((self.region.across, self.region.down)):
            length, low, high = self.size[axis], glimpse.box[axis], glimpse.box[axis + 2]
            if first > max(math.floor(low * length) - 1, 0) or end < min(math.ceil(high * length) + 1, length):
                return False
        return True


def find_visible_part(
    renderer: Renderer, request: PreviewRequest, ports: Mapping[str, Port], glimpse: VisibleRegion
) -> PictureRegion | None:
    """The region of these ports to compute first; None if all must be computed, or all is there.

    Frames that need the ones before are made as a whole, since these are. Raises the errors of `app.errors`.
    """
    if request.frame_cache.needs_history:
        return None
    plan = renderer.compile(request.graph, request.render_request(ports, request.frame))
    textures = renderer.runner.textures
    surfaces = [plan.surfaces[number] for number in plan.outputs.values()]
    size = scale_size(glimpse.picture, request.scale)
    if plan.memories or plan.tiling is not None or any(surface.frame_size != size for surface in surfaces):
        return None
    region = None if all(surface.key in textures for surface in surfaces) else glimpse.region(size)
    return region and PictureRegion(region, size)
